//! What can follow in each place: nothing that a rule expects is lost or taken for something else on its way out of it.

use std::collections::BTreeSet;

use expect_test::expect;
use pydslrep_syntax::{EntityKind, Expected, KEYWORDS, Quantity, Span, TokenKind, expected_after, lex};

/// All that a rule can expect is what can follow one of these tokens.
const ENTITIES: [&str; 7] = [
    "import \"a.pyr\"",
    "wheel a with radius 4",
    "sensor s : bumper",
    "ip i 1.2.3.4",
    "robot r type tw with port 1 has { a, b } wheels with sensors { s }",
    "parallel movement m of r { move 4 meters at 9 until { s } detect within 4 meters \
        turn left 90 with radius 4 meters in reverse wait 2 seconds \
        repeat 2 times { do n } if { s } clear { slam } else { slam } }",
    "environment e with ip i has { r } robots with { m } moves",
];

/// What can follow each token of [`ENTITIES`], and nothing at all.
fn followed() -> Vec<(&'static str, Vec<Expected>)> {
    let mut followed = vec![("", expected_after("", &[]))];
    for text in ENTITIES {
        let tokens = lex(text);
        followed.extend((0..tokens.len()).map(|last| {
            let before = Span::new(0, tokens[last].1.end).text(text);
            (tokens[last].1.text(text), expected_after(before, &tokens[..=last]))
        }));
    }
    followed
}

#[test]
fn nothing_is_taken_for_something_else() {
    let mut seen = BTreeSet::new();
    let lists = followed().into_iter().filter(|(_, expected)| seen.insert(expected.clone()));
    let lists: Vec<String> = lists.map(|(token, expected)| format!("{token} {expected:?}")).collect();
    expect![[r#"
         [Declaration]
        import [Path]
        wheel [NameOf(Wheel)]
        a [Word(With)]
        with [Word(Radius)]
        radius [Number(Radius)]
        sensor [NameOf(Sensor)]
        s [Word(Colon), Declaration]
        : [Word(Distance), Word(Bumper)]
        ip [NameOf(Ip)]
        i [Address]
        robot [NameOf(Robot)]
        r [Word(With), Word(Type)]
        type [Word(Tw), Word(Fw), Word(Fwh)]
        with [Word(Port)]
        port [Port]
        1 [Word(Has)]
        has [Word(OpenBrace)]
        { [Word(CloseBrace), ReferenceTo(Wheel)]
        a [Word(CloseBrace), Word(Comma), ReferenceTo(Wheel)]
        } [Word(Wheels)]
        wheels [Word(With), Declaration]
        with [Word(Sensors)]
        { [ReferenceTo(Sensor)]
        s [Word(CloseBrace), Word(Comma), ReferenceTo(Sensor)]
        parallel [Word(Movement)]
        movement [NameOf(Movement)]
        m [Word(Of)]
        of [ReferenceTo(Robot)]
        { [Word(CloseBrace), Action]
        move [Word(At), Word(Until), Number(Distance)]
        4 [Word(Meters), Word(Centimeters)]
        meters [Word(CloseBrace), Word(At), Word(Until), Action]
        at [Number(Speed)]
        9 [Word(CloseBrace), Word(Until), Action]
        } [Word(CloseBrace), Word(Clear), Word(Detect), Word(Within), Action]
        detect [Word(CloseBrace), Word(Within), Action]
        within [Number(Distance)]
        turn [Word(Left), Word(Right)]
        left [Word(CloseBrace), Word(With), Word(At), Word(Until), Word(In), Number(Angle), Action]
        90 [Word(CloseBrace), Word(With), Word(At), Word(Until), Word(In), Action]
        meters [Word(CloseBrace), Word(At), Word(Until), Word(In), Action]
        in [Word(Reverse)]
        wait [Word(Until), Number(Time)]
        2 [Word(Seconds)]
        repeat [Word(Until), Number(Count)]
        2 [Word(Times)]
        do [ReferenceTo(Movement)]
        } [Word(OpenBrace), Word(Clear), Word(Detect), Word(Within)]
        clear [Word(OpenBrace), Word(Within)]
        } [Word(CloseBrace), Word(Else), Action]
        else [Word(OpenBrace), Word(If)]
        environment [NameOf(Environment)]
        e [Word(With), Word(Has)]
        with [Word(Ip)]
        ip [ReferenceTo(Ip)]
        { [Word(CloseBrace), ReferenceTo(Robot)]
        r [Word(CloseBrace), Word(Comma), ReferenceTo(Robot)]
        } [Word(Robots)]
        { [Word(CloseBrace), ReferenceTo(Movement)]
        m [Word(CloseBrace), Word(Comma), ReferenceTo(Movement)]
        } [Word(Moves)]"#]]
    .assert_eq(&lists.join("\n"));
}

/// All that a rule can expect.
fn all() -> BTreeSet<Expected> {
    let signs = [TokenKind::OpenBrace, TokenKind::CloseBrace, TokenKind::Comma, TokenKind::Colon];
    // Those that begin something are expected after another word only: `with ip`, `parallel movement`, `else if`.
    let second = [TokenKind::Ip, TokenKind::Movement, TokenKind::If];
    let keywords = KEYWORDS.into_iter().map(|(keyword, _)| keyword);
    let others = keywords.filter(|word| !word.is_action() && !TokenKind::DECLARATIONS.contains(word));
    let words = others.chain(signs).chain(second).map(Expected::Word);
    let names = EntityKind::ALL.map(Expected::NameOf);
    let referred = EntityKind::ALL.into_iter().filter(|kind| *kind != EntityKind::Environment);
    let numbers = [
        Quantity::Radius,
        Quantity::Distance,
        Quantity::Speed,
        Quantity::Angle,
        Quantity::Time,
        Quantity::Count,
    ];
    let rest = [Expected::Port, Expected::Address, Expected::Path, Expected::Action, Expected::Declaration];
    let others = names.into_iter().chain(referred.map(Expected::ReferenceTo));
    words.chain(others).chain(numbers.map(Expected::Number)).chain(rest).collect()
}

#[test]
fn nothing_is_lost() {
    let found: BTreeSet<Expected> = followed().into_iter().flat_map(|(_, expected)| expected).collect();
    let differences: Vec<Expected> = found.symmetric_difference(&all()).copied().collect();
    assert_eq!(differences, []);
}
