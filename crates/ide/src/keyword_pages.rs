//! The reference pages of the keywords, shown by completion and hover.

use pydslrep_syntax::{EntityKind, TokenKind};

/// The page of a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeywordPage {
    /// Its syntax, one line per form: keywords verbatim, placeholders in capitals, `[…]` around optional parts, `|` between
    /// alternatives.
    pub syntax: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
    /// An example.
    pub example: &'static str,
}

impl KeywordPage {
    /// The page as Markdown.
    pub fn markdown(&self) -> String {
        format!("```pydslrep\n{}\n```\n{}\n\n```pydslrep\n{}\n```", self.syntax, self.meaning, self.example)
    }
}

const ROBOT: &str = "robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }";
const SENSORS: &str = "with sensors { SENSORS }";
const ENVIRONMENT: &str = "environment area has { rover } robots with { patrol } moves";
const ROBOT_SHAPE: &str =
    "robot NAME [type tw | fw | fwh] with port PORT has { WHEELS } wheels [with sensors { SENSORS }]";
const MOVEMENT_SHAPE: &str = "[parallel] movement NAME of ROBOT { ACTIONS }";
const ENVIRONMENT_SHAPE: &str =
    "environment NAME [with ip IP] has { ROBOTS } robots [with { MOVEMENTS } moves]";
const MOVE: &str = "move DISTANCE meters | centimeters [at SPEED]";
const REVERSE: &str =
    "turn left | right [DEGREES] with radius DISTANCE meters | centimeters [at SPEED] in reverse";
const TYPE: &str = "type tw | fw | fwh";

/// The form of a condition.
macro_rules! condition {
    () => {
        "{ SENSORS } clear | detect [within DISTANCE meters | centimeters]"
    };
}

/// The form of a turn, with what may follow `left` or `right`.
macro_rules! turn {
    () => {
        "turn left | right [DEGREES] [with radius DISTANCE meters | centimeters] [at SPEED] [in reverse]"
    };
}

/// The page of a keyword; `None` for other tokens.
#[expect(clippy::too_many_lines, reason = "a table with one row per keyword")]
pub fn keyword_page(token: TokenKind) -> Option<KeywordPage> {
    let page = |syntax, meaning, example| KeywordPage { syntax, meaning, example };
    Some(match token {
        TokenKind::Wheel => page(
            EntityKind::Wheel.shape(),
            "A standard wheel, with its radius in centimetres. Several robots may use it; each gets a joint of that name.",
            "wheel wheelL with radius 4.5",
        ),
        TokenKind::WheelH => page(
            "wheelH NAME with radius CENTIMETRES",
            "A mecanum wheel, with rollers at 45°: a robot with four of them can drive sideways.",
            "wheelH frontLeft with radius 5.0",
        ),
        TokenKind::With => {
            page("with …", "Adds a clause: a radius, a port, sensors, an ip or movements.", ROBOT)
        }
        TokenKind::Radius => page(
            "with radius CENTIMETRES\nturn left | right [DEGREES] with radius DISTANCE meters | centimeters",
            "The wheel's radius in centimetres, or the radius of the circle that a robot turns on.",
            "wheel wheelL with radius 4.5",
        ),
        TokenKind::Sensor => page(
            "sensor NAME [: distance | bumper]",
            "A proximity sensor: `distance` (the default) detects obstacles ahead, `bumper` on contact.",
            "sensor front : distance",
        ),
        TokenKind::Ip => page(
            EntityKind::Ip.shape(),
            "The address of the simulator's machine; the default is this machine.",
            "ip lab 192.168.0.7\nenvironment area with ip lab has { rover } robots",
        ),
        TokenKind::Robot => page(
            ROBOT_SHAPE,
            "A robot. List its wheels as left, right or as left front, left rear, right front, right rear.",
            ROBOT,
        ),
        TokenKind::Type => page(TYPE, "The drive type; the default follows from the wheels.", ROBOT),
        TokenKind::Tw => page(TYPE, "Two-wheel differential drive: two `wheel`, listed left, right.", ROBOT),
        TokenKind::Fw => page(
            TYPE,
            "Four-wheel skid-steer drive: four `wheel`, listed left front, left rear, right front, right rear.",
            "robot truck type fw with port 23000 has { lf lr rf rr } wheels",
        ),
        TokenKind::Fwh => page(
            TYPE,
            "Mecanum drive: four `wheelH`, listed left front, left rear, right front, right rear.",
            "robot crab type fwh with port 23000 has { lf lr rf rr } wheels",
        ),
        TokenKind::Port => {
            page("with port NUMBER", "The port of the simulator's remote API, from 1 to 65535.", ROBOT)
        }
        TokenKind::Has => {
            page("has { … }", "Lists the wheels of a robot or the robots of an environment.", ENVIRONMENT)
        }
        TokenKind::Wheels => page("has { WHEELS } wheels", "Ends the wheel list of a robot.", ROBOT),
        TokenKind::Sensors => page(SENSORS, "Lists the sensors of a robot.", ROBOT),
        TokenKind::Parallel => page(
            MOVEMENT_SHAPE,
            "Parallel movements next to each other in an environment's list start together.",
            "parallel movement patrol of rover {\n  move 4.0 meters\n}",
        ),
        TokenKind::Movement => page(
            MOVEMENT_SHAPE,
            "A sequence of actions for one robot.",
            "movement patrol of rover {\n  move 4.0 meters\n  turn left\n}",
        ),
        TokenKind::Of => page(
            "movement NAME of ROBOT",
            "Names the robot of a movement.",
            "movement patrol of rover { slam }",
        ),
        TokenKind::Move => page(
            concat!(
                "move DISTANCE meters | centimeters [at SPEED]\n",
                "move [DISTANCE meters | centimeters] [at SPEED] until ",
                condition!()
            ),
            "Drives straight ahead, or backwards if the distance is negative. The speed is in centimetres per second and defaults to 9.0. With `until` it ends early, and without a distance it fails after 100 m.",
            "move 4.0 meters at 12.5",
        ),
        TokenKind::Meters => page(MOVE, "The distance is in metres.", "move 4.0 meters"),
        TokenKind::Centimeters => {
            page("move DISTANCE centimeters", "The distance is in centimetres.", "move 40 centimeters")
        }
        TokenKind::At => page(
            MOVE,
            "The rim speed of the fastest wheel in centimetres per second.",
            "move 4.0 meters at 12.5",
        ),
        TokenKind::Turn => page(
            concat!(turn!(), "\nturn left | right until { SENSORS }\n", turn!(), " until ", condition!()),
            "Turns in place, or on a circle of the given radius, by 90° unless an angle is given; `left` is counter-clockwise seen from above. With `until` it ends early, and without an angle it fails after 360°.",
            "turn left 45\nturn left 90 with radius 1.5 meters",
        ),
        TokenKind::Left => page("turn left DEGREES", "Counter-clockwise seen from above.", "turn left 45"),
        TokenKind::Right => page("turn right DEGREES", "Clockwise seen from above.", "turn right 45"),
        TokenKind::Until => page(
            concat!("until ", condition!(), "\nturn left | right until { SENSORS }"),
            "Ends the action as soon as the condition holds, at once if it does at the start; `repeat until` asks before each round. A turn without `clear` or `detect` turns until no listed sensor detects an obstacle.",
            "turn right until { front }\nmove 3 meters until { front } detect",
        ),
        TokenKind::Wait => page(
            concat!("wait SECONDS seconds\nwait [SECONDS seconds] until ", condition!()),
            "Holds the robot for a time, or until the condition holds. Without a time it fails after 600 s.",
            "wait 2 seconds\nwait until { front } clear",
        ),
        TokenKind::Seconds => page("wait SECONDS seconds", "The time is in seconds.", "wait 2.5 seconds"),
        TokenKind::Repeat => page(
            concat!("repeat COUNT times { ACTIONS }\nrepeat until ", condition!(), " { ACTIONS }"),
            "Does its actions a number of times, or until the condition holds, which it asks before each round. `repeat until` fails after 10 000 rounds.",
            "repeat 4 times {\n  move 1 meters\n  turn left\n}",
        ),
        TokenKind::Times => page(
            "repeat COUNT times { ACTIONS }",
            "Ends the number of rounds, a whole number from 1 to 10 000.",
            "repeat 4 times { turn left 45 }",
        ),
        TokenKind::If => page(
            concat!("if ", condition!(), " { ACTIONS } [else { ACTIONS }]"),
            "Does its actions if the condition holds, and those after `else` if it does not. It takes no time.",
            "if { front } detect {\n  turn left\n} else {\n  move 1 meters\n}",
        ),
        TokenKind::Else => page(
            concat!("else { ACTIONS }\nelse if ", condition!(), " { ACTIONS }"),
            "What is done if the condition of the `if` before it does not hold; perhaps another `if`.",
            "if { front } clear {\n  move 1 meters\n} else {\n  turn left\n}",
        ),
        TokenKind::Do => page(
            "do MOVEMENT",
            "Does another movement of the same robot, which the environment need not list.",
            "do side",
        ),
        TokenKind::In => page(
            REVERSE,
            "Begins `in reverse`: on its circle, the robot drives backwards.",
            "turn left 90 with radius 1 meters in reverse",
        ),
        TokenKind::Reverse => page(
            REVERSE,
            "On its circle, the robot drives backwards, still to the given side: `left` is counter-clockwise.",
            "turn left 90 with radius 1 meters in reverse",
        ),
        TokenKind::Clear => page(
            "{ SENSORS } clear [within DISTANCE meters | centimeters]",
            "The condition holds while none of its sensors detects an obstacle.",
            "wait until { front } clear",
        ),
        TokenKind::Detect => page(
            "{ SENSORS } detect [within DISTANCE meters | centimeters]",
            "The condition holds while at least one of its sensors detects an obstacle.",
            "move 3 meters until { front } detect",
        ),
        TokenKind::Within => page(
            condition!(),
            "Only what is nearer to the sensor than this distance counts.",
            "wait until { front } clear within 60 centimeters",
        ),
        TokenKind::Slam => page(
            "slam",
            "Explores and maps a closed area autonomously. Requires a two-wheel robot with at least five distance sensors.",
            "movement explore of rover { slam }",
        ),
        TokenKind::Environment => page(
            ENVIRONMENT_SHAPE,
            "The robots of a run and their movements in order. Each environment generates one script.",
            ENVIRONMENT,
        ),
        TokenKind::Robots => {
            page("has { ROBOTS } robots", "Ends the robot list of an environment.", ENVIRONMENT)
        }
        TokenKind::Moves => {
            page("with { MOVEMENTS } moves", "Ends the movement list of an environment.", ENVIRONMENT)
        }
        TokenKind::Distance => {
            page("sensor NAME : distance", "Detects obstacles ahead.", "sensor front : distance")
        }
        TokenKind::Bumper => {
            page("sensor NAME : bumper", "Detects an obstacle on contact.", "sensor nose : bumper")
        }
        TokenKind::Import => page(
            "import \"FILE.pyr\"",
            "Makes the declarations of another file visible. The path is relative to this file.",
            "import \"parts/wheels.pyr\"",
        ),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::motion::RIM_SPEED;
    use pydslrep_syntax::KEYWORDS;
    use pydslrep_syntax::ast::Drive;

    use super::*;

    #[test]
    fn the_pages_of_types_say_what_their_rows_do() {
        let words = Drive::ALL.map(Drive::word).join(" | ");
        assert_eq!(TYPE, format!("type {words}"));
        assert!(ROBOT_SHAPE.contains(&format!("[{TYPE}]")), "{ROBOT_SHAPE}");
        for token in TokenKind::DRIVES {
            let row = token.drive().unwrap().row();
            let wheel = if row.mecanum { "wheelH" } else { "wheel" };
            let meaning = format!("{}: {} `{wheel}`, listed {}.", row.label, row.count, row.order());
            assert_eq!(keyword_page(token).unwrap().meaning, meaning);
            assert!(keyword_page(token).unwrap().example.contains(&format!("type {}", row.word)));
        }
    }

    #[test]
    fn the_default_speed_is_that_of_plans() {
        let page = keyword_page(TokenKind::Move).unwrap();
        assert!(page.meaning.contains(&format!("defaults to {:?}.", RIM_SPEED * 100.0)), "{}", page.meaning);
    }

    #[test]
    fn every_keyword_has_a_page_that_uses_it() {
        for (token, word) in KEYWORDS {
            let page = keyword_page(token).unwrap_or_else(|| panic!("`{word}` has no page"));
            let uses =
                |text: &str| text.split(|c: char| !c.is_ascii_alphanumeric()).any(|other| other == word);
            assert!(uses(page.syntax) || uses(page.example), "the page of `{word}` does not show it");
        }
    }
    #[test]
    fn every_example_parses() {
        for (token, word) in KEYWORDS {
            let example = keyword_page(token).unwrap().example;
            let begins = pydslrep_syntax::lex(example)[0].0;
            let text = if TokenKind::DECLARATIONS.contains(&begins) {
                example.to_owned()
            } else {
                format!("movement m of r {{ {example} }}")
            };
            for (_, parse) in pydslrep_syntax::parse(&text) {
                assert_eq!(parse.errors, [], "the example of `{word}`");
            }
        }
    }
}
