//! Python expressions, laid out as the formatter of ruff does: it leaves them as they are.

/// The columns of a line.
pub(crate) const WIDTH: usize = 88;

const INDENT: usize = 4;

/// A Python expression in ASCII.
#[derive(Debug, Clone)]
pub(crate) enum Expression {
    /// An expression that cannot be broken.
    Atom(String),
    /// A call: a long one has its arguments on one line if they fit there, else each on its own.
    Call { head: String, arguments: Vec<Expression> },
    /// A call after words, which can be broken as well.
    Clause { words: Words, call: Box<Expression> },
    /// The value of a keyword argument; a long one has its items each on its own line.
    List { keyword: &'static str, items: Vec<Expression> },
    /// As a list.
    Tuple { keyword: &'static str, items: Vec<Expression> },
    /// As a list, of keys with their values.
    Dict { keyword: &'static str, items: Vec<Expression> },
    /// An entry of those: a tuple under a key.
    Entry { key: String, items: Vec<Expression> },
}

/// The words before the call of a statement.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Words {
    /// `await`.
    Await,
    /// `if await`.
    If,
    /// `elif await`.
    Elif,
    /// `for _ in`.
    For,
    /// `async for _ in`.
    AsyncFor,
}

impl Words {
    /// The word that opens the statement; what it binds, if it is a loop; and what is before the call.
    fn parts(self) -> (&'static str, Option<&'static str>, &'static str) {
        match self {
            Self::Await => ("await", None, ""),
            Self::If => ("if", None, "await "),
            Self::Elif => ("elif", None, "await "),
            Self::For => ("for", Some("_ in"), ""),
            Self::AsyncFor => ("async for", Some("_ in"), ""),
        }
    }

    /// All words, up to the call.
    fn flat(self) -> String {
        match self.parts() {
            (word, Some(binding), before) => format!("{word} {binding} {before}"),
            (word, None, before) => format!("{word} {before}"),
        }
    }

    /// A call after these words. Only if not even its opening parenthesis fits, the words are broken: first what a loop
    /// binds, then in front of the call.
    fn lay_out(self, call: &Expression, indent: usize, suffix: &str) -> String {
        let fits = |indent: usize, before: &str| indent + before.len() + call.head_len() <= WIDTH;
        let after = |before: &str| call.after(before);
        let inner = indent + INDENT;
        let (word, binding, before) = self.parts();
        let flat = self.flat();
        if fits(indent, &flat) {
            after(&flat).lay_out(indent, suffix)
        } else if binding.is_some() && fits(indent, ") in ") {
            let rest = after(") in ").lay_out(indent, suffix);
            format!("{:indent$}{word} (\n{:inner$}_\n{rest}", "", "")
        } else if fits(inner, before) {
            let opening = binding.map_or(String::new(), |binding| format!("{binding} "));
            let rest = after(before).lay_out(inner, "");
            format!("{:indent$}{word} {opening}(\n{rest}\n{:indent$}){suffix}", "", "")
        } else {
            after(&flat).lay_out(indent, suffix)
        }
    }
}

impl Expression {
    /// The expression in lines; what follows it counts for its width.
    pub(crate) fn lay_out(&self, indent: usize, suffix: &str) -> String {
        if let Self::Clause { words, call } = self {
            return words.lay_out(call, indent, suffix);
        }
        let line = format!("{:indent$}{}{suffix}", "", self.flat());
        let Some((open, items, close)) = self.parts().filter(|_| line.len() > WIDTH) else { return line };
        let inner = indent + INDENT;
        let joined = format!("{:inner$}{}", "", flat(items));
        let body = if matches!(self, Self::Call { .. }) && joined.len() <= WIDTH {
            joined
        } else {
            let items: Vec<String> = items.iter().map(|item| item.lay_out(inner, ",")).collect();
            items.join("\n")
        };
        format!("{:indent$}{open}\n{body}\n{:indent$}{close}{suffix}", "", "")
    }

    fn flat(&self) -> String {
        match self {
            Self::Atom(text) => text.clone(),
            Self::Clause { words, call } => words.flat() + &call.flat(),
            group => {
                group.parts().map(|(open, items, close)| open + &flat(items) + close).unwrap_or_default()
            }
        }
    }

    /// The columns of a call up to its opening parenthesis.
    fn head_len(&self) -> usize {
        match self {
            Self::Call { head, .. } => head.len() + 1,
            _ => 0,
        }
    }

    /// A call with something before it.
    fn after(&self, before: &str) -> Self {
        match self {
            Self::Call { head, arguments } => {
                Self::Call { head: format!("{before}{head}"), arguments: arguments.clone() }
            }
            other => other.clone(),
        }
    }

    /// Returns the opening of a group, its items, and the closing.
    fn parts(&self) -> Option<(String, &[Expression], &'static str)> {
        match self {
            Self::Atom(_) | Self::Clause { .. } => None,
            Self::Call { head, arguments } => Some((format!("{head}("), arguments, ")")),
            Self::List { keyword, items } => Some((format!("{keyword}=["), items, "]")),
            Self::Tuple { keyword, items } => Some((format!("{keyword}=("), items, ")")),
            Self::Dict { keyword, items } => Some((format!("{keyword}={{"), items, "}")),
            Self::Entry { key, items } => Some((format!("{key}: ("), items, ")")),
        }
    }
}

fn flat(items: &[Expression]) -> String {
    let items: Vec<String> = items.iter().map(Expression::flat).collect();
    items.join(", ")
}

/// A call and what ends its line, with a comment: after it if that fits, else above.
pub(crate) fn commented(indent: usize, call: &Expression, end: &str, comment: &str) -> String {
    let lines = call.lay_out(indent, end);
    let suffix = format!("  # {comment}");
    if !lines.contains('\n') && lines.len() + width(&suffix) <= WIDTH {
        lines + &suffix
    } else {
        format!("{:indent$}# {comment}\n{lines}", "")
    }
}

/// The most columns that a text takes up.
fn width(text: &str) -> usize {
    text.chars().map(|c| if c.is_ascii() { 1 } else { 2 }).sum()
}

/// A Python string literal, whatever the text.
pub(crate) fn literal(text: &str) -> String {
    let escaped: String = text
        .chars()
        .map(|c| match c {
            '"' | '\\' => format!("\\{c}"),
            ' '..='~' => c.to_string(),
            _ => format!("\\U{:08x}", u32::from(c)),
        })
        .collect();
    format!("\"{escaped}\"")
}

/// A Python float literal.
pub(crate) fn float(value: f64) -> String {
    format!("{value:?}")
}

/// A text for a comment: replaces all characters that could end it or change its appearance.
pub(crate) fn comment_text(text: &str) -> String {
    text.chars()
        .map(|c| if c == ' ' || c.is_ascii_graphic() || c.is_alphanumeric() { c } else { '?' })
        .collect()
}
