//! Quick fixes in a TOML file.

use pydslrep_schema::{Problem, Span};

use super::TomlFile;

/// A fix with its problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyFix {
    /// What it fixes.
    pub problem: Problem,
    /// What it does, in words.
    pub title: String,
    /// What it replaces.
    pub span: Span,
    /// With what.
    pub text: String,
}

/// The fixes of all problems that touch a range.
pub fn toml_fixes(file: TomlFile<'_>, text: &str, range: Span) -> Vec<KeyFix> {
    let fix = |problem: Problem| {
        let span = problem.span.filter(|span| span.start <= range.end && range.start <= span.end)?;
        let text = problem.replacement.clone()?;
        let title = format!("change to `{}`", text.trim_matches('"'));
        Some(KeyFix { problem, title, span, text })
    };
    file.problems(text).into_iter().filter_map(fix).collect()
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use pydslrep_analysis::Database;

    use super::super::tests::{at_cursor, program};
    use super::*;

    /// What is wrong, the titles of the fixes at the cursor, and the text after each, which has fewer problems.
    fn fixes(file: TomlFile<'_>, fixture: &str, expected: &Expect) {
        let (text, offset) = at_cursor(fixture);
        let before = file.problems(&text);
        let lines = before.iter().map(|problem| format!("{}\n", problem.message));
        let mut out: String = lines.collect();
        for fix in toml_fixes(file, &text, Span::at(offset)) {
            let mut fixed = text.clone();
            fixed.replace_range(std::ops::Range::from(fix.span), &fix.text);
            assert!(file.problems(&fixed).len() < before.len(), "{fixed}");
            out += &format!("{}\n{fixed}\n", fix.title);
        }
        expected.assert_eq(&out);
    }

    fn check(fixture: &str, expected: &Expect) {
        fixes(TomlFile::Settings, fixture, expected);
    }

    #[test]
    fn of_settings() {
        check(
            "[sevrity$0]\nwheel-count = \"off\"",
            &expect![[r#"
                there is no setting `sevrity`
                change to `severity`
                [severity]
                wheel-count = "off"
            "#]],
        );
        check(
            "target = \"v-rep$0\"",
            &expect![[r#"
                `target` cannot be `v-rep`
                change to `vrep`
                target = "vrep"
            "#]],
        );
        check(
            "generateonsave$0 = true\ntarget = \"x\"",
            &expect![[r#"
                there is no setting `generateonsave`
                `target` cannot be `x`
                change to `generate-on-save`
                generate-on-save = true
                target = "x"
            "#]],
        );
        check(
            "[severity]\nwheel-counts$0 = \"off\"",
            &expect![[r#"
                there is no diagnostic `wheel-counts`
                change to `wheel-count`
                [severity]
                wheel-count = "off"
            "#]],
        );
        check(
            "[severity]\nwheel-count = \"warn$0\"",
            &expect![[r#"
                `severity.wheel-count` cannot be `warn`
                change to `warning`
                [severity]
                wheel-count = "warning"
            "#]],
        );
        check(
            "targett = \"vrep\"\noutput = $0\"a\"",
            &expect![[r#"
            there is no setting `targett`
        "#]],
        );
    }

    #[test]
    fn of_scenes() {
        let (database, environment) = program();
        let scene = TomlFile::Scene(&database, environment);
        fixes(
            scene,
            "[wrold$0]\nseed = 2",
            &expect![[r#"
                there is no key `wrold`
                change to `world`
                [world]
                seed = 2
            "#]],
        );
        fixes(
            scene,
            "[robots.rovr$0]\nstart = [1, 2]",
            &expect![[r#"
            the environment has no robot `rovr`
            change to `rover`
            [robots.rover]
            start = [1, 2]
        "#]],
        );
        fixes(
            scene,
            "[robots.rover.sensors.frnt$0]\nrange = 2",
            &expect![[r#"
            robot `rover` has no sensor `frnt`
            change to `front`
            [robots.rover.sensors.front]
            range = 2
        "#]],
        );
        fixes(
            scene,
            "[[cylinder]]\nat = [1, 1]\nradus$0 = 0.1",
            &expect![[r#"
                `radius` is missing in this `cylinder`
                there is no key `cylinder.radus`
                change to `radius`
                [[cylinder]]
                at = [1, 1]
                radius = 0.1
            "#]],
        );
        fixes(
            scene,
            "[robots.\"größee$0\"]\nstart = [1, 2]",
            &expect![[r#"
            the environment has no robot `größee`
            change to `größe`
            [robots."größe"]
            start = [1, 2]
        "#]],
        );
        fixes(
            scene,
            "[world]\nsize = [1, 1]$0\nseed = -2",
            &expect![[r#"
            `world.seed` must be a whole number from 0
        "#]],
        );
    }

    #[test]
    fn without_a_program_any_name_is_allowed() {
        let database = Database::new();
        let text = "[robots.rovr]\nstart = 2\n[robots.rovr.sensors.x]\nrnge = 1\n[wrold]";
        let found: Vec<String> =
            database.scene_problems(None, text).into_iter().map(|problem| problem.message).collect();
        expect![[r#"
            `robots.rovr.start` must be a pose `[x, y, heading]`, not a number
            there is no key `robots.rovr.sensors.x.rnge`
            there is no key `wrold`"#]]
        .assert_eq(&found.join("\n"));
    }
}
