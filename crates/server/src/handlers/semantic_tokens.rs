//! `textDocument/semanticTokens`: highlighting by the meaning of names.

use std::sync::Arc;

use pydslrep_analysis::Snapshot;
use pydslrep_ide as ide;
use pydslrep_syntax::{EntityKind, Span};
use tower_lsp::ls_types::{
    Position, SemanticToken, SemanticTokenModifier, SemanticTokenType, SemanticTokens, SemanticTokensDelta,
    SemanticTokensDeltaParams, SemanticTokensEdit, SemanticTokensFullDeltaResult, SemanticTokensFullOptions,
    SemanticTokensLegend, SemanticTokensOptions, SemanticTokensParams, SemanticTokensRangeParams,
    SemanticTokensRangeResult, ServerCapabilities, Uri,
};

use crate::client::ClientFeatures;
use crate::documents::{KnownTokens, TokenCounts};
use crate::positions::{Encoding, LineTable};
use crate::view::View;
use crate::work::Work;

pub(crate) fn announce(server: &mut ServerCapabilities, _: &ClientFeatures) {
    let options = SemanticTokensOptions {
        legend: legend(),
        range: Some(true),
        full: Some(SemanticTokensFullOptions::Delta { delta: Some(true) }),
        ..SemanticTokensOptions::default()
    };
    server.semantic_tokens_provider = Some(options.into());
}

/// The tokens of a whole document.
pub(crate) fn full(view: &View, params: &SemanticTokensParams) -> Option<Work<SemanticTokens>> {
    let uri = &params.text_document.uri;
    let (result_id, counts) = remember(view, uri);
    view.work(uri, |_, encoding| Box::new(move |snapshot| all(&snapshot, encoding, result_id, &counts)))
}

/// Returns the changes since the tokens that the client has.
pub(crate) fn delta(
    view: &View,
    params: &SemanticTokensDeltaParams,
) -> Option<Work<SemanticTokensFullDeltaResult>> {
    let uri = &params.text_document.uri;
    let before = view.document(uri).and_then(|document| document.memory().tokens.lock().last.take());
    let before = before.filter(|before| before.id == params.previous_result_id);
    let (result_id, counts) = remember(view, uri);
    view.work(uri, |_, encoding| {
        Box::new(move |snapshot| {
            let known =
                before.as_ref().and_then(|before| Some((&before.snapshot, before.counts.get()?.as_slice())));
            match known {
                Some(known) => change(known, &snapshot, encoding, result_id, &counts).into(),
                None => all(&snapshot, encoding, result_id, &counts).into(),
            }
        })
    })
}

/// Keeps the tokens that the client is about to get, if it supports deltas.
fn remember(view: &View, uri: &Uri) -> (Option<String>, TokenCounts) {
    let counts = TokenCounts::default();
    let analysed = view.analysed(uri).filter(|_| view.client.token_deltas);
    let Some((document, file)) = analysed else { return (None, counts) };
    let Some(snapshot) = view.database().snapshot(file, None) else { return (None, counts) };
    let memory = document.memory();
    let mut tokens = memory.tokens.lock();
    tokens.answers += 1;
    let id = format!("{}-{}", document.opening(), tokens.answers);
    tokens.last = Some(KnownTokens { id: id.clone(), snapshot, counts: Arc::clone(&counts) });
    (Some(id), counts)
}

fn all(
    snapshot: &Snapshot,
    encoding: Encoding,
    result_id: Option<String>,
    counts: &TokenCounts,
) -> SemanticTokens {
    let (mut tokens, mut lengths) = (Vec::new(), Vec::with_capacity(snapshot.len()));
    for entity in snapshot.entities() {
        let before = tokens.len();
        ide::entity_tokens(snapshot, &entity, &mut tokens);
        lengths.push(tokens.len() - before);
    }
    if lengths.len() == snapshot.len() {
        let _ = counts.set(lengths);
    }
    let table = LineTable::new(snapshot.text(), encoding);
    SemanticTokens { result_id, data: encode(&table, Position::new(0, 0), &tokens) }
}

/// The entities that have changed, and the first one after them, whose position is relative to theirs.
fn change(
    (before, before_counts): (&Snapshot, &[usize]),
    now: &Snapshot,
    encoding: Encoding,
    result_id: Option<String>,
    counts: &TokenCounts,
) -> SemanticTokensDelta {
    let (head, mut tail) = now.unchanged_ends(before);
    while tail > 0 && before_counts[before.len() - tail] == 0 {
        tail -= 1;
    }
    tail = tail.saturating_sub(1);
    let (old_end, new_end) = (before.len() - tail, now.len() - tail);
    // The position of the first new token is relative to the last unchanged one.
    let context = (0..head).rev().find(|index| before_counts[*index] > 0).unwrap_or(head);
    let (mut tokens, mut lengths) = (Vec::new(), Vec::new());
    for entity in now.entities().take(new_end).skip(context) {
        let from = tokens.len();
        ide::entity_tokens(now, &entity, &mut tokens);
        lengths.push(tokens.len() - from);
    }
    let kept = lengths[..(head - context).min(lengths.len())].iter().sum::<usize>();
    let covered = tokens.first().zip(tokens.last()).map(|(first, last)| first.span.to(last.span));
    let table = LineTable::of_part(now.text(), covered.unwrap_or(Span::at(0)), encoding);
    let origin =
        kept.checked_sub(1).map_or(Position::new(0, 0), |last| table.position(tokens[last].span.start));
    let edit = SemanticTokensEdit {
        start: numbers(before_counts[..head].iter().sum()),
        delete_count: numbers(before_counts[head..old_end].iter().sum()),
        data: Some(encode(&table, origin, &tokens[kept..])),
    };
    let new_counts = lengths.into_iter().skip(head - context);
    let all = before_counts[..head]
        .iter()
        .copied()
        .chain(new_counts)
        .chain(before_counts[old_end..].iter().copied());
    let _ = counts.set(all.collect());
    let is_nothing = edit.delete_count == 0 && edit.data.as_ref().is_none_or(Vec::is_empty);
    SemanticTokensDelta { result_id, edits: if is_nothing { Vec::new() } else { vec![edit] } }
}

/// Returns the number of integers that encode so many tokens.
fn numbers(tokens: usize) -> u32 {
    u32::try_from(5 * tokens).unwrap_or(u32::MAX)
}

/// The tokens that touch a range: the visible part of the document.
pub(crate) fn range(view: &View, params: &SemanticTokensRangeParams) -> Option<SemanticTokensRangeResult> {
    let (document, file) = view.analysed(&params.text_document.uri)?;
    let span = view.span(document, params.range);
    let snapshot = view.database().snapshot(file, Some(span))?;
    let tokens = ide::semantic_tokens(&snapshot, Some(span));
    let (Some(first), Some(last)) = (tokens.first(), tokens.last()) else {
        return Some(SemanticTokens { result_id: None, data: Vec::new() }.into());
    };
    let covered = first.span.to(last.span);
    let table = LineTable::of_part(document.text, covered, view.client.encoding);
    Some(SemanticTokens { result_id: None, data: encode(&table, Position::new(0, 0), &tokens) }.into())
}

/// Each token relative to the one before; none extends over the end of a line.
fn encode(table: &LineTable, mut before: Position, tokens: &[ide::SemanticToken]) -> Vec<SemanticToken> {
    let mut data = Vec::with_capacity(tokens.len());
    for token in tokens {
        let start = table.position(token.span.start);
        let end = table.position(token.span.end);
        let same_line = start.line == before.line;
        data.push(SemanticToken {
            delta_line: start.line - before.line,
            delta_start: if same_line { start.character - before.character } else { start.character },
            length: end.character - start.character,
            token_type: token_type(token.kind),
            token_modifiers_bitset: token.modifiers.iter().map(|modifier| modifier_bit(*modifier)).sum(),
        });
        before = start;
    }
    data
}

/// The token types, all of them the protocol's own so that every theme colours them; [`token_type`] and
/// [`modifier_bit`] are indices into these lists.
fn legend() -> SemanticTokensLegend {
    SemanticTokensLegend {
        token_types: vec![
            SemanticTokenType::KEYWORD,
            SemanticTokenType::NUMBER,
            SemanticTokenType::STRING,
            SemanticTokenType::COMMENT,
            SemanticTokenType::VARIABLE,
            SemanticTokenType::PROPERTY,
            SemanticTokenType::ENUM_MEMBER,
            SemanticTokenType::CLASS,
            SemanticTokenType::FUNCTION,
            SemanticTokenType::NAMESPACE,
        ],
        token_modifiers: vec![
            SemanticTokenModifier::DECLARATION,
            SemanticTokenModifier::READONLY,
            SemanticTokenModifier::DEPRECATED,
        ],
    }
}

fn token_type(kind: ide::HighlightKind) -> u32 {
    match kind {
        ide::HighlightKind::Keyword => 0,
        ide::HighlightKind::Number => 1,
        ide::HighlightKind::String => 2,
        ide::HighlightKind::Comment => 3,
        ide::HighlightKind::Name(EntityKind::Wheel) => 4,
        ide::HighlightKind::Name(EntityKind::Sensor) => 5,
        ide::HighlightKind::Name(EntityKind::Ip) => 6,
        ide::HighlightKind::Name(EntityKind::Robot) => 7,
        ide::HighlightKind::Name(EntityKind::Movement) => 8,
        ide::HighlightKind::Name(EntityKind::Environment) => 9,
    }
}

fn modifier_bit(modifier: ide::Modifier) -> u32 {
    match modifier {
        ide::Modifier::Declaration => 1,
        ide::Modifier::Readonly => 2,
        ide::Modifier::Deprecated => 4,
    }
}

#[cfg(test)]
mod tests {
    use ropey::Rope;
    use tower_lsp::ls_types::{
        DidChangeTextDocumentParams, TextDocumentContentChangeEvent, TextDocumentItem,
        VersionedTextDocumentIdentifier,
    };

    use super::*;
    use crate::state::State;

    #[test]
    fn tokens_are_relative_to_the_one_before() {
        let token = |start, end, kind, modifiers: &[ide::Modifier]| ide::SemanticToken {
            span: Span { start, end },
            kind,
            modifiers: modifiers.to_vec(),
        };
        let tokens = [
            token(0, 8, ide::HighlightKind::Comment, &[]),
            token(9, 11, ide::HighlightKind::Number, &[]),
            token(
                14,
                15,
                ide::HighlightKind::Name(EntityKind::Ip),
                &[ide::Modifier::Declaration, ide::Modifier::Readonly],
            ),
        ];
        let table = LineTable::new(&Rope::from_str("/*🤖*/ 42\r\n\n x"), Encoding::Utf16);
        let numbers = |token: SemanticToken| {
            [
                token.delta_line,
                token.delta_start,
                token.length,
                token.token_type,
                token.token_modifiers_bitset,
            ]
        };
        let encoded: Vec<_> = encode(&table, Position::new(0, 0), &tokens).into_iter().map(numbers).collect();
        assert_eq!(encoded, [[0, 0, 6, 3, 0], [0, 7, 2, 1, 0], [2, 0, 1, 6, 3]]);
    }

    const PROGRAM: &str = "wheel a with radius 4 /* é🤖\n*/ sensor s\n\nrobot type tw r with port 1 has { a a } wheels\n\
                           movement m of r {\n  move 4 meters // far\n  turn left\n}\n";

    fn state(text: &str) -> State {
        let mut state = State::default();
        Arc::make_mut(&mut state.view.client).token_deltas = true;
        state.open(&TextDocumentItem::new(uri(), "pydslrep".to_owned(), 1, text.to_owned()));
        state
    }

    fn uri() -> Uri {
        "file:///a.pyr".parse().unwrap()
    }

    fn edit(state: &mut State, start: u32, end: u32, text: &str) {
        let (document, _) = state.view.analysed(&uri()).unwrap();
        let length = u32::try_from(document.text.len_bytes()).unwrap();
        let span = Span::new(start.min(length), end.min(length));
        let range = Some(state.view.range(document, span));
        let content_changes =
            vec![TextDocumentContentChangeEvent { range, range_length: None, text: text.to_owned() }];
        let text_document = VersionedTextDocumentIdentifier::new(uri(), 2);
        state.change(&DidChangeTextDocumentParams { text_document, content_changes });
    }

    fn all_of(state: &State) -> SemanticTokens {
        let params = serde_json::from_value(serde_json::json!({ "textDocument": { "uri": uri() } })).unwrap();
        done(full(&state.view, &params).unwrap())
    }

    fn changes_since(state: &State, id: &str) -> SemanticTokensFullDeltaResult {
        let params = serde_json::json!({ "textDocument": { "uri": uri() }, "previousResultId": id });
        done(delta(&state.view, &serde_json::from_value(params).unwrap()).unwrap())
    }

    fn done<R>(work: Work<R>) -> R {
        match work {
            Work::OnFile(work) => (work.run)(work.snapshot),
            Work::Done(answer) => answer,
        }
    }

    /// As a client applies changes, to its list of tokens.
    fn applied(mut data: Vec<SemanticToken>, edits: &[SemanticTokensEdit]) -> Vec<SemanticToken> {
        for edit in edits {
            let (start, count) = (edit.start as usize / 5, edit.delete_count as usize / 5);
            data.splice(start..start + count, edit.data.clone().unwrap_or_default());
        }
        data
    }

    fn check_changes(edits: &[(u32, u32, &str)]) {
        let mut state = state(PROGRAM);
        let SemanticTokens { result_id, mut data } = all_of(&state);
        let mut id = result_id.unwrap();
        for (start, end, text) in edits {
            edit(&mut state, *start, *end, text);
            let change = changes_since(&state, &id);
            let SemanticTokensFullDeltaResult::TokensDelta(change) = change else { panic!("{change:?}") };
            data = applied(data, &change.edits);
            id = change.result_id.unwrap();
            let text = state.view.document(&uri()).unwrap().text.to_string();
            let fresh = self::state(&text);
            assert_eq!(data, all_of(&fresh).data, "{text}");
        }
    }

    #[test]
    fn an_edit_sends_what_it_touches() {
        let mut state = state(PROGRAM);
        let id = all_of(&state).result_id.unwrap();
        let at = u32::try_from(PROGRAM.find("4 meters").unwrap()).unwrap();
        edit(&mut state, at, at, "1");
        let SemanticTokensFullDeltaResult::TokensDelta(change) = changes_since(&state, &id) else { panic!() };
        let [edit] = &change.edits[..] else { panic!("{change:?}") };
        // Of all the tokens, only those of the movement.
        assert_eq!((edit.start, edit.delete_count), (5 * 20, 5 * 10));
        let again = changes_since(&state, change.result_id.as_deref().unwrap());
        let SemanticTokensFullDeltaResult::TokensDelta(nothing) = again else { panic!() };
        assert_eq!(nothing.edits, []);
        let unknown = changes_since(&state, "7777");
        assert!(matches!(unknown, SemanticTokensFullDeltaResult::Tokens(_)));
    }

    #[test]
    fn changes_lead_to_the_same_tokens() {
        check_changes(&[
            (0, 0, "// x\n"),
            (0, 5, ""),
            (22, 22, "\n"),
            (22, 23, " "),
            (0, 300, ""),
            (0, 0, PROGRAM),
        ]);
    }

    proptest::proptest! {
        #[test]
        fn any_changes_lead_to_the_same_tokens(
            edits in proptest::collection::vec((0_u32..160, 0_u32..9, "[ a\n\r{}é🤖/*\"]{0,3}|wheel |sensor b\n"), 1..12)
        ) {
            let edits: Vec<(u32, u32, &str)> =
                edits.iter().map(|(at, len, text)| (*at, at + len, text.as_str())).collect();
            check_changes(&edits);
        }
    }
}
