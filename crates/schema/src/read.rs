//! From a text or a JSON value to the sections of a file, checked against its list of keys.

use pydslrep_text::{Span, closest};

use crate::keys::{Key, NAME, Names, Schema, Table, TableKind, dotted};
use crate::suggestions::{did_you_mean, suggestions};
use crate::toml::{Entry, Node, Value, from_json, parse};
use crate::values::{Refusal, numbers, rows};
use crate::{Problem, ProblemKind, as_key};

/// The contents of a file.
#[derive(Debug, Default)]
pub struct Contents {
    /// Its tables; those inside of others after them.
    pub sections: Vec<Section>,
    /// Its problems, in the order of the text.
    pub problems: Vec<Problem>,
}

/// A table as a file has it. Unknown keys and values that are wrong are left out.
#[derive(Debug)]
pub struct Section {
    /// The table in the list.
    pub table: &'static Table,
    /// Its name in the file.
    pub written: String,
    /// The names in place of the placeholders of the table's name.
    pub names: Vec<String>,
    /// The number of its kind before it, among those that appear any number of times.
    pub index: usize,
    /// Where its name is; `None` in JSON and for the keys outside of tables.
    pub name_span: Option<Span>,
    /// True if it has all required keys.
    pub is_complete: bool,
    values: Vec<(&'static str, Value, Option<Span>)>,
    /// The keys whose values are wrong.
    wrong: Vec<&'static str>,
}

impl Section {
    /// Its keys with their values.
    pub fn values(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.values.iter().map(|(key, value, _)| (*key, value))
    }

    /// Where the value of a key is.
    pub fn span(&self, key: &str) -> Option<Span> {
        self.values.iter().find(|(known, ..)| *known == key).and_then(|(_, _, span)| *span)
    }

    /// Returns the value of a key that is true or false.
    pub fn flag(&self, key: &str) -> Option<bool> {
        self.get(key)?.flag()
    }

    /// The number of a key.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.get(key)?.number()
    }

    /// The string of a key.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.get(key)?.text()
    }

    /// The list of numbers of a key.
    pub fn numbers(&self, key: &str) -> Option<Vec<f64>> {
        if let Value::List(nodes) = self.get(key)? { numbers(nodes) } else { None }
    }

    /// The two numbers of a key.
    pub fn pair(&self, key: &str) -> Option<(f64, f64)> {
        let numbers: [f64; 2] = self.numbers(key)?.try_into().ok()?;
        Some(numbers.into())
    }

    /// The lists of so many numbers that a key has.
    pub fn rows<const WIDTH: usize>(&self, key: &str) -> Option<Vec<[f64; WIDTH]>> {
        let Value::List(nodes) = self.get(key)? else { return None };
        rows(nodes)?.into_iter().map(|row| row.try_into().ok()).collect()
    }

    /// Where an item of a key's list is.
    pub fn item_span(&self, key: &str, index: usize) -> Option<Span> {
        if let Value::List(nodes) = self.get(key)? { nodes.get(index)?.span } else { None }
    }

    /// Returns whether a key has a wrong value.
    pub fn is_wrong(&self, key: &str) -> bool {
        self.wrong.contains(&key)
    }

    fn get(&self, key: &str) -> Option<&Value> {
        self.values().find(|(known, _)| *known == key).map(|(_, value)| value)
    }
}

impl Schema {
    /// Reads a TOML text. `names` are those that tables can have; any, if they are not known.
    ///
    /// # Errors
    /// If it is not TOML.
    pub fn read(&'static self, text: &str, names: Option<&Names>) -> Result<Contents, Problem> {
        let entries = parse(text, self.noun)?;
        let mut reader = Reader { schema: self, names, is_json: false, contents: Contents::default() };
        reader.table(&Location::default(), None, None, &entries);
        Ok(reader.finish())
    }

    /// Reads a JSON value. Keys may be in kebab or in camel case; null is the same as nothing.
    pub fn read_json(&'static self, value: &serde_json::Value) -> Contents {
        let mut reader = Reader { schema: self, names: None, is_json: true, contents: Contents::default() };
        let node = Node { value: from_json(value), span: None };
        reader.node(&Location::default(), None, &node);
        reader.finish()
    }
}

struct Reader<'n> {
    schema: &'static Schema,
    names: Option<&'n Names>,
    is_json: bool,
    contents: Contents,
}

/// Where the reader is.
#[derive(Debug, Clone, Default)]
struct Location {
    /// The name in the list.
    name: String,
    /// The name in the file.
    written: String,
    /// The names in place of the placeholders.
    names: Vec<String>,
    /// The number of tables of this name before this one.
    index: usize,
}

impl Reader<'_> {
    fn finish(self) -> Contents {
        let mut contents = self.contents;
        contents.problems.sort_by_key(|problem| problem.span.map(|span| span.start));
        contents
    }

    /// Reads a table, or several of a name.
    fn node(&mut self, at: &Location, name_span: Option<Span>, node: &Node) {
        let kind = self.schema.table(&at.name).map_or(TableKind::Once, |table| table.kind);
        match &node.value {
            Value::Nothing => {}
            // Lua writes an empty table so.
            Value::List(nodes) if nodes.is_empty() => {}
            Value::Table(entries) if kind != TableKind::Each => {
                self.table(at, name_span, node.span, entries);
            }
            Value::List(nodes) if kind == TableKind::Each => {
                for (index, node) in nodes.iter().enumerate() {
                    let at = Location { index, ..at.clone() };
                    match &node.value {
                        Value::Table(entries) => self.table(&at, name_span, node.span, entries),
                        _ => self.refuse_table(&at, "a table", node),
                    }
                }
            }
            _ => self.refuse_table(
                at,
                if kind == TableKind::Each { "a list of tables" } else { "a table" },
                node,
            ),
        }
    }

    fn refuse_table(&mut self, at: &Location, expected: &str, node: &Node) {
        let help = match self.schema.first_in(&at.name) {
            Some(table) if !self.is_json => format!("begin it with `{}`", table.header(table.name)),
            _ => self.known(&at.name),
        };
        let subject = match at.written.as_str() {
            "" => format!("the {}s", self.schema.noun),
            written => format!("`{written}`"),
        };
        let message = format!("{subject} must be {expected}, not {}", node.value.kind());
        let problem = Problem::new(ProblemKind::InvalidValue, &*at.written, node.span, message);
        self.contents.problems.push(problem.help(help));
    }

    fn table(&mut self, at: &Location, name_span: Option<Span>, span: Option<Span>, entries: &[Entry]) {
        let table = self.schema.table(&at.name);
        let mut values = Vec::new();
        let mut wrong = Vec::new();
        let mut inner = Vec::new();
        for entry in entries {
            let name = if self.is_json { kebab(&entry.key) } else { entry.key.clone() };
            if let Some(key) = table.and_then(|table| table.key(&name)) {
                match self.value(key, &dotted(&at.written, &entry.key), &entry.node) {
                    Some(value) => values.push((key.name, value, entry.node.span)),
                    None => wrong.push(key.name),
                }
            } else if let Some(inside) = self.inside(at, entry, &name) {
                inner.push((inside, entry));
            }
        }
        if let Some(table) = table {
            let stands_in =
                |key: &Key, names: &[&str]| key.unless.is_some_and(|other| names.contains(&other));
            let set: Vec<&str> = values.iter().map(|(name, ..)| *name).collect();
            let missing: Vec<&Key> = table
                .keys
                .iter()
                .filter(|key| key.required && !set.contains(&key.name) && !stands_in(key, &set))
                .collect();
            let is_told = |key: &Key| wrong.contains(&key.name) || stands_in(key, &wrong);
            for key in missing.iter().filter(|key| !is_told(key)) {
                let message = format!("`{}` is missing in this `{}`", key.name, at.written);
                let problem = Problem::new(ProblemKind::MissingKey, &*at.written, span, message);
                let help = format!("write, for example, `{} = {}`", key.name, key.example);
                self.contents.problems.push(problem.help(help));
            }
            let is_complete = missing.is_empty();
            let Location { written, names, index, .. } = at.clone();
            let section = Section { table, written, names, index, name_span, is_complete, values, wrong };
            self.contents.sections.push(section);
        }
        for (inside, entry) in inner {
            self.node(&inside, entry.key_span, &entry.node);
        }
    }

    /// The value of a key; `None` if it is wrong or null.
    fn value(&mut self, key: &Key, written: &str, node: &Node) -> Option<Value> {
        if node.value == Value::Nothing {
            return None;
        }
        let refusal = match key.read(self.schema, &node.value) {
            Ok(value) => return Some(value),
            Err(refusal) => refusal,
        };
        let help = refusal.help.or_else(|| Some(format!("write, for example, `{}`", key.example)));
        self.refuse(written, node.span, Refusal { help, ..refusal });
        None
    }

    fn refuse(&mut self, written: &str, span: Option<Span>, refusal: Refusal) {
        let Refusal { message, help, replacement } = refusal;
        let problem =
            Problem::new(ProblemKind::InvalidValue, written, span, format!("`{written}` {message}"));
        self.contents.problems.push(Problem { help, replacement, ..problem });
    }

    /// Where an entry leads that is not a key; `None` if there is no such table.
    fn inside(&mut self, at: &Location, entry: &Entry, name: &str) -> Option<Location> {
        let written = dotted(&at.written, &entry.key);
        let placeholder = dotted(&at.name, NAME);
        let mut names = at.names.clone();
        let name = if self.schema.has(&placeholder) {
            if let Some(known) = self.names.and_then(|names| names.inside(&at.name, &at.names))
                && !known.0.iter().any(|(known, _)| *known == entry.key)
            {
                self.unknown_name(at, &placeholder, entry, known);
                return None;
            }
            names.push(entry.key.clone());
            placeholder
        } else if self.schema.has(&dotted(&at.name, name)) {
            dotted(&at.name, name)
        } else {
            self.unknown_key(at, written, entry, name);
            return None;
        };
        Some(Location { name, written, names, index: 0 })
    }

    fn unknown_key(&mut self, at: &Location, written: String, entry: &Entry, name: &str) {
        let (noun, shown) = match self.schema.table(&at.name).map(|table| table.kind) {
            Some(TableKind::Catalogue { noun, .. }) => (noun, &entry.key),
            _ => (self.schema.noun, &written),
        };
        let message = format!("there is no {noun} `{shown}`");
        let known = self.schema.inside(&at.name);
        let spelled = closest(name, known.iter().copied());
        let home = self.home(name).filter(|_| spelled.is_none());
        let near = if home.is_none() { suggestions(name, &known) } else { Vec::new() };
        let help = home.map(|table| format!("it belongs in the table `{table}`"));
        let help = help.or_else(|| did_you_mean(&near)).unwrap_or_else(|| self.known(&at.name));
        let problem = Problem::new(ProblemKind::UnknownKey, written, entry.key_span, message).help(help);
        let replacement = near.first().filter(|_| near.len() == 1).map(|near| (*near).to_owned());
        self.contents.problems.push(Problem { replacement, ..problem });
    }

    /// The table that has a key of this name, if only one does.
    fn home(&self, key: &str) -> Option<&'static str> {
        let mut homes = self.schema.tables.iter().filter(|table| table.key(key).is_some());
        let home = homes.next().filter(|table| !table.name.is_empty())?;
        homes.next().is_none().then_some(home.name)
    }

    /// The help that says which keys there are.
    fn known(&self, name: &str) -> String {
        match self.schema.table(name).map(|table| table.kind) {
            Some(TableKind::Catalogue { help, .. }) => help.to_owned(),
            _ => format!("the keys here are {}", self.schema.inside(name).join(", ")),
        }
    }

    fn unknown_name(&mut self, at: &Location, placeholder: &str, entry: &Entry, known: &Names) {
        let Some(TableKind::Named { owner, noun }) =
            self.schema.first_in(placeholder).map(|table| table.kind)
        else {
            return;
        };
        let owner = at.names.last().map_or_else(|| owner.to_owned(), |name| format!("{owner} `{name}`"));
        let known: Vec<&str> = known.0.iter().map(|(name, _)| name.as_str()).collect();
        let near = closest(&entry.key, known.iter().copied());
        let help = match near {
            Some(near) => format!("did you mean `{near}`?"),
            None if known.is_empty() => "it has none".to_owned(),
            None => format!("its {noun}s are {}", known.join(", ")),
        };
        let message = format!("{owner} has no {noun} `{}`", entry.key);
        let problem = Problem::new(ProblemKind::UnknownName, &*entry.key, entry.key_span, message).help(help);
        self.contents.problems.push(Problem { replacement: near.map(as_key), ..problem });
    }
}

/// `inlayHints` as `inlay-hints`.
fn kebab(key: &str) -> String {
    let mut out = String::with_capacity(key.len() + 2);
    for c in key.chars() {
        if c.is_ascii_uppercase() {
            out.push('-');
        }
        out.push(c.to_ascii_lowercase());
    }
    out
}
