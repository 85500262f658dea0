//! The names of a robot in ROS 2, and the facts that scripts need where its driver does not do what is usual.

use pydslrep_schema::Section;

use crate::{Robot, SCHEMA, defaults};

/// The value of a key of `[robots.NAME.ros2]`.
#[derive(Debug, Clone, PartialEq)]
pub enum Ros2Value {
    /// A name.
    Text(String),
    /// A length or speed.
    Number(f64),
    /// A yes or no.
    Flag(bool),
}

/// The keys that are not as usual, in the order of the list, with their values.
pub type Ros2 = Vec<(&'static str, Ros2Value)>;

/// The names of a robot's topics and frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Topics {
    namespace: String,
    ranges: String,
    /// Of its odometry.
    pub odometry: String,
    /// Of its poses, if they do not come from its odometry.
    pub pose: Option<String>,
    /// The frame of its wheels' centre.
    pub base_frame: String,
    /// The frame of its odometry.
    pub odometry_frame: String,
}

impl Topics {
    /// The topic of a sensor.
    pub fn range(&self, sensor: &str) -> String {
        self.absolute(&self.ranges.replace("{sensor}", sensor))
    }

    /// The topic of a name in the robot's namespace, unless the name begins with `/`.
    pub fn absolute(&self, name: &str) -> String {
        if name.starts_with('/') { name.to_owned() } else { format!("{}/{name}", self.namespace) }
    }
}

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

/// Returns whether a value is the default of its key.
fn is_usual(default: &str, value: &Ros2Value) -> bool {
    let written = match value {
        Ros2Value::Text(text) => format!("`\"{text}\"`"),
        Ros2Value::Number(number) => format!("`{number:?}`"),
        Ros2Value::Flag(flag) => format!("`{flag}`"),
    };
    default == written
}

impl Robot {
    /// Returns the names of its topics; scripts come to the same names (`python/pydslrep_runtime/ros2_topics.py`).
    pub fn topics(&self) -> Topics {
        let namespace = self.ros2_name("namespace").unwrap_or_else(|| format!("/{}", self.name));
        let usual = |key| self.ros2_name(key).unwrap_or_default();
        let mut topics = Topics {
            namespace: namespace.trim_end_matches('/').to_owned(),
            ranges: usual("ranges"),
            odometry: String::new(),
            pose: None,
            base_frame: usual("base-frame"),
            odometry_frame: usual("odom-frame"),
        };
        topics.odometry = topics.absolute(&usual("odom"));
        topics.pose = self.ros2_name("pose").map(|pose| topics.absolute(&pose));
        topics
    }

    /// The value of a key that has a name for value, or its default.
    fn ros2_name(&self, key: &str) -> Option<String> {
        let written = self.ros2.iter().find_map(|(known, value)| match value {
            Ros2Value::Text(text) if *known == key => Some(text.clone()),
            _ => None,
        });
        written.or_else(|| {
            let table = SCHEMA.table("robots.NAME.ros2")?;
            let default = table.keys.iter().find(|each| each.name == key)?.default_value()?;
            Some(default.trim_matches('"').to_owned())
        })
    }

    /// Returns the facts that a script needs: its table, and the distances between its wheels, which no topic reports.
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
