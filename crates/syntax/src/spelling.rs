//! When one word is close enough to another to be meant.

/// Whether `written` is plausibly a slip for `meant`: equal but for case, or an edit distance of up to a third of
/// the length. Words of one or two letters count as slips only by case or by two letters changing places.
pub fn is_similar(written: &str, meant: &str) -> bool {
    if written == meant {
        return false;
    }
    let longest = written.chars().count().max(meant.chars().count());
    written.eq_ignore_ascii_case(meant)
        || strsim::osa_distance(written, meant) <= (longest / 3).max(usize::from(is_swap(written, meant)))
}

fn is_swap(written: &str, meant: &str) -> bool {
    written.len() == 2 && meant.len() == 2 && written.bytes().eq(meant.bytes().rev())
}

/// The candidate nearest to `written`, if one is close enough; the first of equals.
pub fn closest<'a>(written: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates.into_iter().filter(|candidate| is_similar(written, candidate)).min_by_key(|candidate| {
        (!written.eq_ignore_ascii_case(candidate), strsim::osa_distance(written, candidate))
    })
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
    }
}
