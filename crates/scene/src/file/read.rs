//! From the text of a scene file to a scene.

use pydslrep_kinematics::Pose;
use pydslrep_schema::{Contents, Names, Problem, ProblemKind, Section, Span};

use super::keys::SCHEMA;
use crate::{
    Body, Frame, Noise, Obstacle, Robot, Scene, SceneObject, Shape, Trajectory, TrajectoryError, Waypoint,
    defaults, mounts_by_name, ros2, space,
};

/// Reads a scene file for robots on an empty floor. What is wrong is left out; if the text is not TOML, everything.
/// Problems are in the order of the text. In a scene, robots are stopped by what they touch.
pub fn read(text: &str, floor: Scene) -> (Scene, Vec<Problem>) {
    let floor = Scene { collisions: true, ..floor };
    match SCHEMA.read(text, Some(&names(&floor))) {
        Err(problem) => (floor, vec![problem]),
        Ok(contents) => {
            let mut reader = Reader::new(floor, contents);
            reader.check_starts();
            reader.finish()
        }
    }
}

/// Returns the problems of a scene file as long as its program is not known: any name can be that of a robot or a
/// sensor, and the positions of robots are unspecified.
pub fn problems(text: &str) -> Vec<Problem> {
    match SCHEMA.read(text, None) {
        Err(problem) => vec![problem],
        Ok(contents) => Reader::new(Scene::default(), contents).finish().1,
    }
}

fn names(scene: &Scene) -> Names {
    let robot = |robot: &Robot| {
        let names = |names: Vec<&String>| {
            Names(names.into_iter().map(|name| (name.clone(), Names::default())).collect())
        };
        let sensors = names(robot.sensors.iter().map(|sensor| &sensor.name).collect());
        let wheels = names(robot.wheels.iter().map(|wheel| &wheel.name).collect());
        let parts = vec![("sensors".to_owned(), sensors), ("wheels".to_owned(), wheels)];
        (robot.name.clone(), Names(parts))
    };
    Names(scene.robots.iter().map(robot).collect())
}

struct Reader {
    scene: Scene,
    problems: Vec<Problem>,
    /// For robots in the file, where their start is set, or else their name.
    starts: Vec<(usize, Option<Span>)>,
}

impl Reader {
    fn new(scene: Scene, contents: Contents) -> Self {
        let mut reader = Self { scene, problems: contents.problems, starts: Vec::new() };
        for section in &contents.sections {
            reader.section(section);
        }
        reader
    }

    fn finish(self) -> (Scene, Vec<Problem>) {
        let Self { scene, mut problems, .. } = self;
        problems.sort_by_key(|problem| problem.span.map(|span| span.start));
        (scene, problems)
    }

    fn section(&mut self, section: &Section) {
        let robot = section.names.first();
        let robot = robot.and_then(|name| self.scene.robots.iter().position(|robot| robot.name == *name));
        match (section.table.name, robot) {
            ("world", _) => self.world(section),
            ("noise", _) => self.noise(section),
            ("robots.NAME", Some(robot)) => self.robot(robot, section),
            ("robots.NAME.sensors.NAME", Some(robot)) => self.sensor(robot, section),
            ("robots.NAME.wheels.NAME", Some(robot)) => self.object(robot, section),
            ("robots.NAME.ros2", Some(robot)) => self.scene.robots[robot].ros2 = ros2::read(section),
            (name, None) if name.starts_with("robots.") => {}
            _ => self.obstacle(section),
        }
    }

    fn world(&mut self, section: &Section) {
        self.scene.collisions = section.flag("collisions").unwrap_or(self.scene.collisions);
        self.scene.friction = section.number("friction").unwrap_or(self.scene.friction);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the reader lets only counts pass
        let seed = section.number("seed").map(|seed| seed as u64);
        self.scene.seed = seed.unwrap_or(self.scene.seed);
        if let (Some((x, y)), true) = (section.pair("size"), section.flag("walls").unwrap_or(true)) {
            let corner = section.pair("corner").unwrap_or((-x / 2.0, -y / 2.0));
            let walls = walls_around(corner, (corner.0 + x, corner.1 + y));
            // Before those of the file, wherever in it the size is.
            self.scene.obstacles.splice(0..0, walls);
        }
    }

    fn noise(&mut self, section: &Section) {
        let usual = Noise::default();
        let share = |key, usual| section.number(key).map_or(usual, |percent| percent / 100.0);
        self.scene.noise = Some(Noise {
            wheel_slip: share("wheel-slip", usual.wheel_slip),
            track_error: share("track-error", usual.track_error),
            radius_error: share("radius-error", usual.radius_error),
            sensor: section.number("sensor").unwrap_or(usual.sensor),
        });
    }

    fn obstacle(&mut self, section: &Section) {
        let number = || format!("{}_{}", section.table.name, section.index + 1);
        let name = section.text("name").map_or_else(number, str::to_owned);
        let trajectory = self.trajectory(section);
        let whole = Some(section).filter(|section| section.is_complete);
        let Some(obstacle) = whole.and_then(|section| obstacle(name, section, trajectory)) else { return };
        match &obstacle.shape {
            Shape::Polygon(corners) if space::triangles(corners).is_empty() => {
                let message = "the outline of the polygon crosses itself or has no area";
                let help = "list the corners in their order around the outline";
                self.problems.push(refusal(section, "corners", message).help(help));
            }
            Shape::Box(body) if body.length == 0.0 => {
                self.problems.push(refusal(section, "to", "`wall.to` is where the wall begins"));
            }
            _ => {
                let height = section.number("height").unwrap_or(obstacle.height);
                self.scene.obstacles.push(obstacle.of_height(height));
            }
        }
    }

    /// Reads the path of an obstacle; `None` if it does not move, or if the path is wrong.
    fn trajectory(&mut self, section: &Section) -> Option<Trajectory> {
        let Some(rows) = section.rows("path") else {
            if section.flag("repeat") == Some(true) && !section.is_wrong("path") {
                let message = format!("`{}.repeat` is for obstacles that have a `path`", section.written);
                let problem =
                    refusal(section, "repeat", &message).help("add its times and points, or remove `repeat`");
                self.problems.push(Problem { kind: ProblemKind::MissingKey, ..problem });
            }
            return None;
        };
        let points = rows.into_iter().map(|[time, x, y]| Waypoint { time, x, y }).collect::<Vec<_>>();
        let (first, repeats) = (points.first().copied(), section.flag("repeat").unwrap_or(false));
        let trajectory = Trajectory::new(points.clone(), repeats);
        if let Err(error) = &trajectory {
            let problem = refusal(section, "path", &unordered(&section.written, &points, *error));
            let item = match error {
                TrajectoryError::NotLater(index) | TrajectoryError::NotFinite(index) => *index,
                TrajectoryError::Empty | TrajectoryError::TooEarly => 0,
            };
            let span = section.item_span("path", item).or(problem.span);
            let help = "a path is a list of `[t, x, y]`, whose times begin at 0 or later and grow";
            self.problems.push(Problem { span, ..problem }.help(help));
        } else if let (Some((x, y)), Some(first)) = (section.pair("at"), first)
            && (x, y) != (first.x, first.y)
        {
            let message = format!("`{}.at` is not the first point of its `path`", section.written);
            self.problems
                .push(refusal(section, "at", &message).help("leave it out: the path says where it starts"));
        }
        trajectory.ok()
    }

    fn robot(&mut self, index: usize, section: &Section) {
        self.object(index, section);
        self.starts.push((index, section.span("start").or(section.name_span)));
        let robot = &mut self.scene.robots[index];
        match section.numbers("start").as_deref() {
            Some([x, y]) => robot.start = Pose::new(*x, *y, 0.0),
            Some([x, y, heading]) => robot.start = Pose::new(*x, *y, heading.to_radians()),
            _ => {}
        }
        robot.geometry.track = section.number("track").unwrap_or(robot.geometry.track);
        robot.geometry.wheelbase = section.number("wheelbase").unwrap_or(robot.geometry.wheelbase);
        robot.lateral_friction = section.number("grip").unwrap_or(robot.lateral_friction);
        robot.motor_speed = section.number("rim-speed").unwrap_or(robot.motor_speed);
        robot.motor_acceleration = section.number("rim-acceleration").unwrap_or(robot.motor_acceleration);
        robot.motor_gain = section.number("motor-gain").unwrap_or(robot.motor_gain);
        robot.wheel_width = section.number("wheel-width").unwrap_or(robot.wheel_width);
        robot.frame = section.text("frame").and_then(Frame::from_word).unwrap_or(robot.frame);
        if let Some(body) = body(section, "body") {
            robot.body = body;
            mount_by_name(robot);
        }
    }

    /// Where the object of a robot or of a part of it is.
    fn object(&mut self, robot: usize, section: &Section) {
        if let Some((path, name)) = section.text("object").zip(section.names.last()) {
            let paths = self.scene.robots[robot].objects.entry(name.clone()).or_default();
            paths.push(path.to_owned());
        }
    }

    fn sensor(&mut self, robot: usize, section: &Section) {
        self.object(robot, section);
        let name = section.names.last();
        let sensors = &mut self.scene.robots[robot].sensors;
        let Some(sensor) = sensors.iter_mut().find(|sensor| Some(&sensor.name) == name) else { return };
        let mount = &mut sensor.mount;
        (mount.pose.x, mount.pose.y) = section.pair("at").unwrap_or((mount.pose.x, mount.pose.y));
        mount.pose.theta = radians(section, "bearing").unwrap_or(mount.pose.theta);
        mount.range = section.number("range").unwrap_or(mount.range);
        mount.cone = radians(section, "cone").unwrap_or(mount.cone);
    }

    /// Robots that touch something at their start could never leave it.
    fn check_starts(&mut self) {
        if !self.scene.collisions {
            return;
        }
        for (robot, other) in self.scene.overlaps() {
            let start = |robot: usize| self.starts.iter().find(|(index, _)| *index == robot);
            let (what, other_start) = match other {
                SceneObject::Obstacle(index) => (&self.scene.obstacles[index].name, None),
                SceneObject::Robot(index) => (&self.scene.robots[index].name, start(index)),
            };
            let name = &self.scene.robots[robot].name;
            let span = start(robot).or(other_start).and_then(|(_, span)| *span);
            let message = format!("robot `{name}` starts in `{what}`");
            let problem =
                Problem::new(ProblemKind::InvalidValue, format!("robots.{name}.start"), span, message);
            let help = format!("move it: `start = [x, y, heading]` in `[robots.{name}]`");
            self.problems.push(problem.help(help));
        }
    }
}

fn refusal(section: &Section, key: &str, message: &str) -> Problem {
    let name = format!("{}.{key}", section.written);
    Problem::new(ProblemKind::InvalidValue, name, section.span(key), message.to_owned())
}

/// Why the points of a path are wrong.
fn unordered(written: &str, points: &[Waypoint], error: TrajectoryError) -> String {
    let time = |index: usize| points.get(index).map_or(0.0, |point| point.time);
    match error {
        TrajectoryError::TooEarly => {
            format!("`{written}.path` begins at {} s, but the simulation starts at 0 s", time(0))
        }
        TrajectoryError::NotLater(index) => {
            format!(
                "the times of `{written}.path` do not grow: {} s follows {} s",
                time(index),
                time(index - 1)
            )
        }
        TrajectoryError::Empty | TrajectoryError::NotFinite(_) => format!("`{written}.path`: {error}"),
    }
}

fn radians(section: &Section, key: &str) -> Option<f64> {
    section.number(key).map(f64::to_radians)
}

fn points(section: &Section, key: &str) -> Option<Vec<(f64, f64)>> {
    Some(section.rows::<2>(key)?.into_iter().map(Into::into).collect())
}

fn body(section: &Section, key: &str) -> Option<Body> {
    section.pair(key).map(|(length, width)| Body { length, width })
}

/// Moves sensors back to the default positions for their names.
fn mount_by_name(robot: &mut Robot) {
    let named: Vec<_> = robot.sensors.iter().map(|sensor| (sensor.name.clone(), sensor.kind)).collect();
    for (sensor, mount) in robot.sensors.iter_mut().zip(mounts_by_name(&named, robot.body)) {
        sensor.mount.pose = mount.pose;
    }
}

fn obstacle(name: String, section: &Section, trajectory: Option<Trajectory>) -> Option<Obstacle> {
    if section.table.name == "wall" {
        let thickness = section.number("thickness").unwrap_or(defaults::WALL_THICKNESS);
        return Some(Obstacle::wall(name, section.pair("from")?, section.pair("to")?, thickness));
    }
    let heading = radians(section, "heading").unwrap_or_default();
    let shape = match section.table.name {
        "box" => Shape::Box(body(section, "size")?),
        "cylinder" => Shape::Cylinder { radius: section.number("radius")? },
        _ => {
            return Some(Obstacle::fixed(name, Pose::default(), Shape::Polygon(points(section, "corners")?)));
        }
    };
    if let Some(trajectory) = trajectory {
        return Some(Obstacle::moving(name, heading, shape, trajectory));
    }
    // Without a place it has a path that is wrong.
    let (x, y) = section.pair("at")?;
    Some(Obstacle::fixed(name, Pose::new(x, y, heading), shape))
}

/// Walls around a rectangle, outside of it and without gaps at its corners.
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

#[cfg(test)]
mod tests {
    use expect_test::{Expect, expect};
    use proptest::prelude::*;
    use pydslrep_kinematics::Drive;
    use pydslrep_schema::Key;

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
             [[wall]]\nfrom = [-1, 1.2]\nto = [0, 1.2]\n[noise]\nsensor = 0\ntrack-error = 2\nradius-error = -1\n\
             [robots.robot_1]\nstart = [-1, 0.5, 180]\nbody = [0.5, 0.4]\nrim-speed = 0.3\n\
             [robots.robot_1.sensors]\nlSensor = { at = [0.1, 0.05], bearing = -90, range = 2, cone = 45 }\n",
            &expect![""],
        );
        let names: Vec<&str> = scene.obstacles.iter().map(|obstacle| obstacle.name.as_str()).collect();
        assert_eq!(names, ["wall_south", "wall_east", "wall_north", "wall_west", "crate", "wall_1"]);
        let noise = Noise { wheel_slip: 0.02, track_error: 0.02, radius_error: -0.01, sensor: 0.0 };
        assert_eq!((scene.seed, scene.noise), (9, Some(noise)));
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
    fn objects_are_by_the_name_of_their_part() {
        let scene = check(
            "[robots.robot_1]\nobject = \"/P3DX\"\n[robots.robot_1.wheels]\nl.object = \"/P3DX/leftMotor\"\n\
             fSensor.object = \"/a\"\nr.object = \"P3DX\"\n[robots.robot_2.wheels.r]\nobject = \"/P3DX/\"\n\
             [robots.robot_1.sensors]\nfSensor.object = \"/P3DX/sonar[4]\"\nl.object = \"/a\"\n",
            &expect![[r#"
                unknown-name `fSensor`: robot `robot_1` has no wheel `fSensor`
                  help: its wheels are l, r
                invalid-value `"P3DX"`: `robots.robot_1.wheels.r.object` must be a path of names, each after a `/`
                  help: write, for example, `"/PioneerP3DX/leftMotor"`
                invalid-value `"/P3DX/"`: `robots.robot_2.wheels.r.object` must be a path of names, each after a `/`
                  help: write, for example, `"/PioneerP3DX/leftMotor"`
                unknown-name `l`: robot `robot_1` has no sensor `l`
                  help: its sensors are fSensor, lSensor
            "#]],
        );
        let objects: Vec<(&str, &[String])> =
            scene.robots[0].objects.iter().map(|(part, paths)| (part.as_str(), paths.as_slice())).collect();
        let [sonar, motor, body] =
            ["/P3DX/sonar[4]", "/P3DX/leftMotor", "/P3DX"].map(|path| [path.to_owned()]);
        assert_eq!(objects, [("fSensor", &sonar[..]), ("l", &motor[..]), ("robot_1", &body[..])]);
    }

    #[test]
    fn misspelt_words_are_told_with_what_was_meant() {
        let scene = check(
            "[wrld]\n[[boxs]]\nat = [0, 0]\n[world]\nsise = [1, 2]\nx = 1\nseed = 3\n[robots.robt_1]\n[robots.x]\n\
             [robots.robot_1.sensors.fSenso]\n[robots.robot_1]\nstrat = [0, 1]\n[robots.robot_2.sensors.q]\n",
            &expect![[r#"
                unknown-key `wrld`: there is no key `wrld`
                  help: did you mean `world`?
                unknown-key `boxs`: there is no key `boxs`
                  help: did you mean `box`?
                unknown-key `sise`: there is no key `world.sise`
                  help: did you mean `size`?
                unknown-key `x`: there is no key `world.x`
                  help: the keys here are size, corner, walls, collisions, friction, seed
                unknown-name `robt_1`: the environment has no robot `robt_1`
                  help: did you mean `robot_1`?
                unknown-name `x`: the environment has no robot `x`
                  help: its robots are robot_1, robot_2
                unknown-name `fSenso`: robot `robot_1` has no sensor `fSenso`
                  help: did you mean `fSensor`?
                unknown-key `strat`: there is no key `robots.robot_1.strat`
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
                invalid-value `1`: `world` must be a table, not a number
                  help: begin it with `[world]`
                invalid-value `true`: `noise` must be a table, not a boolean
                  help: begin it with `[noise]`
                invalid-value `4`: `wall` must be a list of tables, not a number
                  help: begin it with `[[wall]]`
                invalid-value `[box]`: `box` must be a list of tables, not a table
                  help: begin it with `[[box]]`
                invalid-value `[1]`: `cylinder.at` must be a point `[x, y]`
                  help: write, for example, `[1.0, 0.5]`
                invalid-value `0`: `cylinder.radius` must be a number above zero
                  help: write, for example, `0.25`
                invalid-value `"1 m"`: `cylinder.radius` must be a number above zero, not a string
                  help: write, for example, `0.25`
                missing-key `[[cylinder]]`: `at` is missing in this `cylinder`
                  help: write, for example, `at = [1.0, 0.5]`
                missing-key `[[cylinder]]`: `radius` is missing in this `cylinder`
                  help: write, for example, `radius = 0.25`
                invalid-value `[[0, 5], [1, 6], [1, 5], [0, 6]]`: the outline of the polygon crosses itself or has no area
                  help: list the corners in their order around the outline
                invalid-value `[[0, 0], [1, 1]]`: `polygon.corners` must be a list of at least three points `[x, y]`
                  help: write, for example, `[[0.0, 1.0], [1.0, 1.0], [0.2, 2.0]]`
                invalid-value `[nan, 0]`: `robots.robot_1.start` is beyond 1000 km, or not finite
                  help: write, for example, `[0.5, -0.5, 90]`
                invalid-value `1e9`: `robots.robot_1.track` is beyond 1000 km, or not finite
                  help: write, for example, `0.35`
                invalid-value `[1, -1]`: `robots.robot_1.body` must be a size `[length, width]`, both above zero
                  help: write, for example, `[0.5, 0.4]`
                invalid-value `400`: `robots.robot_1.sensors.fSensor.cone` must be an angle above 0 and up to 180 degrees
                  help: write, for example, `30`
            "#]],
        );
        check(
            "[[wall]]\nfrom = [4, 4]\nto = [4, 4]\n[world]\nseed = 1.5\nwalls = 1\n[[box]]\nname = \"a/b\"\n",
            &expect![[r#"
                invalid-value `[4, 4]`: `wall.to` is where the wall begins
                invalid-value `1.5`: `world.seed` must be a whole number from 0
                  help: write, for example, `7`
                invalid-value `1`: `world.walls` must be `true` or `false`, not a number
                  help: write, for example, `false`
                missing-key `[[box]]`: `at` is missing in this `box`
                  help: write, for example, `at = [1.0, 0.5]`
                missing-key `[[box]]`: `size` is missing in this `box`
                  help: write, for example, `size = [0.6, 0.4]`
                invalid-value `"a/b"`: `box.name` must not be empty, and must not contain `/` or line breaks
                  help: write, for example, `"crate"`
            "#]],
        );
        check(
            "robots = 2\n",
            &expect![[r#"
                invalid-value `2`: `robots` must be a table, not a number
                  help: begin it with `[robots.NAME]`
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
    fn walls_are_around_the_floor() {
        for (text, [left, bottom, right, top]) in [
            ("[world]\nsize = [4, 3]\n", [-2.0, -1.5, 2.0, 1.5]),
            ("[world]\nsize = [4, 3]\ncorner = [1, -2]\n", [1.0, -2.0, 5.0, 1.0]),
        ] {
            let space = crate::Space::of(&read(text, Scene::default()).0);
            let point = Body { length: 1e-9, width: 1e-9 };
            let distance =
                |x, y| space.nearest(point, Pose::new(x, y, 0.0), 9.0).map_or(9.0, |near| near.distance);
            let (x, y) = (f64::midpoint(left, right), f64::midpoint(bottom, top));
            for (x, y) in [(left + 0.4, y), (right - 0.4, y), (x, bottom + 0.4), (x, top - 0.4)] {
                assert!((distance(x, y) - 0.4).abs() < 1e-6, "{text}: ({x}, {y})");
            }
            for (x, y) in [(left, bottom), (left, top), (right, bottom), (right, top)] {
                let (out_x, out_y) =
                    (x + 0.05 * (x - left - right + x).signum(), y + 0.05 * (y - bottom - top + y).signum());
                assert!(distance(out_x, out_y) == 0.0, "{text}: a gap at ({x}, {y})");
            }
        }
    }

    #[test]
    fn the_heading_of_a_box_is_in_degrees() {
        let (scene, problems) =
            read("[[box]]\nat = [1, 2]\nsize = [2, 1]\nheading = -90\n", Scene::default());
        let heading = scene.obstacles[0].pose.theta;
        assert!(problems.is_empty() && (heading + std::f64::consts::FRAC_PI_2).abs() < 1e-12, "{heading}");
    }

    #[test]
    fn obstacles_may_move() {
        let scene = check(
            "[[cylinder]]\nname = \"person\"\nat = [2, 0]\nradius = 0.2\npath = [[0, 2, 0], [30, 2, 0], [35, 2, -2]]\n\
             [[box]]\nsize = [1, 0.5]\nheading = 90\npath = [[1, 0, 1], [3, 4, 1]]\nrepeat = true\n\
             [[box]]\nsize = [1, 1]\nat = [9, 9]\nrepeat = false\n",
            &expect![""],
        );
        let [person, cart, crate_] = scene.obstacles.as_slice() else { panic!("{:?}", scene.obstacles) };
        assert_eq!((person.pose_at(20.0), person.pose_at(99.0)), (person.pose, Pose::new(2.0, -2.0, 0.0)));
        let heading = std::f64::consts::FRAC_PI_2;
        assert_eq!(cart.pose, Pose::new(0.0, 1.0, heading));
        assert_eq!(
            (cart.pose_at(2.0), cart.pose_at(4.5)),
            (Pose::new(2.0, 1.0, heading), Pose::new(1.0, 1.0, heading))
        );
        assert_eq!((crate_.pose_at(7.0), &crate_.trajectory), (Pose::new(9.0, 9.0, 0.0), &None));
    }

    #[test]
    fn wrong_paths_are_told_with_what_fits() {
        let scene = check(
            "[[box]]\nsize = [1, 1]\npath = []\n[[box]]\nsize = [1, 1]\npath = [[0, 1]]\n\
             [[box]]\nsize = [1, 1]\npath = [[0, 1, \"2\"]]\n[[box]]\nsize = [1, 1]\npath = [[0, 1, inf]]\n\
             [[box]]\nsize = [1, 1]\npath = 3\n[[box]]\nsize = [1, 1]\nat = [4, 4]\npath = [[0, 1, 2], [5.5, 1, 1], [5, 2, 2]]\n",
            &expect![[r#"
                invalid-value `[]`: `box.path` must be a list of at least one `[t, x, y]`
                  help: write, for example, `[[0.0, 1.0, 0.5], [20.0, 1.0, 2.5]]`
                invalid-value `[[0, 1]]`: `box.path` must be a list of at least one `[t, x, y]`
                  help: write, for example, `[[0.0, 1.0, 0.5], [20.0, 1.0, 2.5]]`
                invalid-value `[[0, 1, "2"]]`: `box.path` must be a list of at least one `[t, x, y]`
                  help: write, for example, `[[0.0, 1.0, 0.5], [20.0, 1.0, 2.5]]`
                invalid-value `[[0, 1, inf]]`: `box.path` is beyond 1000 km, or not finite
                  help: write, for example, `[[0.0, 1.0, 0.5], [20.0, 1.0, 2.5]]`
                invalid-value `3`: `box.path` must be a list of at least one `[t, x, y]`, not a number
                  help: write, for example, `[[0.0, 1.0, 0.5], [20.0, 1.0, 2.5]]`
                invalid-value `[5, 2, 2]`: the times of `box.path` do not grow: 5 s follows 5.5 s
                  help: a path is a list of `[t, x, y]`, whose times begin at 0 or later and grow
            "#]],
        );
        let poses: Vec<Pose> = scene.obstacles.iter().map(|obstacle| obstacle.pose).collect();
        assert_eq!(poses, [Pose::new(4.0, 4.0, 0.0)], "what is fine holds");
        check(
            "[[cylinder]]\nradius = 1\npath = [[-1, 5, 5]]\n[[cylinder]]\nradius = 1\nat = [5, 5]\npath = [[0, 5, 6]]\n\
             [[cylinder]]\nradius = 1\nat = [5, 5]\nrepeat = true\n[[cylinder]]\nradius = 1\nrepeat = 1\n",
            &expect![[r#"
                invalid-value `[-1, 5, 5]`: `cylinder.path` begins at -1 s, but the simulation starts at 0 s
                  help: a path is a list of `[t, x, y]`, whose times begin at 0 or later and grow
                invalid-value `[5, 5]`: `cylinder.at` is not the first point of its `path`
                  help: leave it out: the path says where it starts
                missing-key `true`: `cylinder.repeat` is for obstacles that have a `path`
                  help: add its times and points, or remove `repeat`
                missing-key `[[cylinder]]`: `at` is missing in this `cylinder`
                  help: write, for example, `at = [1.0, 0.5]`
                invalid-value `1`: `cylinder.repeat` must be `true` or `false`, not a number
                  help: write, for example, `true`
            "#]],
        );
        check(
            "[[wall]]\nfrom = [0, 4]\nto = [1, 4]\npath = [[0, 0, 0]]\n\
             [[polygon]]\ncorners = [[5, 5], [6, 5], [5, 6]]\nrepeat = true\n",
            &expect![[r#"
                unknown-key `path`: there is no key `wall.path`
                  help: the keys here are from, to, thickness, height, name
                unknown-key `repeat`: there is no key `polygon.repeat`
                  help: the keys here are corners, height, name
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
        for table in SCHEMA.tables {
            let part = if table.name.contains("wheels") { "l" } else { "fSensor" };
            let name = table.name.replacen("NAME", "robot_1", 1).replacen("NAME", part, 1);
            let header = table.header(&name);
            let with = |key: &Key, value: &str| {
                let others = table.keys.iter().filter(|other| {
                    // Walls need a size, and only a path is repeated.
                    let is_needed = matches!(
                        (table.name, other.name, key.name),
                        ("world", "size", _) | (_, "path", "repeat")
                    );
                    let matters = other.required || is_needed;
                    matters && other.name != key.name
                });
                let others: Vec<String> =
                    others.map(|key| format!("{} = {}", key.name, key.example)).collect();
                let others = others.join("\n");
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
                if let Some(default) = key.default_value() {
                    assert_eq!(with(key, default), unset, "{} in {}", key.name, table.name);
                }
            }
        }
    }

    proptest! {
        #[test]
        fn no_text_breaks_the_reader(text in "(\\[{0,2}(world|box|robots\\.robot_1|wall|polygon)\\]{0,2}\n|(at|size|corners|start|from|to|path|repeat) = (\\[[-0-9.,\\[\\]e ]{0,20}|1e400|nan|true)\n|.){0,30}") {
            let (scene, _) = read(&text, floor());
            for obstacle in &scene.obstacles {
                prop_assert!(obstacle.outline(8).iter().all(|(x, y)| x.is_finite() && y.is_finite()));
            }
        }
    }
}
