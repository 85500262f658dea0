//! When one word is close enough to another to be meant.

/// Whether `written` is plausibly a slip for `meant`: equal but for case, or an edit distance of up to a third of
/// the length. Words of one or two letters count as slips only by case or by two letters changing places.
pub fn is_similar(written: &str, meant: &str) -> bool {
    slip(written, meant).is_some()
}

/// How far apart the two are, if one may be a slip for the other: the less, the nearer.
fn slip(written: &str, meant: &str) -> Option<(bool, usize)> {
    if written == meant {
        return None;
    }
    let only_case = written.eq_ignore_ascii_case(meant);
    let longest = written.chars().count().max(meant.chars().count());
    let most = (longest / 3).max(usize::from(is_swap(written, meant)));
    let (one, other) = differing(written, meant);
    // At least so many letters more must be inserted; most of many names are told apart by that.
    if !only_case && one.len().abs_diff(other.len()) > most && written.is_ascii() && meant.is_ascii() {
        return None;
    }
    let distance = strsim::osa_distance(one, other);
    (only_case || distance <= most).then_some((!only_case, distance))
}

/// What is left of two words without what they have in common at the start and at the end, which changes nothing about
/// their distance.
fn differing<'a>(one: &'a str, other: &'a str) -> (&'a str, &'a str) {
    let same = |(a, b): &(char, char)| a == b;
    let head: usize = one.chars().zip(other.chars()).take_while(same).map(|(a, _)| a.len_utf8()).sum();
    let (one, other) = (&one[head..], &other[head..]);
    let tail: usize =
        one.chars().rev().zip(other.chars().rev()).take_while(same).map(|(a, _)| a.len_utf8()).sum();
    (&one[..one.len() - tail], &other[..other.len() - tail])
}

fn is_swap(written: &str, meant: &str) -> bool {
    written.len() == 2 && meant.len() == 2 && written.bytes().eq(meant.bytes().rev())
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
    let near = candidates.into_iter().filter_map(|candidate| Some((slip(written, candidate)?, candidate)));
    near.min().map(|(_, candidate)| candidate)
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
            let most = (longest / 3).max(usize::from(is_swap(&one, &other)));
            let similar = one != other && (one.eq_ignore_ascii_case(&other) || distance <= most);
            proptest::prop_assert_eq!(is_similar(&one, &other), similar);
        }
    }
}
