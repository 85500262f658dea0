//! What a robot is called in ROS 2: what scripts have to know where its driver does not do what is usual.

use pydslrep_schema::Section;

use crate::{Robot, defaults};

/// The value of a key of `[robots.NAME.ros2]`.
#[derive(Debug, Clone, PartialEq)]
pub enum Ros2Value {
    /// A name.
    Text(String),
    /// A length or speed.
    Number(f64),
    /// Whether something is so.
    Flag(bool),
}

/// The keys that are not as usual, in the order of the list, with their values.
pub type Ros2 = Vec<(&'static str, Ros2Value)>;

/// Reads the table of a robot.
pub(crate) fn read(section: &Section) -> Ros2 {
    let value = |key: &str| {
        let text = section.text(key).map(|text| Ros2Value::Text(text.to_owned()));
        let number = || section.number(key).map(Ros2Value::Number);
        let flag = || section.flag(key).map(Ros2Value::Flag);
        text.or_else(number).or_else(flag)
    };
    let keys = section.table.keys.iter();
    keys.filter_map(|key| Some((key.name, value(key.name).filter(|value| !is_usual(key.default, value))?)))
        .collect()
}

/// Whether a value is the default of its key.
fn is_usual(default: &str, value: &Ros2Value) -> bool {
    let written = match value {
        Ros2Value::Text(text) => format!("`\"{text}\"`"),
        Ros2Value::Number(number) => format!("`{number:?}`"),
        Ros2Value::Flag(flag) => format!("`{flag}`"),
    };
    default == written
}

impl Robot {
    /// What a script has to know: its table, and the distances between its wheels, which no topic tells.
    pub fn ros2(&self) -> Ros2 {
        let mut all = self.ros2.clone();
        let usual = defaults::GEOMETRY;
        for (key, value, usual) in [
            ("track", self.geometry.track, usual.track),
            ("wheelbase", self.geometry.wheelbase, usual.wheelbase),
        ] {
            if value.to_bits() != usual.to_bits() && all.iter().all(|(known, _)| *known != key) {
                all.push((key, Ros2Value::Number(value)));
            }
        }
        all
    }
}
