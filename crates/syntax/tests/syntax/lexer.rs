//! From texts to tokens.

use expect_test::{Expect, expect};
use pydslrep_syntax::{Span, TokenKind, lex};

fn check(text: &str, expected: &Expect) {
    let listed: Vec<String> =
        lex(text).into_iter().map(|(token, span)| format!("{token:?} {:?}", span.text(text))).collect();
    expected.assert_eq(&listed.join("\n"));
}

#[test]
fn numbers() {
    check(
        "4 -4 4.0 -4.25 127.0.0.1 4. .5 1.2.3 1.2.3.4.5 -1.2.3.4 - 1e5 4meters ..",
        &expect![[r#"
            Integer "4"
            Integer "-4"
            Float "4.0"
            Float "-4.25"
            Ipv4 "127.0.0.1"
            MalformedNumber "4."
            MalformedNumber ".5"
            MalformedNumber "1.2.3"
            MalformedNumber "1.2.3.4.5"
            MalformedNumber "-1.2.3.4"
            Invalid "-"
            Integer "1"
            Name "e5"
            Integer "4"
            Meters "meters"
            Invalid "..""#]],
    );
}

#[test]
fn names_and_escapes() {
    check(
        "wheelL _x ^robots ^ wheelHx wheelH",
        &expect![[r#"
            Name "wheelL"
            Name "_x"
            Name "^robots"
            Invalid "^"
            Name "wheelHx"
            WheelH "wheelH""#]],
    );
}

#[test]
fn comments() {
    check(
        "// a\r/* b **/ /**/ /x *y /* c * /",
        &expect![[r#"
            LineComment "// a"
            BlockComment "/* b **/"
            BlockComment "/**/"
            Invalid "/"
            Name "x"
            Invalid "*"
            Name "y"
            UnterminatedComment "/* c * /""#]],
    );
}

#[test]
fn comments_of_other_languages() {
    check(
        "# a\r-- b\n% c\r\n/ d\n\\\\ e\n<!-- f -->\n50%;--a /g",
        &expect![[r##"
            ForeignComment "# a"
            ForeignComment "-- b"
            ForeignComment "% c"
            ForeignComment "/ d"
            ForeignComment "\\\\ e"
            ForeignComment "<!-- f -->"
            Integer "50"
            Invalid "%;--"
            Name "a"
            Invalid "/"
            Name "g""##]],
    );
}

#[test]
fn names_that_are_none() {
    check(
        "left-wheel räder rover.left it's ^ö-1 move-4 a- b1.5 robot-1 r-1-2.5a at-9 1e-5 ip-1^a",
        &expect![[r#"
            MalformedName "left-wheel"
            MalformedName "räder"
            MalformedName "rover.left"
            MalformedName "it's"
            MalformedName "^ö-1"
            Move "move"
            Integer "-4"
            Name "a"
            Invalid "-"
            Name "b1"
            MalformedNumber ".5"
            MalformedName "robot-1"
            MalformedName "r-1-2.5a"
            At "at"
            Integer "-9"
            Integer "1"
            Name "e"
            Integer "-5"
            MalformedName "ip-1"
            Name "^a""#]],
    );
}

#[test]
fn an_unterminated_comment_takes_the_rest() {
    for text in ["/*", "/* a", "/* a *", "/* é\n}\n", "/***"] {
        assert_eq!(lex(text), [(TokenKind::UnterminatedComment, Span::of(text))], "{text:?}");
    }
}

#[test]
fn strings_end_on_their_line() {
    check(
        "\"a/b.pyr\" \"open\nwheel \"",
        &expect![[r#"
            String "\"a/b.pyr\""
            UnterminatedString "\"open"
            Wheel "wheel"
            UnterminatedString "\"""#]],
    );
}

#[test]
fn what_is_no_token_is_joined() {
    check(
        "\u{feff}wheel §€é;w \u{feff}",
        &expect![[r#"
            Wheel "wheel"
            Invalid "§€"
            MalformedName "é"
            Invalid ";"
            Name "w"
            Invalid "\u{feff}""#]],
    );
}
