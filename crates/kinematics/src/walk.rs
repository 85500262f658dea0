//! The walk through a movement: one leg after the other, round by round, as far as they are to be listed.

use crate::action::Course;
use crate::block::{Block, Node, NodeKind};
use crate::leg::{ActionIndex, Call, Leg, Place};
use crate::path::RobotPath;
use crate::summary::Summary;

/// Calls nested deeper are listed as one entry. Each entry names the calls around it; without a limit,
/// a list of moderate length would not fit into memory.
pub(crate) const MAX_CALL_DEPTH: usize = 32;

/// The maximum number of possible legs listed after the last known pose.
const MAX_POSSIBLE_LEGS: u64 = 1_000;

/// A walk along the steps of one robot.
pub(crate) struct Walk<'p> {
    /// One for each movement that can be called.
    blocks: &'p [Block],
    path: RobotPath,
    /// When it ends, seconds, as far as it is known.
    clock: Option<f64>,
    /// The number of legs that may still be listed.
    left: u64,
    /// The group and the run.
    index: ActionIndex,
    /// True if it is along one of several ways. Those of a branch on it are not walked: they double at each.
    is_way: bool,
    frames: Vec<Frame<'p>>,
    rounds: Vec<u32>,
    /// The total of each of `rounds`.
    counts: Vec<u32>,
    calls: Vec<Call>,
    /// That of `rounds`, `counts` and `calls`, once it is asked for.
    place: Option<Place>,
}

/// A block that the walk is in.
#[derive(Clone, Copy)]
struct Frame<'p> {
    block: &'p Block,
    next: usize,
    entered: Entered,
}

/// Why the walk is in a block.
#[derive(Clone, Copy)]
enum Entered {
    Whole,
    Rounds { count: u32 },
    Call,
}

impl<'p> Walk<'p> {
    /// Starts at the end of `path` and lists so many legs at most.
    pub(crate) fn new(blocks: &'p [Block], path: RobotPath, max_legs: u64) -> Self {
        let index = ActionIndex { group: 0, run: 0, action: 0 };
        Self {
            blocks,
            path,
            clock: Some(0.0),
            left: max_legs,
            index,
            is_way: false,
            frames: Vec::new(),
            rounds: Vec::new(),
            counts: Vec::new(),
            calls: Vec::new(),
            place: None,
        }
    }

    /// Returns the walked path.
    pub(crate) fn into_path(self) -> RobotPath {
        self.path
    }

    /// Walks one run, from a time on; returns when it ends, `None` if nobody knows.
    pub(crate) fn run(
        &mut self,
        block: &'p Block,
        group: usize,
        run: usize,
        clock: Option<f64>,
    ) -> Option<f64> {
        self.index = ActionIndex { group, run, action: 0 };
        self.clock = clock;
        self.walk(block);
        self.clock
    }

    fn walk(&mut self, block: &'p Block) {
        self.frames.push(Frame { block, next: 0, entered: Entered::Whole });
        while let Some(frame) = self.frames.last_mut() {
            if self.path.unknown_after.is_some() {
                self.clock = None;
                self.frames.clear();
                return;
            }
            if let Some(node) = frame.block.nodes.get(frame.next) {
                frame.next += 1;
                self.step(node);
            } else {
                self.end_of_block();
            }
        }
    }

    fn step(&mut self, node: &'p Node) {
        if self.left == 0 && self.skip(&node.summary) {
            return;
        }
        match &node.kind {
            NodeKind::Course(course) => self.list(node.number, course),
            NodeKind::Unknown(limit) => self.lose(node.number, limit.as_deref().map(Possible::Bound)),
            NodeKind::Repeat { count, body } => {
                self.rounds.push(1);
                self.counts.push(*count);
                self.enter(body, Entered::Rounds { count: *count });
            }
            NodeKind::Branch { ways } => self.whole(node, Some(Possible::Ways(ways))),
            NodeKind::Call { movement } => match self.blocks.get(*movement) {
                Some(block) if self.calls.len() < MAX_CALL_DEPTH => {
                    self.calls.push(Call { action: node.number, movement: *movement });
                    self.enter(block, Entered::Call);
                }
                _ => self.whole(node, None),
            },
        }
    }

    fn enter(&mut self, block: &'p Block, entered: Entered) {
        self.place = None;
        self.frames.push(Frame { block, next: 0, entered });
    }

    fn end_of_block(&mut self) {
        let Some(&Frame { block, entered, .. }) = self.frames.last() else { return };
        match entered {
            Entered::Whole => {}
            Entered::Rounds { count } if self.next_round(block, count) => return,
            Entered::Rounds { .. } => {
                self.rounds.pop();
                self.counts.pop();
            }
            Entered::Call => drop(self.calls.pop()),
        }
        self.place = None;
        self.frames.pop();
    }

    /// Returns whether there is another round that has to be looked at.
    fn next_round(&mut self, block: &Block, count: u32) -> bool {
        let rest = self.rounds.last().map_or(0, |round| count.saturating_sub(*round));
        if rest == 0 || (self.left == 0 && self.skip(&block.summary.repeated(rest))) {
            return false;
        }
        self.place = None;
        self.rounds.iter_mut().last().into_iter().for_each(|round| *round += 1);
        self.frames.iter_mut().last().into_iter().for_each(|frame| frame.next = 0);
        true
    }

    /// Goes on behind steps without a list of them; not if their end is unknown.
    fn skip(&mut self, steps: &Summary) -> bool {
        let Some(motion) = steps.motion else { return false };
        self.path.truncated = true;
        self.path.end = self.path.end.compose(&motion.change);
        self.clock = self.clock.map(|clock| clock + motion.seconds);
        true
    }

    /// Lists a statement as one leg if it is known where it ends.
    fn whole(&mut self, node: &'p Node, possible: Option<Possible<'p>>) {
        match node.summary.motion {
            Some(motion) => self.list(node.number, &Course::whole(&motion.change, motion.seconds)),
            None => self.lose(node.number, possible),
        }
    }

    fn list(&mut self, number: usize, course: &Course) {
        let leg = self.leg(number, course);
        self.clock = leg.end();
        self.path.end = leg.to;
        self.path.legs.push(leg);
        self.left = self.left.saturating_sub(1);
    }

    fn leg(&mut self, number: usize, course: &Course) -> Leg {
        Leg {
            index: ActionIndex { action: number, ..self.index },
            place: self.place(),
            kind: course.kind,
            from: self.path.end,
            to: course.end(self.path.end),
            start: self.clock,
            duration: course.duration,
            rates: course.rates,
            profile: course.profile,
            twist: course.twist,
        }
    }

    fn place(&mut self) -> Place {
        self.place.get_or_insert_with(|| Place::new(&self.rounds, &self.counts, &self.calls)).clone()
    }

    /// From here on nothing is known.
    fn lose(&mut self, number: usize, possible: Option<Possible<'p>>) {
        self.path.unknown_after = Some(ActionIndex { action: number, ..self.index });
        self.path.unknown_place = self.place();
        match possible {
            Some(Possible::Bound(course)) => {
                let leg = self.leg(number, course);
                self.path.possible.push(vec![leg]);
            }
            Some(Possible::Ways(ways)) if !self.is_way => self.path.possible = self.ways(ways),
            _ => {}
        }
    }

    /// Each way up to its own first unknown statement, and that one to its bound.
    fn ways(&self, ways: &'p [Block]) -> Vec<Vec<Leg>> {
        let mut left = MAX_POSSIBLE_LEGS;
        let mut found = Vec::new();
        for way in ways {
            let mut walk = Walk {
                clock: self.clock,
                index: self.index,
                is_way: true,
                rounds: self.rounds.clone(),
                counts: self.counts.clone(),
                calls: self.calls.clone(),
                ..Walk::new(self.blocks, RobotPath::new(self.path.end), left)
            };
            walk.walk(way);
            let RobotPath { mut legs, possible, truncated, .. } = walk.path;
            left = left.saturating_sub(legs.len() as u64);
            if !truncated {
                legs.extend(possible.into_iter().flatten());
            }
            if !legs.is_empty() {
                found.push(legs);
            }
        }
        found
    }
}

/// The possible drives of a robot where its path becomes unknown.
#[derive(Clone, Copy)]
enum Possible<'p> {
    Bound(&'p Course),
    Ways(&'p [Block]),
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    use super::*;
    use crate::testing::{
        arc, call, either, forward, left, numbered, repeat, slam, step, turn, two_wheels, until, wait,
    };
    use crate::{
        LegKind, MAX_ACTIONS, MotionPrimitive, Movement, Plan, Pose, RobotPlan, Step, StepKind,
        plan_movement, plan_schedule, plan_step, plan_steps,
    };

    fn path(steps: Vec<Step>) -> RobotPath {
        plan_steps(&two_wheels(), Pose::default(), &numbered(steps), &[])
    }

    fn numbers(path: &RobotPath) -> Vec<usize> {
        path.legs.iter().map(|leg| leg.index.action).collect()
    }

    fn calls(place: &Place) -> Vec<(usize, usize)> {
        place.calls().iter().map(|call| (call.action, call.movement)).collect()
    }

    #[track_caller]
    fn comes_to(path: &RobotPath, legs: usize, (x, y, degrees): (f64, f64, f64)) {
        let end = path.end();
        assert!(end.distance(&Pose::new(x, y, 0.0)) < 1e-9, "{end:?}");
        assert!(crate::angle_between(end.theta, degrees.to_radians()).abs() < 1e-9, "{end:?}");
        assert_eq!((path.legs.len(), path.truncated, path.unknown_after), (legs, false, None));
    }

    #[test]
    fn a_square_in_four_rounds() {
        let path = path(vec![repeat(4, vec![forward(2.0), left()])]);
        comes_to(&path, 8, (0.0, 0.0, 0.0));
        assert_eq!(numbers(&path), [1, 2, 1, 2, 1, 2, 1, 2]);
        let rounds: Vec<&[u32]> = path.legs.iter().map(|leg| leg.place.rounds()).collect();
        assert_eq!(rounds, [[1], [1], [2], [2], [3], [3], [4], [4]]);
    }

    #[test]
    fn three_levels_of_rounds() {
        let inner = repeat(2, vec![forward(1.0), repeat(4, vec![turn(45.0)])]);
        let path = path(vec![repeat(3, vec![inner, arc(360.0, 0.5, 0.09)])]);
        comes_to(&path, 33, (0.0, 0.0, 0.0));
        assert_eq!(path.legs[32].place.rounds(), [3]);
        assert_eq!((path.legs[31].place.rounds(), path.legs[31].index.action), (&[3, 2, 4][..], 4));
        assert_eq!((path.legs[32].place.counts(), path.legs[31].place.counts()), (&[3][..], &[3, 2, 4][..]));
    }

    #[test]
    fn a_slalom_of_arcs_and_lanes_that_never_turn_in_place() {
        let path_of = path;
        let slalom = vec![arc(90.0, 0.5, 0.09), arc(-180.0, 0.5, 0.2), arc(90.0, 0.5, 0.09)];
        comes_to(&path_of(slalom), 3, (2.0, 0.0, 0.0));
        let lane = || step(StepKind::Action(MotionPrimitive::Move { distance: 4.0, speed: 0.3 }));
        let lanes = repeat(5, vec![lane(), arc(-180.0, 0.25, 0.3), lane(), arc(180.0, 0.25, 0.3)]);
        comes_to(&path_of(vec![lanes]), 20, (0.0, -5.0, 0.0));
    }

    #[test]
    fn a_movement_that_does_others() {
        let side = numbered(vec![forward(1.0), left()]);
        let square = numbered(vec![repeat(2, vec![call(0), call(0)])]);
        let twice = numbered(vec![call(1), call(1)]);
        let path = plan_steps(&two_wheels(), Pose::default(), &twice, &[side, square]);
        comes_to(&path, 16, (0.0, 0.0, 0.0));
        let last = &path.legs[15];
        assert_eq!((last.index.action, last.place.rounds()), (1, &[2][..]));
        assert_eq!(calls(&last.place), [(1, 1), (2, 0)]);
    }

    #[test]
    fn a_call_alone_is_one_leg_to_where_its_movement_ends() {
        let side = numbered(vec![forward(1.0), left()]);
        let start = Pose::new(1.0, 2.0, 0.5);
        let summary = Summary::of(&two_wheels(), &side, &|_| None);
        let alone = plan_step(&two_wheels(), start, call(0), &|_| Some(summary));
        let whole = plan_steps(&two_wheels(), start, &numbered(vec![call(0)]), &[side]);
        assert!(alone.end().distance(&whole.end()) < 1e-12 && alone.legs.len() == 1, "{alone:?}");
        assert_eq!(plan_step(&two_wheels(), start, call(0), &|_| None).legs, []);
    }

    #[test]
    fn a_movement_that_does_itself_or_a_later_one_is_unknown_there() {
        let movements = [vec![forward(1.0), call(0)], vec![call(2)], vec![forward(1.0)]].map(numbered);
        for (movement, legs, action) in [(0, 1, 1), (1, 0, 0)] {
            let steps = numbered(vec![call(movement)]);
            let path = plan_steps(&two_wheels(), Pose::default(), &steps, &movements);
            let lost = path.unknown_after.map(|index| index.action);
            assert_eq!((path.legs.len(), lost), (legs, Some(action)));
            assert_eq!(calls(&path.unknown_place), [(0, movement)]);
        }
    }

    /// Each movement does the one before twice, after a metre: no list or stack may grow with what that comes to.
    #[test]
    fn calls_of_calls_are_listed_up_to_a_depth_and_right_at_any() {
        let deep = |depth: usize, times: usize| {
            let mut movements = vec![numbered(vec![forward(1.0)])];
            for movement in 0..depth {
                let mut steps = vec![forward(1.0)];
                steps.extend((0..times).map(|_| call(movement)));
                movements.push(numbered(steps));
            }
            plan_steps(&two_wheels(), Pose::default(), &numbered(vec![call(depth)]), &movements)
        };
        let chain = deep(5_000, 1);
        assert!((chain.end().x - 5_001.0).abs() < 1e-6 && !chain.truncated);
        let last = chain.legs.last().unwrap();
        assert_eq!((chain.legs.len(), last.kind), (MAX_CALL_DEPTH + 1, LegKind::Whole));
        assert_eq!(last.place.calls().len(), MAX_CALL_DEPTH);
        let doubled = deep(40, 2);
        assert!((doubled.end().x / (2_f64.powi(41) - 1.0) - 1.0).abs() < 1e-12 && doubled.truncated);
    }

    #[test]
    fn a_million_million_rounds_are_listed_up_to_a_limit() {
        let rounds = |body| vec![repeat(10_000, vec![repeat(10_000, vec![repeat(10_000, body)])])];
        let long = path(rounds(vec![forward(1.0)]));
        assert_eq!((long.legs.len() as u64, long.truncated), (MAX_ACTIONS, true));
        assert!((long.end().x / 1e12 - 1.0).abs() < 1e-9 && long.unknown_after.is_none());
        assert_eq!(long.legs[99_999].place.rounds(), [1, 10, 10_000]);
        assert_eq!(path(rounds(vec![])), path(vec![]));
    }

    #[test]
    fn behind_the_limit_the_end_is_right_and_what_is_unknown_is_found() {
        let body = || vec![forward(1.0), turn(90.0), wait(0.5), arc(-40.0, 0.2, 0.1)];
        let just_listed = path(vec![repeat(25_000, body())]);
        assert!(!just_listed.truncated && just_listed.legs.len() == 100_000);
        let longer = path(vec![repeat(25_000, body()), wait(0.0), repeat(3, body()), forward(1.0)]);
        assert!(longer.truncated && longer.legs == just_listed.legs);
        let rest = plan_steps(
            &two_wheels(),
            just_listed.end(),
            &numbered(vec![repeat(3, body()), forward(1.0)]),
            &[],
        );
        assert!(longer.end().distance(&rest.end()) < 1e-9);

        let inner = repeat(300, vec![repeat(500, vec![forward(1.0)]), either(vec![vec![], vec![slam()]])]);
        let lost = path(vec![repeat(200, vec![forward(0.0); 500]), forward(0.25), repeat(2, vec![inner])]);
        assert!(lost.truncated && (lost.end().x - 500.25).abs() < 1e-9, "{:?}", lost.end());
        assert_eq!(lost.unknown_after.map(|index| index.action), Some(506));
        assert_eq!(lost.unknown_place.rounds(), [1, 1]);
    }

    #[test]
    fn a_branch_that_stays_known_is_one_entry() {
        let ways = vec![vec![turn(90.0), turn(-90.0)], vec![turn(-90.0), turn(90.0)]];
        let path = path(vec![forward(1.0), either(ways.clone()), forward(1.0), either(vec![vec![], vec![]])]);
        comes_to(&path, 4, (2.0, 0.0, 0.0));
        assert_eq!(numbers(&path), [0, 1, 6, 7]);
        let leg = &path.legs[1];
        let alone = plan_steps(&two_wheels(), Pose::default(), &ways[0], &[]);
        assert_eq!((leg.kind, leg.duration), (LegKind::Whole, alone.legs[1].end().unwrap()));
        assert_eq!(path.legs[2].start, leg.end());
        assert_eq!(path.legs[3].duration.to_bits(), 0);
    }

    #[test]
    fn the_leg_of_a_branch_leads_evenly_to_its_end() {
        let way = || vec![forward(1.0), arc(120.0, 0.5, 0.09)];
        let leg = &path(vec![turn(30.0), either(vec![way(), way()])]).legs[1];
        assert_eq!(leg.pose_at(0.0), leg.from);
        let before = leg.pose_at(leg.duration * (1.0 - 1e-12));
        assert!(before.distance(&leg.to) < 1e-9 && leg.pose_at(leg.duration) == leg.to);
        let half = leg.pose_at(leg.duration / 2.0);
        assert!((leg.from.distance(&half) - half.distance(&leg.to)).abs() < 1e-12);
    }

    #[test]
    fn a_branch_that_parts_is_where_the_path_ends() {
        let ways = vec![vec![forward(1.0), left()], vec![wait(2.0), until(3.0), forward(1.0)], vec![]];
        let body = vec![forward(0.5), either(ways), forward(1.0)];
        let path = path(vec![left(), repeat(3, body)]);
        assert_eq!(numbers(&path), [0, 2]);
        assert_eq!(path.unknown_after.map(|index| index.action), Some(3));
        assert_eq!(path.unknown_place.rounds(), [1]);
        let possible: Vec<Vec<usize>> =
            path.possible.iter().map(|way| way.iter().map(|leg| leg.index.action).collect()).collect();
        assert_eq!(possible, [vec![4, 5], vec![6, 7]], "what follows an open action is not drawn");
        for way in &path.possible {
            assert_eq!((way[0].from, way[0].start), (path.end(), path.legs[1].end()));
            assert_eq!((way[1].place.rounds(), way[1].place.counts()), (&[1][..], &[3][..]));
        }
        assert!(path.possible[1][1].to.distance(&Pose::new(0.0, 3.5, 0.0)) < 1e-9);
    }

    #[test]
    fn an_action_with_a_bound_is_drawn_up_to_it() {
        let path = path(vec![forward(1.0), until(3.0), forward(1.0)]);
        let [way] = path.possible.as_slice() else { panic!("{path:?}") };
        assert_eq!((way.len(), way[0].from, way[0].to.x), (1, path.end(), 4.0));
        assert_eq!(path.unknown_after.map(|index| index.action), Some(1));
        assert!(super::tests::path(vec![slam()]).possible.is_empty());
    }

    #[test]
    fn ways_are_no_longer_than_a_picture_needs() {
        let endless = || vec![repeat(10_000, vec![forward(0.01)]), until(1.0)];
        let path = path(vec![either(vec![endless(), endless(), vec![slam()]])]);
        let legs: Vec<usize> = path.possible.iter().map(Vec::len).collect();
        assert_eq!(legs, [1_000], "nor does the bound follow, which is not where they end");
    }

    fn three(steps: [Vec<Step>; 3], last: Vec<Step>) -> Plan {
        let robots: Vec<RobotPlan> =
            (0..3).map(|_| RobotPlan { model: two_wheels(), start: Pose::default() }).collect();
        let mut movements: Vec<Movement> = steps
            .into_iter()
            .enumerate()
            .map(|(robot, steps)| Movement { robot, steps: numbered(steps) })
            .collect();
        movements.push(Movement { robot: 0, steps: numbered(last) });
        plan_schedule(&robots, &movements, &[vec![0, 1, 2], vec![3], vec![1]]).unwrap()
    }

    #[test]
    fn two_robots_stay_known_beside_a_third_that_is_not() {
        let lost = vec![forward(1.0), repeat(2, vec![until(1.0)])];
        let plan = three([vec![repeat(2, vec![forward(1.0)])], vec![left()], lost], vec![forward(1.0)]);
        let known = |robot: usize| -> Vec<bool> {
            plan.robots[robot].legs.iter().map(|leg| leg.start.is_some()).collect()
        };
        assert_eq!((known(0), known(1), known(2)), (vec![true, true, false], vec![true, false], vec![true]));
        assert_eq!((plan.duration, plan.robots[0].unknown_after), (None, None));
        assert_eq!(plan.robots[2].unknown_after, Some(ActionIndex { group: 0, run: 2, action: 2 }));
        assert!(plan.robots[0].end().distance(&Pose::new(3.0, 0.0, 0.0)) < 1e-12);
    }

    #[test]
    fn robots_with_many_actions_share_what_is_listed() {
        let many = |count| vec![repeat(10_000, vec![forward(0.1); count])];
        let plan = three([many(10), vec![left()], many(3)], vec![forward(1.0)]);
        let listed: Vec<(usize, bool)> =
            plan.robots.iter().map(|path| (path.legs.len(), path.truncated)).collect();
        assert_eq!(listed, [(69_998, true), (2, false), (30_000, false)]);
        let once = plan_movement(
            &two_wheels(),
            Pose::default(),
            &[MotionPrimitive::Move { distance: 0.1, speed: 0.09 }],
        );
        let turned = plan.robots[1].legs[1].duration;
        let metre = plan_movement(
            &two_wheels(),
            Pose::default(),
            &[MotionPrimitive::Move { distance: 1.0, speed: 0.09 }],
        );
        let expected = 100_000.0 * once.legs[0].duration + metre.legs[0].duration + turned;
        assert!((plan.duration.unwrap() - expected).abs() < 1e-6 && plan.is_truncated());
        assert!((plan.robots[0].end().x - 10_001.0).abs() < 1e-6);
    }

    fn actions() -> impl Strategy<Value = StepKind> {
        (0..4, -2.0..2.0, 0.05..1.0, 0.05..0.5, any::<bool>()).prop_map(
            |(which, amount, radius, speed, reverse)| {
                StepKind::Action(match which {
                    0 => MotionPrimitive::Move { distance: amount, speed },
                    1 => MotionPrimitive::Turn { angle: amount, speed },
                    2 => MotionPrimitive::Arc { angle: amount, radius, speed, reverse },
                    _ => MotionPrimitive::Wait { seconds: amount.abs() },
                })
            },
        )
    }

    fn nested() -> impl Strategy<Value = Vec<Step>> {
        let block = |inner: BoxedStrategy<StepKind>| {
            prop::collection::vec(inner, 0..4)
                .prop_map(|kinds| kinds.into_iter().map(step).collect::<Vec<Step>>())
        };
        let kinds = actions().boxed().prop_recursive(4, 24, 4, move |inner| {
            let body = block(inner.clone().boxed());
            prop_oneof![
                3 => (0_u32..5, body.clone()).prop_map(|(count, body)| StepKind::Repeat { count, body }),
                1 => body.prop_map(|way| StepKind::Branch { ways: vec![way.clone(), way] }),
                2 => Just(StepKind::Call { movement: 0 }),
                3 => inner,
            ]
        });
        prop::collection::vec(kinds, 0..5).prop_map(|kinds| kinds.into_iter().map(step).collect())
    }

    /// An action of a program that is written out, with its number and where it is.
    type Written = (usize, Vec<u32>, Vec<(usize, usize)>, MotionPrimitive);

    /// Writes a program out, round by round; of branches their first way, under the number of the branch.
    fn write_out(steps: &[Step], called: &[Vec<Step>], at: &Written, found: &mut Vec<Written>) {
        for Step { number, kind } in steps {
            let (_, rounds, calls, _) = at.clone();
            match kind {
                StepKind::Action(action) => found.push((*number, rounds, calls, *action)),
                StepKind::Repeat { count, body } => {
                    for round in 1..=*count {
                        let rounds = [rounds.as_slice(), &[round]].concat();
                        write_out(body, called, &(0, rounds, calls.clone(), at.3), found);
                    }
                }
                StepKind::Call { movement } => {
                    let calls = [calls.as_slice(), &[(*number, *movement)]].concat();
                    let body = &called[*movement];
                    write_out(body, called, &(0, rounds, calls, at.3), found);
                }
                StepKind::Branch { ways } => {
                    write_out(&ways[0], called, &(0, rounds, calls, at.3), found);
                }
                StepKind::Until { .. } => unreachable!("none is made"),
            }
        }
    }

    fn has_branch(steps: &[Step]) -> bool {
        steps.iter().any(|step| match &step.kind {
            StepKind::Branch { .. } => true,
            StepKind::Repeat { body, .. } => has_branch(body),
            _ => false,
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 400,
            rng_seed: RngSeed::Fixed(34),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        #[test]
        fn nested_steps_are_what_they_are_written_out(main in nested(), side in nested()) {
            let model = two_wheels();
            let side = numbered(side.into_iter().filter(|step| !calls_any(step)).collect());
            let (main, called) = (numbered(main), [side]);
            let mut written = Vec::new();
            write_out(&main, &called, &(0, vec![], vec![], MotionPrimitive::Unknown { reach: 0.0 }), &mut written);
            prop_assume!(written.len() < 20_000);
            let actions: Vec<MotionPrimitive> = written.iter().map(|(.., action)| *action).collect();
            let flat = plan_movement(&model, Pose::default(), &actions);
            let flat_end = flat.legs.last().map_or(Some(0.0), Leg::end).unwrap();

            let path = plan_steps(&model, Pose::default(), &main, &called);
            prop_assert!(path.end().distance(&flat.end()) < 1e-9);
            let end = path.legs.last().map_or(Some(0.0), Leg::end).unwrap();
            prop_assert!((end - flat_end).abs() < 1e-9 * (1.0 + flat_end));
            if !has_branch(&main) && !has_branch(&called[0]) {
                prop_assert_eq!(path.legs.len(), flat.legs.len());
                for ((leg, other), (number, rounds, calls, _)) in path.legs.iter().zip(&flat.legs).zip(&written) {
                    prop_assert_eq!((leg.from, leg.to, leg.start), (other.from, other.to, other.start));
                    prop_assert_eq!((leg.index.action, leg.place.rounds()), (*number, rounds.as_slice()));
                    prop_assert_eq!(&super::tests::calls(&leg.place), calls);
                }
            }

            let of = |steps: &[Step], side: Option<Summary>| Summary::of(&model, steps, &|_| side);
            let summary = of(&main, Some(of(&called[0], None)));
            let motion = summary.motion.unwrap();
            prop_assert!(motion.change.distance(&flat.end()) < 1e-9, "{motion:?}, not {:?}", flat.end());
            prop_assert!((motion.seconds - flat_end).abs() < 1e-9 * (1.0 + flat_end));
            prop_assert_eq!(summary.entries, path.legs.len() as u64);
            for left in [0, 1, 7] {
                let block = Block::new(&model, &main, &|_| Some(of(&called[0], None)));
                let blocks = [Block::new(&model, &called[0], &|_| None)];
                let mut walk = Walk::new(&blocks, RobotPath::new(Pose::default()), left);
                let end = walk.run(&block, 0, 0, Some(0.0)).unwrap();
                let short = walk.into_path();
                prop_assert_eq!(short.truncated, summary.entries > left);
                prop_assert_eq!(&short.legs[..], &path.legs[..short.legs.len()]);
                prop_assert!(short.end().distance(&flat.end()) < 1e-9);
                prop_assert!((end - flat_end).abs() < 1e-9 * (1.0 + flat_end));
            }
        }
    }

    fn calls_any(step: &Step) -> bool {
        match &step.kind {
            StepKind::Call { .. } => true,
            StepKind::Repeat { body, .. } => body.iter().any(calls_any),
            StepKind::Branch { ways } => ways.iter().flatten().any(calls_any),
            _ => false,
        }
    }
}
