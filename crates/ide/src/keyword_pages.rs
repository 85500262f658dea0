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
const TYPE: &str = "type tw | fw | fwh";

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
            "with radius CENTIMETRES",
            "The wheel's radius in centimetres.",
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
            MOVE,
            "Drives straight ahead, or backwards if the distance is negative. The speed is in centimetres per second and defaults to 9.0.",
            "move 4.0 meters at 12.5",
        ),
        TokenKind::Meters => page(MOVE, "The distance is in metres.", "move 4.0 meters"),
        TokenKind::Centimeters => {
            page("move DISTANCE centimeters", "The distance is in centimetres.", "move 40 centimeters")
        }
        TokenKind::At => {
            page(MOVE, "The rim speed of the wheels in centimetres per second.", "move 4.0 meters at 12.5")
        }
        TokenKind::Turn => page(
            "turn left | right [DEGREES]\nturn left | right until { SENSORS }",
            "Turns in place, by 90° unless an angle is given; `left` is counter-clockwise seen from above.",
            "turn left 45",
        ),
        TokenKind::Left => page("turn left DEGREES", "Counter-clockwise seen from above.", "turn left 45"),
        TokenKind::Right => page("turn right DEGREES", "Clockwise seen from above.", "turn right 45"),
        TokenKind::Until => page(
            "turn left | right until { SENSORS }",
            "Turns until no listed sensor detects an obstacle; not at all if none does at the start.",
            "turn right until { front }",
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
            let count = ["two", "four"][usize::from(row.wheels.len() == 4)];
            let wheel = if row.mecanum { "wheelH" } else { "wheel" };
            let meaning = format!("{}: {count} `{wheel}`, listed {}.", row.label, row.order());
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
}
