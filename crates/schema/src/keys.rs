//! The parts of a list of keys.

use crate::Values;

/// The part of a table's name that a name of the program takes the place of: `robots.NAME`.
pub const NAME: &str = "NAME";

/// Everything that a kind of file can contain.
#[derive(Debug)]
pub struct Schema {
    /// The name of an entry in messages: `setting`.
    pub noun: &'static str,
    /// All tables. The keys outside of tables are in one without a name.
    pub tables: &'static [Table],
    /// Numbers must not be further from zero.
    pub largest: f64,
    /// The message for those that are, after the key.
    pub too_large: &'static str,
}

/// A table of a file.
#[derive(Debug)]
pub struct Table {
    /// Its name, with [`NAME`] in place of names of the program.
    pub name: &'static str,
    /// The kind of table: it says how often the table can appear.
    pub kind: TableKind,
    /// A description, in Markdown.
    pub summary: &'static str,
    /// The keys that can be set in it.
    pub keys: &'static [Key],
}

/// Kinds of tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableKind {
    /// Appears once: `[world]`.
    Once,
    /// Appears any number of times: `[[box]]`.
    Each,
    /// Appears once for each name of its kind: `[robots.rover]`.
    Named {
        /// The kind of things that the names belong to.
        owner: &'static str,
        /// The kind of things that are named.
        noun: &'static str,
    },
    /// Appears once; its keys come from a list that is documented elsewhere.
    Catalogue {
        /// The name of a key in messages.
        noun: &'static str,
        /// The allowed values of the table, in Markdown.
        words: &'static str,
        /// The default of keys that are not set, in Markdown.
        default: &'static str,
        /// Where to find the keys.
        help: &'static str,
    },
}

/// Something that can be set.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// The allowed values.
    pub values: Values,
    /// True if its table makes no sense without it.
    pub required: bool,
    /// A key of the same table that can stand in for it, if it is required.
    pub unless: Option<&'static str>,
    /// Its meaning, in Markdown.
    pub summary: &'static str,
    /// The default, in Markdown; a value in backticks, or words.
    pub default: &'static str,
    /// A value that is not the default, in the syntax that TOML and JSON share.
    pub example: &'static str,
}

/// An optional key without default or example.
pub const fn key(name: &'static str, values: Values, summary: &'static str) -> Key {
    Key { name, values, required: false, unless: None, summary, default: "", example: "" }
}

impl Key {
    /// The same, but required.
    pub const fn required(self) -> Self {
        Self { required: true, ..self }
    }

    /// The same, but required where another key is not set.
    pub const fn required_unless(self, other: &'static str) -> Self {
        Self { required: true, unless: Some(other), ..self }
    }

    /// The same with a default.
    pub const fn default(self, default: &'static str) -> Self {
        Self { default, ..self }
    }

    /// The same with an example.
    pub const fn example(self, example: &'static str) -> Self {
        Self { example, ..self }
    }

    /// The same with another summary.
    pub const fn summary(self, summary: &'static str) -> Self {
        Self { summary, ..self }
    }

    /// In place of a default if it is required: that it is, in Markdown.
    pub fn requirement(&self) -> Option<String> {
        let unless = self.unless.map_or_else(String::new, |other| format!(" without `{other}`"));
        self.required.then(|| format!("required{unless}"))
    }

    /// Its default as TOML, if it is a value.
    pub fn default_value(&self) -> Option<&'static str> {
        let value = self.default.strip_prefix('`')?.strip_suffix('`')?;
        (!value.contains('`')).then_some(value)
    }
}

impl Table {
    /// The parts of its name.
    pub fn parts(&self) -> Vec<&'static str> {
        self.name.split('.').filter(|part| !part.is_empty()).collect()
    }

    /// Returns the header that begins it in a file, with names in place of its placeholders.
    pub fn header(&self, name: &str) -> String {
        if self.kind == TableKind::Each { format!("[[{name}]]") } else { format!("[{name}]") }
    }

    /// The key of a name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// Returns whether it is the table of these parts of a name.
    fn is_at(&self, path: &[&str]) -> bool {
        let parts = self.parts();
        parts.len() == path.len() && parts.iter().zip(path).all(|(part, name)| *part == NAME || part == name)
    }
}

/// The table or key that a name in a file refers to.
#[derive(Debug, Clone, Copy)]
pub enum Item {
    /// A table, or the table of all names inside of it.
    Table(&'static Table),
    /// A key.
    Key(&'static Key),
}

impl Schema {
    /// The table of a name from the list.
    pub fn table(&self, name: &str) -> Option<&'static Table> {
        self.tables.iter().find(|table| table.name == name)
    }

    /// The table at these parts of a name in a file.
    pub fn table_at(&self, path: &[&str]) -> Option<&'static Table> {
        self.tables.iter().find(|table| table.is_at(path))
    }

    /// Returns the item that these parts of a name in a file refer to.
    pub fn find(&self, path: &[&str]) -> Option<Item> {
        let (last, outer) = path.split_last()?;
        let key = || self.table_at(outer)?.key(last).map(Item::Key);
        let named = || self.table_at(&[path, &[NAME]].concat()).map(Item::Table);
        self.table_at(path).map(Item::Table).or_else(key).or_else(named)
    }

    /// Returns whether a name from the list is that of a table or begins one.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.first_in(name).is_some()
    }

    /// The table of a name from the list, else the first inside of it.
    pub(crate) fn first_in(&self, name: &str) -> Option<&'static Table> {
        let is_inside = |table: &&Table| {
            table.name.strip_prefix(name).is_some_and(|rest| matches!(rest.as_bytes(), [] | [b'.', ..]))
        };
        self.tables.iter().find(is_inside)
    }

    /// The keys and tables directly inside of a name from the list, each once.
    pub(crate) fn inside(&self, name: &str) -> Vec<&'static str> {
        let keys = self.table(name).into_iter().flat_map(|table| table.keys).map(|key| key.name);
        let prefix = dotted(name, "");
        let tables = self.tables.iter().filter_map(|table| table.name.strip_prefix(prefix.as_str()));
        let tables =
            tables.filter_map(|rest| rest.split('.').next()).filter(|part| !["", NAME].contains(part));
        let mut found: Vec<&str> = keys.chain(tables).collect();
        found.dedup();
        found
    }
}

/// A part of a name after those outside of it.
pub(crate) fn dotted(outer: &str, part: &str) -> String {
    if outer.is_empty() { part.to_owned() } else { format!("{outer}.{part}") }
}

/// The names that tables can have, each with those inside of it: robots with `sensors` and `wheels`, and these with theirs.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Names(pub Vec<(String, Names)>);

impl Names {
    /// The names inside of a table from the list; `outer` is in place of its placeholders.
    pub(crate) fn inside(&self, table: &str, outer: &[String]) -> Option<&Self> {
        let mut outer = outer.iter();
        let mut parts = table.split('.').skip_while(|part| *part != NAME);
        parts.try_fold(self, |names, part| {
            let part = if part == NAME { outer.next()?.as_str() } else { part };
            names.get(part)
        })
    }

    /// The names inside of a name.
    pub fn get(&self, name: &str) -> Option<&Self> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, inner)| inner)
    }
}
