//! Python expressions, laid out as the formatter of ruff does: it leaves them as they are.

/// The columns of a line.
pub(crate) const WIDTH: usize = 88;

const INDENT: usize = 4;

/// A Python expression in ASCII.
#[derive(Debug)]
pub(crate) enum Expression {
    /// What cannot be broken.
    Atom(String),
    /// A call: a long one has its arguments on one line if they fit there, else each on its own.
    Call { head: String, arguments: Vec<Expression> },
    /// The value of a keyword argument; a long one has its items each on its own line.
    List { keyword: &'static str, items: Vec<Expression> },
    /// As a list.
    Tuple { keyword: &'static str, items: Vec<Expression> },
    /// As a list, of keys with their values.
    Dict { keyword: &'static str, items: Vec<Expression> },
}

impl Expression {
    /// The expression in lines; what follows it counts for its width.
    pub(crate) fn lay_out(&self, indent: usize, suffix: &str) -> String {
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
            group => {
                group.parts().map(|(open, items, close)| open + &flat(items) + close).unwrap_or_default()
            }
        }
    }

    /// What opens a group, what is in it, and what closes it.
    fn parts(&self) -> Option<(String, &[Expression], &'static str)> {
        match self {
            Self::Atom(_) => None,
            Self::Call { head, arguments } => Some((format!("{head}("), arguments, ")")),
            Self::List { keyword, items } => Some((format!("{keyword}=["), items, "]")),
            Self::Tuple { keyword, items } => Some((format!("{keyword}=("), items, ")")),
            Self::Dict { keyword, items } => Some((format!("{keyword}={{"), items, "}")),
        }
    }
}

fn flat(items: &[Expression]) -> String {
    let items: Vec<String> = items.iter().map(Expression::flat).collect();
    items.join(", ")
}

/// A call with a comment: after it if that fits, else above.
pub(crate) fn commented(indent: usize, call: &Expression, comment: &str) -> String {
    let lines = call.lay_out(indent, "");
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
