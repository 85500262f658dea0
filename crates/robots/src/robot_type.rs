//! The table: the types of robots, and a row for each.

/// A type of robot: how its driven wheels are laid out. What that means is in its row, [`Drive::row`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Drive {
    /// Two-wheel differential (`tw`).
    TwoWheel,
    /// Four standard wheels, skid-steer (`fw`).
    FourWheel,
    /// Four mecanum wheels whose rollers form an X seen from above (`fwh`).
    Mecanum,
}

impl Drive {
    /// All types, in the order in which they are listed for people, and in which wheels without a type are tried.
    pub const ALL: [Self; 3] = [Self::TwoWheel, Self::FourWheel, Self::Mecanum];

    /// The default sizes of their bodies in words, as Markdown.
    pub const BODIES: &str = "`[0.30, 0.30]` with two wheels, `[0.36, 0.30]` with four";

    /// Its row of the table.
    pub const fn row(self) -> &'static RobotType {
        match self {
            Self::TwoWheel => &TWO_WHEEL,
            Self::FourWheel => &FOUR_WHEEL,
            Self::Mecanum => &MECANUM,
        }
    }
}

/// The row of a type of robot: its differences from the others.
#[derive(Debug, PartialEq)]
pub struct RobotType {
    /// The type.
    pub drive: Drive,
    /// As programs spell it.
    pub word: &'static str,
    /// Its name with the article: `a two-wheel robot`.
    pub noun: &'static str,
    /// The title of its description: `Two-wheel differential drive`.
    pub label: &'static str,
    /// The number of its wheels in words: `two`.
    pub count: &'static str,
    /// The places of its wheels, in the order in which programs list them and everything else has them.
    pub wheels: &'static [WheelPlace],
    /// True if it drives on mecanum wheels (`wheelH`); otherwise on standard ones (`wheel`).
    pub mecanum: bool,
    /// Another type that it is driven as if all its wheels are mecanum wheels, which is then a warning instead of an error: so
    /// the article's programs have it.
    pub on_mecanum: Option<Drive>,
    /// True if it can explore with distance sensors (`slam`).
    pub explores: bool,
    /// The class that a script makes such robots of.
    pub class: &'static str,
    /// The class of the runtime that drives them.
    pub runtime_drive: &'static str,
    /// The rates of its wheels for a twist, as people write it: v or vx ahead, vy to the left, ω, the wheels' radius r, and
    /// for the distances of wheels d (the track) or K (half of track and wheelbase).
    pub equations: &'static [&'static str],
    /// Length and width of its body where the scene does not say otherwise, metres.
    pub body: (f64, f64),
    /// The friction of its wheels across their rolling direction, as a share of that along it, where the scene does not say
    /// otherwise: the same for rubber tyres, next to nothing for the rollers of mecanum wheels.
    pub lateral_friction: f64,
}

/// Where a wheel is on its robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WheelPlace {
    /// As scripts spell it: `left_front`.
    pub identifier: &'static str,
    /// The distance ahead of the body's middle, in half wheelbases: 1, −1, or 0 on the only axle.
    pub ahead: f64,
    /// The distance to the left of it, in half tracks: 1 or −1.
    pub left: f64,
    /// Which way it pushes: 0 along the wheel, 1 ahead and to the left by as much, −1 ahead and to the right, as the axes of a
    /// mecanum wheel's rollers lead.
    pub push: f64,
}

/// The most wheels that any type has.
pub const MAX_WHEELS: usize = {
    let (mut most, mut index) = (0, 0);
    while index < Drive::ALL.len() {
        let count = Drive::ALL[index].wheel_count();
        most = if count > most { count } else { most };
        index += 1;
    }
    most
};

const fn wheel(identifier: &'static str, ahead: f64, left: f64, push: f64) -> WheelPlace {
    WheelPlace { identifier, ahead, left, push }
}

const TWO_WHEEL: RobotType = RobotType {
    drive: Drive::TwoWheel,
    word: "tw",
    noun: "a two-wheel robot",
    label: "Two-wheel differential drive",
    count: "two",
    wheels: &[wheel("left", 0.0, 1.0, 0.0), wheel("right", 0.0, -1.0, 0.0)],
    mecanum: false,
    on_mecanum: None,
    explores: true,
    class: "TwoWheelRobot",
    runtime_drive: "TwoWheelDrive",
    equations: &["left  = (v − ω d/2) / r", "right = (v + ω d/2) / r"],
    body: (0.30, 0.30),
    lateral_friction: 1.0,
};

const FOUR_WHEEL: RobotType = RobotType {
    drive: Drive::FourWheel,
    word: "fw",
    noun: "a four-wheel robot",
    label: "Four-wheel skid-steer drive",
    count: "four",
    wheels: &[
        wheel("left_front", 1.0, 1.0, 0.0),
        wheel("left_rear", -1.0, 1.0, 0.0),
        wheel("right_front", 1.0, -1.0, 0.0),
        wheel("right_rear", -1.0, -1.0, 0.0),
    ],
    mecanum: false,
    on_mecanum: Some(Drive::Mecanum),
    explores: false,
    class: "FourWheelRobot",
    runtime_drive: "FourWheelDrive",
    equations: &["left front, left rear   = (v − ω d/2) / r", "right front, right rear = (v + ω d/2) / r"],
    body: (0.36, 0.30),
    lateral_friction: 1.0,
};

const MECANUM: RobotType = RobotType {
    drive: Drive::Mecanum,
    word: "fwh",
    noun: "a mecanum robot",
    label: "Mecanum drive",
    count: "four",
    wheels: &[
        wheel("left_front", 1.0, 1.0, -1.0),
        wheel("left_rear", -1.0, 1.0, 1.0),
        wheel("right_front", 1.0, -1.0, 1.0),
        wheel("right_rear", -1.0, -1.0, -1.0),
    ],
    mecanum: true,
    on_mecanum: None,
    explores: false,
    class: "MecanumRobot",
    runtime_drive: "MecanumDrive",
    equations: &[
        "left front  = (vx − vy − K ω) / r",
        "left rear   = (vx + vy − K ω) / r",
        "right front = (vx + vy + K ω) / r",
        "right rear  = (vx − vy + K ω) / r",
    ],
    body: (0.36, 0.30),
    lateral_friction: 0.05,
};

impl RobotType {
    /// Returns whether some wheels are ahead of others.
    pub fn has_wheelbase(&self) -> bool {
        self.wheels.iter().any(|wheel| wheel.ahead != 0.0)
    }

    /// Returns whether wheels are dragged sideways over the floor in turns: standard ones not on an axle through the
    /// middle.
    pub fn scrubs(&self) -> bool {
        !self.mecanum && self.has_wheelbase()
    }

    /// The places of its wheels in order, in words: `left, right`.
    pub fn order(&self) -> String {
        self.wheels.iter().map(WheelPlace::words).collect::<Vec<_>>().join(", ")
    }
}

impl WheelPlace {
    /// In words: `left front`.
    pub fn words(&self) -> String {
        self.identifier.replace('_', " ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wheels_on_the_left_come_first_and_front_ones_before_rear_ones() {
        for drive in Drive::ALL {
            let places: Vec<(f64, f64)> =
                drive.row().wheels.iter().map(|wheel| (-wheel.left, -wheel.ahead)).collect();
            assert!(places.is_sorted(), "{drive:?}: {places:?}");
            for wheel in drive.row().wheels {
                assert_eq!(wheel.identifier.starts_with("left"), wheel.left > 0.0, "{wheel:?}");
                assert_eq!(wheel.identifier.ends_with("front"), wheel.ahead > 0.0, "{wheel:?}");
                assert_eq!(wheel.push != 0.0, drive.row().mecanum, "{wheel:?}");
            }
        }
    }

    #[test]
    fn wheels_push_evenly() {
        for drive in Drive::ALL {
            let sum =
                |of: fn(&WheelPlace) -> f64| -> f64 { drive.row().wheels.iter().map(of).sum::<f64>().abs() };
            assert!(sum(|wheel| wheel.left) + sum(|wheel| wheel.ahead) + sum(|wheel| wheel.push) == 0.0);
        }
        assert!(Drive::ALL.into_iter().all(|drive| drive.wheel_count() <= MAX_WHEELS));
    }

    #[test]
    fn bodies_and_numbers_are_the_same_in_words() {
        let mut bodies = Vec::new();
        for count in Drive::wheel_counts() {
            let rows: Vec<_> = Drive::with_wheels(count).map(Drive::row).collect();
            let (length, width) = rows[0].body;
            let wheels = if bodies.is_empty() { " wheels" } else { "" };
            bodies.push(format!("`[{length:.2}, {width:.2}]` with {}{wheels}", rows[0].count));
            assert!(rows.iter().all(|row| (row.body, row.count) == (rows[0].body, rows[0].count)));
        }
        assert_eq!(Drive::BODIES, bodies.join(", "));
    }

    #[test]
    fn types_of_as_many_wheels_have_them_in_the_same_places() {
        for drive in Drive::ALL {
            for other in Drive::with_wheels(drive.wheel_count()) {
                assert_eq!(drive.row().order(), other.row().order(), "lists without a type have one order");
            }
        }
    }

    #[test]
    fn equations_name_every_wheel_once_and_in_order() {
        for drive in Drive::ALL {
            let left = drive.row().equations.iter().filter_map(|line| Some(line.split_once('=')?.0.trim()));
            assert_eq!(left.collect::<Vec<_>>().join(", "), drive.row().order());
        }
    }

    #[test]
    fn only_standard_wheels_off_the_axle_scrub() {
        let scrubs = [Drive::TwoWheel, Drive::FourWheel, Drive::Mecanum].map(|drive| drive.row().scrubs());
        assert_eq!(scrubs, [false, true, false]);
    }
}
