//! The reference of the language's words, as completion and hover show it.

use pydslrep_syntax::{EntityKind, TokenKind};

/// What there is to say of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeywordPage {
    /// How it is used, a line for each way: words as they are, what a person fills in in capitals, `[…]` around what may
    /// be left out, `|` between words to choose from.
    pub syntax: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// A piece of a program with it.
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

/// The page of a word; `None` for what is no word of the language.
#[expect(clippy::too_many_lines, reason = "a table, a row a word")]
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
            "A mecanum wheel: its rollers stand at 45°, so that four of them can drive a robot sideways.",
            "wheelH frontLeft with radius 5.0",
        ),
        TokenKind::With => {
            page("with …", "Adds a part: a radius, a port, sensors, an ip or movements.", ROBOT)
        }
        TokenKind::Radius => page(
            "with radius CENTIMETRES",
            "The wheel's radius in centimetres.",
            "wheel wheelL with radius 4.5",
        ),
        TokenKind::Sensor => page(
            "sensor NAME [: distance | bumper]",
            "A proximity sensor. `distance` (also where nothing is written) sees an obstacle ahead of it, `bumper` feels one.",
            "sensor front : distance",
        ),
        TokenKind::Ip => page(
            EntityKind::Ip.shape(),
            "The address of the machine the simulator runs on. Without one it is this machine.",
            "ip lab 192.168.0.7\nenvironment area with ip lab has { rover } robots",
        ),
        TokenKind::Robot => page(
            ROBOT_SHAPE,
            "A robot: its wheels in the order left, right, or left front, left rear, right front, right rear.",
            ROBOT,
        ),
        TokenKind::Type => page(TYPE, "How the robot drives. Without it the wheels tell.", ROBOT),
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
        TokenKind::Has => page("has { … }", "What a robot or an environment is made of.", ENVIRONMENT),
        TokenKind::Wheels => page("has { WHEELS } wheels", "Ends the list of a robot's wheels.", ROBOT),
        TokenKind::Sensors => page(SENSORS, "The sensors a robot carries.", ROBOT),
        TokenKind::Parallel => page(
            MOVEMENT_SHAPE,
            "Parallel movements that are next to each other in an environment's list start together.",
            "parallel movement patrol of rover {\n  move 4.0 meters\n}",
        ),
        TokenKind::Movement => page(
            MOVEMENT_SHAPE,
            "What one robot does, action by action.",
            "movement patrol of rover {\n  move 4.0 meters\n  turn left\n}",
        ),
        TokenKind::Of => {
            page("movement NAME of ROBOT", "Whose movement it is.", "movement patrol of rover { slam }")
        }
        TokenKind::Move => page(
            MOVE,
            "Straight ahead along the heading; a negative distance drives backwards. The speed is in centimetres per second, 9.0 where nothing is written.",
            "move 4.0 meters at 12.5",
        ),
        TokenKind::Meters => page(MOVE, "The distance is in metres.", "move 4.0 meters"),
        TokenKind::Centimeters => {
            page("move DISTANCE centimeters", "The distance is in centimetres.", "move 40 centimeters")
        }
        TokenKind::At => {
            page(MOVE, "The speed at the wheels' rim in centimetres per second.", "move 4.0 meters at 12.5")
        }
        TokenKind::Turn => page(
            "turn left | right [DEGREES]\nturn left | right until { SENSORS }",
            "In place, by 90° where nothing is written; `left` is counter-clockwise seen from above.",
            "turn left 45",
        ),
        TokenKind::Left => page("turn left DEGREES", "Counter-clockwise seen from above.", "turn left 45"),
        TokenKind::Right => page("turn right DEGREES", "Clockwise seen from above.", "turn right 45"),
        TokenKind::Until => page(
            "turn left | right until { SENSORS }",
            "Turns until none of the sensors detects an obstacle; not at all if none does.",
            "turn right until { front }",
        ),
        TokenKind::Slam => page(
            "slam",
            "Explores a closed area on its own and maps it. Two-wheel robots with five distance sensors or more.",
            "movement explore of rover { slam }",
        ),
        TokenKind::Environment => page(
            ENVIRONMENT_SHAPE,
            "The robots of a run and their movements in order. Each environment becomes one script.",
            ENVIRONMENT,
        ),
        TokenKind::Robots => {
            page("has { ROBOTS } robots", "Ends the list of an environment's robots.", ENVIRONMENT)
        }
        TokenKind::Moves => {
            page("with { MOVEMENTS } moves", "Ends the list of an environment's movements.", ENVIRONMENT)
        }
        TokenKind::Distance => {
            page("sensor NAME : distance", "Sees an obstacle ahead of it.", "sensor front : distance")
        }
        TokenKind::Bumper => {
            page("sensor NAME : bumper", "Feels an obstacle at contact.", "sensor nose : bumper")
        }
        TokenKind::Import => page(
            "import \"FILE.pyr\"",
            "Makes the entities of another file visible, by its path relative to this one.",
            "import \"parts/wheels.pyr\"",
        ),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use pydslrep_syntax::KEYWORDS;

    use super::*;

    #[test]
    fn every_word_has_a_page_that_uses_it() {
        for (token, word) in KEYWORDS {
            let page = keyword_page(token).unwrap_or_else(|| panic!("`{word}` has no page"));
            let uses =
                |text: &str| text.split(|c: char| !c.is_ascii_alphanumeric()).any(|other| other == word);
            assert!(uses(page.syntax) || uses(page.example), "the page of `{word}` does not show it");
        }
    }
}
