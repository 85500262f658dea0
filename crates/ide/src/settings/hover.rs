//! Hover in a settings file: what the setting under the cursor does.

use pydslrep_schema::names;

use super::{documentation, meaning};
use crate::Hover;

/// What there is to say of an offset in the text of a settings file.
pub fn settings_hover(text: &str, offset: u32) -> Option<Hover> {
    let named = names(text).into_iter().find(|named| named.span.touches(offset))?;
    Some(Hover { span: named.span, markdown: documentation(&meaning(&named.name)?) })
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;
    use crate::settings::at_cursor;

    fn check(fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let told = settings_hover(&text, offset)
            .map(|hover| format!("{}\n---\n{}", hover.span.text(&text), hover.markdown));
        expected.assert_eq(told.as_deref().unwrap_or("nothing"));
    }

    #[test]
    fn of_keys_tables_and_codes() {
        check(
            "tar$0get = 'v",
            &expect![[r#"
            target
            ---
            **`target`**: `"coppeliasim"` or `"vrep"`

            The simulator that scripts are for.

            * `"coppeliasim"`: CoppeliaSim 4.6 or later, by its ZeroMQ remote API
            * `"vrep"`: V-REP 3, by its legacy remote API: each robot has a port of its own

            Default: `"coppeliasim"`
        "#]],
        );
        check(
            "default-speed$0",
            &expect![[r#"
            default-speed
            ---
            **`default-speed`**: a number above zero

            The speed in snippets that an editor inserts, in centimetres per second.

            Default: `9.0`
        "#]],
        );
        check(
            "[inlay-hints]\n$0pose = true",
            &expect![[r#"
                pose
                ---
                **`inlay-hints.pose`**: `true` or `false`

                Whether an editor shows the pose after each action, counted from where its movement starts: x and y in metres, and the heading.

                Default: `true`
            "#]],
        );
        check(
            "[inlay$0-hints]",
            &expect![[r#"
                inlay-hints
                ---
                * `inlay-hints.pose`: Whether an editor shows the pose after each action, counted from where its movement starts: x and y in metres, and the heading.
                * `inlay-hints.duration`: Whether an editor shows how long each action takes.
                * `inlay-hints.defaults`: Whether an editor shows speeds and angles that are left out.
            "#]],
        );
        check(
            "[severity$0]",
            &expect![[r#"
            severity
            ---
            **`severity`**: a table: `CODE = "LEVEL"`

            How bad problems of a code are to you: `"off"`, `"hint"`, `"information"`, `"warning"` or `"error"`. This is about what is shown and the exit code of `pydslrep check`; what keeps a script from being made does so at any level.
        "#]],
        );
        check(
            "severity = { wheel-c$0ount = ",
            &expect![[r#"
            wheel-count
            ---
            **`wheel-count`**: `"off"`, `"hint"`, `"information"`, `"warning"`, `"error"`

            a robot does not have the 2 wheels of a `tw`, or the 4 of an `fw` or `fwh`

            Default: `"error"`
        "#]],
        );
    }

    #[test]
    fn of_nothing_else() {
        for fixture in ["$0", "tarjet$0 = 1", "target = $0'vrep'", "# tar$0get", "[severity]\nx$0 = 1"] {
            check(fixture, &expect!["nothing"]);
        }
    }
}
