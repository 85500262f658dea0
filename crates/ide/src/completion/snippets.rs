//! Patterns to fill in: whole entities and whole actions.

/// A pattern to fill in.
pub(super) struct Snippet {
    pub(super) label: &'static str,
    pub(super) detail: &'static str,
    pub(super) insert: &'static str,
}

/// Whole entities.
pub(super) const ENTITIES: &[Snippet] = &[
    Snippet { label: "wheel …", detail: "a whole wheel", insert: "wheel ${1:wheelL} with radius ${2:4.5}" },
    Snippet {
        label: "wheelH …",
        detail: "a whole mecanum wheel",
        insert: "wheelH ${1:wheelLF} with radius ${2:4.5}",
    },
    Snippet { label: "sensor …", detail: "a whole sensor", insert: "sensor ${1:front}" },
    Snippet { label: "ip …", detail: "a whole address", insert: "ip ${1:lab} ${2:127.0.0.1}" },
    Snippet {
        label: "robot …",
        detail: "a whole robot",
        insert: "robot ${1:rover} type ${2:tw} with port ${3:19999} has { ${4:wheelL wheelR} } wheels",
    },
    Snippet {
        label: "movement …",
        detail: "a whole movement",
        insert: "movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}",
    },
    Snippet {
        label: "parallel movement …",
        detail: "a movement that runs beside others",
        insert: "parallel movement ${1:patrol} of ${2:rover} {\n  move ${3:1.0} meters\n  $0\n}",
    },
    Snippet {
        label: "environment …",
        detail: "a whole environment",
        insert: "environment ${1:area} has { ${2:rover} } robots with { ${3:patrol} } moves",
    },
];

/// Whole actions.
pub(super) const ACTIONS: &[Snippet] = &[
    Snippet { label: "move … meters", detail: "straight ahead", insert: "move ${1:1.0} meters" },
    Snippet {
        label: "move … centimeters at …",
        detail: "straight ahead, with a speed",
        insert: "move ${1:50} centimeters at ${2:SPEED}",
    },
    Snippet { label: "turn left", detail: "in place", insert: "turn left ${1:90}" },
    Snippet { label: "turn right", detail: "in place", insert: "turn right ${1:90}" },
    Snippet {
        label: "turn … until",
        detail: "until the way is free",
        insert: "turn ${1:right} until { $0 }",
    },
];

/// Behind a move.
pub(super) const SPEEDS: &[Snippet] =
    &[Snippet { label: "at …", detail: "a speed in centimetres per second", insert: "at ${1:SPEED}" }];

impl Snippet {
    /// What is inserted, with a speed in centimetres per second where there is one.
    pub(super) fn filled_in(&self, speed: f64) -> String {
        self.insert.replace("SPEED", &format!("{speed:?}"))
    }
}

/// A snippet as plain text: `${1:name}` becomes `name`, `$0` nothing.
pub(super) fn without_stops(snippet: &str) -> String {
    let mut plain = String::with_capacity(snippet.len());
    let mut depth = 0_u32;
    let mut characters = snippet.chars().peekable();
    while let Some(character) = characters.next() {
        match character {
            '\\' => plain.extend(characters.next()),
            '$' => {
                let braced = characters.next_if_eq(&'{').is_some();
                while characters.next_if(char::is_ascii_digit).is_some() {}
                if braced {
                    characters.next_if_eq(&':');
                    depth += 1;
                }
            }
            '}' if depth > 0 => depth -= 1,
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_leave_their_text() {
        assert_eq!(without_stops("a ${1:b} {\n  $0\n}"), "a b {\n  \n}");
        assert_eq!(without_stops("{ $1 } ${2:a ${3:b}} \\$ \\}"), "{  } a b $ }");
    }

    #[test]
    fn every_pattern_is_a_program_once_it_is_filled_in() {
        let in_movement = |text: String| format!("movement m of r {{ {text} }}");
        let entities = ENTITIES.iter().map(|snippet| without_stops(snippet.insert));
        // A list must not be empty, and `until`'s is for the person to fill in.
        let actions = ACTIONS
            .iter()
            .map(|snippet| in_movement(without_stops(&snippet.filled_in(20.0)).replace("{  }", "{ s }")));
        for text in entities.chain(actions) {
            for (_, parse) in pydslrep_syntax::parse(&text) {
                assert_eq!(parse.errors, [], "{text}");
            }
        }
    }
}
