//! Readable cases, and what holds for any text at all.

use expect_test::{Expect, expect};
use proptest::prelude::*;
use pydslrep_syntax::{KEYWORDS, Span, TokenKind, format, format_edits, lex, parse};

fn check(text: &str, expected: &Expect) {
    let formatted = format(text);
    expected.assert_eq(&formatted);
    assert_eq!(format(&formatted), formatted, "formatting again changes something");
    assert_eq!(meaning(&formatted), meaning(text));
}

/// The trees and errors of a text without their places.
fn meaning(text: &str) -> Vec<String> {
    let pieces = parse(text);
    let entities = pieces.iter().filter_map(|(_, parse)| {
        let mut errors: Vec<_> = parse.errors.iter().map(|error| format!("{:?}", error.kind)).collect();
        errors.sort_unstable();
        let something = parse.entity.is_some() || !errors.is_empty();
        something.then(|| without_spans(&format!("{:?} {errors:?}", parse.entity)))
    });
    entities.collect()
}

fn without_spans(tree: &str) -> String {
    let mut parts = tree.split("Span { start: ");
    let mut kept = parts.next().unwrap().to_owned();
    for part in parts {
        kept.push_str(part.split_once(" }").unwrap().1);
    }
    kept
}

/// Comments, and the tokens around them, with what the layout may change left out.
fn tokens_and_comments(text: &str) -> Vec<String> {
    let kept = lex(text).into_iter().filter(|(token, _)| *token != TokenKind::Comma);
    let lines = |span: Span| {
        let lines = span.text(text).split(['\r', '\n']).map(|line| line.trim_matches([' ', '\t', '\x0c']));
        lines.filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n")
    };
    kept.map(|(token, span)| format!("{token:?} {}", lines(span))).collect()
}

/// The text of what has to stay as it is, from the first to the last token of each broken entity.
fn broken_texts(text: &str) -> Vec<&str> {
    let pieces = parse(text);
    let broken = pieces.iter().filter(|(_, parse)| !parse.errors.is_empty());
    broken
        .filter_map(|(span, parse)| {
            let stays = |token: TokenKind| !token.is_comment() || token == TokenKind::UnterminatedComment;
            let mut kept = parse.tokens.iter().filter(|(token, _)| stays(*token)).map(|(_, span)| *span);
            // A comment of another language is a mistake without any token.
            let first = kept.next()?;
            Some(first.to(kept.next_back().unwrap_or(first)).shifted(span.start).text(text))
        })
        .collect()
}

#[test]
fn the_canonical_example_stays_as_it_is() {
    const CANONICAL: &str = "\
wheel wheelR with radius 4.5
wheel wheelL with radius 4.5

robot robot_1 type tw with port 23000 has { wheelL wheelR } wheels with sensors { fSensor, lSensor }

movement mov_1 of robot_1 {
  move 4.0 meters at 9.0
  turn right until { fSensor }
}

environment area_1 has { robot_1 } robots with { mov_1 } moves
";
    assert_eq!(format(CANONICAL), CANONICAL);
    let one_line = CANONICAL.split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(format(&one_line), CANONICAL);
    let one_word_per_line = CANONICAL.split_whitespace().collect::<Vec<_>>().join("\n\n");
    // Blank lines inside a movement stay, where there can be any.
    assert_eq!(format(&one_word_per_line), CANONICAL.replace("9.0\n", "9.0\n\n"));
}

#[test]
fn runs_and_blank_lines() {
    check(
        "\n\nimport \"a.pyr\"\n\nimport \"b.pyr\"\nwheel a with radius 3\n\n\nwheelH b with radius 3 sensor s:bumper sensor  t\nip i 1.2.3.4
ip j 1.2.3.4
movement m of r{}\n\n\nmovement n of r {\n\n  slam\n\n\n\n  slam\n\n}\n\n",
        &expect![[r#"
            import "a.pyr"
            import "b.pyr"

            wheel a with radius 3
            wheelH b with radius 3

            sensor s : bumper
            sensor t

            ip i 1.2.3.4
            ip j 1.2.3.4

            movement m of r { }

            movement n of r {
              slam

              slam
            }
        "#]],
    );
}

#[test]
fn commas() {
    check(
        "robot r with port 1 has {a,b,} wheels with sensors {s t,}
movement m of ^r { turn left until {s t u} }
environment e,i has {r,q} robots with {m,} moves environment e , i has {} robots",
        &expect![[r#"
            robot r with port 1 has { a b } wheels with sensors { s, t }

            movement m of ^r {
              turn left until { s, t, u }
            }

            environment e, i has { r q } robots with { m } moves

            environment e, i has { } robots
        "#]],
    );
}

#[test]
fn blocks() {
    check(
        "movement m of r { repeat 4 times{move 1 meters // once
  if {a b} clear{slam}else if{a}detect /* near */{ } else // never
  { // really
   do do do if wait 1 seconds

  } } repeat 2 times // often
  /* and
   * more */
  { slam if { a } clear { } // one
   // two
   else /* three */ if { a } detect { } else /* four */ { /* five */ } }
  wait until {a} clear repeat 2 times { /* nothing */ } turn left until {a} detect within 4 meters slam }",
        &expect![[r#"
            movement m of r {
              repeat 4 times {
                move 1 meters // once
                if { a, b } clear {
                  slam
                } else if { a } detect {
                  /* near */
                } else {
                  // never
                  // really
                  do do
                  do if
                  wait 1 seconds
                }
              }
              repeat 2 times {
                // often
                /* and
                 * more */
                slam
                if { a } clear { } else if { a } detect {
                  // one
                  // two
                  /* three */
                } else {
                  /* four */
                  /* five */
                }
              }
              wait until { a } clear
              repeat 2 times {
                /* nothing */
              }
              turn left until { a } detect within 4 meters
              slam
            }
        "#]],
    );
}

#[test]
fn long_lists() {
    check(
        "robot quite_a_long_name type fw with port 23000 has { wheelFL wheelRL wheelFR wheelRR } wheels with sensors { front, leftOne }
robot short type fw with port 23000 has { wheelFL wheelRL wheelFR wheelRR } wheels with sensors { front, leftOne }
robot a_name_that_is_long_enough type fw with port 23000 has { wheelFrontLeft wheelRearLeft wheelFR } wheels
movement m of r { turn left until { a_sensor_in_front, a_sensor_on_the_left_side, a_sensor_on_the_right_side_of_it_ } turn left until { a_sensor_in_front, a_sensor_on_the_left_side, a_sensor_on_the_right_side_of_it } }",
        &expect![[r#"
            robot quite_a_long_name type fw with port 23000 has {
              wheelFL
              wheelRL
              wheelFR
              wheelRR
            } wheels with sensors { front, leftOne }

            robot short type fw with port 23000 has { wheelFL wheelRL wheelFR wheelRR } wheels with sensors {
              front,
              leftOne
            }

            robot a_name_that_is_long_enough type fw with port 23000 has {
              wheelFrontLeft
              wheelRearLeft
              wheelFR
            } wheels

            movement m of r {
              turn left until {
                a_sensor_in_front,
                a_sensor_on_the_left_side,
                a_sensor_on_the_right_side_of_it_
              }
              turn left until { a_sensor_in_front, a_sensor_on_the_left_side, a_sensor_on_the_right_side_of_it }
            }
        "#]],
    );
}

#[test]
fn comments_keep_their_place() {
    check(
        "// top  \n\n\n/** doc\n      * of a */\nwheel a with radius 3 // three\n   // about b\nwheel b with radius 3 /* x */ /* y */ wheel c with radius 3
/* d */ wheel d with radius 3


      // the last
wheel e with radius 3
// of the robot
robot r /* type */ type tw // two
with port 1
// wheels
has { a /* left */ , b // right
} wheels
// remark

movement m of r { // start
  // first

move 4 meters /* far */ turn left // left
  turn
     // way
  right 3


  // last
}
// end",
        &expect![[r#"
            // top

            /** doc
             * of a */
            wheel a with radius 3 // three
            // about b
            wheel b with radius 3 /* x */ /* y */
            wheel c with radius 3
            /* d */ wheel d with radius 3

            // the last
            wheel e with radius 3

            // of the robot
            robot r /* type */ type tw // two
              with port 1
              // wheels
              has {
                a /* left */
                b // right
              } wheels
            // remark

            movement m of r { // start
              // first

              move 4 meters /* far */
              turn left // left
              turn
                // way
                right 3

              // last
            }
            // end
        "#]],
    );
}

#[test]
fn comments_in_empty_places() {
    check(
        "movement m of r { /* nothing */ } movement m of r { // later
} movement n of r {
/* a
   b */ } robot r with port 1 has { /* none */ } wheels",
        &expect![[r#"
            movement m of r {
              /* nothing */
            }

            movement m of r { // later
            }

            movement n of r {
              /* a
               b */
            }

            robot r with port 1 has { /* none */ } wheels
        "#]],
    );
    check(
        "robot r with port 1 has { a
// one line of its own
b } wheels with sensors { s /* of s */, /* of t */ t
/* alone */
u }",
        &expect![[r#"
            robot r with port 1 has {
              a
              // one line of its own
              b
            } wheels with sensors {
              s, /* of s */ /* of t */
              t,
              /* alone */
              u
            }
        "#]],
    );
    check("", &expect![""]);
    check(" \n\n\t", &expect![""]);
    check("\u{feff}", &expect!["\u{feff}"]);
    check("// only", &expect![["// only\n"]]);
}

#[test]
fn broken_entities_stay() {
    check(
        "wheel   a with radius   3
   wheel   b with   4 // four
     // maybe of b

// of c
wheel   c with radius 3
movement m of r{ slam }
movement  m of r {
  move 4  metrs
  wheel   d with radius 3",
        &expect![[r#"
            wheel a with radius 3
               wheel   b with   4 // four
                 // maybe of b

            // of c
            wheel c with radius 3

            movement m of r {
              slam
            }

            movement  m of r {
              move 4  metrs

            wheel d with radius 3
        "#]],
    );
    // A comment that may be part of a broken entity does not move above the next one.
    check(
        "wheel b with 3\n// of b\n\n\nwheel  c with radius 3",
        &expect![[r#"
        wheel b with 3
        // of b

        wheel c with radius 3
    "#]],
    );
    check(
        "garbage   §\nwheel  a with radius 3 /* open  ",
        &expect!["garbage   §\nwheel  a with radius 3 /* open  "],
    );
}

#[test]
fn line_endings_and_the_byte_order_mark_stay() {
    assert_eq!(
        format("\u{feff}\nwheel a\r\n with radius 3\n/*\n * a */"),
        "\u{feff}wheel a with radius 3\r\n/*\r\n * a */\r\n"
    );
    assert_eq!(format("\n\u{feff}\n"), "\n\u{feff}\n", "only a first one is a byte order mark");
    assert_eq!(format("// é\rwheel a with radius 3"), "// é\rwheel a with radius 3\r");
    assert_eq!(
        format("movement m of r {\r\n\r\n\r\nslam\r\n\r\n\r\nslam }"),
        "movement m of r {\r\n  slam\r\n\r\n  slam\r\n}\r\n"
    );
}

#[test]
fn edits_are_small() {
    let text = "wheel a  with radius 3\nwheel b with radius 3\nsensor s\n";
    let pieces = parse(text);
    let edits = format_edits(text, pieces.iter().map(|(span, parse)| (*span, parse)));
    let listed: Vec<_> =
        edits.iter().map(|edit| (edit.span.start, edit.span.end, edit.text.as_str())).collect();
    assert_eq!(listed, [(7, 9, " "), (44, 45, "\n\n")]);
}

#[test]
fn the_articles_programs() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/paper");
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert_eq!(paths.len(), 6);
    for path in paths {
        let text = std::fs::read_to_string(path).unwrap();
        let formatted = format(&text);
        assert_eq!(meaning(&formatted), meaning(&text));
        assert_eq!(format(&formatted), formatted);
        assert!(formatted.lines().all(|line| line.len() <= 100 && line == line.trim_end()));
    }
}

/// For each comment, whether it is alone on its lines, and whether more than a comma is before it on its line.
fn stands(text: &str) -> Vec<(bool, bool)> {
    let is_blank = |part: &str| part.trim_matches([' ', '\t', '\x0c', '\u{feff}']).is_empty();
    let comments = lex(text).into_iter().filter(|(token, _)| token.is_comment());
    comments
        .map(|(_, span)| {
            let before = text[..span.start as usize].rsplit(['\n', '\r']).next().unwrap();
            let after = text[span.end as usize..].split(['\n', '\r']).next().unwrap();
            (is_blank(before) && is_blank(after), !is_blank(&before.replace(',', "")))
        })
        .collect()
}

/// Checks the look of a layout where nothing is broken.
fn check_looks(text: &str, formatted: &str) -> Result<(), TestCaseError> {
    let places = lex(text).into_iter().filter(|(token, _)| token.is_comment() && !has_blocks(text));
    for ((token, _), (before, after)) in places.zip(stands(text).into_iter().zip(stands(formatted))) {
        prop_assert!(!before.0 || after.0, "a comment is no longer alone on its line");
        prop_assert!(
            token != TokenKind::LineComment || !before.1 || after.1,
            "a comment left the end of its line"
        );
    }
    if broken_texts(text).is_empty() {
        let lines = formatted.replace("\r\n", "\n").replace('\r', "\n");
        prop_assert!(!lines.contains(" \n") && !lines.contains("\n\n\n") && !lines.starts_with('\n'));
        let blank_at_brace = lines.contains("{\n\n") || lines.contains("\n\n}");
        prop_assert!(!blank_at_brace);
    }
    Ok(())
}

fn has_blocks(text: &str) -> bool {
    lex(text).iter().any(|(token, _)| matches!(token, TokenKind::Repeat | TokenKind::If | TokenKind::Else))
}

/// Checks the properties that hold for any text.
fn check_properties(text: &str) -> Result<(), TestCaseError> {
    let formatted = format(text);
    prop_assert_eq!(format(&formatted), formatted.clone(), "not idempotent");
    prop_assert_eq!(meaning(&formatted), meaning(text));
    let (mut after, mut before) = (tokens_and_comments(&formatted), tokens_and_comments(text));
    if has_blocks(text) {
        // Comments before a block go into it, perhaps past those of its condition.
        for tokens in [&mut after, &mut before] {
            tokens.sort_by_key(|token| token.contains("Comment ").then(|| token.clone()));
        }
    }
    prop_assert_eq!(after, before);
    prop_assert_eq!(broken_texts(&formatted), broken_texts(text));
    let ends_well = formatted.ends_with(['\n', '\r']) && !formatted.ends_with("\n\n");
    let is_empty = formatted.trim_start_matches('\u{feff}').is_empty();
    let is_open = lex(text).last().is_some_and(|(token, _)| *token == TokenKind::UnterminatedComment);
    prop_assert!(ends_well || is_empty || is_open);
    Ok(())
}

proptest! {
    #[test]
    fn any_text_keeps_what_it_says(text in token_soup()) {
        check_properties(&text)?;
    }

    #[test]
    fn programs_keep_what_they_say(text in program()) {
        check_properties(&text)?;
        check_looks(&text, &format(&text))?;
    }

    /// Whatever edits a person picks, the meaning is the same.
    #[test]
    fn each_edit_keeps_the_meaning(text in program(), choice in any::<u64>()) {
        let pieces = parse(&text);
        let edits = format_edits(&text, pieces.iter().map(|(span, parse)| (*span, parse)));
        let mut changed = text.clone();
        for (index, edit) in edits.iter().enumerate().rev() {
            if choice >> (index % 64) & 1 == 1 {
                changed.replace_range(std::ops::Range::from(edit.span), &edit.text);
            }
        }
        prop_assert_eq!(meaning(&changed), meaning(&text));
    }
}

fn token_soup() -> impl Strategy<Value = String> {
    let word = prop_oneof![
        6 => proptest::sample::select(KEYWORDS.map(|(_, word)| word).to_vec()).prop_map(str::to_owned),
        4 => proptest::sample::select(vec![
            "{", "}", ",", ":", "/*", "*/", "//", "\"", "\n", "\r", "\r\n", "\n\n", "^", "-", ".", "a", "b1", "4.5",
            "90", "1.2.3.4", "é", "🤖", "\u{feff}",
        ])
        .prop_map(str::to_owned),
        2 => proptest::sample::select(vec![
            "wheel a with radius 3", "sensor s", "ip i 1.2.3.4", "movement m of r { slam }", "import \"a\"",
        ])
        .prop_map(str::to_owned),
        1 => ".{0,4}",
    ];
    proptest::collection::vec(word, 0..40).prop_map(|words| words.join(" "))
}

/// Entities, most of them without mistakes, with any white space and comments between any two tokens.
fn program() -> impl Strategy<Value = String> {
    let pieces = proptest::collection::vec((entity(), 0..12_usize, any::<prop::sample::Index>()), 0..6);
    let tokens = pieces.prop_map(|entities| {
        let mut tokens = Vec::new();
        for (mut entity, spoil, at) in entities {
            if spoil == 0 {
                entity.remove(at.index(entity.len()));
            }
            tokens.extend(entity);
        }
        tokens
    });
    let spaced = tokens.prop_flat_map(|tokens| {
        let count = tokens.len() + 1;
        (Just(tokens), proptest::collection::vec(trivia(), count))
    });
    (spaced, proptest::sample::select(vec!["\n", "\r\n", "\r"])).prop_map(
        |((tokens, trivia), line_ending)| {
            let mut text = trivia[0].clone();
            for (token, trivia) in tokens.iter().zip(&trivia[1..]) {
                text += token;
                text += trivia;
            }
            text.replace('\n', line_ending)
        },
    )
}

fn trivia() -> impl Strategy<Value = String> {
    let comment = proptest::sample::select(vec![
        " /* a */ ",
        "/* b */\n",
        "\n/* c */\n",
        "\n/* d */ ",
        " // e  \n",
        "\n // f\n",
        "\n\n// g\n\n",
        "\n/** h\n   * i\n\t*/\n",
        " /* j\n k */ ",
        "\n/* l */ /* m */\n",
        " /* n */ // o\n",
    ]);
    let space = proptest::sample::select(vec!["\n", "\n\n", "\n \n\n  ", "\t", "  "]);
    prop_oneof![
        12 => Just(" ".to_owned()),
        3 => space.prop_map(str::to_owned),
        1 => proptest::collection::vec(comment, 1..3).prop_map(|comments| comments.concat()),
    ]
}

fn name() -> impl Strategy<Value = String> {
    let names = vec!["a", "wheelL", "^robots", "import", "bumper", "a_name_of_thirty_characters_or_so"];
    proptest::sample::select(names).prop_map(str::to_owned)
}

fn names(least: usize) -> impl Strategy<Value = Vec<String>> {
    proptest::collection::vec((name(), any::<bool>()), least..5).prop_map(|names| {
        let mut list = vec!["{".to_owned()];
        for (name, comma) in names {
            list.push(name);
            if comma {
                list.push(",".to_owned());
            }
        }
        list.push("}".to_owned());
        list
    })
}

fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

fn entity() -> impl Strategy<Value = Vec<String>> {
    let simple = proptest::sample::select(vec![
        "wheel a with radius 4.50",
        "wheelH b with radius 4",
        "sensor s",
        "sensor t : bumper",
        "ip i 1.2.3.4",
        "import \"parts/a.pyr\"",
    ]);
    let heads = vec![
        "robot type tw r with port 1 has",
        "robot ^r with port 23000 has",
        "robot r type fwh with port 7 has",
    ];
    let robot = (proptest::sample::select(heads), names(0), prop::option::of(names(1)));
    let robot = robot.prop_map(|(head, wheels, sensors)| {
        let sensors = sensors.map(|sensors| [words("with sensors"), sensors].concat());
        [words(head), wheels, words("wheels"), sensors.unwrap_or_default()].concat()
    });
    let heads = vec!["environment e has", "environment e , i has", "environment e with ip i has"];
    let environment = (proptest::sample::select(heads), names(0), prop::option::of(names(0)));
    let environment = environment.prop_map(|(head, robots, moves)| {
        let moves = moves.map(|moves| [words("with"), moves, words("moves")].concat());
        [words(head), robots, words("robots"), moves.unwrap_or_default()].concat()
    });
    prop_oneof![
        3 => simple.prop_map(words),
        1 => robot,
        1 => movement(),
        1 => environment,
    ]
}

fn movement() -> impl Strategy<Value = Vec<String>> {
    let simple = proptest::sample::select(vec![
        "move -4.0 meters",
        "move 4 centimeters at 9",
        "turn left",
        "turn right 30",
        "slam",
    ]);
    let ends = proptest::sample::select(vec!["clear", "detect within 40 centimeters"]);
    let condition = (names(1), ends).prop_map(|(sensors, end)| [sensors, words(end)].concat()).boxed();
    let until =
        proptest::sample::select(vec!["move until", "wait 2 seconds until", "turn left in reverse until"]);
    let action = prop_oneof![
        3 => simple.prop_map(words),
        1 => names(1).prop_map(|sensors| [words("turn left until"), sensors].concat()),
        1 => (until, condition.clone()).prop_map(|(until, condition)| [words(until), condition].concat()),
        1 => name().prop_map(|name| vec!["do".to_owned(), name]),
    ];
    let action = action.prop_recursive(3, 16, 4, move |inner| with_blocks(&condition, &inner));
    (any::<bool>(), proptest::collection::vec(action, 0..4)).prop_map(|(parallel, actions)| {
        let head = if parallel { "parallel movement m of r {" } else { "movement m of r {" };
        [words(head), actions.concat(), words("}")].concat()
    })
}

/// A `repeat` or an `if` around other actions.
fn with_blocks(
    condition: &BoxedStrategy<Vec<String>>,
    inner: &BoxedStrategy<Vec<String>>,
) -> impl Strategy<Value = Vec<String>> + use<> {
    let block = proptest::collection::vec(inner.clone(), 0..3)
        .prop_map(|actions| [words("{"), actions.concat(), words("}")].concat());
    let branch = (condition.clone(), block.clone())
        .prop_map(|(condition, block)| [words("if"), condition, block].concat());
    let times = block.clone().prop_map(|block| [words("repeat 4 times"), block].concat());
    let more = proptest::collection::vec(branch.clone(), 0..2);
    let choice = (branch, more, prop::option::of(block)).prop_map(|(first, more, last)| {
        let more = more.into_iter().map(|branch| [words("else"), branch].concat());
        let last = last.map(|block| [words("else"), block].concat());
        [first, more.collect::<Vec<_>>().concat(), last.unwrap_or_default()].concat()
    });
    prop_oneof![times, choice]
}
