//! From the text of a scene file to a scene.

use pydslrep_kinematics::{Drive, Pose};
use pydslrep_schema::{Entry, Node, Problem, ProblemKind, Span, Value, as_key, closest, did_you_mean, parse};

use super::keys::{Key, Sort, TABLES, Table, Values, find};
use crate::{Body, Noise, Obstacle, Robot, Scene, SensorKind, Shape, Thing, defaults, mounts_by_name, space};

/// Nothing is further away or longer, metres: what is, was meant in another unit.
const FURTHEST: f64 = 1e6;

/// Reads a scene file for robots on an empty floor. What is fine holds, whatever else is not; of a text that is no
/// TOML, nothing does. Problems are in the order of the text. With a scene, things are in each other's way.
pub fn read(text: &str, floor: Scene) -> (Scene, Vec<Problem>) {
    let floor = Scene { collisions: true, ..floor };
    let mut reader = Reader { scene: floor, problems: Vec::new(), starts: Vec::new() };
    match parse(text, "key") {
        Err(problem) => return (reader.scene, vec![problem]),
        Ok(entries) => reader.all(&entries),
    }
    reader.starts_in_something();
    let Reader { scene, mut problems, .. } = reader;
    problems.sort_by_key(|problem| problem.span.map(|span| span.start));
    (scene, problems)
}

/// What is wrong with a scene file as long as the program is not known: every name is that of a robot or a sensor, and
/// nobody knows where robots start.
pub fn problems(text: &str) -> Vec<Problem> {
    let entries = match parse(text, "key") {
        Err(problem) => return vec![problem],
        Ok(entries) => entries,
    };
    let robots = inside(&entries, "robots").iter().map(|robot| {
        let Value::Table(own) = &robot.node.value else { return named(robot, &[]) };
        named(robot, inside(own, "sensors"))
    });
    let scene = Scene { robots: robots.collect(), ..Scene::default() };
    let mut reader = Reader { scene, problems: Vec::new(), starts: Vec::new() };
    reader.all(&entries);
    reader.problems.sort_by_key(|problem| problem.span.map(|span| span.start));
    reader.problems
}

/// What is in a table of this name; nothing where there is none.
fn inside<'a>(entries: &'a [Entry], name: &str) -> &'a [Entry] {
    match entries.iter().find(|entry| entry.key == name).map(|entry| &entry.node.value) {
        Some(Value::Table(inner)) => inner,
        _ => &[],
    }
}

/// A robot with the names that a file gives it and its sensors.
fn named(robot: &Entry, sensors: &[Entry]) -> Robot {
    let sensors = sensors.iter().map(|sensor| (sensor.key.clone(), SensorKind::Distance));
    Robot::new(&robot.key, Drive::TwoWheel, Vec::new(), sensors.collect())
}

struct Reader {
    scene: Scene,
    problems: Vec<Problem>,
    /// Where the start of each robot is said, or at least something about it.
    starts: Vec<(usize, Option<Span>)>,
}

/// A value that its key can have.
enum Given {
    Flag(bool),
    Number(f64),
    Text(String),
    Points(Vec<(f64, f64)>),
    Pose(Pose),
}

/// What a table sets.
struct Fields {
    given: Vec<(&'static str, Given, Option<Span>)>,
    is_complete: bool,
}

impl Fields {
    fn get(&self, name: &str) -> Option<&Given> {
        self.given.iter().find(|(key, _, _)| *key == name).map(|(_, given, _)| given)
    }

    fn span(&self, name: &str) -> Option<Span> {
        self.given.iter().find(|(key, _, _)| *key == name).and_then(|(_, _, span)| *span)
    }

    fn flag(&self, name: &str) -> Option<bool> {
        if let Given::Flag(flag) = self.get(name)? { Some(*flag) } else { None }
    }

    fn number(&self, name: &str) -> Option<f64> {
        if let Given::Number(number) = self.get(name)? { Some(*number) } else { None }
    }

    fn points(&self, name: &str) -> Option<&[(f64, f64)]> {
        if let Given::Points(points) = self.get(name)? { Some(points) } else { None }
    }

    /// A point, or a pair of lengths.
    fn pair(&self, name: &str) -> Option<(f64, f64)> {
        self.points(name)?.first().copied()
    }

    fn body(&self, name: &str) -> Option<Body> {
        self.pair(name).map(|(length, width)| Body { length, width })
    }

    fn radians(&self, name: &str) -> Option<f64> {
        self.number(name).map(f64::to_radians)
    }

    fn pose(&self, name: &str) -> Option<Pose> {
        if let Given::Pose(pose) = self.get(name)? { Some(*pose) } else { None }
    }

    /// A table that only makes sense with all of its keys.
    fn if_complete(&self) -> Option<&Self> {
        self.is_complete.then_some(self)
    }
}

impl Reader {
    fn all(&mut self, entries: &[Entry]) {
        for entry in entries {
            match (entry.key.as_str(), &entry.node.value) {
                ("robots", Value::Table(robots)) => self.robots(robots),
                ("robots", _) => self.refuse("robots", &entry.node, "must be a table: `[robots.NAME]`", None),
                (name, value) => match (find(name), value) {
                    (None, _) => self.unknown_table(entry),
                    (Some(table), Value::Table(entries)) if table.sort == Sort::Once => {
                        let fields = self.fields(table, name, &entry.node, entries);
                        self.take_once(name, &fields);
                    }
                    (Some(table), Value::List(nodes)) if table.sort == Sort::Each => {
                        for (index, node) in nodes.iter().enumerate() {
                            self.each(table, index, node);
                        }
                    }
                    (Some(table), _) => {
                        let header = match table.sort {
                            Sort::Each => format!("begin each one by `[[{name}]]`"),
                            _ => format!("begin it by `[{name}]`"),
                        };
                        self.refuse(name, &entry.node, "must be a table", Some(header));
                    }
                },
            }
        }
    }

    fn take_once(&mut self, name: &str, fields: &Fields) {
        if name == "noise" {
            let usual = Noise::default();
            self.scene.noise = Some(Noise {
                wheel_slip: fields.number("wheel-slip").map_or(usual.wheel_slip, |percent| percent / 100.0),
                sensor: fields.number("sensor").unwrap_or(usual.sensor),
            });
            return;
        }
        self.scene.collisions = fields.flag("collisions").unwrap_or(self.scene.collisions);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // it was checked to be a count
        let seed = fields.number("seed").map(|seed| seed as u64);
        self.scene.seed = seed.unwrap_or(self.scene.seed);
        if let (Some((x, y)), true) = (fields.pair("size"), fields.flag("walls").unwrap_or(true)) {
            let corner = fields.pair("corner").unwrap_or((-x / 2.0, -y / 2.0));
            let walls = walls_around(corner, (corner.0 + x, corner.1 + y));
            // Before those that the file names, wherever it says how large the floor is.
            self.scene.obstacles.splice(0..0, walls);
        }
    }

    fn each(&mut self, table: &'static Table, index: usize, node: &Node) {
        let Value::Table(entries) = &node.value else {
            let help = format!("begin each one by `[[{}]]`", table.name);
            return self.refuse(table.name, node, "must be a table", Some(help));
        };
        let fields = self.fields(table, table.name, node, entries);
        let name = match fields.get("name") {
            Some(Given::Text(name)) => name.clone(),
            _ => format!("{}_{}", table.name, index + 1),
        };
        let obstacle = fields.if_complete().and_then(|fields| obstacle(table.name, name, fields));
        let Some(obstacle) = obstacle else { return };
        match &obstacle.shape {
            Shape::Polygon(corners) if space::triangles(corners).is_empty() => self.problems.push(Problem {
                kind: ProblemKind::InvalidValue,
                key: "polygon.corners".to_owned(),
                span: fields.span("corners"),
                message: "the outline of the polygon crosses itself or has no area".to_owned(),
                help: Some(
                    "list the corners in the order in which one meets them walking around it".to_owned(),
                ),
                replacement: None,
            }),
            Shape::Box(body) if body.length == 0.0 => {
                self.refuse_span("wall.to", fields.span("to"), "is where the wall begins", None);
            }
            _ => self.scene.obstacles.push(obstacle),
        }
    }

    fn robots(&mut self, entries: &[Entry]) {
        for entry in entries {
            let found = self.scene.robots.iter().position(|robot| robot.name == entry.key);
            let Some(index) = found else {
                let names = self.scene.robots.iter().map(|robot| robot.name.as_str());
                let problem = unknown_name(
                    "the environment has no robot",
                    "its robots are",
                    entry,
                    &names.collect::<Vec<_>>(),
                );
                self.problems.push(problem);
                continue;
            };
            match &entry.node.value {
                Value::Table(entries) => self.robot(index, entry, entries),
                _ => self.refuse(&entry.key, &entry.node, "must be a table", None),
            }
        }
    }

    fn robot(&mut self, index: usize, entry: &Entry, entries: &[Entry]) {
        let (sensors, own): (Vec<&Entry>, Vec<&Entry>) =
            entries.iter().partition(|entry| entry.key == "sensors");
        let written = format!("robots.{}", entry.key);
        let Some(table) = find("robots.NAME") else { return };
        let fields = self.fields_of(table, &written, &entry.node, own.into_iter());
        self.starts.push((index, fields.span("start").or(entry.key_span)));
        let robot = &mut self.scene.robots[index];
        robot.start = fields.pose("start").unwrap_or(robot.start);
        robot.geometry.track = fields.number("track").unwrap_or(robot.geometry.track);
        robot.geometry.wheelbase = fields.number("wheelbase").unwrap_or(robot.geometry.wheelbase);
        robot.grip = fields.number("grip").unwrap_or(robot.grip);
        robot.motor_speed = fields.number("rim-speed").unwrap_or(robot.motor_speed);
        robot.motor_acceleration = fields.number("rim-acceleration").unwrap_or(robot.motor_acceleration);
        if let Some(body) = fields.body("body") {
            robot.body = body;
            place_by_name(robot);
        }
        for sensors in sensors {
            let Value::Table(entries) = &sensors.node.value else {
                self.refuse(&written, &sensors.node, "has sensors in a table", None);
                continue;
            };
            for entry in entries {
                self.sensor(index, &written, entry);
            }
        }
    }

    fn sensor(&mut self, robot: usize, robot_written: &str, entry: &Entry) {
        let sensors = &self.scene.robots[robot].sensors;
        let Some(index) = sensors.iter().position(|sensor| sensor.name == entry.key) else {
            let names: Vec<&str> = sensors.iter().map(|sensor| sensor.name.as_str()).collect();
            let what = format!("robot `{}` has no sensor", self.scene.robots[robot].name);
            let problem = unknown_name(&what, "its sensors are", entry, &names);
            return self.problems.push(problem);
        };
        let written = format!("{robot_written}.sensors.{}", entry.key);
        let (Value::Table(entries), Some(table)) = (&entry.node.value, find("robots.NAME.sensors.NAME"))
        else {
            return self.refuse(&written, &entry.node, "must be a table", None);
        };
        let fields = self.fields(table, &written, &entry.node, entries);
        let mount = &mut self.scene.robots[robot].sensors[index].mount;
        (mount.pose.x, mount.pose.y) = fields.pair("at").unwrap_or((mount.pose.x, mount.pose.y));
        mount.pose.theta = fields.radians("bearing").unwrap_or(mount.pose.theta);
        mount.range = fields.number("range").unwrap_or(mount.range);
        mount.cone = fields.radians("cone").unwrap_or(mount.cone);
    }

    fn fields(&mut self, table: &'static Table, written: &str, node: &Node, entries: &[Entry]) -> Fields {
        self.fields_of(table, written, node, entries.iter())
    }

    fn fields_of<'a>(
        &mut self,
        table: &'static Table,
        written: &str,
        node: &Node,
        entries: impl Iterator<Item = &'a Entry>,
    ) -> Fields {
        let mut fields = Fields { given: Vec::new(), is_complete: true };
        let mut wrong = Vec::new();
        for entry in entries {
            let Some(key) = table.keys.iter().find(|key| key.name == entry.key) else {
                self.problems.push(unknown_key(table, written, entry));
                continue;
            };
            match given(key, &entry.node) {
                Ok(given) => fields.given.push((key.name, given, entry.node.span)),
                Err((message, help)) => {
                    wrong.push(key.name);
                    self.refuse(&format!("{written}.{}", key.name), &entry.node, &message, Some(help));
                }
            }
        }
        let is_missing = |key: &&Key| key.required && fields.get(key.name).is_none();
        let missing: Vec<&Key> = table.keys.iter().filter(is_missing).collect();
        fields.is_complete = missing.is_empty();
        for key in missing {
            if !wrong.contains(&key.name) {
                self.problems.push(Problem {
                    kind: ProblemKind::MissingKey,
                    key: written.to_owned(),
                    span: node.span,
                    message: format!("`{}` is missing in this `{written}`", key.name),
                    help: Some(format!("write for example `{} = {}`", key.name, key.example)),
                    replacement: None,
                });
            }
        }
        fields
    }

    fn refuse(&mut self, written: &str, node: &Node, message: &str, help: Option<String>) {
        self.refuse_span(written, node.span, message, help);
    }

    fn refuse_span(&mut self, written: &str, span: Option<Span>, message: &str, help: Option<String>) {
        self.problems.push(Problem {
            kind: ProblemKind::InvalidValue,
            key: written.to_owned(),
            span,
            message: format!("`{written}` {message}"),
            help,
            replacement: None,
        });
    }

    fn unknown_table(&mut self, entry: &Entry) {
        let mut tops: Vec<&str> = TABLES.iter().filter_map(|table| table.name.split('.').next()).collect();
        tops.dedup();
        let near = closest(&entry.key, tops.iter().copied());
        let home = TABLES.iter().find(|table| table.keys.iter().any(|key| key.name == entry.key));
        let help = match (near, home) {
            (Some(near), _) => did_you_mean(near),
            (None, Some(home)) => format!("it belongs into the table `{}`", home.name),
            (None, None) => format!("a scene has {}", tops.join(", ")),
        };
        self.problems.push(Problem {
            kind: ProblemKind::UnknownKey,
            key: entry.key.clone(),
            span: entry.key_span,
            message: format!("there is nothing called `{}` in a scene", entry.key),
            help: Some(help),
            replacement: near.map(str::to_owned),
        });
    }

    /// Robots that stand in something when they start could never leave it.
    fn starts_in_something(&mut self) {
        if !self.scene.collisions {
            return;
        }
        for (robot, thing) in self.scene.overlaps() {
            let said = |robot: usize| self.starts.iter().find(|(index, _)| *index == robot);
            let (what, other) = match thing {
                Thing::Obstacle(index) => (&self.scene.obstacles[index].name, None),
                Thing::Robot(index) => (&self.scene.robots[index].name, said(index)),
            };
            let name = &self.scene.robots[robot].name;
            self.problems.push(Problem {
                kind: ProblemKind::InvalidValue,
                key: format!("robots.{name}.start"),
                span: said(robot).or(other).and_then(|(_, span)| *span),
                message: format!("robot `{name}` starts in `{what}`"),
                help: Some(format!("move it: `start = [x, y, heading]` in `[robots.{name}]`")),
                replacement: None,
            });
        }
    }
}

/// Sensors back to where their names put them on the robot's body.
fn place_by_name(robot: &mut Robot) {
    let named: Vec<_> = robot.sensors.iter().map(|sensor| (sensor.name.clone(), sensor.kind)).collect();
    for (sensor, mount) in robot.sensors.iter_mut().zip(mounts_by_name(&named, robot.body)) {
        sensor.mount.pose = mount.pose;
    }
}

fn obstacle(table: &str, name: String, fields: &Fields) -> Option<Obstacle> {
    if table == "wall" {
        let thickness = fields.number("thickness").unwrap_or(defaults::WALL_THICKNESS);
        return Some(Obstacle::wall(name, fields.pair("from")?, fields.pair("to")?, thickness));
    }
    let (x, y) = fields.pair("at").unwrap_or_default();
    let pose = Pose::new(x, y, fields.radians("heading").unwrap_or_default());
    let shape = match table {
        "box" => Shape::Box(fields.body("size")?),
        "cylinder" => Shape::Cylinder { radius: fields.number("radius")? },
        _ => Shape::Polygon(fields.points("corners")?.to_vec()),
    };
    Some(Obstacle { name, pose, shape })
}

/// Walls that stand outside of a rectangle, with no gap at its corners.
fn walls_around((left, bottom): (f64, f64), (right, top): (f64, f64)) -> [Obstacle; 4] {
    let thickness = defaults::WALL_THICKNESS;
    let off = thickness / 2.0;
    let (left, bottom, right, top) = (left - off, bottom - off, right + off, top + off);
    let wall = |name: &str, from, to| Obstacle::wall(name, from, to, thickness);
    [
        wall("wall_south", (left - off, bottom), (right + off, bottom)),
        wall("wall_east", (right, bottom - off), (right, top + off)),
        wall("wall_north", (left - off, top), (right + off, top)),
        wall("wall_west", (left, bottom - off), (left, top + off)),
    ]
}

/// The value of a key; else what is wrong, to stand behind the key, and what to do.
fn given(key: &Key, node: &Node) -> Result<Given, (String, String)> {
    let refuse = |message: String| Err((message, format!("write for example `{}`", key.example)));
    let expected = || format!("must be {}, not {}", key.values.words(), node.value.sort());
    let limits = || format!("must be {}", key.values.words());
    let numbers = |node: &Node| -> Option<Vec<f64>> {
        let Value::List(nodes) = &node.value else { return None };
        nodes
            .iter()
            .map(|node| if let Value::Number(number) = node.value { Some(number) } else { None })
            .collect()
    };
    let is_far = |number: &f64| number.is_nan() || number.abs() > FURTHEST;
    let far = || format!("is beyond {} km, or no number", FURTHEST / 1000.0);
    match (key.values, &node.value) {
        (Values::Flag, Value::Flag(flag)) => Ok(Given::Flag(*flag)),
        (Values::Name, Value::Text(text)) => {
            let is_name =
                !text.trim().is_empty() && !text.contains('/') && !text.chars().any(char::is_control);
            if is_name {
                Ok(Given::Text(text.clone()))
            } else {
                refuse("must have letters in it, and neither `/` nor line ends".to_owned())
            }
        }
        (Values::Count, Value::Number(number)) => {
            let is_count = number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(number);
            if is_count { Ok(Given::Number(*number)) } else { refuse(limits()) }
        }
        (
            Values::AboveZero | Values::FromZero | Values::Share | Values::Angle | Values::Opening,
            Value::Number(number),
        ) => {
            if is_far(number) {
                return refuse(far());
            }
            let fits = match key.values {
                Values::AboveZero => *number > 0.0,
                Values::FromZero => *number >= 0.0,
                Values::Share => (0.0..=1.0).contains(number),
                Values::Opening => *number > 0.0 && *number <= 180.0,
                _ => true,
            };
            if fits { Ok(Given::Number(*number)) } else { refuse(limits()) }
        }
        (Values::Point | Values::Size | Values::Pose, Value::List(_)) => match numbers(node).as_deref() {
            Some(list) if list.iter().any(is_far) => refuse(far()),
            Some([x, y]) if key.values == Values::Pose => Ok(Given::Pose(Pose::new(*x, *y, 0.0))),
            Some([x, y, heading]) if key.values == Values::Pose => {
                Ok(Given::Pose(Pose::new(*x, *y, heading.to_radians())))
            }
            Some([x, y]) if key.values == Values::Point || (*x > 0.0 && *y > 0.0) => {
                Ok(Given::Points(vec![(*x, *y)]))
            }
            _ => refuse(limits()),
        },
        (Values::Points, Value::List(nodes)) => {
            let point = |node: &Node| match numbers(node).as_deref() {
                Some([x, y]) => Some((*x, *y)),
                _ => None,
            };
            match nodes.iter().map(point).collect::<Option<Vec<_>>>() {
                Some(points) if points.iter().any(|(x, y)| is_far(x) || is_far(y)) => refuse(far()),
                Some(points) if points.len() >= 3 => Ok(Given::Points(points)),
                _ => refuse(limits()),
            }
        }
        _ => refuse(expected()),
    }
}

fn unknown_key(table: &Table, written: &str, entry: &Entry) -> Problem {
    let keys = || table.keys.iter().map(|key| key.name);
    let near = closest(&entry.key, keys());
    let listed = keys().collect::<Vec<_>>().join(", ");
    Problem {
        kind: ProblemKind::UnknownKey,
        key: format!("{written}.{}", entry.key),
        span: entry.key_span,
        message: format!("there is no key `{}` in `{written}`", entry.key),
        help: Some(near.map_or_else(|| format!("the keys here are {listed}"), did_you_mean)),
        replacement: near.map(str::to_owned),
    }
}

fn unknown_name(what: &str, they_are: &str, entry: &Entry, names: &[&str]) -> Problem {
    let near = closest(&entry.key, names.iter().copied());
    let help = match near {
        Some(near) => did_you_mean(near),
        None if names.is_empty() => "it has none".to_owned(),
        None => format!("{they_are} {}", names.join(", ")),
    };
    Problem {
        kind: ProblemKind::UnknownName,
        key: entry.key.clone(),
        span: entry.key_span,
        message: format!("{what} `{}`", entry.key),
        help: Some(help),
        replacement: near.map(as_key),
    }
}

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use proptest::prelude::*;
    use pydslrep_kinematics::Drive;

    use super::*;
    use crate::{SensorKind, Wheel};

    fn floor() -> Scene {
        let wheels = ["l", "r"].map(|name| Wheel::new(name, 0.045)).to_vec();
        let sensors = ["fSensor", "lSensor"].map(|name| (name.to_owned(), SensorKind::Distance)).to_vec();
        let robot = |name| Robot::new(name, Drive::TwoWheel, wheels.clone(), sensors.clone());
        Scene::empty_floor(vec![robot("robot_1"), robot("robot_2")])
    }

    #[track_caller]
    fn check(text: &str, expected: &Expect) -> Scene {
        let (scene, problems) = read(text, floor());
        let mut out = String::new();
        for problem in problems {
            let span = problem.span.map_or(0..0, |span| span.start as usize..span.end as usize);
            let found = text[span].lines().next().unwrap_or_default();
            out += &format!("{} `{found}`: {}\n", problem.kind.code(), problem.message);
            if let Some(help) = &problem.help {
                out += &format!("  help: {help}\n");
            }
        }
        expected.assert_eq(&out);
        scene
    }

    #[test]
    fn a_file_says_what_differs_from_an_empty_floor() {
        let scene = check(
            "[world]\nsize = [4, 3]\nseed = 9\n[[box]]\nat = [1, 1]\nsize = [0.5, 0.2]\nheading = 90\nname = \"crate\"\n\
             [[wall]]\nfrom = [-1, 1.2]\nto = [0, 1.2]\n[noise]\nsensor = 0\n\
             [robots.robot_1]\nstart = [-1, 0.5, 180]\nbody = [0.5, 0.4]\nrim-speed = 0.3\n\
             [robots.robot_1.sensors]\nlSensor = { at = [0.1, 0.05], bearing = -90, range = 2, cone = 45 }\n",
            &expect![""],
        );
        let names: Vec<&str> = scene.obstacles.iter().map(|obstacle| obstacle.name.as_str()).collect();
        assert_eq!(names, ["wall_south", "wall_east", "wall_north", "wall_west", "crate", "wall_1"]);
        assert_eq!((scene.seed, scene.noise), (9, Some(Noise { wheel_slip: 0.02, sensor: 0.0 })));
        let robot = &scene.robots[0];
        assert_eq!(robot.start, Pose::new(-1.0, 0.5, std::f64::consts::PI));
        assert!((robot.motor_speed, robot.body.length) == (0.3, 0.5));
        // The one that is not placed sits on the edge of the new body.
        assert!(robot.sensors[0].mount.pose == Pose::new(0.25, 0.0, 0.0), "{:?}", robot.sensors[0]);
        let mount = robot.sensors[1].mount;
        assert!(mount.pose == Pose::new(0.1, 0.05, -std::f64::consts::FRAC_PI_2));
        assert!((mount.range, mount.cone) == (2.0, 45_f64.to_radians()));
        assert_eq!(scene.robots[1], floor().robots[1]);
    }

    #[test]
    fn misspelt_words_are_told_with_what_was_meant() {
        let scene = check(
            "[wrld]\n[[boxs]]\nat = [0, 0]\n[world]\nsise = [1, 2]\nx = 1\nseed = 3\n[robots.robt_1]\n[robots.x]\n\
             [robots.robot_1.sensors.fSenso]\n[robots.robot_1]\nstrat = [0, 1]\n[robots.robot_2.sensors.q]\n",
            &expect![[r#"
                unknown-key `wrld`: there is nothing called `wrld` in a scene
                  help: did you mean `world`?
                unknown-key `boxs`: there is nothing called `boxs` in a scene
                  help: did you mean `box`?
                unknown-key `sise`: there is no key `sise` in `world`
                  help: did you mean `size`?
                unknown-key `x`: there is no key `x` in `world`
                  help: the keys here are size, corner, walls, collisions, seed
                unknown-name `robt_1`: the environment has no robot `robt_1`
                  help: did you mean `robot_1`?
                unknown-name `x`: the environment has no robot `x`
                  help: its robots are robot_1, robot_2
                unknown-name `fSenso`: robot `robot_1` has no sensor `fSenso`
                  help: did you mean `fSensor`?
                unknown-key `strat`: there is no key `strat` in `robots.robot_1`
                  help: did you mean `start`?
                unknown-name `q`: robot `robot_2` has no sensor `q`
                  help: its sensors are fSensor, lSensor
            "#]],
        );
        assert_eq!(scene.seed, 3, "what is fine holds");
    }

    #[test]
    fn wrong_values_are_told_with_what_fits() {
        check(
            "world = 1\nnoise = true\nwall = 4\n[box]\n[[cylinder]]\nat = [1]\nradius = 0\n\
             [[cylinder]]\nat = [0, 5]\nradius = \"1 m\"\n[[cylinder]]\n\
             [[polygon]]\ncorners = [[0, 5], [1, 6], [1, 5], [0, 6]]\n[[polygon]]\ncorners = [[0, 0], [1, 1]]\n\
             [robots.robot_1]\nstart = [nan, 0]\ntrack = 1e9\nbody = [1, -1]\n\
             [robots.robot_1.sensors.fSensor]\ncone = 400\n",
            &expect![[r#"
                invalid-value `1`: `world` must be a table
                  help: begin it by `[world]`
                invalid-value `true`: `noise` must be a table
                  help: begin it by `[noise]`
                invalid-value `4`: `wall` must be a table
                  help: begin each one by `[[wall]]`
                invalid-value `[box]`: `box` must be a table
                  help: begin each one by `[[box]]`
                invalid-value `[1]`: `cylinder.at` must be a point `[x, y]`
                  help: write for example `[1.0, 0.5]`
                invalid-value `0`: `cylinder.radius` must be a number above zero
                  help: write for example `0.25`
                invalid-value `"1 m"`: `cylinder.radius` must be a number above zero, not a text
                  help: write for example `0.25`
                missing-key `[[cylinder]]`: `at` is missing in this `cylinder`
                  help: write for example `at = [1.0, 0.5]`
                missing-key `[[cylinder]]`: `radius` is missing in this `cylinder`
                  help: write for example `radius = 0.25`
                invalid-value `[[0, 5], [1, 6], [1, 5], [0, 6]]`: the outline of the polygon crosses itself or has no area
                  help: list the corners in the order in which one meets them walking around it
                invalid-value `[[0, 0], [1, 1]]`: `polygon.corners` must be a list of at least three points `[x, y]`
                  help: write for example `[[0.0, 1.0], [1.0, 1.0], [0.2, 2.0]]`
                invalid-value `[nan, 0]`: `robots.robot_1.start` is beyond 1000 km, or no number
                  help: write for example `[0.5, -0.5, 90]`
                invalid-value `1e9`: `robots.robot_1.track` is beyond 1000 km, or no number
                  help: write for example `0.35`
                invalid-value `[1, -1]`: `robots.robot_1.body` must be a size `[length, width]`, both above zero
                  help: write for example `[0.5, 0.4]`
                invalid-value `400`: `robots.robot_1.sensors.fSensor.cone` must be an angle above 0 and up to 180 degrees
                  help: write for example `30`
            "#]],
        );
        check(
            "[[wall]]\nfrom = [4, 4]\nto = [4, 4]\n[world]\nseed = 1.5\nwalls = 1\n[[box]]\nname = \"a/b\"\n",
            &expect![[r#"
                invalid-value `[4, 4]`: `wall.to` is where the wall begins
                invalid-value `1.5`: `world.seed` must be a whole number from 0
                  help: write for example `7`
                invalid-value `1`: `world.walls` must be true or false, not a number
                  help: write for example `false`
                missing-key `[[box]]`: `at` is missing in this `box`
                  help: write for example `at = [1.0, 0.5]`
                missing-key `[[box]]`: `size` is missing in this `box`
                  help: write for example `size = [0.6, 0.4]`
                invalid-value `"a/b"`: `box.name` must have letters in it, and neither `/` nor line ends
                  help: write for example `"crate"`
            "#]],
        );
        check(
            "robots = 2\n",
            &expect![[r#"
            invalid-value `2`: `robots` must be a table: `[robots.NAME]`
        "#]],
        );
        check(
            "[world\n",
            &expect![[r#"
            invalid-toml ``: `]` is missing
              help: a table begins with `[NAME]`
        "#]],
        );
    }

    #[test]
    fn nobody_starts_in_something() {
        check(
            "[[box]]\nat = [0.2, 0.1]\nsize = [1, 1]\n[robots.robot_2]\nstart = [9, 9]\n",
            &expect![[r#"
                invalid-value ``: robot `robot_1` starts in `box_1`
                  help: move it: `start = [x, y, heading]` in `[robots.robot_1]`
            "#]],
        );
        check(
            "[robots.robot_1]\nstart = [0, -0.8]\n",
            &expect![[r#"
            invalid-value `[0, -0.8]`: robot `robot_2` starts in `robot_1`
              help: move it: `start = [x, y, heading]` in `[robots.robot_2]`
        "#]],
        );
        check("[world]\ncollisions = false\n[robots.robot_1]\nstart = [0, -0.8]\n", &expect![""]);
    }

    #[test]
    fn every_key_does_something_and_its_default_is_true() {
        for table in &TABLES {
            let header = match table.sort {
                Sort::Each => format!("[[{}]]", table.name),
                Sort::Once => format!("[{}]", table.name),
                _ => {
                    format!("[{}]", table.name.replacen("NAME", "robot_1", 1).replacen("NAME", "fSensor", 1))
                }
            };
            let with = |key: &Key, value: &str| {
                let others = table.keys.iter().filter(|other| {
                    // What there are walls around depends on these.
                    let matters = other.required || (table.name == "world" && other.name == "size");
                    matters && other.name != key.name
                });
                let others: Vec<String> =
                    others.map(|key| format!("{} = {}", key.name, key.example)).collect();
                let others = others.join(
                    "
",
                );
                let own = if value.is_empty() { String::new() } else { format!("{} = {value}\n", key.name) };
                let text = format!("{header}\n{others}\n{own}");
                let (scene, problems) = read(&text, Scene { robots: floor().robots, ..Scene::default() });
                let problems: Vec<_> =
                    problems.into_iter().filter(|problem| !problem.message.contains("starts in")).collect();
                assert_eq!((problems, key.required && value.is_empty()), (vec![], false), "{text}");
                scene
            };
            for key in table.keys {
                let example = with(key, key.example);
                if key.required {
                    continue;
                }
                let unset = with(key, "");
                assert_ne!(example, unset, "{} in {}", key.name, table.name);
                let plain = key.default.strip_prefix('`').and_then(|rest| rest.strip_suffix('`'));
                if let Some(default) = plain.filter(|default| !default.contains('`')) {
                    assert_eq!(with(key, default), unset, "{} in {}", key.name, table.name);
                }
            }
        }
    }

    proptest! {
        #[test]
        fn no_text_breaks_the_reader(text in "(\\[{0,2}(world|box|robots\\.robot_1|wall|polygon)\\]{0,2}\n|(at|size|corners|start|from|to) = (\\[[-0-9.,\\[\\]e ]{0,20}|1e400|nan|true)\n|.){0,30}") {
            let (scene, _) = read(&text, floor());
            for obstacle in &scene.obstacles {
                prop_assert!(obstacle.outline(8).iter().all(|(x, y)| x.is_finite() && y.is_finite()));
            }
        }
    }
}
