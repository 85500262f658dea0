//! The context of a cursor in a text, even if it is half typed and not TOML yet.

use std::borrow::Cow;

use pydslrep_text::{Span, offset};
use toml_parser::Source;
use toml_parser::parser::{Event, EventKind, RecursionGuard, parse_document};

/// The maximum depth of nested values; deeper ones are ignored.
const MAX_DEPTH: u32 = 16;

/// A part of a name, in a key or in the header of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamePart {
    /// The whole name up to and including this part, with its tables: `inlay-hints.pose`.
    pub name: String,
    /// Where the part is.
    pub span: Span,
    /// Which section of the text it is in; each but the first begins with a header.
    pub section: usize,
}

/// The word at an offset, and its role.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CursorContext {
    /// The word there, which is being typed or would be replaced.
    pub word: Span,
    /// Which section of the text it is in; each but the first begins with a header.
    pub section: usize,
    /// The role of the word.
    pub slot: Slot,
}

/// The role of a word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Slot {
    /// A part of a table's name in its header.
    Table {
        /// The parts before it, each with a dot after it.
        outer: String,
        /// True if more parts follow.
        has_more: bool,
        /// True if the header has two brackets, as tables have that can appear any number of times.
        is_each: bool,
        /// True if the closing brackets are there.
        is_closed: bool,
    },
    /// A key.
    Key {
        /// The table it is in, with a dot after it; empty outside of tables.
        table: String,
        /// True if a `=` follows.
        has_value: bool,
        /// True if it is the first word of its line, where a table could begin.
        begins_line: bool,
    },
    /// The value of a key.
    Value {
        /// The whole name of the key, with its tables.
        key: String,
    },
}

/// All parts of names, in the order of the text.
pub fn name_parts(text: &str) -> Vec<NamePart> {
    let mut parts = Vec::new();
    for (index, section) in sections(text).into_iter().enumerate() {
        let mut reader = Reader::new(section);
        for event in section.events() {
            reader.take(&event);
            if event.kind() == EventKind::SimpleKey && !event.span().is_empty() {
                parts.push(NamePart { name: reader.name(), span: section.span(&event), section: index });
            }
        }
    }
    parts
}

/// Returns the context at an offset in bytes; `None` where neither keys nor values can be.
pub fn cursor_context(text: &str, offset: u32) -> Option<CursorContext> {
    let (index, section) =
        sections(text).into_iter().enumerate().rfind(|(_, section)| section.start <= offset)?;
    let events = section.events();
    let touches = |event: &&Event| is_word(event) && section.span(event).touches(offset);
    let word = events.iter().find(touches).map_or(Span::at(offset), |event| section.span(event));
    let is_next = |event: &Event| section.span(event).start >= word.start;
    let (before, rest) = events.split_at(events.iter().position(is_next).unwrap_or(events.len()));
    let mut reader = Reader::new(section);
    for event in before {
        reader.take(event);
    }
    let rest =
        || rest.iter().take_while(|event| !ends_statement(event)).filter(|event| !event.span().is_empty());
    let slot = match reader.stage {
        Stage::Header if reader.wants_part => Slot::Table {
            outer: reader.table(),
            has_more: rest().any(|event| event.kind() == EventKind::KeySep),
            is_each: reader.is_each,
            is_closed: rest().any(is_table_close),
        },
        Stage::Key if reader.wants_part => Slot::Key {
            begins_line: reader.parts.is_empty() && reader.outer.is_empty(),
            table: reader.table(),
            has_value: rest().any(|event| event.kind() == EventKind::KeyValSep),
        },
        Stage::Value => Slot::Value { key: reader.name() },
        Stage::Header | Stage::Key | Stage::Nothing => return None,
    };
    Some(CursorContext { word, section: index, slot })
}

fn is_word(event: &Event) -> bool {
    matches!(event.kind(), EventKind::SimpleKey | EventKind::Scalar)
}

fn is_table_close(event: &Event) -> bool {
    matches!(event.kind(), EventKind::StdTableClose | EventKind::ArrayTableClose)
}

fn ends_statement(event: &Event) -> bool {
    matches!(event.kind(), EventKind::Newline | EventKind::ValueSep | EventKind::InlineTableClose)
}

/// A part of the text that is parsed on its own.
#[derive(Debug, Clone, Copy)]
struct Section<'t> {
    text: &'t str,
    start: u32,
}

impl Section<'_> {
    fn events(self) -> Vec<Event> {
        let tokens = Source::new(self.text).lex().into_vec();
        let mut events = Vec::new();
        parse_document(&tokens, &mut RecursionGuard::new(&mut events, MAX_DEPTH), &mut ());
        events
    }

    fn span(self, event: &Event) -> Span {
        let range = event.span();
        Span::from(range.start()..range.end()).shifted(self.start)
    }
}

/// Cuts a text before each header, so that what is left open in a table does not reach into the next one.
fn sections(text: &str) -> Vec<Section<'_>> {
    let mut sections = Vec::new();
    let (mut start, mut at) = (0, 0);
    for line in text.split_inclusive('\n') {
        if is_header(line) && at > start {
            sections.push(start..at);
            start = at;
        }
        at += line.len();
    }
    sections.push(start..at);
    let section =
        |range: std::ops::Range<usize>| Section { text: &text[range.clone()], start: offset(range.start) };
    sections.into_iter().map(section).collect()
}

/// A line that begins with a bracket is a header, whatever is open before it, unless a number follows: lists can span
/// several lines, and they contain points.
fn is_header(line: &str) -> bool {
    let Some(inside) = line.trim_start().strip_prefix('[') else { return false };
    let inside = inside.strip_prefix('[').unwrap_or(inside).trim_start();
    !inside.starts_with(|first: char| first.is_ascii_digit() || matches!(first, '[' | '-' | '+' | '.'))
}

/// The role of the next word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Header,
    Key,
    Value,
    Nothing,
}

/// Keeps track of the table and the key while events are read.
struct Reader<'t> {
    source: Source<'t>,
    stage: Stage,
    /// The table that keys are in.
    path: Vec<String>,
    /// For each open brace, the table outside of it.
    outer: Vec<Vec<String>>,
    /// The parts of the name that is being read.
    parts: Vec<String>,
    /// True if the next word can be another part.
    wants_part: bool,
    /// The number of open lists.
    lists: usize,
    /// True if the header has two brackets.
    is_each: bool,
}

impl<'t> Reader<'t> {
    fn new(section: Section<'t>) -> Self {
        Self {
            source: Source::new(section.text),
            // Nothing can be typed before a bracket.
            stage: if is_header(section.text) { Stage::Nothing } else { Stage::Key },
            path: Vec::new(),
            outer: Vec::new(),
            parts: Vec::new(),
            wants_part: true,
            lists: 0,
            is_each: false,
        }
    }

    fn take(&mut self, event: &Event) {
        match event.kind() {
            EventKind::StdTableOpen | EventKind::ArrayTableOpen => {
                self.is_each = event.kind() == EventKind::ArrayTableOpen;
                self.begin(Stage::Header);
            }
            EventKind::StdTableClose | EventKind::ArrayTableClose => {
                self.path = std::mem::take(&mut self.parts);
                self.stage = Stage::Nothing;
            }
            EventKind::SimpleKey => {
                self.parts.push(self.decoded(event));
                self.wants_part = false;
            }
            EventKind::KeySep => self.wants_part = true,
            EventKind::KeyValSep => self.stage = Stage::Value,
            EventKind::InlineTableOpen => {
                self.outer.push(self.path.clone());
                self.path.append(&mut self.parts);
                self.begin(Stage::Key);
            }
            // The parser inserts a missing brace here; what is typed is still inside.
            EventKind::InlineTableClose if event.span().is_empty() => {}
            EventKind::InlineTableClose => {
                self.path = self.outer.pop().unwrap_or_default();
                self.begin(Stage::Nothing);
            }
            EventKind::ValueSep if !self.outer.is_empty() => self.begin(Stage::Key),
            EventKind::Newline if self.outer.is_empty() && self.lists == 0 => {
                if self.stage == Stage::Header {
                    self.path = std::mem::take(&mut self.parts);
                }
                self.begin(Stage::Key);
            }
            EventKind::ArrayOpen => {
                self.lists += 1;
                self.stage = Stage::Nothing;
            }
            EventKind::ArrayClose => {
                self.lists = self.lists.saturating_sub(1);
                self.stage = Stage::Nothing;
            }
            EventKind::Scalar | EventKind::Comment | EventKind::Error => self.stage = Stage::Nothing,
            EventKind::ValueSep | EventKind::Newline | EventKind::Whitespace => {}
        }
    }

    fn begin(&mut self, stage: Stage) {
        self.parts.clear();
        self.wants_part = true;
        self.stage = stage;
    }

    fn decoded(&self, event: &Event) -> String {
        let mut key = Cow::default();
        if let Some(raw) = self.source.get(event) {
            raw.decode_key(&mut key, &mut ());
        }
        key.into_owned()
    }

    fn whole(&self) -> impl Iterator<Item = &str> {
        // A header contains the whole name.
        let path = if self.stage == Stage::Header { &[][..] } else { &self.path };
        path.iter().chain(&self.parts).map(String::as_str)
    }

    fn name(&self) -> String {
        self.whole().collect::<Vec<_>>().join(".")
    }

    fn table(&self) -> String {
        self.whole().flat_map(|part| [part, "."]).collect()
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use proptest::prelude::*;

    use super::*;

    /// Checks the context at each `$0`, a line each.
    fn check(fixtures: &[&str], expected: &Expect) {
        let mut out = String::new();
        for fixture in fixtures {
            let offset = u32::try_from(fixture.find("$0").unwrap()).unwrap();
            let text = fixture.replacen("$0", "", 1);
            let found = cursor_context(&text, offset).map(|CursorContext { word, slot, .. }| match slot {
                Slot::Table { outer, has_more, is_each, is_closed } => format!(
                    "table `{}` in `{outer}`, more: {has_more}, each: {is_each}, closed: {is_closed}",
                    word.text(&text)
                ),
                Slot::Key { table, has_value, begins_line } => format!(
                    "key `{}` of `{table}`, value: {has_value}, first: {begins_line}",
                    word.text(&text)
                ),
                Slot::Value { key } => format!("value `{}` of `{key}`", word.text(&text)),
            });
            out += &format!("{fixture:?}: {}\n", found.as_deref().unwrap_or("nothing"));
        }
        expected.assert_eq(&out);
    }

    #[test]
    fn keys_know_their_table() {
        check(
            &[
                "$0",
                "tar$0",
                "ta$0rget = 1",
                "$0target = 1",
                "target $0",
                "severity.$0",
                "severity.wh$0el-count",
                "x = 1\n[severity]\n$0\ny = 1",
                "[severity]\nwh$0",
                "[\"severity\"]\nwh$0",
                "[severity\nwh$0",
                "severity = { $0",
                "severity = { $0 }",
                "severity = { wheel-count = \"off\", wh$0\n[inlay-hints]\npose = true",
                "severity = { wheel-count = \"off\n[inlay-hints]\np$0",
                "severity = {} \nt$0",
                "[inlay-hints]\npose = \n$0\nduration = true",
                "# $0",
                "target = 'vrep' # $0",
                "[inlay-hints] $0",
                "x = [$0",
                "x = [1, $0",
                "x = [\n$0",
                "[[a]]\nx = [\n  [1.0, 2.0],\n[-1, 2]]\n$0",
                "[[a]]\nx = [0, 1]\n[[b]]\ny$0",
            ],
            &expect![[r##"
                "$0": key `` of ``, value: false, first: true
                "tar$0": key `tar` of ``, value: false, first: true
                "ta$0rget = 1": key `target` of ``, value: true, first: true
                "$0target = 1": key `target` of ``, value: true, first: true
                "target $0": nothing
                "severity.$0": key `` of `severity.`, value: false, first: false
                "severity.wh$0el-count": key `whel-count` of `severity.`, value: false, first: false
                "x = 1\n[severity]\n$0\ny = 1": key `` of `severity.`, value: false, first: true
                "[severity]\nwh$0": key `wh` of `severity.`, value: false, first: true
                "[\"severity\"]\nwh$0": key `wh` of `severity.`, value: false, first: true
                "[severity\nwh$0": key `wh` of `severity.`, value: false, first: true
                "severity = { $0": key `` of `severity.`, value: false, first: false
                "severity = { $0 }": key `` of `severity.`, value: false, first: false
                "severity = { wheel-count = \"off\", wh$0\n[inlay-hints]\npose = true": key `wh` of `severity.`, value: false, first: false
                "severity = { wheel-count = \"off\n[inlay-hints]\np$0": key `p` of `inlay-hints.`, value: false, first: true
                "severity = {} \nt$0": key `t` of ``, value: false, first: true
                "[inlay-hints]\npose = \n$0\nduration = true": key `` of `inlay-hints.`, value: false, first: true
                "# $0": nothing
                "target = 'vrep' # $0": nothing
                "[inlay-hints] $0": nothing
                "x = [$0": nothing
                "x = [1, $0": nothing
                "x = [\n$0": nothing
                "[[a]]\nx = [\n  [1.0, 2.0],\n[-1, 2]]\n$0": key `` of `a.`, value: false, first: true
                "[[a]]\nx = [0, 1]\n[[b]]\ny$0": key `y` of `b.`, value: false, first: true
            "##]],
        );
    }

    #[test]
    fn values_know_their_key() {
        check(
            &[
                "target =$0",
                "target = $0",
                "target = v$0",
                "target = \"v$0rep\"",
                "target = \"v$0\n[severity]",
                "target = \"vrep\" $0",
                "[inlay-hints]\npose = $0tr",
                "[severity]\nwheel-count = \"$0\"",
                "severity.wheel-count=$0",
                "severity = { wheel-count = $0 }",
                "severity = { wheel-count = 'off', wheel-order = '$0",
            ],
            &expect![[r#"
                "target =$0": value `` of `target`
                "target = $0": value `` of `target`
                "target = v$0": value `v` of `target`
                "target = \"v$0rep\"": value `"vrep"` of `target`
                "target = \"v$0\n[severity]": value `"v` of `target`
                "target = \"vrep\" $0": nothing
                "[inlay-hints]\npose = $0tr": value `tr` of `inlay-hints.pose`
                "[severity]\nwheel-count = \"$0\"": value `""` of `severity.wheel-count`
                "severity.wheel-count=$0": value `` of `severity.wheel-count`
                "severity = { wheel-count = $0 }": value `` of `severity.wheel-count`
                "severity = { wheel-count = 'off', wheel-order = '$0": value `'` of `severity.wheel-order`
            "#]],
        );
    }

    #[test]
    fn tables_are_named_in_brackets() {
        check(
            &[
                "[$0",
                "[$0]",
                "[sev$0]",
                "[sev$0\nx = 1",
                "x = 1\n[$0sev]",
                "$0[severity]",
                "[severity]$0",
                "[inlay-hints.$0]",
                "[robots.$0",
                "[robots.ro$0ver.sensors.front]",
                "[[$0",
                "[[bo$0]]\nx = 1",
                "[[$0box",
            ],
            &expect![[r#"
                "[$0": table `` in ``, more: false, each: false, closed: false
                "[$0]": table `` in ``, more: false, each: false, closed: true
                "[sev$0]": table `sev` in ``, more: false, each: false, closed: true
                "[sev$0\nx = 1": table `sev` in ``, more: false, each: false, closed: false
                "x = 1\n[$0sev]": table `sev` in ``, more: false, each: false, closed: true
                "$0[severity]": nothing
                "[severity]$0": nothing
                "[inlay-hints.$0]": table `` in `inlay-hints.`, more: false, each: false, closed: true
                "[robots.$0": table `` in `robots.`, more: false, each: false, closed: false
                "[robots.ro$0ver.sensors.front]": table `rover` in `robots.`, more: true, each: false, closed: true
                "[[$0": table `` in ``, more: false, each: true, closed: false
                "[[bo$0]]\nx = 1": table `bo` in ``, more: false, each: true, closed: true
                "[[$0box": table `box` in ``, more: false, each: true, closed: false
            "#]],
        );
    }

    #[test]
    fn names_are_whole() {
        let text = "target = 1\nseverity.wheel-count = 1\n[inlay-hints]\n'pose' = {\n[severity]\nwheel-order";
        let found: Vec<String> = name_parts(text)
            .into_iter()
            .map(|named| format!("{} `{}`", named.name, named.span.text(text)))
            .collect();
        expect![[r#"
            target `target`
            severity `severity`
            severity.wheel-count `wheel-count`
            inlay-hints `inlay-hints`
            inlay-hints.pose `'pose'`
            severity `severity`
            severity.wheel-order `wheel-order`"#]]
        .assert_eq(&found.join("\n"));
    }

    proptest! {
        #[test]
        fn any_text_has_a_context(text in "[a-z\\[\\]{}=.,#\"'\\n\\r é-]{0,60}", at in 0..70_usize) {
            let offset = text.char_indices().map(|(offset, _)| offset).nth(at).unwrap_or(text.len());
            let offset = u32::try_from(offset).unwrap();
            if let Some(context) = cursor_context(&text, offset) {
                prop_assert!(context.word.touches(offset));
                prop_assert!(text.get(std::ops::Range::from(context.word)).is_some());
            }
            for named in name_parts(&text) {
                prop_assert!(text.get(std::ops::Range::from(named.span)).is_some());
            }
        }
    }

    #[test]
    fn deep_nesting_is_harmless() {
        for open in ["[", "{ a = ", "a = [", "a = {"] {
            let text = open.repeat(100_000);
            cursor_context(&text, Span::of(&text).end);
        }
    }
}
