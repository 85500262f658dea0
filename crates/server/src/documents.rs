//! The documents: what the client shows, exactly as it sent it, and the files of the workspace besides.

use std::sync::{Arc, OnceLock};

use pydslrep_analysis::{CancellationToken, FileId, Snapshot};
use pydslrep_config::{FILE_NAME, Settings};
use pydslrep_ide::{KnownMovements, ShownLenses};
use pydslrep_scene::ENDING;
use pydslrep_syntax::Span;
use ropey::Rope;
use rustc_hash::FxHashMap;
use tower_lsp::ls_types::{Diagnostic, TextDocumentContentChangeEvent, Uri};

use crate::positions::{self, Encoding};

/// A document that is open in the client, or a file that matters to one of those.
#[derive(Debug)]
pub(crate) struct Document {
    /// As the client writes it, for it is the client that has to recognise it.
    pub(crate) uri: Uri,
    /// The client's number for this text; `None` if it is not open there and was read from a disk.
    pub(crate) version: Option<i32>,
    /// The text. It shares its memory with the database's copy and outlives a database that failed.
    pub(crate) text: Rope,
    /// Its number in the database; `None` if it cannot be analysed.
    pub(crate) file: Option<FileId>,
    /// Which opening this is, counted over the session: an editor that opens a document again remembers nothing of it.
    pub(crate) opening: u64,
    /// What the client was last told about it, if anything.
    pub(crate) published: Option<Vec<Diagnostic>>,
    /// The paths it imported when they were last looked for.
    pub(crate) imports: Vec<String>,
    /// What is set for it.
    pub(crate) settings: Arc<Settings>,
    /// Cancelled when the text changes.
    pub(crate) outdated: CancellationToken,
    /// What was last known of its movements.
    pub(crate) movements: KnownMovements,
    /// The lenses the client was last told of.
    pub(crate) lenses: ShownLenses,
    /// The semantic tokens the client has, if it takes changes of them.
    pub(crate) tokens: Option<SentTokens>,
}

/// What the client has of a document's semantic tokens.
#[derive(Debug)]
pub(crate) struct SentTokens {
    /// The id they were sent under.
    pub(crate) id: String,
    /// The text they are of.
    pub(crate) snapshot: Snapshot,
    /// How many tokens each entity of it has.
    pub(crate) counts: TokenCounts,
}

/// How many semantic tokens each entity of a text has; not there before the work is done.
pub(crate) type TokenCounts = Arc<OnceLock<Vec<usize>>>;

impl Document {
    /// A document that was just opened or found, not yet analysed.
    pub(crate) fn new(uri: Uri, text: Rope, version: Option<i32>) -> Self {
        Self {
            uri,
            version,
            text,
            file: None,
            opening: 0,
            published: None,
            imports: Vec::new(),
            settings: Arc::default(),
            outdated: CancellationToken::default(),
            movements: KnownMovements::default(),
            lenses: ShownLenses::default(),
            tokens: None,
        }
    }

    /// Stops work on the text as it was.
    pub(crate) fn set_outdated(&mut self) {
        std::mem::take(&mut self.outdated).cancel();
    }

    /// Whether it is a program.
    pub(crate) fn is_program(&self) -> bool {
        self.sort() == Sort::Program
    }

    /// What sort of file it is.
    pub(crate) fn sort(&self) -> Sort {
        Sort::of(self.uri.as_str())
    }

    /// Applies one change; returns the bytes it replaces in the text before it, `None` if it replaces all of them.
    pub(crate) fn apply(
        &mut self,
        change: &TextDocumentContentChangeEvent,
        encoding: Encoding,
    ) -> Option<Span> {
        let Some(range) = change.range else {
            self.text = Rope::from_str(&change.text);
            return None;
        };
        let span = positions::to_span(&self.text, range, encoding);
        let start = self.text.byte_to_char(span.start as usize);
        let end = self.text.byte_to_char(span.end as usize);
        self.text.remove(start..end);
        self.text.insert(start, &change.text);
        Some(span)
    }
}

/// What a document may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sort {
    /// A program.
    Program,
    /// The settings of a folder, `pydslrep.toml`.
    Settings,
    /// What an environment stands in, `<environment>.scene.toml`.
    Scene,
}

impl Sort {
    /// That of a document, by its key or address.
    pub(crate) fn of(name: &str) -> Self {
        match name.rsplit('/').next().unwrap_or(name) {
            FILE_NAME => Self::Settings,
            name if name.ends_with(ENDING) => Self::Scene,
            _ => Self::Program,
        }
    }
}

/// All documents by [`key`].
pub(crate) type Documents = FxHashMap<String, Document>;

/// The name under which a document is known, one for all spellings of its address: a file's path, decoded, with the
/// letter of a drive in upper case; the address itself for what is not a file.
pub(crate) fn key(uri: &Uri) -> String {
    if !uri.scheme().as_str().eq_ignore_ascii_case("file") {
        return uri.as_str().to_owned();
    }
    let mut path = uri.path().decode().to_string_lossy().into_owned();
    if let [b'/', drive, b':', ..] = path.as_bytes()
        && drive.is_ascii_alphabetic()
    {
        path[1..2].make_ascii_uppercase();
    }
    // A file on another host (`file://server/share`) is another file.
    match uri.authority().map(|authority| authority.as_str()) {
        None | Some("" | "localhost") => path,
        Some(host) => format!("//{host}{path}"),
    }
}

#[cfg(test)]
mod tests {
    use std::str::FromStr;

    use proptest::prelude::*;
    use tower_lsp::ls_types::{Position, Range};

    use super::*;

    #[test]
    fn spellings_of_one_address_have_one_key() {
        let key = |uri: &str| super::key(&Uri::from_str(uri).unwrap());
        assert_eq!(key("file:///c%3A/a%20b/x.pyr"), "/C:/a b/x.pyr");
        assert_eq!(key("file:///C:/a%20b/x.pyr"), "/C:/a b/x.pyr");
        assert_eq!(key("file://localhost/home/%C3%A9.pyr"), "/home/é.pyr");
        assert_eq!(key("file://server/share/x.pyr"), "//server/share/x.pyr");
        assert_eq!(key("untitled:Untitled-1"), "untitled:Untitled-1");
    }

    /// The offset of a position by the protocol's words, one character at a time.
    fn naive_offset(text: &str, position: Position, encoding: Encoding) -> usize {
        let mut lines = vec![0];
        for (at, character) in text.char_indices() {
            let next = text[at + character.len_utf8()..].chars().next();
            if character == '\n' || (character == '\r' && next != Some('\n')) {
                lines.push(at + 1);
            }
        }
        let Some(&start) = lines.get(position.line as usize) else { return text.len() };
        let mut units = 0;
        for (at, character) in text[start..].char_indices() {
            units += match encoding {
                Encoding::Utf8 => character.len_utf8(),
                Encoding::Utf16 => character.len_utf16(),
                Encoding::Utf32 => 1,
            };
            if units > position.character as usize || matches!(character, '\n' | '\r') {
                return start + at;
            }
        }
        text.len()
    }

    fn position() -> impl Strategy<Value = Position> {
        (0_u32..6, 0_u32..12).prop_map(|(line, character)| Position::new(line, character))
    }

    proptest! {
        #[test]
        fn changes_do_what_the_protocol_says(
            text in "[a\r\n🤖é日]{0,24}",
            changes in prop::collection::vec((position(), position(), "[b\r\n🤖é]{0,4}"), 1..6),
            encoding in prop::sample::select(vec![Encoding::Utf8, Encoding::Utf16, Encoding::Utf32]),
        ) {
            let mut expected = text.clone();
            let uri = Uri::from_str("file:///a.pyr").unwrap();
            let mut document = Document::new(uri, Rope::from_str(&text), Some(0));
            for (a, b, new_text) in changes {
                let (start, end) = (naive_offset(&expected, a, encoding), naive_offset(&expected, b, encoding));
                expected.replace_range(start.min(end)..start.max(end), &new_text);
                let range = Some(Range::new(a, b));
                let change = TextDocumentContentChangeEvent { range, range_length: None, text: new_text };
                document.apply(&change, encoding);
                prop_assert_eq!(document.text.to_string(), expected.clone());
            }
        }
    }
}
