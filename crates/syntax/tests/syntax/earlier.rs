//! Tokens after an edit.

use pydslrep_syntax::{Earlier, Span, lex, lex_again, parse};

/// Texts before and after their first character is replaced by a space.
#[test]
fn what_tokens_have_been_joined_to_counts() {
    for text in ["4e-5 slam", "r-1 slam", "/*/ slam", "\"x\" slam"] {
        let text = format!("movement m of r {{ move {text} }}");
        let place = u32::try_from(text.find("move ").unwrap() + 5).unwrap();
        let (span, before) = parse(&text).remove(0);
        let edited = Span::new(place, place + 1);
        let mut after = text.clone();
        after.replace_range(std::ops::Range::from(edited), " ");
        let earlier = Earlier { parse: &before, now: span, edited, growth: 0 };
        assert_eq!(lex_again(&after, Some(&earlier)), lex(&after), "{text}");
    }
}
