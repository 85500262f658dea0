//! `textDocument/semanticTokens`: the colours that only the meaning of a name can tell.

use pydslrep_ide as ide;
use pydslrep_syntax::EntityKind;
use tower_lsp::ls_types::{
    Position, SemanticToken, SemanticTokenModifier, SemanticTokenType, SemanticTokens, SemanticTokensLegend,
    SemanticTokensParams, SemanticTokensRangeParams,
};

use crate::positions::LineTable;
use crate::state::State;

/// The tokens of a whole document.
pub(crate) fn full(state: &State, params: &SemanticTokensParams) -> Option<SemanticTokens> {
    let (document, file) = state.analysed(&params.text_document.uri)?;
    let tokens = ide::semantic_tokens(&state.database, file, None);
    Some(encode(&LineTable::new(&document.text, state.client.encoding), &tokens))
}

/// The tokens that touch a range: what the editor shows first.
pub(crate) fn range(state: &State, params: &SemanticTokensRangeParams) -> Option<SemanticTokens> {
    let (document, file) = state.analysed(&params.text_document.uri)?;
    let span = state.span(document, params.range);
    let tokens = ide::semantic_tokens(&state.database, file, Some(span));
    let (Some(first), Some(last)) = (tokens.first(), tokens.last()) else {
        return Some(SemanticTokens { result_id: None, data: Vec::new() });
    };
    let covered = first.span.to(last.span);
    Some(encode(&LineTable::of_part(&document.text, covered, state.client.encoding), &tokens))
}

/// Each token by its distance from the one before; none reaches over the end of a line.
fn encode(table: &LineTable, tokens: &[ide::SemanticToken]) -> SemanticTokens {
    let mut data = Vec::with_capacity(tokens.len());
    let mut before = Position::new(0, 0);
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
    SemanticTokens { result_id: None, data }
}

/// The protocol's names for our kinds of token, its own ones so that every theme colours them; [`token_type`] and
/// [`modifier_bit`] count in their order.
pub(crate) fn legend() -> SemanticTokensLegend {
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

fn token_type(kind: ide::TokenKind) -> u32 {
    match kind {
        ide::TokenKind::Keyword => 0,
        ide::TokenKind::Number => 1,
        ide::TokenKind::String => 2,
        ide::TokenKind::Comment => 3,
        ide::TokenKind::Name(EntityKind::Wheel) => 4,
        ide::TokenKind::Name(EntityKind::Sensor) => 5,
        ide::TokenKind::Name(EntityKind::Ip) => 6,
        ide::TokenKind::Name(EntityKind::Robot) => 7,
        ide::TokenKind::Name(EntityKind::Movement) => 8,
        ide::TokenKind::Name(EntityKind::Environment) => 9,
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
    use pydslrep_syntax::Span;
    use ropey::Rope;

    use super::*;
    use crate::positions::Encoding;

    #[test]
    fn tokens_are_told_by_their_distances() {
        let token = |start, end, kind, modifiers: &[ide::Modifier]| ide::SemanticToken {
            span: Span { start, end },
            kind,
            modifiers: modifiers.to_vec(),
        };
        let tokens = [
            token(0, 8, ide::TokenKind::Comment, &[]),
            token(9, 11, ide::TokenKind::Number, &[]),
            token(
                14,
                15,
                ide::TokenKind::Name(EntityKind::Ip),
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
        let encoded: Vec<_> = encode(&table, &tokens).data.into_iter().map(numbers).collect();
        assert_eq!(encoded, [[0, 0, 6, 3, 0], [0, 7, 2, 1, 0], [2, 0, 1, 6, 3]]);
    }
}
