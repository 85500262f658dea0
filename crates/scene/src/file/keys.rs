//! The one list of what a scene file can say.

/// A table of a scene file.
#[derive(Debug)]
pub struct Table {
    /// What it is called; for tables of a robot or a sensor with a placeholder for its name.
    pub name: &'static str,
    /// How often it can stand.
    pub sort: Sort,
    /// What it is about, in Markdown.
    pub summary: &'static str,
    /// What can be set in it.
    pub keys: &'static [Key],
}

/// How often a table can stand, and what for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sort {
    /// Once: `[world]`.
    Once,
    /// Any number of times, each for another obstacle: `[[box]]`.
    Each,
    /// Once for every robot: `[robots.robot_1]`.
    Robot,
    /// Once for every sensor of a robot: `[robots.robot_1.sensors.fSensor]`.
    Sensor,
}

/// Something that can be set.
#[derive(Debug)]
pub struct Key {
    /// What it is called.
    pub name: &'static str,
    /// What it can be.
    pub values: Values,
    /// Whether the table makes no sense without it.
    pub required: bool,
    /// What it means, in Markdown.
    pub summary: &'static str,
    /// What holds where nothing is said, in Markdown.
    pub default: &'static str,
    /// A value that is not the default, as TOML and JSON write it alike.
    pub example: &'static str,
}

/// What a key can be set to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Values {
    /// `true` or `false`.
    Flag,
    /// A whole number from 0 to 2³².
    Count,
    /// A number above zero.
    AboveZero,
    /// A number, zero or above.
    FromZero,
    /// A number from 0 to 1.
    Share,
    /// An angle in degrees.
    Angle,
    /// An angle above 0° and up to 180°.
    Opening,
    /// A name.
    Name,
    /// `[x, y]`.
    Point,
    /// `[length, width]`, both above zero.
    Size,
    /// `[x, y]` or `[x, y, heading]`.
    Pose,
    /// Three points or more.
    Points,
}

impl Values {
    /// What is expected, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Flag => "true or false",
            Self::Count => "a whole number from 0",
            Self::AboveZero => "a number above zero",
            Self::FromZero => "a number from 0",
            Self::Share => "a number from 0 to 1",
            Self::Angle => "an angle in degrees",
            Self::Opening => "an angle above 0 and up to 180 degrees",
            Self::Name => "a text",
            Self::Point => "a point `[x, y]`",
            Self::Size => "a size `[length, width]`, both above zero",
            Self::Pose => "a pose `[x, y, heading]`",
            Self::Points => "a list of at least three points `[x, y]`",
        }
    }
}

const fn key(name: &'static str, values: Values, summary: &'static str) -> Key {
    Key { name, values, required: false, summary, default: "", example: "" }
}

impl Key {
    const fn required(self) -> Self {
        Self { required: true, ..self }
    }

    const fn default(self, default: &'static str) -> Self {
        Self { default, ..self }
    }

    /// What there is to say of it, in Markdown.
    pub fn markdown(&self) -> String {
        let default =
            if self.required { "Required".to_owned() } else { format!("Default: {}", self.default) };
        let (name, words, example) = (self.name, self.values.words(), self.example);
        format!(
            "**`{name}`**: {words}\n\n{}\n\n{default}\n\nFor example `{name} = {example}`\n",
            self.summary
        )
    }

    const fn example(self, example: &'static str) -> Self {
        Self { example, ..self }
    }
}

const NAME: Key =
    key("name", Values::Name, "What it is called in messages and for clients of the remote API.")
        .default("the table's name and a number: `box_1`")
        .example("\"crate\"");

const AT: Key = key("at", Values::Point, "Where its middle stands.").required().example("[1.0, 0.5]");

const HEADING: Key = key("heading", Values::Angle, "How far it is turned about that, to the left.")
    .default("`0`")
    .example("30");

impl Table {
    /// As a file begins it.
    pub fn header(&self) -> String {
        match self.sort {
            Sort::Each => format!("[[{}]]", self.name),
            Sort::Once | Sort::Robot | Sort::Sensor => format!("[{}]", self.name),
        }
    }

    /// What there is to say of it, in Markdown.
    pub fn markdown(&self) -> String {
        let keys: Vec<String> =
            self.keys.iter().map(|key| format!("* `{}`: {}\n", key.name, key.summary)).collect();
        format!("**`{}`**\n\n{}\n\n{}", self.header(), self.summary, keys.concat())
    }
}

/// All tables.
pub const TABLES: [Table; 8] = [
    Table {
        name: "world",
        sort: Sort::Once,
        summary: "The floor, and what holds for everything on it.",
        keys: &[
            key("size", Values::Size, "How long the floor is along x and along y.")
                .default("without end")
                .example("[7.0, 7.7]"),
            key("corner", Values::Point, "Where the floor's corner with the least x and y is.")
                .default("so that the middle is at `[0, 0]`")
                .example("[0.0, 0.0]"),
            key("walls", Values::Flag, "Whether there are walls around a floor with a `size`.")
                .default("`true`")
                .example("false"),
            key(
                "collisions",
                Values::Flag,
                "Whether robots are stopped by what they touch; sensors see it either way.",
            )
            .default("`true`")
            .example("false"),
            key("seed", Values::Count, "What noise is made from: the same seed, the same run.")
                .default("`1`")
                .example("7"),
        ],
    },
    Table {
        name: "noise",
        sort: Sort::Once,
        summary: "What goes wrong in the world. Without this table nothing does; with it alone, as much as below. What is \
                  0 is off.",
        keys: &[
            key(
                "wheel-slip",
                Values::FromZero,
                "How much of the way that a wheel rolls is lost or gained on the floor: the standard deviation, in \
                 percent. It changes slowly, over about a second.",
            )
            .default("`2`")
            .example("5"),
            key("sensor", Values::FromZero, "How far readings of a distance are off: the standard deviation, in metres.")
                .default("`0.01`")
                .example("0.05"),
        ],
    },
    Table {
        name: "wall",
        sort: Sort::Each,
        summary: "A straight wall between two points.",
        keys: &[
            key("from", Values::Point, "Where the middle of one of its ends is.").required().example("[-1.0, 1.0]"),
            key("to", Values::Point, "Where the middle of its other end is.").required().example("[1.0, 1.5]"),
            key("thickness", Values::AboveZero, "How thick it is.").default("`0.1`").example("0.2"),
            NAME,
        ],
    },
    Table {
        name: "box",
        sort: Sort::Each,
        summary: "A rectangle.",
        keys: &[
            AT,
            key("size", Values::Size, "How long it is along its heading, and how wide across it.")
                .required()
                .example("[0.6, 0.4]"),
            HEADING,
            NAME,
        ],
    },
    Table {
        name: "cylinder",
        sort: Sort::Each,
        summary: "A circle.",
        keys: &[AT, key("radius", Values::AboveZero, "Its radius.").required().example("0.25"), NAME],
    },
    Table {
        name: "polygon",
        sort: Sort::Each,
        summary: "Any outline that does not cross itself.",
        keys: &[
            key("corners", Values::Points, "Its corners, in order either way round.")
                .required()
                .example("[[0.0, 1.0], [1.0, 1.0], [0.2, 2.0]]"),
            NAME,
        ],
    },
    Table {
        name: "robots.NAME",
        sort: Sort::Robot,
        summary: "A robot of the program.",
        keys: &[
            key("start", Values::Pose, "Where it starts.")
                .default("`[0, 0, 0]`, the next one a metre to its right, and so on")
                .example("[0.5, -0.5, 90]"),
            key("body", Values::Size, "Its outer length and width.")
                .default("`[0.30, 0.30]` with two wheels, `[0.36, 0.30]` with four")
                .example("[0.5, 0.4]"),
            key("track", Values::AboveZero, "How far its left and right wheels are apart.")
                .default("`0.30`")
                .example("0.35"),
            key("wheelbase", Values::AboveZero, "How far its front and rear wheels are apart.")
                .default("`0.25`")
                .example("0.2"),
            key(
                "grip",
                Values::Share,
                "What wheels hold across the direction they drive in, as a share of what they hold along it. Four wheels \
                 with grip scrub in turns: the robot turns less than they do. Mecanum wheels with grip, whose rollers \
                 drag, lose speed sideways.",
            )
            .default("`1`, of mecanum wheels `0.05`")
            .example("0.5"),
            key("rim-speed", Values::AboveZero, "The most its motors can do, at the wheels' rims, per second.")
                .default("without end")
                .example("0.4"),
            key(
                "rim-acceleration",
                Values::AboveZero,
                "How fast its motors can change the speed of the wheels' rims, per second squared.",
            )
            .default("`1.0`")
            .example("0.7"),
        ],
    },
    Table {
        name: "robots.NAME.sensors.NAME",
        sort: Sort::Sensor,
        summary: "A proximity sensor of a robot. One that is not placed sits where its name says: f… ahead, l… left, \
                  r… right, b… behind, any other one somewhere in front.",
        keys: &[
            key("at", Values::Point, "Where it sits, ahead and to the left of the robot's middle.")
                .default("by its name")
                .example("[0.1, 0.05]"),
            key("bearing", Values::Angle, "Where it looks: 0 is ahead, 90 left.")
                .default("by its name")
                .example("-45"),
            key("range", Values::AboveZero, "How far it sees.")
                .default("`1.0`, of a bumper `0.05`")
                .example("2.5"),
            key("cone", Values::Opening, "How wide it looks.").default("`20`").example("30"),
        ],
    },
];

/// The tables of obstacles, which stand any number of times.
pub(crate) fn find(name: &str) -> Option<&'static Table> {
    TABLES.iter().find(|table| table.name == name)
}
