//! Which wheels make a robot.

/// Wheels that make a robot.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    /// Its type; `None` if it needs none.
    pub(crate) word: Option<&'static str>,
    pub(crate) wheels: usize,
    /// Whether these are `wheelH`.
    pub(crate) mecanum: bool,
}

pub(crate) const LAYOUTS: [Layout; 6] = [
    Layout { word: Some("tw"), wheels: 2, mecanum: false },
    Layout { word: None, wheels: 2, mecanum: false },
    Layout { word: Some("fw"), wheels: 4, mecanum: false },
    Layout { word: Some("fwh"), wheels: 4, mecanum: true },
    Layout { word: None, wheels: 4, mecanum: true },
    Layout { word: None, wheels: 4, mecanum: false },
];

/// The keywords for types.
pub(crate) fn words() -> Vec<&'static str> {
    LAYOUTS.iter().filter_map(|layout| layout.word).collect()
}

/// Those of a type, or of robots without one.
pub(crate) fn layouts(word: Option<&str>) -> impl Iterator<Item = Layout> {
    LAYOUTS.into_iter().filter(move |layout| layout.word == word)
}
