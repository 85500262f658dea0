//! Roll up equal actions in a row, or groups of them, into `repeat`.

use std::cell::OnceCell;
use std::ops::Range;

use pydslrep_analysis::{COUNTS, Edit};
use pydslrep_syntax::Span;
use pydslrep_syntax::ast::Action;

use super::meaning::meaning;
use super::rows::Row;
use super::{Refactoring, Selection};

/// The longest group that is looked for, in actions.
const MAX_GROUP: usize = 100;

/// The refactoring for the longest run of equal groups among the selected actions, or around the cursor: in the innermost
/// block that has one.
pub(super) fn roll_up(selection: &Selection<'_>) -> Option<Refactoring> {
    let mut rows = selection.rows().into_iter().rev();
    let (row, run) = rows.find_map(|row| Some((row, longest_run(&row)?)))?;
    let edit = row.rolled_up(&run)?;
    let title = format!("roll up into `repeat {} times`", run.count);
    Some(Refactoring::rewrite(title, edit))
}

/// Groups of actions that do the same, one after the other.
struct Run {
    first: usize,
    /// The number of actions in a group.
    period: usize,
    /// The number of groups.
    count: usize,
}

impl Run {
    fn len(&self) -> usize {
        self.period * self.count
    }
}

fn longest_run(row: &Row<'_>) -> Option<Run> {
    let touched = row.touched();
    let first = row.actions.partition_point(|action| action.span.end < row.selection.range.start);
    let is_selection = touched.len() > 1 && !row.selection.range.is_empty();
    let run = if is_selection {
        Search::new(row, first..first + touched.len()).longest(None)?
    } else {
        touched.first()?;
        Search::new(row, 0..row.actions.len()).longest(Some(first))?
    };
    row.has_room(&row.actions[run.first..run.first + run.len()], 1).then_some(run)
}

/// The search for the longest run in a part of a row.
struct Search<'a> {
    selection: Selection<'a>,
    actions: &'a [Action],
    part: Range<usize>,
    /// The meaning of each action, computed on demand.
    meanings: Vec<OnceCell<Option<String>>>,
}

impl<'a> Search<'a> {
    fn new(row: &Row<'a>, part: Range<usize>) -> Self {
        let meanings = (0..row.actions.len()).map(|_| OnceCell::new()).collect();
        Self { selection: row.selection, actions: row.actions, part, meanings }
    }

    /// The longest run, of those with the smallest groups the first; with an action, only runs that include it.
    fn longest(&self, around: Option<usize>) -> Option<Run> {
        let mut longest: Option<Run> = None;
        for period in 1..=MAX_GROUP.min(self.part.len() / 2) {
            for equal in self.stretches(period, around) {
                let Some(run) = as_run(&equal, period, around) else { continue };
                if longest.as_ref().is_none_or(|longest| run.len() > longest.len()) {
                    longest = Some(run);
                }
            }
            if longest.as_ref().is_some_and(|longest| longest.len() == self.part.len()) {
                break;
            }
        }
        longest
    }

    /// The stretches of actions that each do the same as the one a period later.
    fn stretches(&self, period: usize, around: Option<usize>) -> Vec<Range<usize>> {
        let last = self.part.end - period;
        let is_equal = |index: usize| self.do_the_same(index, index + period);
        let (mut start, mut end) = (self.part.start, last);
        if let Some(action) = around {
            start = action.saturating_sub(period).max(start).min(last);
            while start > self.part.start && is_equal(start - 1) {
                start -= 1;
            }
            end = (action + 1).min(last);
            while end < last && is_equal(end) {
                end += 1;
            }
        }
        let equal: Vec<usize> = (start..end).filter(|index| is_equal(*index)).collect();
        equal.chunk_by(|a, b| a + 1 == *b).map(|run| run[0]..run[0] + run.len()).collect()
    }

    fn do_the_same(&self, a: usize, b: usize) -> bool {
        self.meaning(a).is_some() && self.meaning(a) == self.meaning(b)
    }

    fn meaning(&self, index: usize) -> Option<&str> {
        let of_action = || meaning(&self.selection, self.actions.get(index)?);
        self.meanings.get(index)?.get_or_init(of_action).as_deref()
    }
}

/// The run in a stretch of equal actions.
fn as_run(equal: &Range<usize>, period: usize, around: Option<usize>) -> Option<Run> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it is whole and small")]
    let max_count = *COUNTS.end() as usize;
    let count = (equal.len() / period + 1).min(max_count);
    let mut first = equal.start;
    if let Some(action) = around {
        if action < equal.start || equal.end + period <= action {
            return None;
        }
        first = first.max((action + 1).saturating_sub(period * count));
    }
    (count > 1).then_some(Run { first, period, count })
}

/// A comment and where it is in its group.
struct Remark {
    text: String,
    /// Which group it is in.
    round: usize,
    /// Which action of the group it belongs to.
    action: usize,
    /// True if it is before that action, not in or after it.
    before: bool,
}

/// The comments of a run, in the order of the text.
struct Remarks(Vec<Remark>);

impl Row<'_> {
    /// The edit that writes the first group into a block, with the comments of the others that it does not have.
    fn rolled_up(&self, run: &Run) -> Option<Edit> {
        let remarks = self.remarks(run);
        let inside = remarks.are_headed_alike();
        let own_start = self.actions.get(run.first)?.span.start;
        let start = if inside { self.bound(run.first) } else { own_start };
        let mut lines = Vec::new();
        for action in 0..run.period {
            let index = run.first + action;
            let from = if action == 0 { start } else { self.bound(index) };
            let own = self.selection.text(Span::new(from, self.bound(index + 1)));
            if action > 0 && begins_after_blank_line(&own) {
                lines.push(String::new());
            }
            lines.extend(remarks.new_at(action, true).map(str::to_owned));
            lines.push(own.trim().to_owned());
            remarks.new_at(action, false).for_each(|text| add_at_end(&mut lines, text));
        }
        let end = self.bound(run.first + run.len());
        let break_before = if inside { "\n" } else { "" };
        let text = format!("{break_before}repeat {} times {{\n{}\n}}", run.count, lines.join("\n"));
        self.selection.rewrite(&[(Span::new(start, end), text)])
    }

    fn remarks(&self, run: &Run) -> Remarks {
        let mut remarks = Vec::new();
        for offset in 0..run.len() {
            let (index, action) = (run.first + offset, offset % run.period);
            let Some(span) = self.actions.get(index).map(|action| action.span) else { continue };
            let cut = Span::new(self.bound(index), self.bound(index + 1));
            remarks.extend(self.selection.comments(cut).map(|comment| Remark {
                text: self.selection.text(comment),
                round: offset / run.period,
                action,
                before: comment.start < span.start,
            }));
        }
        Remarks(remarks)
    }
}

impl Remarks {
    /// Returns whether the comments above the first two groups are the same: then they are about the group. Otherwise
    /// those above the first are about all of them.
    fn are_headed_alike(&self) -> bool {
        let above = |round: usize| self.texts(move |remark| remark.round == round, 0, true);
        above(0).next().is_some() && above(0).eq(above(1))
    }

    /// Returns the comments at a place that later groups have and the first does not, each once.
    fn new_at(&self, action: usize, before: bool) -> impl Iterator<Item = &str> {
        let mut known: Vec<&str> = self.texts(|remark| remark.round == 0, action, before).collect();
        let later = self.texts(|remark| remark.round > 0, action, before);
        later.filter(move |text| {
            let is_new = !known.contains(text);
            known.push(text);
            is_new
        })
    }

    fn texts(
        &self,
        is_of: impl Fn(&Remark) -> bool,
        action: usize,
        before: bool,
    ) -> impl Iterator<Item = &str> {
        let there = self.0.iter().filter(move |remark| remark.action == action && remark.before == before);
        there.filter(move |remark| is_of(remark)).map(|remark| remark.text.as_str())
    }
}

fn begins_after_blank_line(text: &str) -> bool {
    let blank = &text[..text.len() - text.trim_start().len()];
    blank.replace("\r\n", "\n").matches(['\n', '\r']).count() > 1
}

/// Adds a comment to the last line, or as lines of its own if it has several.
fn add_at_end(lines: &mut Vec<String>, comment: &str) {
    match lines.last_mut().filter(|_| !comment.contains(['\n', '\r'])) {
        Some(last) => *last += &format!(" {comment}"),
        None => lines.push(comment.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use expect_test::expect;

    use crate::refactorings::testing::check_only;

    #[test]
    fn equal_actions_and_groups() {
        check_only(
            "roll",
            "  $0turn left\n  turn left 90\n  turn left at 9\n  move 1 meters",
            &expect![[r#"
                Rewrite: roll up into `repeat 3 times`
                    |   repeat 3 times {
                    |     turn left
                    |   }
            "#]],
        );
        check_only(
            "roll",
            "  move 1 meters\n  turn left\n  $0move 100 centimeters\n  turn left\n  move 1 meters\n  turn left\n  slam",
            &expect![[r#"
                Rewrite: roll up into `repeat 3 times`
                    |   repeat 3 times {
                    |     move 1 meters
                    |     turn left
                    |   }
            "#]],
        );
        check_only(
            "roll",
            "  turn right move 1 meters turn left $0move 1 meters turn left",
            &expect![[r#"
            Rewrite: roll up into `repeat 2 times`
                |   turn right
                |   repeat 2 times {
                |     move 1 meters
                |     turn left
                |   }
        "#]],
        );
    }

    #[test]
    fn the_longest_around_the_cursor_or_in_the_selection() {
        check_only(
            "roll",
            "  turn left\n  turn left\n  $0move 1 meters\n  turn left\n  turn left\n  move 1 meters",
            &expect![[r#"
                Rewrite: roll up into `repeat 2 times`
                    |   repeat 2 times {
                    |     turn left
                    |     turn left
                    |     move 1 meters
                    |   }
            "#]],
        );
        check_only(
            "roll",
            "  $0turn left\n  turn left$0\n  turn left\n  turn left",
            &expect![[r#"
            Rewrite: roll up into `repeat 2 times`
                |   repeat 2 times {
                |     turn left
                |   }
        "#]],
        );
        check_only("roll", "  turn left\n  turn left\n  $0move 1 meters\n  move 2 meters", &expect![[""]]);
    }

    #[test]
    fn inside_blocks_and_around_them() {
        check_only(
            "roll",
            "  repeat until { front } detect {\n    wait 1 seconds\n    $0wait 1.0 seconds\n  }",
            &expect![[r#"
                Rewrite: roll up into `repeat 2 times`
                    |     repeat 2 times {
                    |       wait 1 seconds
                    |     }
            "#]],
        );
        check_only(
            "roll",
            "  if { front } clear { $0slam }\n  if { front } clear { slam }\n  wait 1 seconds",
            &expect![[r#"
                Rewrite: roll up into `repeat 2 times`
                    |   repeat 2 times {
                    |     if { front } clear {
                    |       slam
                    |     }
                    |   }
            "#]],
        );
        check_only(
            "roll",
            "  move 1 meters until { front } detect within 1 meters\n  $0move 1 meters until { front, } detect within 100 centimeters",
            &expect![[r#"
                Rewrite: roll up into `repeat 2 times`
                    |   repeat 2 times {
                    |     move 1 meters until { front } detect within 1 meters
                    |   }
            "#]],
        );
    }

    #[test]
    fn comments_of_all_groups_stay() {
        check_only(
            "roll",
            "  // A square.\n  $0move 1 meters // north\n  turn left\n  move 1 meters // west\n  // To the south.\n  turn left\n  move 1 meters // north\n  turn left // home\n  // done",
            &expect![[r#"
                Rewrite: roll up into `repeat 3 times`
                    |   repeat 3 times {
                    |     move 1 meters // north // west
                    |     // To the south.
                    |     turn left // home
                    |   }
            "#]],
        );
        check_only(
            "roll",
            "  slam // first\n  // a side\n  $0move 1 meters\n  turn left\n\n  // a side\n  move 1 meters\n  turn left",
            &expect![[r#"
                Rewrite: roll up into `repeat 2 times`
                    |   repeat 2 times {
                    |     // a side
                    |     move 1 meters
                    |     turn left
                    |   }
            "#]],
        );
        check_only(
            "roll",
            "  $0turn left /* a\n  b */ turn left /* c\n  d */ turn left // e\n  slam",
            &expect![[r#"
                Rewrite: roll up into `repeat 3 times`
                    |   repeat 3 times {
                    |     turn left /* a
                    |   b */
                    |     /* c
                    |   d */ // e
                    |   }
            "#]],
        );
    }

    #[test]
    fn what_differs_is_not_rolled_up() {
        check_only(
            "roll",
            "  $0turn left\n  turn right\n  turn left 45\n  turn left at 10\n  turn left with radius 1 meters\n  turn left with radius 1 meters in reverse",
            &expect![[""]],
        );
        check_only(
            "roll",
            "  $0turn left until { front }\n  turn left until { front } clear\n  turn left until { front } detect",
            &expect![[""]],
        );
        check_only("roll", "  $0turn left\n  move 1 meters", &expect![[""]]);
    }

    #[test]
    fn not_deeper_than_blocks_may_be() {
        let nested = |count: usize, actions: &str| {
            format!("{}{actions}{}", "repeat 2 times { ".repeat(count), " }".repeat(count))
        };
        check_only("roll", &nested(16, "$0turn left turn left"), &expect![[""]]);
        let with_block = "$0turn left repeat 2 times { turn left } turn left repeat 2 times { turn left }";
        check_only("roll", &nested(15, with_block), &expect![[""]]);
        check_only(
            "roll",
            &nested(14, with_block),
            &expect![[r#"
                Rewrite: roll up into `repeat 2 times`
                    | repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times { repeat 2 times {
                    |                               repeat 2 times {
                    |                                 turn left
                    |                                 repeat 2 times {
                    |                                   turn left
                    |                                 }
                    |                               }
                    |                             } } } } } } } } } } } } } }
            "#]],
        );
    }
}
