//! The PyDSLRep language as text: tokens, cutting a file into entities, parsing one entity, the syntax tree,
//! syntax errors, the canonical layout.
//!
//! Knows one piece of text at a time. Must never know files, names across entities, editors or I/O.
//!
//! Parsing never fails: any text gives a tree, as much of it as could be understood, and a list of errors. All spans
//! are byte offsets from the start of the text that was handed in, so a parsed entity stays valid wherever in a file
//! it is.

pub mod ast;
mod cut;
mod earlier;
mod error;
mod format;
mod lexer;
mod parser;
mod shift;
mod token;

pub use cut::{LOOKAHEAD, cut};
pub use earlier::{Earlier, lex_again};
pub use error::{Expected, Found, Quantity, SyntaxError, SyntaxErrorKind};
pub use format::{COLUMNS, TextEdit, apply_edits, format, format_edits};
pub use lexer::{Token, lex};
pub use parser::{Parse, expected_after, parse, parse_again, parse_cut, parse_each};
pub use pydslrep_text::{Span, offset};
pub use token::{EntityKind, KEYWORDS, TokenKind, TokenSet, escape};
