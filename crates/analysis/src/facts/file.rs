//! One document: its text and the entities that tile it, and how an edit finds the few that it touches.

use std::ops::Range;

use pydslrep_syntax::{Earlier, LOOKAHEAD, Parse, Span, Token, cut, lex_again, parse_again, parse_cut};
use ropey::Rope;

use crate::entity::EntityId;
use crate::facts::slots::{EntitySlot, EntitySlots};

/// One document.
#[derive(Debug, Clone)]
pub(crate) struct File {
    pub(crate) path: String,
    pub(crate) text: Rope,
    pub(crate) slots: EntitySlots,
}

/// The slots an edit replaces, and what replaces them.
#[derive(Debug)]
pub(crate) struct Window {
    pub(crate) replaced: Range<usize>,
    /// The number of slots at the window's head and tail that the edit did not touch; they were read for what is around
    /// them, and may turn out as before.
    pub(crate) untouched: (usize, usize),
    /// The number of tokens that were lexed for all this.
    pub(crate) relexed: usize,
    pub(crate) parses: Vec<(Span, Parse)>,
}

/// Where to begin reading again after an edit.
struct ReadFrom<'a> {
    start: u32,
    /// How much longer the text is now.
    growth: i64,
    /// The entity that the edit is in.
    earlier: Option<Earlier<'a>>,
}

impl File {
    /// The line ending that the file uses.
    pub(crate) fn line_ending(&self) -> &'static str {
        let first = self.text.lines().next().map(|line| line.to_string()).unwrap_or_default();
        ["\r\n", "\r"].into_iter().find(|ending| first.ends_with(ending)).unwrap_or("\n")
    }

    /// Takes `after` as the text, in which only `span` is replaced, and reads again what that may have changed. The
    /// caller puts the new slots in place. `parse_of` gives what a slot was read as.
    pub(crate) fn edit<'a>(
        &mut self,
        span: Span,
        after: Rope,
        parse_of: impl Fn(EntityId) -> Option<&'a Parse>,
    ) -> Window {
        let tokens_of = |entity| parse_of(entity).map_or(&[][..], |parse| &parse.tokens);
        let (first, first_start) = self.window_start(span.start, tokens_of);
        let (touched, touched_start) = self.slots.at(span.end);
        let before = self.slots.at(span.start).0 - first;
        let untouched = |window: &Range<usize>| (before, window.end - touched - 1);
        let old_len = Span::of_rope(&self.text).len();
        self.text = after;
        let growth = i64::from(Span::of_rope(&self.text).len()) - i64::from(old_len);
        let earlier =
            parse_of(self.slots[touched].entity).filter(|_| span.start >= touched_start).map(|parse| {
                let start = touched_start - first_start;
                Earlier {
                    parse,
                    now: Span::new(start, shift(start + self.slots[touched].len, growth)),
                    edited: Span::new(span.start - touched_start, span.end - touched_start),
                    growth,
                }
            });
        let from = ReadFrom { start: first_start, growth, earlier };
        let mut end = touched + 1;
        let mut end_offset = touched_start + self.slots[touched].len;
        let mut more = 1;
        let mut relexed = 0;
        loop {
            let parses = if end >= self.slots.len() {
                let window = Span::new(first_start, Span::of_rope(&self.text).len());
                Some(parse_again(&window.slice(&self.text), earlier))
            } else {
                let ahead = end_offset + ahead(&self.slots[end..], tokens_of);
                self.read_up_to(&from, end_offset, ahead, &mut relexed)
            };
            if let Some(parses) = parses {
                let replaced = first..end.min(self.slots.len());
                relexed += parses.iter().map(|(_, parse)| parse.tokens.len()).sum::<usize>();
                return Window { untouched: untouched(&replaced), replaced, relexed, parses };
            }
            let next_end = (end + more).min(self.slots.len());
            end_offset += self.slots[end..next_end].iter().map(|slot| slot.len).sum::<u32>();
            end = next_end;
            more *= 2;
        }
    }

    /// Reads up to what was at `end_offset`, where a slot began, if it still begins there: a token begins on it and still
    /// begins an entity. Whether it does depends on that token and the few after it, which ended at `ahead`. The text after
    /// that is not needed: a token that ends later covers this place, too.
    fn read_up_to(
        &self,
        from: &ReadFrom<'_>,
        end_offset: u32,
        ahead: u32,
        relexed: &mut usize,
    ) -> Option<Vec<(Span, Parse)>> {
        let ReadFrom { start, growth, earlier } = *from;
        let boundary = shift(end_offset, growth);
        let text = Span::new(start, shift(ahead, growth)).slice(&self.text);
        let tokens = lex_again(&text, earlier.as_ref());
        *relexed += tokens.len();
        let starts = cut(&text, &tokens);
        let last = starts.iter().position(|&index| tokens[index].1.start + start == boundary)?;
        let mut parses = Vec::with_capacity(last + 1);
        let text = Span::new(0, boundary - start).text(&text);
        let (tokens, starts) = (&tokens[..starts[last]], &starts[..last]);
        parse_cut(text, tokens, starts, earlier, |span, parse| parses.push((span, parse)));
        Some(parses)
    }

    /// The first slot to read again. Whether a slot begins where it does depends on its first token, those few after
    /// it and what is before; so that many of its tokens must be as they were.
    fn window_start<'a>(&self, offset: u32, tokens_of: impl Fn(EntityId) -> &'a [Token]) -> (usize, u32) {
        const NEEDED: usize = 1 + LOOKAHEAD;
        let (mut index, mut start) = self.slots.at(offset);
        let (mut settled, mut untouched) = (offset, 0);
        loop {
            let tokens = tokens_of(self.slots[index].entity);
            let before = tokens.partition_point(|(_, span)| span.start + start < settled);
            for (token, span) in tokens[..before].iter().rev() {
                if span.end + start >= settled {
                    // Tokens without a gap between them can become one, as `left`, `.` and what is typed after that do.
                    settled = span.start + start;
                } else if !token.is_comment() {
                    untouched += 1;
                }
                if untouched == NEEDED {
                    return (index, start);
                }
            }
            if index == 0 {
                return (index, start);
            }
            index -= 1;
            start -= self.slots[index].len;
        }
    }
}

/// How far the first tokens of these slots reach, from the start of the first slot: those that decide whether it begins there.
fn ahead<'a>(slots: &[EntitySlot], tokens_of: impl Fn(EntityId) -> &'a [Token]) -> u32 {
    let mut needed = 1 + LOOKAHEAD;
    let mut start = 0;
    for slot in slots {
        let words = tokens_of(slot.entity).iter().filter(|(token, _)| !token.is_comment());
        let (left, end) = words.take(needed).fold((needed, 0), |(left, _), (_, span)| (left - 1, span.end));
        if left == 0 {
            return start + end;
        }
        needed = left;
        start += slot.len;
    }
    start
}

fn shift(offset: u32, by: i64) -> u32 {
    u32::try_from(i64::from(offset) + by).unwrap_or(u32::MAX)
}

/// The nearest range that fits the text and cuts no character.
pub(crate) fn fit(text: &Rope, span: Span) -> Span {
    let whole = Span::of_rope(text);
    let snap = |offset: u32| {
        let offset = offset.min(whole.end) as usize;
        let character = text.byte_to_char(offset);
        pydslrep_text::offset(text.char_to_byte(character))
    };
    let start = snap(span.start);
    Span::new(start, snap(span.end.max(span.start)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Database;

    /// Typed text joins the tokens before it, `ist` and `.`, though it touches only one of them: then `lsensor s` is no
    /// slip for a sensor, because the text after it cannot follow a sensor.
    /// for a sensor, because what follows it is none of what can follow a sensor.
    #[test]
    fn what_is_typed_changes_a_token_that_it_does_not_touch() {
        let before = "wheel w with radius 4\nlsensor s\nist.\nwheel v with radius 4\n";
        let after = before.replace("ist.", "ist.wheel");
        let places = |database: &Database, file| -> Vec<Span> {
            database.entities(file).map(|entity| entity.span).collect()
        };
        let mut edited = Database::new();
        let file = edited.open("edited.pyr", before);
        let cuts = places(&edited, file).len();
        let at = u32::try_from(before.find("ist.").unwrap() + 4).unwrap();
        edited.edit(file, Span::at(at), "wheel");
        let mut fresh = Database::new();
        let other = fresh.open("fresh.pyr", &after);
        assert_eq!(places(&edited, file), places(&fresh, other));
        assert_ne!(places(&edited, file).len(), cuts, "the edit joins entities");
    }
}
