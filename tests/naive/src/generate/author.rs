//! Writes a program bottom-up and tracks its declarations.

use super::Recipe;
use super::Statements;
use super::choices::Choices;
use super::layout;
use super::statements::Piece;
use super::words::{self, ADDRESSES, ANGLES, DISTANCES, ENDLESS, Numbers, PORTS, RADII, SPEEDS};

use crate::Source;
use crate::robot_types::{self, LAYOUTS, Layout};

/// The properties of a robot that its users depend on.
struct Robot {
    name: String,
    wheels: Vec<String>,
    mecanum: bool,
    sensors: Vec<String>,
    /// Whether it may run `slam`.
    explores: bool,
}

pub(super) struct Movement {
    pub(super) name: String,
    pub(super) robot: String,
    parallel: bool,
    /// The index of its entity.
    entity: usize,
    /// How much it does.
    pub(super) seconds: f64,
    pub(super) actions: f64,
    /// Whether another movement does it.
    pub(super) is_done: bool,
}

/// The properties of a robot that its statements depend on.
pub(super) struct Performer {
    pub(super) robot: String,
    pub(super) sensors: Vec<String>,
    /// Whether it may run `slam`.
    pub(super) explores: bool,
}

pub(super) struct Author {
    pub(super) recipe: Recipe,
    pub(super) choices: Choices,
    /// Whether there are statements with blocks, and those that came with them.
    grows: bool,
    /// The inverse probability of an error.
    careless: Option<usize>,
    pub(super) lines: usize,
    /// The radius of most wheels, as an index of the usual ones.
    radius: usize,
    /// The tokens of each entity.
    entities: Vec<Vec<String>>,
    wheels: Vec<String>,
    pub(super) sensors: Vec<String>,
    /// The distance sensors among them.
    pub(super) distance_sensors: Vec<String>,
    ips: Vec<String>,
    robots: Vec<Robot>,
    pub(super) movements: Vec<Movement>,
    environments: Vec<String>,
}

impl Author {
    pub(super) fn new(recipe: Recipe, mut choices: Choices) -> Self {
        let grows = match recipe.statements {
            Statements::Flat => false,
            Statements::Any => choices.below(3) > 0,
            Statements::Known => true,
        };
        let careless = choices.pick(&[None, None, Some(200), Some(40), Some(12)]).filter(|_| recipe.mistakes);
        let radius = choices.below(RADII.usual.len());
        Self {
            recipe,
            choices,
            grows,
            careless,
            lines: 0,
            radius,
            entities: Vec::new(),
            wheels: Vec::new(),
            sensors: Vec::new(),
            distance_sensors: Vec::new(),
            ips: Vec::new(),
            robots: Vec::new(),
            movements: Vec::new(),
            environments: Vec::new(),
        }
    }

    pub(super) fn write(&mut self) {
        while self.lines < self.recipe.lines && self.choices.has_more() {
            match self.choices.below(13) {
                1..=10 if !self.robots.is_empty() => self.movement(),
                11 if !self.robots.is_empty() => self.environment(),
                12 if self.slips() => self.lone_part(),
                _ => self.robot(),
            }
        }
        if !self.robots.is_empty() && !self.choices.once_in(8) {
            self.environment();
        }
        self.close_a_circle();
        self.choices.shuffle(&mut self.entities);
    }

    pub(super) fn text(mut self) -> String {
        if self.recipe.imports {
            let count = self.choices.below(3);
            let imports = ["lib.pyr", "parts/more.pyr"][..count].iter().map(|path| import(path));
            self.entities.splice(..0, imports);
        }
        self.lay_out()
    }

    /// The same program in several files, of which each imports some others. Some entities are in two files, and some imports
    /// lead nowhere.
    pub(super) fn files(mut self, dealing: Choices) -> Vec<Source> {
        self.choices = dealing;
        let mut dealt: [Vec<Vec<String>>; 3] = Default::default();
        for (from, entities) in dealt.iter_mut().enumerate() {
            for (to, path) in PATHS.iter().enumerate() {
                let once_in = if from == 0 { 8 } else { 3 };
                if to != from && self.choices.once_in(once_in) != (from == 0) {
                    entities.push(import(&relative(PATHS[from], path)));
                }
            }
            if self.slips() {
                entities.push(import("missing.pyr"));
            }
        }
        for entity in std::mem::take(&mut self.entities) {
            let file = self.choices.pick(&[0, 0, 0, 1, 1, 2]);
            if self.slips() {
                dealt[(file + 1) % PATHS.len()].push(entity.clone());
            }
            dealt[file].push(entity);
        }
        let files = PATHS.iter().zip(dealt).map(|(path, entities)| {
            self.entities = entities;
            Source { path, text: self.lay_out(), for_vrep: self.choices.once_in(2) }
        });
        files.collect()
    }

    fn lay_out(&mut self) -> String {
        if self.recipe.odd_layout && self.choices.once_in(2) {
            layout::odd(&mut self.choices, &self.entities)
        } else {
            layout::tidy(&self.entities)
        }
    }

    pub(super) fn slips(&mut self) -> bool {
        self.careless.is_some_and(|times| self.choices.once_in(times))
    }

    /// An error that few programs would have if it were as rare as others, because few have the place for it.
    pub(super) fn slips_in(&mut self, times: usize) -> bool {
        self.careless.is_some() && self.choices.once_in(times)
    }

    fn push(&mut self, tokens: Vec<String>) {
        self.lines += 1;
        self.entities.push(tokens);
    }

    fn names(&self) -> &'static [&'static str] {
        if self.grows { &words::NEW_NAMES } else { &words::NAMES }
    }

    /// A new name for a declaration; a taken one by error.
    fn new_name(&mut self, taken: &[String], words: &[&str]) -> String {
        if !taken.is_empty() && self.slips() {
            let index = self.choices.below(taken.len());
            return taken[index].clone();
        }
        let name = words::name(&mut self.choices, words);
        let is_free = |name: &String| !taken.iter().any(|other| plain(other) == plain(name));
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        std::iter::once(name.clone()).chain(numbered).find(is_free).unwrap_or(name)
    }

    /// A reference to a name; to another one by error.
    pub(super) fn reference(&mut self, name: &str) -> String {
        if self.slips() {
            let names = self.names();
            return words::name(&mut self.choices, names);
        }
        let may_hide = self.recipe.odd_layout && !name.starts_with('^');
        if may_hide && self.choices.once_in(30) { format!("^{name}") } else { name.to_owned() }
    }

    pub(super) fn number(&mut self, numbers: &Numbers) -> String {
        let is_doubtful = self.slips();
        let number = self.choices.pick(if is_doubtful { numbers.doubtful } else { numbers.usual });
        if number == ENDLESS {
            return "9".repeat(400);
        }
        let may_rewrite = self.recipe.odd_layout && self.choices.once_in(8);
        if may_rewrite { words::rewritten(&mut self.choices, number) } else { number.to_owned() }
    }

    /// `{ a, b c, }`
    pub(super) fn list(&mut self, names: &[String]) -> Vec<String> {
        let mut tokens = vec!["{".to_owned()];
        let commas = self.choices.pick(&[0, 1, 2]);
        for name in names {
            tokens.push(self.reference(name));
            if commas == 1 || commas == 2 && self.choices.once_in(2) {
                tokens.push(",".to_owned());
            }
        }
        tokens.push("}".to_owned());
        tokens
    }

    /// Removes, repeats or reverses names by error.
    fn mangle(&mut self, names: &mut Vec<String>) {
        if names.is_empty() || !self.slips() {
            return;
        }
        let index = self.choices.below(names.len());
        match self.choices.below(3) {
            0 => drop(names.remove(index)),
            1 => names.push(names[index].clone()),
            _ => names.reverse(),
        }
    }

    fn lone_part(&mut self) {
        match self.choices.below(3) {
            0 => drop(self.sensor()),
            1 => drop(self.wheel(false)),
            _ => drop(self.ip()),
        }
    }

    fn wheel(&mut self, mecanum: bool) -> String {
        self.wheel_called(mecanum, self.names())
    }

    fn wheel_called(&mut self, mecanum: bool, names: &[&str]) -> String {
        let taken = self.wheels.clone();
        let name = self.new_name(&taken, names);
        let mecanum = mecanum != self.slips();
        let radius = if self.careless.is_some() && self.choices.once_in(6) {
            self.number(&RADII)
        } else {
            self.number(&self.wheel_size())
        };
        let keyword = if mecanum { "wheelH" } else { "wheel" };
        self.push(words(&[keyword, &name, "with", "radius", &radius]));
        self.wheels.push(name.clone());
        name
    }

    fn wheel_size(&self) -> Numbers {
        Numbers { usual: &RADII.usual[self.radius..=self.radius], doubtful: RADII.doubtful }
    }

    fn sensor(&mut self) -> String {
        let taken = self.sensors.clone();
        let name = self.new_name(&taken, self.names());
        let tokens: &[&str] = match self.choices.below(6) {
            0..=2 => &["sensor", &name],
            3..=4 => &["sensor", &name, ":", "distance"],
            _ => &["sensor", &name, ":", "bumper"],
        };
        self.push(words(tokens));
        if tokens.last() != Some(&"bumper") {
            self.distance_sensors.push(name.clone());
        }
        self.sensors.push(name.clone());
        name
    }

    fn ip(&mut self) -> String {
        let taken = self.ips.clone();
        let name = self.new_name(&taken, self.names());
        let is_doubtful = self.slips() || self.slips_in(4);
        let address = self.choices.pick(if is_doubtful { ADDRESSES.doubtful } else { ADDRESSES.usual });
        self.push(words(&["ip", &name, address]));
        self.ips.push(name.clone());
        name
    }

    /// A robot with its wheels and sensors, unless it uses those of another.
    fn robot(&mut self) {
        let Layout { word: drive, wheels: count, mecanum } = self.choices.pick(&LAYOUTS);
        let wheels = self.some_wheels(count, mecanum);
        let sensors = self.some_sensors();
        let taken: Vec<String> = self.robots.iter().map(|robot| robot.name.clone()).collect();
        let name = self.new_name(&taken, self.names());
        let eyes = sensors.iter().filter(|sensor| self.distance_sensors.contains(sensor)).count();
        let robot = Robot { name, wheels, mecanum, explores: count == 2 && eyes >= 5, sensors };
        self.declare_robot(&robot, drive);
        self.robots.push(robot);
        self.movement_of(self.robots.len() - 1, false);
    }

    fn declare_robot(&mut self, robot: &Robot, drive: Option<&'static str>) {
        let drive = if self.slips() {
            let words = robot_types::words().into_iter().map(Some);
            self.choices.pick(&[None].into_iter().chain(words).collect::<Vec<_>>())
        } else {
            drive
        };
        let type_clause = drive.map(|drive| words(&["type", drive])).unwrap_or_default();
        let mut tokens = if self.recipe.older_spellings && self.choices.once_in(24) {
            [words(&["robot"]), type_clause, words(&[&robot.name])].concat()
        } else {
            [words(&["robot", &robot.name]), type_clause].concat()
        };
        let port = self.port();
        tokens.extend(words(&["with", "port", &port, "has"]));
        let mut wheels = robot.wheels.clone();
        self.mangle(&mut wheels);
        tokens.extend(self.list(&wheels));
        tokens.push("wheels".to_owned());
        if !robot.sensors.is_empty() {
            let mut sensors = robot.sensors.clone();
            self.mangle(&mut sensors);
            if !sensors.is_empty() {
                tokens.extend(words(&["with", "sensors"]));
                tokens.extend(self.list(&sensors));
            }
        }
        self.push(tokens);
    }

    /// A port, possibly with leading zeros.
    fn port(&mut self) -> String {
        let is_doubtful = self.slips() || self.slips_in(40);
        let port = self.choices.pick(if is_doubtful { PORTS.doubtful } else { PORTS.usual });
        let zeros = if self.recipe.odd_layout && self.choices.once_in(20) { "00" } else { "" };
        format!("{zeros}{port}")
    }

    fn some_wheels(&mut self, count: usize, mecanum: bool) -> Vec<String> {
        let fits = |robot: &&Robot| robot.mecanum == mecanum && robot.wheels.len() == count;
        if let Some(wheels) = self.robots.iter().find(fits).map(|robot| robot.wheels.clone())
            && self.choices.once_in(2)
        {
            return wheels;
        }
        if !self.recipe.mistakes || !self.choices.once_in(3) {
            return (0..count).map(|_| self.wheel(mecanum)).collect();
        }
        // By their sides; some in another order, which is only a hint.
        let names = words::by_sides(count);
        let mut wheels: Vec<String> = names.iter().map(|name| self.wheel_called(mecanum, &[name])).collect();
        if self.choices.once_in(3) {
            self.choices.shuffle(&mut wheels);
        }
        wheels
    }

    fn some_sensors(&mut self) -> Vec<String> {
        let count = self.choices.pick(&[0, 0, 1, 2, 6, 7]);
        let mut sensors = Vec::new();
        for index in 0..count {
            let existing = self.sensors.get(index).cloned().filter(|_| self.choices.once_in(2));
            let sensor = match existing.filter(|sensor| !sensors.contains(sensor)) {
                Some(sensor) => sensor,
                None => self.sensor(),
            };
            sensors.push(sensor);
        }
        sensors
    }

    /// A movement of any robot, or two parallel ones.
    fn movement(&mut self) {
        let robot = self.choices.below(self.robots.len());
        let may_pair = self.robots.len() > 1;
        if may_pair && self.choices.once_in(4) {
            let other = (robot + 1) % self.robots.len();
            self.movement_of(robot, true);
            self.movement_of(other, true);
        } else {
            self.movement_of(robot, false);
        }
    }

    fn movement_of(&mut self, robot: usize, parallel: bool) {
        let parallel = parallel != self.slips();
        let performer = {
            let robot = &self.robots[robot];
            Performer { robot: robot.name.clone(), sensors: robot.sensors.clone(), explores: robot.explores }
        };
        let taken: Vec<String> = self.movements.iter().map(|movement| movement.name.clone()).collect();
        let name = self.new_name(&taken, self.names());
        let of = self.reference(&performer.robot);
        let mut tokens = words(if parallel { &["parallel", "movement"] } else { &["movement"] });
        tokens.extend(words(&[&name, "of", &of, "{"]));
        let count = if self.slips() { 0 } else { 1 + self.choices.below(5) };
        let body = if self.grows {
            self.statements(&name, &performer, count)
        } else {
            self.actions(&performer, count)
        };
        tokens.extend(body.tokens);
        tokens.push("}".to_owned());
        let entity = self.entities.len();
        self.push(tokens);
        let (seconds, actions) = (body.seconds, body.actions);
        let robot = performer.robot;
        self.movements.push(Movement { name, robot, parallel, entity, seconds, actions, is_done: false });
    }

    /// By error, a movement does one that does it, or any other.
    fn close_a_circle(&mut self) {
        if self.movements.is_empty() || !self.grows || !self.slips_in(8) {
            return;
        }
        let entity = self.movements[self.choices.below(self.movements.len())].entity;
        let done = self.movements[self.choices.below(self.movements.len())].name.clone();
        let tokens = &mut self.entities[entity];
        tokens.splice(tokens.len() - 1..tokens.len() - 1, ["do".to_owned(), done]);
    }

    /// The actions without blocks and what came with them.
    fn actions(&mut self, performer: &Performer, count: usize) -> Piece {
        let mut tokens = Vec::new();
        for _ in 0..count {
            tokens.extend(self.action(&performer.sensors, performer.explores));
            self.lines += 1;
        }
        Piece { tokens, ..Piece::default() }
    }

    fn action(&mut self, sensors: &[String], explores: bool) -> Vec<String> {
        match self.choices.below(8) {
            6 if !sensors.is_empty() => self.turn_until(sensors),
            7 if explores || self.slips() || self.slips_in(80) => words(&["slam"]),
            4..=6 => self.turn(),
            _ => self.move_(),
        }
    }

    fn move_(&mut self) -> Vec<String> {
        let distance = self.number(&DISTANCES);
        let unit = self.choices.pick(&["meters", "centimeters"]);
        let mut tokens = words(&["move", &distance, unit]);
        if self.choices.once_in(3) {
            let speed = self.number(&SPEEDS);
            tokens.extend(words(&["at", &speed]));
        }
        tokens
    }

    fn turn(&mut self) -> Vec<String> {
        let mut tokens = words(&["turn", self.choices.pick(&["left", "right"])]);
        if self.choices.once_in(2) {
            tokens.push(self.number(&ANGLES));
        }
        tokens
    }

    fn turn_until(&mut self, sensors: &[String]) -> Vec<String> {
        let count = 1 + self.choices.below(sensors.len());
        let mut named = sensors[..count].to_vec();
        if self.slips() {
            named.push(self.sensors[self.choices.below(self.sensors.len())].clone());
        }
        let mut tokens = words(&["turn", self.choices.pick(&["left", "right"]), "until"]);
        tokens.extend(self.list(&named));
        tokens
    }

    fn environment(&mut self) {
        let taken = self.environments.clone();
        let may_clash = self.slips();
        let name = self.new_name(&taken, if may_clash { &words::SCRIPTS } else { &words::NAMES });
        let ip_clause = self.ip_clause();
        let robots = self.cast();
        let movements = self.schedule(&robots);
        let mut tokens = [words(&["environment", &name]), ip_clause, words(&["has"])].concat();
        tokens.extend(self.list(&robots));
        tokens.push("robots".to_owned());
        if !movements.is_empty() || self.choices.once_in(2) {
            tokens.push("with".to_owned());
            tokens.extend(self.list(&movements));
            tokens.push("moves".to_owned());
        }
        self.push(tokens);
        self.environments.push(name);
    }

    fn ip_clause(&mut self) -> Vec<String> {
        if !self.choices.once_in(3) {
            return Vec::new();
        }
        let name = if self.ips.is_empty() { self.ip() } else { self.ips[0].clone() };
        let name = self.reference(&name);
        let is_older = self.recipe.older_spellings && self.choices.once_in(8);
        if is_older { words(&[",", &name]) } else { words(&["with", "ip", &name]) }
    }

    /// The robots of an environment.
    fn cast(&mut self) -> Vec<String> {
        let all: Vec<String> = self.robots.iter().map(|robot| robot.name.clone()).collect();
        let mut robots: Vec<String> = all.into_iter().filter(|_| !self.slips()).collect();
        self.mangle(&mut robots);
        if self.recipe.mistakes && self.choices.once_in(12) {
            // Both are only warnings.
            match robots.first().cloned().filter(|_| self.choices.once_in(2)) {
                Some(first) => robots.push(first),
                None => robots.clear(),
            }
        }
        robots
    }

    /// The movements of these robots, without conflicts unless by error.
    fn schedule(&mut self, robots: &[String]) -> Vec<String> {
        let mut listed = Vec::new();
        let mut busy: Vec<&str> = Vec::new();
        for movement in &self.movements {
            let times = self.careless.unwrap_or(usize::MAX);
            if movement.is_done && self.choices.once_in(2) {
                continue;
            }
            let mut slips = || self.careless.is_some() && self.choices.once_in(times);
            if !movement.parallel {
                busy.clear();
            }
            let fits = robots.contains(&movement.robot) && !busy.contains(&movement.robot.as_str());
            if fits != slips() {
                listed.push(movement.name.clone());
                if movement.parallel {
                    busy.push(&movement.robot);
                }
            }
        }
        if self.recipe.mistakes && self.choices.once_in(6) {
            self.leave_one_idle(robots, &mut listed);
        }
        if self.slips_in(if self.grows { 3 } else { 5 }) {
            self.start_one_twice(&mut listed);
        }
        self.mangle(&mut listed);
        listed
    }

    /// Removes all movements of a robot that is not the only one.
    fn leave_one_idle(&mut self, robots: &[String], listed: &mut Vec<String>) {
        if robots.len() > 1 {
            let idle = &robots[self.choices.below(robots.len())];
            let is_of_idle = |movement: &&Movement| movement.robot == *idle;
            let movements: Vec<&str> =
                self.movements.iter().filter(is_of_idle).map(|movement| movement.name.as_str()).collect();
            listed.retain(|name| !movements.contains(&name.as_str()));
        }
    }

    /// Lists a parallel movement twice in a row.
    fn start_one_twice(&self, listed: &mut Vec<String>) {
        let is_parallel =
            |name: &String| self.movements.iter().any(|movement| movement.name == *name && movement.parallel);
        if let Some(place) = listed.iter().position(is_parallel) {
            listed.insert(place, listed[place].clone());
        }
    }
}

/// The paths of a project's files.
const PATHS: [&str; 3] = ["main.pyr", "lib.pyr", "parts/more.pyr"];

fn import(path: &str) -> Vec<String> {
    vec!["import".to_owned(), format!("\"{path}\"")]
}

/// A path as the file at another one names it.
fn relative(from: &str, to: &str) -> String {
    let up = "../".repeat(from.matches('/').count());
    let in_same_folder =
        from.rsplit_once('/').map(|(folder, _)| folder) == to.rsplit_once('/').map(|(folder, _)| folder);
    if in_same_folder { to.rsplit('/').next().unwrap_or(to).to_owned() } else { format!("{up}{to}") }
}

pub(super) fn plain(name: &str) -> &str {
    name.trim_start_matches('^')
}

pub(super) fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}
