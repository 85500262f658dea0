//! Decides whether one word is so close to another that it is probably a misspelling of it.

/// Returns whether `written` is plausibly a misspelling of `intended`: equal except for case, or an edit distance of up to a
/// third of the length. Words of one or two letters count as misspellings only by case or by two letters changing places.
pub fn is_similar(written: &str, intended: &str) -> bool {
    slip(written, intended).is_some()
}

/// The distance between two words: first whether they differ in more than case, then the number of edits.
type Distance = (bool, usize);

/// Returns the distance between the two, if one may be a misspelling of the other; smaller is closer.
fn slip(written: &str, intended: &str) -> Option<Distance> {
    slip_within(written, intended, (true, usize::MAX))
}

/// As [`slip`], if they are not farther apart than `bound`. Lengths and ends alone rule nearly all of many names out.
fn slip_within(written: &str, intended: &str, bound: Distance) -> Option<Distance> {
    let (one, other) = differing(written, intended);
    if one.is_empty() && other.is_empty() {
        return None;
    }
    let only_case = one.eq_ignore_ascii_case(other);
    // In bytes there are not fewer than in characters, so this turns away too few rather than too many.
    let max_edits = (written.len().max(intended.len()) / 3).max(1);
    if !only_case && (!bound.0 || at_least(one, other) > max_edits.min(bound.1)) {
        return None;
    }
    let longest = written.chars().count().max(intended.chars().count());
    let max_edits = (longest / 3).max(usize::from(is_swap(written, intended)));
    let distance = strsim::osa_distance(one, other);
    let found = (!only_case, distance);
    ((only_case || distance <= max_edits) && found <= bound).then_some(found)
}

/// A number of edits that it takes at least to make one of the other, which differs from it at both ends.
fn at_least(one: &str, other: &str) -> usize {
    let (longer, shorter) = (one.len().max(other.len()), one.len().min(other.len()));
    match (longer, shorter) {
        _ if !one.is_ascii() || !other.is_ascii() => 1,
        (_, 0) => longer,
        // Another letter, or two that change places.
        (1, 1) | (2, 2) => 1,
        _ => (longer - shorter).max(2),
    }
}

/// Removes what two words have in common at the start and at the end, which changes nothing about their distance.
fn differing<'a>(one: &'a str, other: &'a str) -> (&'a str, &'a str) {
    let same = |(a, b): &(u8, u8)| a == b;
    let mut head = one.bytes().zip(other.bytes()).take_while(same).count();
    while !one.is_char_boundary(head) || !other.is_char_boundary(head) {
        head -= 1;
    }
    let (one, other) = (&one[head..], &other[head..]);
    let mut tail = one.bytes().rev().zip(other.bytes().rev()).take_while(same).count();
    while !one.is_char_boundary(one.len() - tail) || !other.is_char_boundary(other.len() - tail) {
        tail -= 1;
    }
    (&one[..one.len() - tail], &other[..other.len() - tail])
}

fn is_swap(written: &str, intended: &str) -> bool {
    written.len() == 2 && intended.len() == 2 && written.bytes().eq(intended.bytes().rev())
}

/// The candidate nearest to `written`, if one is close enough; the first of equals.
pub fn closest<'a>(written: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let near = candidates.into_iter().filter_map(|candidate| Some((slip(written, candidate)?, candidate)));
    near.min_by_key(|(distance, _)| *distance).map(|(_, candidate)| candidate)
}

/// The candidate nearest to `written`, if one is close enough; the first of equals by the alphabet, in whatever order
/// they come.
pub fn closest_of_any_order<'a>(
    written: &str,
    candidates: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    let mut nearest: Option<(Distance, &str)> = None;
    for candidate in candidates {
        let bound = nearest.map_or((true, usize::MAX), |(distance, _)| distance);
        if let Some(distance) = slip_within(written, candidate, bound) {
            let found = (distance, candidate);
            nearest = Some(nearest.map_or(found, |nearest| nearest.min(found)));
        }
    }
    nearest.map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_close_and_other_words_are_not() {
        assert!(is_similar("weel", "wheel"));
        assert!(is_similar("mvoe", "move"));
        assert!(is_similar("HAS", "has"));
        assert!(is_similar("fo", "of"));
        assert!(is_similar("wheel", "wheels"));
        assert!(!is_similar("wheel", "wheel"));
        assert!(!is_similar("a", "at"));
        assert!(!is_similar("robot_1", "sensor"));
    }

    #[test]
    fn the_nearest_wins() {
        assert_eq!(closest("wheelx", ["wheel", "wheelX", "radius"]), Some("wheelX"));
        assert_eq!(closest("zzz", ["wheel"]), None);
        assert_eq!(closest("wheel_", ["wheel2", "wheel1"]), Some("wheel2"));
        assert_eq!(closest_of_any_order("wheel_", ["wheel2", "wheel1"]), Some("wheel1"));
    }

    proptest::proptest! {
        #[test]
        fn what_words_have_in_common_does_not_matter(one in "[abA_é]{0,7}", other in "[abA_é]{0,7}") {
            let longest = one.chars().count().max(other.chars().count());
            let distance = strsim::osa_distance(&one, &other);
            let max_edits = (longest / 3).max(usize::from(is_swap(&one, &other)));
            let similar = one != other && (one.eq_ignore_ascii_case(&other) || distance <= max_edits);
            proptest::prop_assert_eq!(is_similar(&one, &other), similar);
        }

        #[test]
        fn what_was_found_only_hides_what_is_farther(
            written in "[abA_é]{0,7}",
            candidates in proptest::collection::vec("[abA_é]{0,7}", 0..20),
        ) {
            let all = candidates.iter().filter_map(|word| Some((slip(&written, word)?, word.as_str())));
            let nearest = all.min().map(|(_, word)| word);
            let found = closest_of_any_order(&written, candidates.iter().map(String::as_str));
            proptest::prop_assert_eq!(found, nearest);
        }
    }
}
