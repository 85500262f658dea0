//! Refactorings: equivalent ways to write the selected code, such as equal actions as a `repeat` and back, a movement in the place
//! of its `do`, or an `if` with the opposite condition; and changes of unit, speed, schedule or path, which their titles name.

mod actions;
mod circle;
mod drive_type;
mod extract;
mod inline;
mod invert;
mod meaning;
mod parallel;
mod rewriting;
mod roll_up;
mod rows;
mod speed;
mod units;
mod unroll;

#[cfg(test)]
mod testing;

use pydslrep_analysis::{Database, Edit, Edition, EntityRef, FileId};
use pydslrep_syntax::Span;

/// The kind of a refactoring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RefactoringKind {
    /// Moves code into a new declaration.
    Extract,
    /// Removes redundant code.
    Inline,
    /// Rewrites code.
    Rewrite,
}

/// An offered change.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refactoring {
    /// Its title, as an imperative.
    pub title: String,
    /// Its kind.
    pub kind: RefactoringKind,
    /// The edits, without overlaps; or why it is not available here.
    pub edits: Result<Vec<Edit>, String>,
}

impl Refactoring {
    fn new(title: impl Into<String>, kind: RefactoringKind, edits: Vec<Edit>) -> Self {
        Self { title: title.into(), kind, edits: Ok(edits) }
    }

    /// One that rewrites code in one place.
    fn rewrite(title: impl Into<String>, edit: Edit) -> Self {
        Self::new(title, RefactoringKind::Rewrite, vec![edit])
    }

    fn no_rewrite(title: impl Into<String>, reason: impl Into<String>) -> Self {
        Self::unavailable(title, RefactoringKind::Rewrite, reason)
    }

    fn unavailable(title: impl Into<String>, kind: RefactoringKind, reason: impl Into<String>) -> Self {
        Self { title: title.into(), kind, edits: Err(reason.into()) }
    }
}

/// The refactorings for a selection; a cursor is an empty one.
pub fn refactorings(database: &Database, file: FileId, range: Span) -> Vec<Refactoring> {
    let mut found = Vec::new();
    if let Some(selection) = Selection::find(database, file, range) {
        found.extend(units::convert(&selection));
        found.extend(speed::refactorings(&selection));
        found.extend(unroll::unroll(&selection));
        found.extend(inline::inline(&selection));
        found.extend(circle::in_place(&selection));
        if database.edition(file) != Edition::Article {
            found.extend(extending(&selection));
        }
        found.extend(parallel::change(&selection));
        found.extend(drive_type::add(&selection));
    }
    found
}

/// Refactorings that write forms which the article does not have.
fn extending(selection: &Selection<'_>) -> impl Iterator<Item = Refactoring> {
    let offers = [
        extract::extract(selection),
        roll_up::roll_up(selection),
        invert::invert(selection),
        circle::on_circle(selection),
    ];
    offers.into_iter().flatten()
}

/// The selected entity, which has no syntax errors, and the selection within it.
#[derive(Clone, Copy)]
struct Selection<'a> {
    database: &'a Database,
    file: FileId,
    entity: EntityRef<'a>,
    /// The selection, relative to the start of the entity.
    range: Span,
}

impl<'a> Selection<'a> {
    fn find(database: &'a Database, file: FileId, range: Span) -> Option<Self> {
        let before = range.start.checked_sub(1).and_then(|offset| database.entity_at(file, offset));
        let at = database.entity_at(file, range.start);
        let touched = |entity: &EntityRef<'a>| {
            let body = crate::cursor::body(entity);
            body.start <= range.end && range.start <= body.end
        };
        let entity = at.into_iter().chain(before).find(touched)?;
        let from = |offset: u32| offset.clamp(entity.span.start, entity.span.end) - entity.span.start;
        let range = Span::new(from(range.start), from(range.end));
        entity.parse.errors.is_empty().then_some(Self { database, file, entity, range })
    }

    /// Returns whether a range in the entity touches the selection.
    fn touches(&self, span: Span) -> bool {
        span.start <= self.range.end && self.range.start <= span.end
    }

    /// The text of a range of the entity.
    fn text(&self, span: Span) -> String {
        self.database.slice(self.file, span.shifted(self.entity.span.start))
    }

    /// The text between the braces of a block.
    fn inner_text(&self, block: Span) -> String {
        self.text(Span::new(block.start + 1, block.end.saturating_sub(1)))
    }

    /// An edit within the entity.
    fn edit(&self, span: Span, text: impl Into<String>) -> Edit {
        Edit { file: self.file, span: span.shifted(self.entity.span.start), text: text.into() }
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use super::testing::check_titles_of_article;

    #[test]
    fn nothing_writes_what_the_article_does_not_have() {
        check_titles_of_article("  $0turn left\n  turn left$0\n  slam", &expect![[""]]);
        check_titles_of_article(
            "  turn left\n  $0turn left\n  move 1 meters",
            &expect![[r#"
            Rewrite: convert all lengths of `tour` to centimeters
            Rewrite: make the default speed explicit in all moves of `tour`
        "#]],
        );
        check_titles_of_article("  $0if { front } clear { slam } else { turn left }", &expect![[""]]);
        check_titles_of_article(
            "  $0repeat 2 times { turn left }",
            &expect![[r#"
            Rewrite: unroll `repeat 2 times`
        "#]],
        );
        check_titles_of_article(
            "  $0turn left with radius 1 meters",
            &expect![[r#"
            Rewrite: convert to centimeters
            Rewrite: turn in place (changes the path)
        "#]],
        );
    }
}
