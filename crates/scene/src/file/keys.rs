//! The list of what a scene file can contain.

use pydslrep_kinematics::Drive;
use pydslrep_schema::{Key, Range, Refusal, Schema, Table, TableKind, Values, Word, key};

use crate::Frame;

/// Everything that a scene file can contain.
pub static SCHEMA: Schema = Schema {
    noun: "key",
    tables: &TABLES,
    // Larger numbers were written in another unit.
    largest: 1e6,
    too_large: "is beyond 1000 km, or not finite",
};

const TABLES: [Table; 10] = [
    Table {
        name: "world",
        kind: TableKind::Once,
        summary: "The floor, and what applies to everything on it.",
        keys: &[
            key("size", SIZE, "The size of the floor along x and y.")
                .default("unlimited")
                .example("[7.0, 7.7]"),
            key("corner", POINT, "The corner of the floor with the smallest x and y.")
                .default("the middle of the floor is at `[0, 0]`")
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
            key(
                "friction",
                Values::ABOVE_ZERO,
                "How well wheels grip the floor in MuJoCo: the coefficient of sliding friction, about 0.1 on ice. In the \
                 embedded simulator, wheels do not slide.",
            )
            .default("`0.8`")
            .example("0.3"),
            key("seed", COUNT, "The seed of noise: with the same seed, runs are the same.")
                .default("`1`")
                .example("7"),
        ],
    },
    Table {
        name: "noise",
        kind: TableKind::Once,
        summary: "Deviations from an ideal world, for all robots. Without this table there are none; with it, the defaults below apply. 0 \
                  switches one off.",
        keys: &[
            key(
                "wheel-slip",
                FROM_ZERO,
                "How much wheels slip: the standard deviation, in percent of the distance that they roll. Slip changes \
                 slowly, over about a second.",
            )
            .default("`2`")
            .example("5"),
            key(
                "track-error",
                ERROR,
                "How much wider than in the scene the track really is, in percent; narrower if negative. It does not change, \
                 and scripts do not know of it: by wheel odometry, turns seem wider by as much.",
            )
            .default("`0`")
            .example("1.5"),
            key(
                "radius-error",
                ERROR,
                "How much larger than in the program the radii of the wheels really are, in percent; smaller if negative. \
                 It does not change, and scripts do not know of it: by wheel odometry, distances seem shorter by as much.",
            )
            .default("`0`")
            .example("-1.5"),
            key("sensor", FROM_ZERO, "The error of measured distances: the standard deviation, in metres.")
                .default("`0.01`")
                .example("0.05"),
        ],
    },
    Table {
        name: "wall",
        kind: TableKind::Each,
        summary: "A straight wall between two points.",
        keys: &[
            key("from", POINT, "The middle of one of its ends.").required().example("[-1.0, 1.0]"),
            key("to", POINT, "The middle of its other end.").required().example("[1.0, 1.5]"),
            key("thickness", Values::ABOVE_ZERO, "Its thickness.").default("`0.1`").example("0.2"),
            HEIGHT,
            NAME,
        ],
    },
    Table {
        name: "box",
        kind: TableKind::Each,
        summary: "A rectangle.",
        keys: &[
            AT,
            key("size", SIZE, "Its length along its heading, and its width across it.")
                .required()
                .example("[0.6, 0.4]"),
            HEADING,
            HEIGHT,
            TRAJECTORY,
            REPEAT,
            NAME,
        ],
    },
    Table {
        name: "cylinder",
        kind: TableKind::Each,
        summary: "A circle.",
        keys: &[
            AT,
            key("radius", Values::ABOVE_ZERO, "Its radius.").required().example("0.25"),
            HEIGHT,
            TRAJECTORY,
            REPEAT,
            NAME,
        ],
    },
    Table {
        name: "polygon",
        kind: TableKind::Each,
        summary: "Any outline that does not cross itself.",
        keys: &[
            key("corners", POINTS, "Its corners, in order, in either direction.")
                .required()
                .example("[[0.0, 1.0], [1.0, 1.0], [0.2, 2.0]]"),
            HEIGHT,
            NAME,
        ],
    },
    Table {
        name: "robots.NAME",
        kind: TableKind::Named { owner: "the environment", noun: "robot" },
        summary: "A robot of the program.",
        keys: &[
            key("start", POSE, "Its pose at the start.")
                .default("`[0, 0, 0]`, each further robot a metre to the right")
                .example("[0.5, -0.5, 90]"),
            key("body", SIZE, "Its outer length and width.")
                .default(Drive::BODIES)
                .example("[0.5, 0.4]"),
            key("track", Values::ABOVE_ZERO, "The distance between its left and right wheels.")
                .default("`0.30`")
                .example("0.35"),
            key("wheelbase", Values::ABOVE_ZERO, "The distance between its front and rear wheels.")
                .default("`0.25`")
                .example("0.2"),
            key(
                "grip",
                SHARE,
                "The lateral friction of wheels, as a share of that along their rolling direction. Four wheels with \
                 grip scrub in turns: the robot turns less than they do. Mecanum wheels with grip, whose rollers drag, \
                 lose speed sideways.",
            )
            .default("`1`, for mecanum wheels `0.05`")
            .example("0.5"),
            key("rim-speed", Values::ABOVE_ZERO, "The maximum speed of its wheels' rims, per second.")
                .default("unlimited")
                .example("0.4"),
            key(
                "rim-acceleration",
                Values::ABOVE_ZERO,
                "The maximum acceleration of its wheels' rims, per second squared.",
            )
            .default("`1.0`")
            .example("0.7"),
            key(
                "motor-gain",
                Values::ABOVE_ZERO,
                "How strongly its motors hold their speed in MuJoCo: newtons at the wheels' rims for each metre per second \
                 that it is off.",
            )
            .default("`500`")
            .example("150"),
            key(
                "wheel-width",
                Values::ABOVE_ZERO,
                "The width of its wheels in MuJoCo, where wide ones turn less easily; mecanum wheels are as wide as their \
                 rollers.",
            )
            .default("`0.024`")
            .example("0.04"),
            key(
                "frame",
                Values::Words(&FRAMES),
                "How scripts see the object that has the robot's name. With any other than the default they cannot drive: \
                 to try what they say about such a model.",
            )
            .default("`\"ahead\"`")
            .example("\"x-up\""),
            key(
                "object",
                PATH,
                "Where its body is in CoppeliaSim's scene, if that has a name of its own: scripts and `doctor` look \
                 for it there.",
            )
            .default("by its name")
            .example("\"/PioneerP3DX\""),
        ],
    },
    Table {
        name: "robots.NAME.wheels.NAME",
        kind: TableKind::Named { owner: "robot", noun: "wheel" },
        summary: "A wheel of a robot.",
        keys: &[key(
            "object",
            PATH,
            "Where the joint of the wheel is in CoppeliaSim's scene, if that has a name of its own.",
        )
        .default("by its name")
        .example("\"/PioneerP3DX/leftMotor\"")],
    },
    Table {
        name: "robots.NAME.sensors.NAME",
        kind: TableKind::Named { owner: "robot", noun: "sensor" },
        summary: "A proximity sensor of a robot. Its default position depends on the first letter of its name: f… ahead, \
                  l… left, r… right, b… behind, any other in the front half.",
        keys: &[
            key("at", POINT, "Its position, ahead and to the left of the robot's middle.")
                .default("by its name")
                .example("[0.1, 0.05]"),
            key("bearing", ANGLE, "The direction it faces: 0 is ahead, 90 left.")
                .default("by its name")
                .example("-45"),
            key("range", Values::ABOVE_ZERO, "The greatest distance it measures.")
                .default("`1.0`, for a bumper `0.05`")
                .example("2.5"),
            key("cone", OPENING, "The opening angle of its cone.").default("`20`").example("30"),
            key(
                "object",
                PATH,
                "Where the sensor is in CoppeliaSim's scene, if that has a name of its own.",
            )
            .default("by its name")
            .example("\"/PioneerP3DX/ultrasonicSensor[4]\""),
        ],
    },
    Table {
        name: "robots.NAME.ros2",
        kind: TableKind::Once,
        summary: "What a robot's driver is like in ROS 2: for scripts of the target `ros2` and for `pydslrep sim --ros2`. \
                  Names of topics are relative to the `namespace` unless they begin with `/`.",
        keys: &[
            key("namespace", NAMESPACE, "Where its topics are; `/` is for those without a namespace.")
                .default("`/` and its name")
                .example("\"/\""),
            key("cmd-vel", TOPIC, "Where it takes commands: `geometry_msgs/Twist`.")
                .default("`\"cmd_vel\"`")
                .example("\"diff_drive/cmd_vel\""),
            key(
                "stamped",
                Values::Flag,
                "Whether commands are `geometry_msgs/TwistStamped`, as `diff_drive_controller` takes them from Jazzy on.",
            )
            .default("`false`")
            .example("true"),
            key("odom", TOPIC, "Where its poses come from: `nav_msgs/Odometry`.")
                .default("`\"odom\"`")
                .example("\"odometry/filtered\""),
            key(
                "pose",
                TOPIC,
                "Where its poses come from in place of odometry: `geometry_msgs/PoseWithCovarianceStamped`, as \
                 localisation publishes it.",
            )
            .default("by `odom`")
            .example("\"/amcl_pose\""),
            key(
                "ranges",
                TEMPLATE,
                "Where the readings of its sensors come from: `sensor_msgs/Range`, with the name of a sensor in place of \
                 `{sensor}`.",
            )
            .default("`\"range/{sensor}\"`")
            .example("\"ir/{sensor}\""),
            key(
                "scan",
                TOPIC,
                "A `sensor_msgs/LaserScan` of which its sensors are sectors, by their `bearing`, `cone` and `range`: for \
                 robots that have no others.",
            )
            .default("sensors have topics of their own")
            .example("\"scan\""),
            key("base-frame", FRAME, "The frame of its wheels' centre, for commands with a stamp and for `sim --ros2`.")
                .default("`\"base_link\"`")
                .example("\"base_footprint\""),
            key("odom-frame", FRAME, "The frame of its odometry, for `sim --ros2`.")
                .default("`\"odom\"`")
                .example("\"rover/odom\""),
            key(
                "qos",
                Values::Words(&QOS),
                "How its readings are asked for. With the default, scripts also hear publishers that are reliable.",
            )
            .default("`\"best-effort\"`")
            .example("\"reliable\""),
            key(
                "track",
                Values::ABOVE_ZERO,
                "The distance between its left and right wheels, for the speed of its turns.",
            )
            .default("that of the robot")
            .example("0.287"),
            key(
                "speed-limit",
                Values::ABOVE_ZERO,
                "The greatest speed that scripts command, per second: that of the rims of its wheels.",
            )
            .default("`0.5`")
            .example("0.22"),
        ],
    },
];

const NAME: Key = key("name", TEXT, "Its name in messages and for clients of the remote API.")
    .default("the table's name and a number: `box_1`")
    .example("\"crate\"");

const AT: Key = key("at", POINT, "Its middle.").required_unless("path").example("[1.0, 0.5]");

const TRAJECTORY: Key = key(
    "path",
    WAYPOINTS,
    "Where its middle is at which time: `t` is in seconds since the start of the simulation, from 0, and grows. Between two \
     points it moves straight; before the first and after the last it stands still.",
)
.default("it does not move")
.example("[[0.0, 1.0, 0.5], [20.0, 1.0, 2.5]]");

const REPEAT: Key = key(
    "repeat",
    Values::Flag,
    "Whether it goes back to the first point of its `path` in the same times, and there and back again and again.",
)
.default("`false`")
.example("true");

const HEADING: Key =
    key("heading", ANGLE, "Its rotation about its middle, counter-clockwise.").default("`0`").example("30");

const HEIGHT: Key =
    key("height", Values::ABOVE_ZERO, "Its height in MuJoCo, where sensors look over what is low.")
        .default("`0.5`")
        .example("0.1");

const FRAMES: [Word; 5] = [
    Word { word: Frame::Ahead.word(), summary: "x ahead, y to the left, z up" },
    Word { word: Frame::XUp.word(), summary: "x up, y to the left, z behind" },
    Word { word: Frame::XLeft.word(), summary: "x to the left, y behind, z up" },
    Word { word: Frame::ZAhead.word(), summary: "x down, y to the left, z ahead" },
    Word { word: Frame::Static.word(), summary: "stays at the start; what moves is below it" },
];

const QOS: [Word; 2] = [
    Word { word: "best-effort", summary: "what is lost is not sent again, as drivers of sensors do" },
    Word { word: "reliable", summary: "what is lost is sent again; publishers must be reliable, too" },
];

const COUNT: Values = Values::Number(
    "a whole number from 0",
    Range { max: 4_294_967_295.0, is_whole: true, ..Range::FROM_ZERO },
);
const FROM_ZERO: Values = Values::Number("a number from 0", Range::FROM_ZERO);
const SHARE: Values = Values::Number("a number from 0 to 1", Range { max: 1.0, ..Range::FROM_ZERO });
const ERROR: Values =
    Values::Number("a number from -50 to 50", Range { min: -50.0, max: 50.0, ..Range::ANY });
const ANGLE: Values = Values::Number("an angle in degrees", Range::ANY);
const OPENING: Values =
    Values::Number("an angle above 0 and up to 180 degrees", Range { max: 180.0, ..Range::ABOVE_ZERO });
const POINT: Values = Values::Numbers("a point `[x, y]`", Range::ANY, (2, 2));
const SIZE: Values = Values::Numbers("a size `[length, width]`, both above zero", Range::ABOVE_ZERO, (2, 2));
const POSE: Values = Values::Numbers("a pose `[x, y, heading]`", Range::ANY, (2, 3));
const POINTS: Values = Values::Rows("a list of at least three points `[x, y]`", 3, 2);
const WAYPOINTS: Values = Values::Rows("a list of at least one `[t, x, y]`", 1, 3);
const PATH: Values = Values::Text("the path of an object", r"^(/[^/]*[^/\s][^/]*)+$", path);
const NAMESPACE: Values = Values::Text("a namespace", r"^/?([A-Za-z_]\w*(/[A-Za-z_]\w*)*)?$", namespace);
const TOPIC: Values = Values::Text("the name of a topic", r"^/?[A-Za-z_]\w*(/[A-Za-z_]\w*)*$", topic);
const TEMPLATE: Values =
    Values::Text("the name of topics", r"^/?[A-Za-z_{][\w{}]*(/[A-Za-z_{][\w{}]*)*$", template);
const FRAME: Values = Values::Text("the name of a frame", r"^\S+$", frame);
const TEXT: Values = Values::Text("a string", r"^[^/]*\S[^/]*$", name);

/// A text that is its own canonical form, if it is valid.
fn accepted(text: &str, is_valid: bool, complaint: &str) -> Result<String, Refusal> {
    if is_valid { Ok(text.to_owned()) } else { Err(complaint.to_owned().into()) }
}

/// A path from the top of the scene, as in CoppeliaSim: `/PioneerP3DX/leftMotor`.
fn path(text: &str) -> Result<String, Refusal> {
    let is_name = |name: &str| !name.trim().is_empty() && !name.contains(char::is_control);
    let is_path = text.strip_prefix('/').is_some_and(|names| names.split('/').all(is_name));
    accepted(text, is_path, "must be a path of names, each after a `/`")
}

const NOT_A_TOPIC: &str = "must consist of letters, digits and `_`, with `/` between names";

/// Names of topics, as ROS 2 takes them: letters, digits and `_`, none of which begins with a digit.
fn is_topic(text: &str) -> bool {
    let is_token = |token: &str| {
        token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && token.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    text.strip_prefix('/').unwrap_or(text).split('/').all(is_token)
}

fn topic(text: &str) -> Result<String, Refusal> {
    accepted(text, is_topic(text), NOT_A_TOPIC)
}

fn template(text: &str) -> Result<String, Refusal> {
    accepted(text, is_topic(&text.replace("{sensor}", "sensor")), NOT_A_TOPIC)
}

/// In its canonical form, a namespace begins with `/`.
fn namespace(text: &str) -> Result<String, Refusal> {
    match text.strip_prefix('/').unwrap_or(text) {
        "" => Ok("/".to_owned()),
        name if is_topic(name) && !name.starts_with('/') => Ok(format!("/{name}")),
        _ => Err(NOT_A_TOPIC.to_owned().into()),
    }
}

fn frame(text: &str) -> Result<String, Refusal> {
    let is_valid = !text.is_empty() && !text.chars().any(|c| c.is_whitespace() || c.is_control());
    accepted(text, is_valid, "must not be empty, and must not contain spaces")
}

/// Clients of the remote API address objects by paths with `/`.
fn name(text: &str) -> Result<String, Refusal> {
    let is_valid = !text.trim().is_empty() && !text.contains('/') && !text.chars().any(char::is_control);
    accepted(text, is_valid, "must not be empty, and must not contain `/` or line breaks")
}
