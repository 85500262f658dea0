//! Documents as the client knows them: their addresses, and the client's state of each.

use std::str::FromStr;
use std::sync::{Arc, OnceLock};

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, utf8_percent_encode};
use pydslrep_analysis::{CancellationToken, FileId, Snapshot};
use pydslrep_config::Settings;
use pydslrep_ide::{KnownMovements, ShownLenses};
use pydslrep_text::Span;
use pydslrep_workspace::{DocumentKind, TextChange, path_of};
use ropey::Rope;
use tower_lsp::ls_types::{InitializeParams, TextDocumentContentChangeEvent, Uri};

use crate::positions::{self, Encoding};
use crate::shared::Shared;

/// True if files are on a disk; otherwise every address with a path is a file.
const HAS_DISK: bool = cfg!(feature = "process");

/// The characters that are escaped in the path of an address: all but the unreserved ones.
const UNRESERVED: &AsciiSet =
    &NON_ALPHANUMERIC.remove(b'-').remove(b'.').remove(b'_').remove(b'~').remove(b'/');

/// A document of the workspace, with the client's state of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Document<'a> {
    /// Its key in the workspace.
    pub(crate) key: &'a str,
    /// Its kind.
    pub(crate) kind: DocumentKind,
    /// Its text.
    pub(crate) text: &'a Rope,
    /// A program's number in the database; `None` if it could not be analysed.
    pub(crate) file: Option<FileId>,
    /// Its settings.
    pub(crate) settings: &'a Settings,
    client: Option<&'a ClientDocument>,
}

impl<'a> Document<'a> {
    /// Returns a document of the workspace, with the client's state of it.
    pub(crate) fn new(
        document: &'a pydslrep_workspace::Document,
        client: Option<&'a ClientDocument>,
    ) -> Self {
        let pydslrep_workspace::Document { key, kind, text, file, settings, .. } = document;
        Self { key, kind: *kind, text, file: *file, settings, client }
    }

    /// Its address, as the client writes it: the client has to recognise it. A file that is not open has that of its
    /// path.
    pub(crate) fn uri(self) -> Option<Uri> {
        self.client.map(|client| client.uri.clone()).or_else(|| uri_of(self.key))
    }

    /// The client's number for this text; `None` if the document is not open there.
    pub(crate) fn version(self) -> Option<i32> {
        self.client.map(|client| client.version)
    }

    /// Which opening this is, counted over the session: an editor that opens a document again remembers nothing of it.
    pub(crate) fn opening(self) -> u64 {
        self.client.map_or(0, |client| client.opening)
    }

    /// What requests about it remember for later ones; nothing if it is not open.
    pub(crate) fn memory(self) -> Arc<Memory> {
        self.client.map(|client| Arc::clone(&client.memory)).unwrap_or_default()
    }

    /// Cancelled when the text changes.
    pub(crate) fn outdated(self) -> CancellationToken {
        self.client.map(|client| client.outdated.clone()).unwrap_or_default()
    }
}

/// A document that is open in the client.
#[derive(Debug, Clone)]
pub(crate) struct ClientDocument {
    /// Its address as the client writes it.
    pub(crate) uri: Uri,
    /// The client's number for the text.
    pub(crate) version: i32,
    /// See [`Document::opening`].
    opening: u64,
    /// Cancelled when the text changes.
    outdated: CancellationToken,
    /// What later requests need of earlier ones.
    memory: Arc<Memory>,
}

/// What requests about a document remember for later ones; those that read on another thread share it.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    /// The last known state of its movements.
    pub(crate) movements: Shared<KnownMovements>,
    /// The lenses the client last got.
    pub(crate) lenses: Shared<ShownLenses>,
    /// The semantic tokens the client has, if it takes changes of them.
    pub(crate) tokens: Shared<SentTokens>,
}

impl ClientDocument {
    /// A document that was opened, as the `opening`th of the session.
    pub(crate) fn new(uri: Uri, version: i32, opening: u64) -> Self {
        Self { uri, version, opening, outdated: CancellationToken::default(), memory: Arc::default() }
    }

    /// Stops work on the text as it was.
    pub(crate) fn set_outdated(&mut self) {
        std::mem::take(&mut self.outdated).cancel();
    }
}

/// The semantic tokens of a document that were sent to the client.
#[derive(Debug, Default)]
pub(crate) struct SentTokens {
    /// The number of answers.
    pub(crate) answers: u32,
    /// Those of the last answer.
    pub(crate) last: Option<KnownTokens>,
}

/// The semantic tokens of a document that the client has.
#[derive(Debug, Clone)]
pub(crate) struct KnownTokens {
    /// The id they were sent under.
    pub(crate) id: String,
    /// The text they are of.
    pub(crate) snapshot: Snapshot,
    /// The number of tokens of each of its entities.
    pub(crate) counts: TokenCounts,
}

/// The number of semantic tokens of each entity of a text; empty until the work is done.
pub(crate) type TokenCounts = Arc<OnceLock<Vec<usize>>>;

/// Applies the changes of one message one after the other; returns each with the text after it.
pub(crate) fn text_changes(
    text: &Rope,
    changes: &[TextDocumentContentChangeEvent],
    encoding: Encoding,
) -> Vec<TextChange> {
    let mut now = text.clone();
    let changes = changes.iter().map(|change| {
        let span = change.range.map(|range| positions::to_span(&now, range, encoding));
        match span {
            Some(span) => replace(&mut now, span, &change.text),
            None => now = Rope::from_str(&change.text),
        }
        TextChange { span, after: now.clone() }
    });
    changes.collect()
}

fn replace(text: &mut Rope, span: Span, new: &str) {
    let start = text.byte_to_char(span.start as usize);
    let end = text.byte_to_char(span.end as usize);
    text.remove(start..end);
    text.insert(start, new);
}

/// The key of a document in the workspace, one for all spellings of its address: a file's path, decoded, with the
/// letter of a drive in upper case; the address itself for what is not a file. Without a disk, any address with a path is
/// that of a file.
pub(crate) fn key(uri: &Uri) -> String {
    if !uri.scheme().as_str().eq_ignore_ascii_case("file") {
        let of_virtual = if HAS_DISK { None } else { virtual_key(uri) };
        return of_virtual.unwrap_or_else(|| uri.as_str().to_owned());
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

/// The address of the file with a key; [`key`] leads back.
pub(crate) fn uri_of(key: &str) -> Option<Uri> {
    if HAS_DISK {
        return Uri::from_file_path(path_of(key));
    }
    Uri::from_str(&virtual_address(key)?).ok()
}

/// The key of a file that is on no disk: an absolute path that begins with the scheme. `None` for a buffer without a file.
fn virtual_key(uri: &Uri) -> Option<String> {
    let path = uri.path().decode().to_string_lossy();
    let authority = uri.authority().map_or("", |authority| authority.as_str());
    path.starts_with('/').then(|| format!("/{}:{authority}{path}", uri.scheme()))
}

/// The address of a file that is on no disk.
fn virtual_address(key: &str) -> Option<String> {
    let path = key.strip_prefix('/')?;
    let (first, _) = path.split_once('/').unwrap_or((path, ""));
    // The letter of a drive is no scheme.
    let Some((scheme, authority)) = first.split_once(':').filter(|(scheme, _)| scheme.len() > 1) else {
        return Some(format!("file://{}", utf8_percent_encode(key, UNRESERVED)));
    };
    let path = utf8_percent_encode(&path[first.len()..], UNRESERVED);
    let slashes = if authority.is_empty() { "" } else { "//" };
    Some(format!("{scheme}:{slashes}{authority}{path}"))
}

/// Folders that a client has open, as prefixes of keys.
pub(crate) fn folders<'a>(uris: impl IntoIterator<Item = &'a Uri>) -> Vec<String> {
    uris.into_iter().map(|uri| format!("{}/", key(uri).trim_end_matches('/'))).collect()
}

/// The folders that a client opens from the start.
pub(crate) fn folders_of(params: &InitializeParams) -> Vec<String> {
    match &params.workspace_folders {
        Some(open) => folders(open.iter().map(|folder| &folder.uri)),
        // Older clients know one folder only.
        #[allow(deprecated, reason = "older clients send nothing else")]
        None => folders(&params.root_uri),
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

    #[test]
    fn without_a_disk_addresses_with_a_path_are_files() {
        for (address, key) in [
            ("vscode-vfs://github/o/r/a%20b.pyr", Some("/vscode-vfs:github/o/r/a b.pyr")),
            ("memfs:/sample/%C3%A9.pyr", Some("/memfs:/sample/é.pyr")),
            ("untitled:Untitled-1", None),
        ] {
            assert_eq!(virtual_key(&Uri::from_str(address).unwrap()).as_deref(), key);
            if let Some(key) = key {
                assert_eq!(virtual_address(key).as_deref(), Some(address));
            }
        }
        assert_eq!(virtual_address("/C:/a b.pyr").as_deref(), Some("file:///C%3A/a%20b.pyr"));
        assert_eq!(virtual_address("/a/b.pyr").as_deref(), Some("file:///a/b.pyr"));
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
            let rope = Rope::from_str(&text);
            let (mut expected, mut now) = (text, rope.clone());
            let (mut events, mut texts) = (Vec::new(), Vec::new());
            for (a, b, new_text) in changes {
                let (start, end) = (naive_offset(&expected, a, encoding), naive_offset(&expected, b, encoding));
                expected.replace_range(start.min(end)..start.max(end), &new_text);
                let range = Some(Range::new(a, b));
                events.push(TextDocumentContentChangeEvent { range, range_length: None, text: new_text });
                texts.push(expected.clone());
            }
            for (change, expected) in text_changes(&rope, &events, encoding).into_iter().zip(texts) {
                prop_assert_eq!(change.after.to_string(), expected);
                now = change.after;
            }
            prop_assert_eq!(now.to_string(), expected);
        }
    }
}
