//! Folding: collapses entities, blocks, comments, regions and imports.
//!
//! A region reaches from `// #region` (or `// region`) to its `// endregion`, with or without `#`; regions nest.

use pydslrep_analysis::Snapshot;
use pydslrep_syntax::ast::{Action, Entity, Movement};
use pydslrep_syntax::{Span, TokenKind, offset};

use crate::cursor::body;

/// A range that folds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fold {
    /// The hidden text; it spans several lines.
    pub span: Span,
    /// Its kind.
    pub kind: FoldKind,
    /// True if other text follows on its last line, so that editors which fold whole lines must keep that line.
    pub keeps_last_line: bool,
}

/// The kind of a fold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FoldKind {
    /// A declaration, or the body of a movement.
    Entity,
    /// A comment, or consecutive line comments.
    Comment,
    /// From `region` to `endregion`.
    Region,
    /// The imports at the top of the file.
    Imports,
}

/// The folds of a file in text order, collected in one pass over its tokens.
pub fn folding_ranges(snapshot: &Snapshot) -> Vec<Fold> {
    let text = snapshot.text().to_string();
    let mut folds = Folds::new(&text);
    for entity in snapshot.entities() {
        let start = entity.span.start;
        for (token, span) in &entity.parse.tokens {
            folds.token(*token, span.shifted(start));
        }
        match &entity.parse.entity {
            Some(Entity::Import(_)) => folds.import(body(&entity)),
            Some(Entity::Movement(movement @ Movement { body: Some(braces), .. })) => {
                folds.entity(folds.inside(braces.shifted(start)));
                for block in movement.all_actions().flat_map(Action::blocks) {
                    folds.entity(folds.inside(block.span.shifted(start)));
                }
            }
            Some(_) => folds.entity(folds.after_first_line(body(&entity))),
            None => {}
        }
    }
    folds.finish()
}

struct Folds<'a> {
    text: &'a str,
    found: Vec<Fold>,
    /// The end of the last token.
    last_end: u32,
    /// Consecutive line comments, each alone on its line.
    run: Option<Span>,
    /// The starts of open regions.
    regions: Vec<u32>,
    imports: Option<Span>,
}

impl<'a> Folds<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, found: Vec::new(), last_end: 0, run: None, regions: Vec::new(), imports: None }
    }

    fn token(&mut self, token: TokenKind, span: Span) {
        if token == TokenKind::LineComment {
            self.line_comment(span);
        } else {
            self.end_run();
            if token.is_comment() {
                self.push(span, FoldKind::Comment);
            }
        }
        self.last_end = span.end;
    }

    fn line_comment(&mut self, span: Span) {
        let lines = line_ends(Span::new(self.last_end, span.start).text(self.text));
        let marker = region_marker(span.text(self.text));
        if marker.is_some() || lines != 1 {
            self.end_run();
        }
        match marker {
            Some(RegionMarker::Begin) => self.regions.push(span.start),
            Some(RegionMarker::End) => {
                if let Some(start) = self.regions.pop() {
                    self.push(Span::new(start, span.end), FoldKind::Region);
                }
            }
            // A comment after other text on its line belongs to that line.
            None if lines > 0 || self.last_end == 0 => {
                self.run = Some(self.run.map_or(span, |run| run.to(span)));
            }
            None => {}
        }
    }

    fn end_run(&mut self) {
        if let Some(run) = self.run.take() {
            self.push(run, FoldKind::Comment);
        }
    }

    fn import(&mut self, span: Span) {
        self.imports = Some(self.imports.map_or(span, |imports| imports.to(span)));
    }

    fn entity(&mut self, span: Span) {
        self.end_imports();
        self.push(span, FoldKind::Entity);
    }

    fn end_imports(&mut self) {
        if let Some(imports) = self.imports.take() {
            self.push(imports, FoldKind::Imports);
        }
    }

    /// Ranges on a single line do not fold.
    fn push(&mut self, span: Span, kind: FoldKind) {
        if !span.text(self.text).contains(['\n', '\r']) {
            return;
        }
        let after = self.text.get(span.end as usize..).unwrap_or_default();
        let rest = after.split(['\n', '\r']).next().unwrap_or_default();
        self.found.push(Fold { span, kind, keeps_last_line: !rest.trim().is_empty() });
    }

    /// A span without its first line, which stays visible.
    fn after_first_line(&self, span: Span) -> Span {
        let first = span.text(self.text).find(['\n', '\r']);
        Span::new(span.start + first.map_or_else(|| span.len(), offset), span.end)
    }

    /// The text between braces; either or both may be missing.
    fn inside(&self, braces: Span) -> Span {
        if braces.is_empty() {
            return braces;
        }
        let closed = braces.len() > 1 && braces.text(self.text).ends_with('}');
        Span::new(braces.start + 1, braces.end - u32::from(closed))
    }

    fn finish(mut self) -> Vec<Fold> {
        self.end_run();
        self.end_imports();
        self.found.sort_by_key(|fold| (fold.span.start, std::cmp::Reverse(fold.span.end)));
        self.found
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RegionMarker {
    Begin,
    End,
}

/// The region marker in a line comment, if any.
fn region_marker(comment: &str) -> Option<RegionMarker> {
    let words = comment.trim_start_matches('/').trim_start();
    let word = words.strip_prefix('#').unwrap_or(words).split_whitespace().next()?;
    match word {
        "region" => Some(RegionMarker::Begin),
        "endregion" => Some(RegionMarker::End),
        _ => None,
    }
}

/// The number of line breaks in `blank`.
fn line_ends(blank: &str) -> usize {
    let bytes = blank.as_bytes();
    let ends = |at: usize| match bytes[at] {
        b'\n' => true,
        b'\r' => bytes.get(at + 1) != Some(&b'\n'),
        _ => false,
    };
    (0..bytes.len()).filter(|at| ends(*at)).count()
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};

    use super::*;

    fn check(text: &str, expected: &Expect) {
        let mut database = pydslrep_analysis::Database::new();
        let file = database.open("a.pyr", text);
        let render = |fold: &Fold| {
            let keeps = if fold.keeps_last_line { ", last line stays" } else { "" };
            format!("{:?}{keeps}: {:?}\n", fold.kind, fold.span.text(text))
        };
        expected.assert_eq(
            &folding_ranges(&database.snapshot(file, None).unwrap()).iter().map(render).collect::<String>(),
        );
    }

    #[test]
    fn entities_fold_if_they_span_several_lines() {
        check(
            "wheel a with radius 3\nmovement m of r {\n  slam\n}\n// c\nrobot r with port 1 has {\n  a\n  b\n} wheels\nmovement n of r { slam }",
            &expect![[r#"
                Entity, last line stays: "\n  slam\n"
                Entity: "\n  a\n  b\n} wheels"
            "#]],
        );
    }

    #[test]
    fn entities_with_errors_fold() {
        check(
            "movement m of r {\n  slam\n\nwheel a with\nradius",
            &expect![[r#"
                Entity: "\n  slam"
                Entity: "\nradius"
            "#]],
        );
    }

    #[test]
    fn a_movement_without_a_body_does_not_fold() {
        for text in ["movement", "movement m of r", "movement {", "movement }\n"] {
            check(text, &expect![""]);
        }
    }

    #[test]
    fn comments_fold_with_their_neighbours() {
        check(
            "// a\r\n// b\r\n\r\n// c\r\n// d\r\nwheel a // e\r\n// f\r\n/* g\r\nh */ sensor s\r\n// i\r// j",
            &expect![[r#"
                Comment: "// a\r\n// b"
                Comment: "// c\r\n// d"
                Comment, last line stays: "/* g\r\nh */"
                Comment: "// i\r// j"
            "#]],
        );
    }

    #[test]
    fn regions_nest_and_unmatched_marks_are_ignored() {
        check(
            "// endregion\n// #region parts\nwheel a with radius 3\n//region\nsensor s\n// endregion\n// #endregion x\n// #region open\n// c\n// d\n",
            &expect![[r##"
                Region: "// #region parts\nwheel a with radius 3\n//region\nsensor s\n// endregion\n// #endregion x"
                Region: "//region\nsensor s\n// endregion"
                Comment: "// c\n// d"
            "##]],
        );
    }

    #[test]
    fn imports_fold_together() {
        check(
            "import \"a.pyr\"\n// why\nimport \"b.pyr\"\n\nwheel a with radius 3",
            &expect![[r#"
                Imports: "import \"a.pyr\"\n// why\nimport \"b.pyr\""
            "#]],
        );
    }

    #[test]
    fn blocks_fold() {
        check(
            "movement m of r {\n  repeat 2 times {\n    if { a } clear {\n      slam\n    } else {\n      do n\n    }\n    wait 2 seconds\n  }\n  repeat 2 times { slam }\n}",
            &expect![[r#"
                Entity, last line stays: "\n  repeat 2 times {\n    if { a } clear {\n      slam\n    } else {\n      do n\n    }\n    wait 2 seconds\n  }\n  repeat 2 times { slam }\n"
                Entity, last line stays: "\n    if { a } clear {\n      slam\n    } else {\n      do n\n    }\n    wait 2 seconds\n  "
                Entity, last line stays: "\n      slam\n    "
                Entity, last line stays: "\n      do n\n    "
            "#]],
        );
    }
}
