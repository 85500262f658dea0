//! Statements with blocks, and those that came with them.
//!
//! A block is written before the statement around it, which then repeats it as often as it may.

use super::Statements;
use super::author::{Author, Performer, words};
use super::words::{
    ANGLES, ANGLES_ON_CIRCLES, CIRCLES, COUNTS, DISTANCES, NEAR, Numbers, ROUND_SPEEDS, SHORT_DISTANCES,
    TIMES,
};

/// Some statements, and how much they do when loops are unrolled and conditions are always true: an estimate.
#[derive(Default)]
pub(super) struct Piece {
    pub(super) tokens: Vec<String>,
    pub(super) seconds: f64,
    pub(super) actions: f64,
}

impl Piece {
    fn one(tokens: Vec<String>, seconds: f64) -> Self {
        Self { tokens, seconds, actions: 1.0 }
    }

    fn then(&mut self, next: Self) {
        self.tokens.extend(next.tokens);
        self.seconds += next.seconds;
        self.actions += next.actions;
    }

    fn is_within(&self, most: Most) -> bool {
        self.seconds <= most.seconds && self.actions <= most.actions
    }

    fn times(&self, count: f64) -> Self {
        Self { tokens: Vec::new(), seconds: self.seconds * count, actions: self.actions * count }
    }
}

/// What a movement does at most, unless by error.
#[derive(Clone, Copy)]
struct Most {
    seconds: f64,
    actions: f64,
}

/// Even ten of them take less than 30 days.
const MUCH: Most = Most { seconds: 200_000.0, actions: 2_000.0 };
/// Little enough to be driven in a test.
const LITTLE: Most = Most { seconds: 2_000.0, actions: 300.0 };

/// The heights of towers of blocks; the last two are too high.
const TOWERS: [usize; 5] = [8, 15, 16, 17, 21];

struct Movement<'a> {
    name: &'a str,
    performer: &'a Performer,
}

impl Author {
    /// The body of a movement.
    pub(super) fn statements(&mut self, name: &str, performer: &Performer, count: usize) -> Piece {
        let movement = Movement { name, performer };
        let depth = self.choices.pick(&[1, 2, 3, 5]);
        let mut body = Piece::default();
        for _ in 0..count {
            let piece = if self.choices.once_in(20) {
                self.tower(&movement)
            } else {
                self.statement(&movement, depth)
            };
            let sum = Piece {
                seconds: body.seconds + piece.seconds,
                actions: body.actions + piece.actions,
                ..Piece::default()
            };
            if sum.is_within(self.most()) || self.slips_in(2) {
                body.then(piece);
            } else {
                body.then(self.wait(&movement));
            }
        }
        body
    }

    fn only_known(&self) -> bool {
        self.recipe.statements == Statements::Known
    }

    fn most(&self) -> Most {
        if self.only_known() { LITTLE } else { MUCH }
    }

    fn statement(&mut self, movement: &Movement<'_>, depth: usize) -> Piece {
        self.lines += 1;
        let may_ask = !movement.performer.sensors.is_empty() && !self.only_known();
        match self.choices.below(20) {
            3 | 4 => self.turn_in_place(movement),
            5 | 6 => self.arc(movement),
            7 => self.wait(movement),
            8 | 9 => self.do_(movement),
            10..=13 if depth > 0 => self.repeat(movement, depth),
            14 if may_ask && depth > 0 => self.repeat_until(movement, depth),
            15 | 16 if may_ask && depth > 0 => self.if_(movement, depth),
            17 if may_ask => self.article_turn(movement),
            18 if may_ask => self.move_until(movement),
            19 if !self.only_known() && (movement.performer.explores || self.slips_in(20)) => {
                Piece::one(words(&["slam"]), 0.0)
            }
            _ => self.move_on(movement),
        }
    }

    /// Many blocks, one in another.
    fn tower(&mut self, movement: &Movement<'_>) -> Piece {
        let heights = if self.slips_in(2) { &TOWERS[..] } else { &TOWERS[..3] };
        let height = self.choices.pick(heights);
        let may_ask = !movement.performer.sensors.is_empty() && !self.only_known();
        let mut piece = self.wait(movement);
        for _ in 0..height {
            self.lines += 1;
            piece = if may_ask && self.choices.once_in(2) {
                let mut tokens = words(&["if"]);
                tokens.extend(self.condition(movement));
                in_block(tokens, piece)
            } else {
                // Once is only a warning.
                let count = if piece.times(2.0).is_within(self.most()) { "2" } else { "1" };
                times(count, piece)
            };
        }
        piece
    }

    fn move_on(&mut self, movement: &Movement<'_>) -> Piece {
        let (mut tokens, metres) = self.distance();
        let speed = self.speed();
        tokens.extend(speed.tokens);
        let mut seconds = metres / speed.value;
        if self.may_stop(movement, 6) {
            tokens.extend(self.stop(movement));
            seconds = 0.0;
        }
        Piece::one(tokens, seconds)
    }

    fn distance(&mut self) -> (Vec<String>, f64) {
        let number = self.number(if self.only_known() { &SHORT_DISTANCES } else { &DISTANCES });
        let unit = self.unit();
        let metres = value(&number).abs() * if unit == "meters" { 1.0 } else { 0.01 };
        (words(&["move", &number, unit]), metres)
    }

    fn move_until(&mut self, movement: &Movement<'_>) -> Piece {
        let mut tokens = words(&["move"]);
        tokens.extend(self.speed().tokens);
        tokens.extend(self.stop(movement));
        Piece::one(tokens, 0.0)
    }

    fn turn_in_place(&mut self, movement: &Movement<'_>) -> Piece {
        let mut tokens = words(&["turn", self.choices.pick(&["left", "right"])]);
        if self.choices.once_in(2) {
            tokens.push(self.number(&ANGLES));
        }
        tokens.extend(self.speed().tokens);
        if self.slips_in(20) {
            tokens.extend(words(&["in", "reverse"]));
        }
        if self.may_stop(movement, 6) {
            tokens.extend(self.stop(movement));
        }
        Piece::one(tokens, 100.0)
    }

    fn article_turn(&mut self, movement: &Movement<'_>) -> Piece {
        let mut tokens = words(&["turn", self.choices.pick(&["left", "right"]), "until"]);
        let mut condition = self.condition(movement);
        if !condition.iter().any(|word| word == "within") && self.choices.below(3) < 2 {
            // Its word may be missing.
            condition.truncate(condition.iter().position(|word| word == "}").map_or(0, |end| end + 1));
        }
        tokens.extend(condition);
        Piece::one(tokens, 100.0)
    }

    fn arc(&mut self, movement: &Movement<'_>) -> Piece {
        let mut tokens = words(&["turn", self.choices.pick(&["left", "right"])]);
        let mut degrees = 90.0;
        if self.choices.below(4) < 3 {
            let angle = self.doubtful_number(&ANGLES_ON_CIRCLES, 60);
            degrees = value(&angle).abs();
            tokens.push(angle);
        }
        let radius = self.doubtful_number(&CIRCLES, 60);
        // A robot can drive no circle of millimetres.
        let unit = if self.only_known() { "meters" } else { self.unit() };
        tokens.extend(words(&["with", "radius", &radius, unit]));
        let speed = self.speed();
        tokens.extend(speed.tokens);
        if self.choices.once_in(4) {
            tokens.extend(words(&["in", "reverse"]));
        }
        if self.may_stop(movement, 6) {
            tokens.extend(self.stop(movement));
        }
        Piece::one(tokens, degrees.to_radians() * (value(&radius).abs() + 1.0) / speed.value)
    }

    fn wait(&mut self, movement: &Movement<'_>) -> Piece {
        let may_ask = self.may_stop(movement, 3);
        let mut tokens = words(&["wait"]);
        let mut seconds = 0.0;
        if !may_ask || self.choices.once_in(2) {
            let number = self.doubtful_number(&TIMES, 30);
            seconds = value(&number).abs();
            tokens.extend(words(&[&number, "seconds"]));
        }
        if may_ask {
            tokens.extend(self.stop(movement));
        }
        Piece::one(tokens, seconds)
    }

    /// Another movement of the same robot that is not too much; by error, one of another robot, or itself.
    fn do_(&mut self, movement: &Movement<'_>) -> Piece {
        let any = self.slips_in(4);
        let most = self.most();
        if any && self.choices.once_in(6) {
            return Piece::one(words(&["do", movement.name]), 0.0);
        }
        let fits = |index: &usize| {
            let other = &self.movements[*index];
            let is_small = other.seconds < most.seconds / 4.0 && other.actions < most.actions / 4.0;
            (other.robot == movement.performer.robot) != any && (any || is_small)
        };
        let others: Vec<usize> = (0..self.movements.len()).filter(fits).collect();
        if others.is_empty() {
            return self.move_on(movement);
        }
        let other = self.choices.pick(&others);
        self.movements[other].is_done = true;
        let (name, seconds, actions) = {
            let other = &self.movements[other];
            (other.name.clone(), other.seconds, other.actions)
        };
        let name = self.reference(&name);
        Piece { tokens: words(&["do", &name]), seconds, actions: actions + 1.0 }
    }

    fn repeat(&mut self, movement: &Movement<'_>, depth: usize) -> Piece {
        let mut body = self.block(movement, depth);
        if self.slips_in(60) {
            body.then(Piece::one(words(&["wait", "86400", "seconds"]), 86_400.0));
            return times(self.choices.pick(&["31", "10000"]), body);
        }
        let count = self.doubtful_number(&COUNTS, 50);
        if body.times(value(&count).abs()).is_within(self.most()) || self.slips_in(2) {
            times(&count, body)
        } else if body.times(2.0).is_within(self.most()) {
            times("2", body)
        } else {
            body
        }
    }

    fn repeat_until(&mut self, movement: &Movement<'_>, depth: usize) -> Piece {
        let body = self.block(movement, depth);
        let mut tokens = words(&["repeat", "until"]);
        tokens.extend(self.condition(movement));
        in_block(tokens, body)
    }

    fn if_(&mut self, movement: &Movement<'_>, depth: usize) -> Piece {
        let then = self.block(movement, depth);
        let mut tokens = words(&["if"]);
        tokens.extend(self.condition(movement));
        let mut piece = in_block(tokens, then);
        let others = self.choices.pick(&[0, 1, 1, 2, 3]);
        for other in 0..others {
            let mut tokens = words(&["else"]);
            if other + 1 < others {
                tokens.push("if".to_owned());
                tokens.extend(self.condition(movement));
            }
            let block = self.block(movement, depth);
            let next = in_block(tokens, block);
            piece.then(next);
        }
        piece
    }

    /// Statements for a block; none by error.
    fn block(&mut self, movement: &Movement<'_>, depth: usize) -> Piece {
        let mut body = Piece::default();
        let count = if self.slips_in(40) { 0 } else { 1 + self.choices.below(2) };
        for _ in 0..count {
            let piece = self.statement(movement, depth - 1);
            body.then(piece);
        }
        body
    }

    fn may_stop(&mut self, movement: &Movement<'_>, times: usize) -> bool {
        !movement.performer.sensors.is_empty() && !self.only_known() && self.choices.once_in(times)
    }

    fn stop(&mut self, movement: &Movement<'_>) -> Vec<String> {
        let mut tokens = words(&["until"]);
        tokens.extend(self.condition(movement));
        tokens
    }

    fn condition(&mut self, movement: &Movement<'_>) -> Vec<String> {
        let sensors = &movement.performer.sensors;
        let count = 1 + self.choices.below(sensors.len());
        let mut named = sensors[..count].to_vec();
        if self.slips() {
            named.push(self.sensors[self.choices.below(self.sensors.len())].clone());
        }
        let measures = named.iter().any(|sensor| self.distance_sensors.contains(sensor));
        let mut tokens = self.list(&named);
        if !self.slips_in(60) {
            tokens.extend(words(&[self.choices.pick(&["clear", "detect"])]));
        }
        if (measures || self.slips_in(4)) && self.choices.once_in(3) {
            let near = self.doubtful_number(&NEAR, 20);
            let unit = self.unit();
            tokens.extend(words(&["within", &near, unit]));
        }
        tokens
    }

    fn unit(&mut self) -> &'static str {
        self.choices.pick(&["meters", "centimeters"])
    }

    /// An optional speed, in metres per second.
    fn speed(&mut self) -> Speed {
        if !self.choices.once_in(3) {
            return Speed { tokens: Vec::new(), value: 0.09 };
        }
        let speed = self.number(&ROUND_SPEEDS);
        let value = value(&speed).abs().max(0.001) / 100.0;
        Speed { tokens: words(&["at", &speed]), value }
    }

    /// A number that is wrong more often than others.
    fn doubtful_number(&mut self, numbers: &Numbers, times: usize) -> String {
        if self.slips_in(times) {
            self.number(&Numbers { usual: numbers.doubtful, doubtful: numbers.doubtful })
        } else {
            self.number(numbers)
        }
    }
}

/// `HEAD { BODY }`
fn in_block(mut head: Vec<String>, body: Piece) -> Piece {
    head.push("{".to_owned());
    head.extend(body.tokens);
    head.push("}".to_owned());
    Piece { tokens: head, ..body }
}

fn times(count: &str, body: Piece) -> Piece {
    let much = body.times(value(count).abs());
    let piece = in_block(words(&["repeat", count, "times"]), body);
    Piece { tokens: piece.tokens, ..much }
}

struct Speed {
    tokens: Vec<String>,
    value: f64,
}

fn value(number: &str) -> f64 {
    number.parse().unwrap_or(f64::INFINITY)
}
