//! Elements of XML, written with indentation.

use std::fmt::Write;

/// An element with attributes and other elements in it.
#[derive(Debug, Clone)]
pub(super) struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
}

impl Element {
    pub(super) fn new(name: &'static str) -> Self {
        Self { name, attributes: Vec::new(), children: Vec::new() }
    }

    /// It with a text as an attribute.
    pub(super) fn text(mut self, key: &'static str, value: impl Into<String>) -> Self {
        self.attributes.push((key, value.into()));
        self
    }

    /// It with numbers as an attribute.
    pub(super) fn numbers(self, key: &'static str, values: &[f64]) -> Self {
        let words: Vec<String> = values.iter().copied().map(number).collect();
        self.text(key, words.join(" "))
    }

    /// It with other elements behind those that are in it.
    pub(super) fn with(mut self, children: impl IntoIterator<Item = Element>) -> Self {
        self.children.extend(children);
        self
    }

    /// Returns whether it has neither attributes nor children.
    pub(super) fn is_void(&self) -> bool {
        self.attributes.is_empty() && self.children.is_empty()
    }

    /// Adds it to a text, so many levels deep.
    pub(super) fn write(&self, out: &mut String, depth: usize) {
        let indentation = "  ".repeat(depth);
        // Writing to a string does not fail.
        let _ = write!(out, "{indentation}<{}", self.name);
        for (key, value) in &self.attributes {
            let _ = write!(out, " {key}=\"{}\"", escaped(value));
        }
        if self.children.is_empty() {
            out.push_str("/>\n");
            return;
        }
        out.push_str(">\n");
        for child in &self.children {
            child.write(out, depth + 1);
        }
        let _ = writeln!(out, "{indentation}</{}>", self.name);
    }
}

/// A number to a billionth, without zeros that say nothing.
fn number(value: f64) -> String {
    let rounded = (value * 1e9).round() / 1e9;
    // Not −0.
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded })
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
