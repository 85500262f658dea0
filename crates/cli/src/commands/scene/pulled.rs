//! The scene read from a simulator, as a program and as a scene file.

use std::collections::BTreeMap;
use std::fmt::Write;

use pydslrep_kinematics::{Drive, heading_degrees};
use pydslrep_scene::geometry_of;
use pydslrep_syntax::escape;
use serde::Deserialize;

/// A scene: `SceneDescription` of the package that scripts import. Metres and radians.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Pulled {
    pub(super) robots: Vec<Robot>,
    pub(super) obstacles: Vec<Obstacle>,
    /// The parts that cannot be written as a program.
    #[serde(skip)]
    pub(super) unclear: Vec<String>,
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct Robot {
    name: String,
    #[serde(rename = "type")]
    drive: String,
    x: f64,
    y: f64,
    heading: f64,
    length: f64,
    width: f64,
    grip: f64,
    rim_speed: Option<f64>,
    rim_acceleration: f64,
    wheels: Vec<Wheel>,
    sensors: Vec<Sensor>,
}

#[derive(Debug, Clone, Deserialize)]
struct Wheel {
    name: String,
    radius: f64,
    x: f64,
    y: f64,
}

#[derive(Debug, Clone, Deserialize)]
struct Sensor {
    name: String,
    kind: String,
    x: f64,
    y: f64,
    bearing: f64,
    range: f64,
    cone: f64,
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct Obstacle {
    name: String,
    x: f64,
    y: f64,
    heading: f64,
    size: Option<[f64; 2]>,
    radius: Option<f64>,
    corners: Vec<[f64; 2]>,
}

impl Robot {
    /// The keyword that declares its wheels.
    fn wheel_keyword(&self) -> &'static str {
        let is_mecanum = Drive::from_word(&self.drive).is_some_and(|drive| drive.row().mecanum);
        if is_mecanum { "wheelH" } else { "wheel" }
    }
}

impl Pulled {
    /// Without the robots that share a name, or the name of a wheel or sensor of another kind, with an earlier one: in a
    /// program a name stands for one thing.
    pub(super) fn with_distinct_wheels(mut self) -> Self {
        let mut known: BTreeMap<String, String> = BTreeMap::new();
        let mut robots: Vec<Robot> = Vec::new();
        for robot in self.robots {
            let wheel = robot.wheel_keyword();
            let wheels = robot.wheels.iter().map(|part| {
                (format!("wheel {}", part.name), format!("{wheel} {}", number(100.0 * part.radius)))
            });
            let sensors =
                robot.sensors.iter().map(|part| (format!("sensor {}", part.name), part.kind.clone()));
            let parts: Vec<(String, String)> = wheels.chain(sensors).collect();
            let clash = parts.iter().find(|(name, what)| known.get(name).is_some_and(|known| known != what));
            if let Some((name, _)) = clash {
                self.unclear.push(format!(
                    "{name} of {} differs from that of another robot: rename one of them; it is left out",
                    robot.name
                ));
            } else if robots.iter().any(|other| other.name == robot.name) {
                self.unclear.push(format!("there is another robot {}: it is left out", robot.name));
            } else {
                known.extend(parts);
                robots.push(robot);
            }
        }
        self.robots = robots;
        self
    }
}

/// The starter program: each robot drives a little.
pub(super) fn program_text(scene: &Pulled, environment: &str, port: u16) -> String {
    let mut text =
        "// Read out of CoppeliaSim. A wheel's name is that of its joint; radii are in centimetres.\n"
            .to_owned();
    let mut declared: Vec<String> = Vec::new();
    for robot in &scene.robots {
        let wheel = robot.wheel_keyword();
        let wheels = robot.wheels.iter().map(|part| {
            format!("{wheel} {} with radius {}\n", escape(&part.name), number(100.0 * part.radius))
        });
        let sensors = robot.sensors.iter().map(|part| {
            let kind = if part.kind == "bumper" { " : bumper" } else { "" };
            format!("sensor {}{kind}\n", escape(&part.name))
        });
        for line in wheels.chain(sensors) {
            if !declared.contains(&line) {
                text += &line;
                declared.push(line);
            }
        }
    }
    let list = |names: &mut dyn Iterator<Item = &String>| {
        names.map(|name| escape(name)).collect::<Vec<_>>().join(" ")
    };
    let mut movements = Vec::new();
    for robot in &scene.robots {
        let name = escape(&robot.name);
        let wheels = list(&mut robot.wheels.iter().map(|wheel| &wheel.name));
        let _ =
            write!(text, "\nrobot {name} type {} with port {port} has {{ {wheels} }} wheels", robot.drive);
        if !robot.sensors.is_empty() {
            let sensors = list(&mut robot.sensors.iter().map(|sensor| &sensor.name));
            let _ = write!(text, " with sensors {{ {sensors} }}");
        }
        let movement = format!("first_move_of_{}", robot.name);
        let _ = write!(text, "\n\nmovement {movement} of {name} {{\n  move 10 centimeters\n}}\n");
        movements.push(movement);
    }
    let robots = list(&mut scene.robots.iter().map(|robot| &robot.name));
    let _ = write!(
        text,
        "\nenvironment {} has {{ {robots} }} robots with {{ {} }} moves\n",
        escape(environment),
        movements.join(" ")
    );
    text
}

/// The scene file.
pub(super) fn scene_text(scene: &Pulled) -> String {
    let mut text = "# Read out of CoppeliaSim. Metres and degrees.\n".to_owned();
    for obstacle in &scene.obstacles {
        let table = match obstacle {
            Obstacle { size: Some(_), .. } => "box",
            Obstacle { radius: Some(_), .. } => "cylinder",
            _ => "polygon",
        };
        let _ = write!(text, "\n[[{table}]]\nname = {}\n", quoted(&obstacle.name));
        if let Some(size) = obstacle.size {
            let _ = writeln!(text, "at = {}\nsize = {}", pair([obstacle.x, obstacle.y]), pair(size));
            let _ = writeln!(text, "heading = {}", heading(obstacle.heading));
        } else if let Some(radius) = obstacle.radius {
            let _ = writeln!(text, "at = {}\nradius = {}", pair([obstacle.x, obstacle.y]), number(radius));
        } else {
            let (sin, cos) = obstacle.heading.sin_cos();
            let corners = obstacle
                .corners
                .iter()
                .map(|[x, y]| pair([obstacle.x + x * cos - y * sin, obstacle.y + x * sin + y * cos]));
            let _ = writeln!(text, "corners = [{}]", corners.collect::<Vec<_>>().join(", "));
        }
    }
    for robot in &scene.robots {
        robot_table(&mut text, robot);
    }
    text
}

fn robot_table(text: &mut String, robot: &Robot) {
    let _ = writeln!(
        text,
        "\n[robots.{}]\nstart = [{}, {}, {}]\nbody = {}",
        robot.name,
        number(robot.x),
        number(robot.y),
        heading(robot.heading),
        pair([robot.length, robot.width]),
    );
    if let Some(drive) = Drive::from_word(&robot.drive) {
        let places: Vec<(f64, f64)> = robot.wheels.iter().map(|wheel| (wheel.x, wheel.y)).collect();
        let geometry = geometry_of(drive, &places);
        let _ = writeln!(text, "track = {}", number(geometry.track));
        if drive.row().has_wheelbase() {
            let _ = writeln!(text, "wheelbase = {}", number(geometry.wheelbase));
        }
    }
    let _ = writeln!(text, "grip = {}", number(robot.grip));
    if let Some(speed) = robot.rim_speed {
        let _ = writeln!(text, "rim-speed = {}", number(speed));
    }
    let _ = writeln!(text, "rim-acceleration = {}", number(robot.rim_acceleration));
    for sensor in &robot.sensors {
        let _ = writeln!(
            text,
            "\n[robots.{}.sensors.{}]\nat = {}\nbearing = {}\nrange = {}\ncone = {}",
            robot.name,
            sensor.name,
            pair([sensor.x, sensor.y]),
            heading(sensor.bearing),
            number(sensor.range),
            degrees(sensor.cone),
        );
    }
}

/// A number without the noise of a conversion: micrometres and millionths of degrees are kept.
fn number(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    // Not -0.
    format!("{}", rounded + 0.0)
}

/// The opening of a cone.
fn degrees(radians: f64) -> String {
    number(radians.to_degrees())
}

fn heading(radians: f64) -> String {
    format!("{}", heading_degrees(radians, 6))
}

fn pair([x, y]: [f64; 2]) -> String {
    format!("[{}, {}]", number(x), number(y))
}

/// A basic string of TOML, whose escapes are those of JSON; TOML allows no control character without one.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string().replace('\u{7f}', "\\u007F")
}
