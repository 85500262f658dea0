//! Filters completion items by the typed word, so that the list never gets in the way of typing.

use pydslrep_schema::{CursorContext, Slot};
use pydslrep_syntax::Span;

use super::{Completion, CompletionKind, CompletionTrigger};

/// A list that opens automatically has no items that save fewer letters than this or as many. Otherwise it would still be
/// open when the user presses a key right after the word, until the response to the last letter arrives.
const MIN_SAVED_LETTERS: usize = 3;

/// The word at the cursor.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Word<'a> {
    /// The part before the cursor.
    pub(crate) before: &'a str,
    /// The part after the cursor.
    pub(crate) after: &'a str,
    /// True if only auto-closed characters follow it on its line, so that Enter may come next.
    pub(crate) ends_line: bool,
}

impl Word<'_> {
    /// Returns whether a text is complete but for a few letters.
    fn almost_completes(&self, text: &str) -> bool {
        let is_short = text.len() <= self.before.len() + MIN_SAVED_LETTERS;
        self.ends_line && self.after.is_empty() && is_short && starts_with(text, &self.before.to_lowercase())
    }
}

/// Returns whether only characters that editors close automatically follow on the line.
pub(crate) fn ends_line(following: impl Iterator<Item = char>) -> bool {
    let mut line = following.take_while(|character| !matches!(character, '\r' | '\n'));
    line.all(|character| " \t}]\"'".contains(character))
}

/// The items that match the typed part of the word, the word itself first. No list opens automatically at a complete
/// word; where Enter may end the line, it has no items that are almost complete.
pub(crate) fn filter(items: Vec<Completion>, word: Word<'_>, trigger: CompletionTrigger) -> Vec<Completion> {
    if word.before.is_empty() && word.after.is_empty() {
        return items;
    }
    let is_automatic = trigger != CompletionTrigger::Invoked;
    let is_whole = |item: &Completion| word.after.is_empty() && item.plain() == word.before;
    if is_automatic && items.iter().any(is_whole) {
        return Vec::new();
    }
    let typed = bare(word.before).to_lowercase();
    let mut found: Vec<(bool, Completion)> = items
        .into_iter()
        .filter(|item| !is_automatic || !word.almost_completes(&item.plain()))
        .filter_map(|item| Some((!fit(&item, &typed)?, item)))
        .collect();
    found.sort_by_key(|(is_inside, item)| (!is_whole(item), *is_inside, item.rank));
    found.into_iter().map(|(_, item)| item).collect()
}

/// Returns whether the typed letters, in lower case, begin the label (`true`) or fit one of its subwords (`false`).
fn fit(item: &Completion, typed: &str) -> Option<bool> {
    let label = bare(&item.label);
    if starts_with(label, typed) {
        return Some(true);
    }
    if matches!(item.kind, CompletionKind::Keyword | CompletionKind::Snippet) {
        // Users type a clause or a statement from its first word; other letters begin a name or another statement.
        return None;
    }
    subwords(label).any(|word| has_letters(word, typed)).then_some(false)
}

/// A label without its quote or escape.
fn bare(text: &str) -> &str {
    text.trim_start_matches(['^', '"', '\''])
}

pub(super) fn starts_with(text: &str, typed: &str) -> bool {
    text.get(..typed.len()).is_some_and(|start| start.to_lowercase() == typed)
}

/// The words of a name, each with all that follows it: `wheelLeft` has `wheelLeft` and `Left`.
fn subwords(name: &str) -> impl Iterator<Item = &str> {
    let mut previous = '_';
    name.char_indices().filter_map(move |(at, character)| {
        let is_start = character.is_alphanumeric()
            && (!previous.is_alphanumeric()
                || (previous.is_lowercase() && character.is_uppercase())
                || (previous.is_alphabetic() && character.is_ascii_digit()));
        previous = character;
        is_start.then(|| &name[at..])
    })
}

/// Returns whether a word begins with the first typed letter and contains the others in this order, ignoring case.
fn has_letters(word: &str, typed: &str) -> bool {
    let mut wanted = typed.chars();
    let mut letters = word.chars().flat_map(char::to_lowercase);
    wanted.next().is_none_or(|first| letters.next() == Some(first))
        && wanted.all(|wanted| letters.any(|letter| letter == wanted))
}

/// The same for a TOML file; all items at a position replace the same word.
pub(crate) fn filter_in_toml(
    items: Vec<Completion>,
    text: &str,
    offset: u32,
    trigger: CompletionTrigger,
) -> Vec<Completion> {
    let Some(word) = items.first().map(|item| item.replace) else { return items };
    let cut = offset.clamp(word.start, word.end);
    let following = text.get(word.end as usize..).unwrap_or_default();
    let word = Word {
        before: Span::new(word.start, cut).text(text),
        after: Span::new(cut, word.end).text(text),
        ends_line: ends_line(following.chars()),
    };
    filter(items, word, trigger)
}

impl CompletionTrigger {
    /// Returns whether the list opens in a TOML file: automatically where a value is expected and in a header.
    pub(crate) fn opens_in_toml(self, cursor: &CursorContext) -> bool {
        match self {
            Self::Invoked | Self::Letter => true,
            Self::Character('[') => matches!(cursor.slot, Slot::Table { .. }),
            Self::Character(' ' | '"') => matches!(cursor.slot, Slot::Value { .. }),
            Self::Character(_) => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::completion::MAX_ITEMS;
    use crate::completion::testing::{asked, opens};
    use crate::fixture::PARTS;

    #[test]
    fn the_list_opens_automatically_where_a_name_must_follow() {
        assert_eq!(opens(&format!("{PARTS}movement m of $0")), ["rover"]);
        assert_eq!(opens(&format!("{PARTS}robot r with port 1 has {{ $0 }} wheels")), ["wheelL", "wheelR"]);
        assert_eq!(opens(&format!("{PARTS}robot r type tw with port 1 has {{ wheelL $0 }}")), ["wheelR"]);
        assert_eq!(opens(&format!("{PARTS}environment e has {{ $0 }}")), ["rover"]);
        assert_eq!(opens(&format!("{PARTS}movement m of rover {{ turn left until {{ $0 }} }}")), ["front"]);
        assert_eq!(opens("ip lab 127.0.0.1 environment e with ip $0"), ["lab"]);
        assert_eq!(
            opens(&format!("{PARTS}robot r with port 1 has {{ }} wheels with sensors {{ back, $0 }}")),
            ["front"]
        );
    }

    #[test]
    fn no_list_opens_automatically_anywhere_else() {
        let in_movement = |action: &str| format!("{PARTS}movement m of rover {{{action}");
        let robot = |rest: &str| format!("{PARTS}robot r type tw {rest}");
        let fixtures = [
            in_movement("$0}"),
            in_movement(" $0 }"),
            in_movement(" move $0 }"),
            in_movement(" move 2 $0 }"),
            in_movement(" move 2$0 }"),
            in_movement(" move 2 meters $0 }"),
            in_movement(" move 2 meters at 12$0 }"),
            in_movement(" turn $0 }"),
            in_movement(" turn left $0 }"),
            in_movement(" turn left 90$0 }"),
            robot("$0"),
            robot("with port $0"),
            robot("with port 23000 $0"),
            robot("with port 23000 has {$0"),
            robot("with port 23000 has { wheelL wheelR $0"),
            robot("with port 23000 has { $0 wheelL wheelR }"),
            robot("with port 23000 has { wheelL wheelR } wheels $0"),
            format!("{PARTS}movement m of $0 rover"),
            format!("{PARTS}environment e has {{ rover $0 }}"),
            format!("{PARTS}environment e has {{ rover }} robots $0"),
            "wheel w $0".to_owned(),
            "wheel w with radius 4.5$0".to_owned(),
            "wheel w with radius 4.5 $0".to_owned(),
            "wheel w$0".to_owned(),
            "import $0".to_owned(),
            "// of $0".to_owned(),
        ];
        for fixture in fixtures {
            assert_eq!(opens(&fixture), [""; 0], "{fixture}");
        }
    }

    #[test]
    fn no_list_opens_automatically_where_a_new_statement_may_be_complete() {
        for action in [
            "wait $0",
            "wait 2 $0",
            "wait 2 seconds $0",
            "wait until { front } $0",
            "wait until { front } clear $0",
            "repeat $0",
            "repeat 4 $0",
            "repeat 4 times $0",
            "repeat 4 times { $0 }",
            "if { front } clear { slam } $0",
            "if { front } clear { slam } else $0",
            "turn left 90 with $0",
            "move 1 meters until { front } detect within 2 $0",
            "wait 2 seconds$0",
            "repeat 4 times$0",
            "if { front } clear$0",
            "do side$0",
            "if$0",
            "do$0",
            "wait$0",
            "repeat$0",
        ] {
            let fixture =
                format!("{PARTS}movement side of rover {{ slam }}\nmovement m of rover {{\n  {action}\n}}");
            assert_eq!(opens(&fixture), [""; 0], "{action}");
        }
    }

    #[test]
    fn a_word_that_is_complete_is_left_alone() {
        let in_movement = |action: &str| format!("{PARTS}movement m of rover {{ {action} }}");
        let fixtures = [
            in_movement("move 2 meters$0"),
            in_movement("move 2 centimeters$0"),
            in_movement("turn left$0"),
            in_movement("slam$0"),
            in_movement("turn left until { front$0 }"),
            format!("{PARTS}robot r with port 1 has {{ wheelL wheelR }} wheels$0"),
            format!("{PARTS}wheel wheelL2 with radius 4.5 robot r with port 1 has {{ wheelL$0 }}"),
            format!("{PARTS}movement m of rover$0"),
            "wheel$0".to_owned(),
            "sensor s : bumper$0".to_owned(),
        ];
        for fixture in fixtures {
            assert_eq!(opens(&fixture), [""; 0], "{fixture}");
        }
    }

    #[test]
    fn a_word_inside_a_line_is_offered_until_it_is_complete() {
        let fixture = |typed: &str| format!("{PARTS}movement m of {typed}$0 {{ slam }}");
        assert_eq!(opens(&fixture("rove")), ["rover"]);
        assert_eq!(opens(&fixture("rover")), [""; 0]);
    }

    const SIMILAR: &str = "wheel abc with radius 4.5\nwheel ab with radius 4.5\nwheel a2 with radius 4.5\nwheel a with radius 4.5\n";

    #[test]
    fn no_list_opens_at_a_name_that_others_begin_with() {
        let inside = |list: &str| format!("{SIMILAR}robot r with port 1 has {{\n  {list}");
        for list in
            ["a$0", "ab$0", "a\n  ab$0", "a\n  ab\n  a2$0 } wheels", "ab$0 } wheels", "a$0 ab } wheels"]
        {
            assert_eq!(opens(&inside(list)), [""; 0], "{list}");
        }
        assert_eq!(opens(&inside("a ab$0 ab")), [""; 0], "a name that the list has already");
    }

    #[test]
    fn a_list_that_is_asked_for_begins_with_the_exact_name() {
        let inside = |list: &str| format!("{SIMILAR}robot r with port 1 has {{\n  {list}");
        assert_eq!(asked(&inside("ab$0")), ["ab", "abc"]);
        assert_eq!(asked(&inside("a$0")), ["a", "a2", "ab", "abc"]);
        assert_eq!(asked(&format!("{PARTS}movement m of rover {{ move 2 meters$0 }}")), ["meters"]);
    }

    #[test]
    fn the_exact_name_is_among_the_first_of_very_many() {
        let many: Vec<String> = (0..3_000).map(|number| format!("sensor s{number}")).collect();
        let many = many.join("\n");
        let list = format!("{many}\nrobot r with port 1 has {{ }} wheels with sensors {{ s2999, s2$0");
        let found = asked(&list);
        assert_eq!((found[0].as_str(), found.len()), ("s2", MAX_ITEMS));
    }

    #[test]
    fn the_list_closes_before_the_word_is_complete() {
        let fixture = |typed: &str| format!("{PARTS}movement m of rover {{ move 2 {typed}$0");
        assert_eq!(opens(&fixture("me")), ["meters"]);
        assert_eq!(opens(&fixture("met")), [""; 0]);
        assert_eq!(opens(&fixture("meter")), [""; 0]);
    }

    #[test]
    fn prefixes_come_before_subwords() {
        let wheels = "wheel bigWheel with radius 9 wheel wheel_right with radius 9 wheel left with radius 9";
        assert_eq!(opens(&format!("{wheels} robot r with port 1 has {{ w$0")), ["wheel_right", "bigWheel"]);
        assert_eq!(opens(&format!("{wheels} robot r with port 1 has {{ ri$0")), ["wheel_right"]);
        assert_eq!(opens(&format!("{wheels} robot r with port 1 has {{ heel$0")), [""; 0]);
    }
}
