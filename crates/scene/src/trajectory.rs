//! Where a moving obstacle is at which time.

use std::fmt;

/// The minimum duration of a segment, seconds: the rounding of late times never makes one shorter.
const MIN_SEGMENT_DURATION: f64 = 1e-9;

/// A way along straight lines, each at a constant speed: at the first point before its time, and at the last one after its
/// time, or there and back between the two.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// At least one; their times grow.
    points: Vec<Waypoint>,
    repeats: bool,
}

/// A point of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// Seconds since the start of the simulation.
    pub time: f64,
    /// Metres.
    pub x: f64,
    /// Metres.
    pub y: f64,
}

/// A segment of a trajectory, with a constant velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectorySegment {
    /// Metres per second.
    pub speed: f64,
    /// When it ends, seconds since the start of the simulation; infinite if it does not.
    pub until: f64,
}

/// Why points are no trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrajectoryError {
    /// There are none.
    Empty,
    /// The point of this index is not finite.
    NotFinite(usize),
    /// The first time is before the simulation starts.
    TooEarly,
    /// The time of the point of this index is not later than that of the point before it.
    NotLater(usize),
}

impl fmt::Display for TrajectoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("it has no points"),
            Self::NotFinite(index) => write!(f, "point {} is not finite", index + 1),
            Self::TooEarly => f.write_str("its first time is before the start of the simulation, at 0 s"),
            Self::NotLater(index) => write!(f, "point {} is not later than the one before it", index + 1),
        }
    }
}

impl std::error::Error for TrajectoryError {}

/// A moment of the way there, or of the way back.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    /// It has not begun yet.
    Before,
    /// At this time of the way there.
    There(f64),
    /// Where it was at this time of the way there.
    Back(f64),
    /// It has ended.
    After,
}

impl Trajectory {
    /// A trajectory through points. One that repeats goes back the same way in the same times, and there again at once: it
    /// waits for the first point's time only once, at the beginning.
    ///
    /// # Errors
    /// If there are no points, one is not finite, the first time is negative, or the times do not grow.
    pub fn new(points: Vec<Waypoint>, repeats: bool) -> Result<Self, TrajectoryError> {
        let first = points.first().ok_or(TrajectoryError::Empty)?;
        let is_finite = |point: &Waypoint| [point.time, point.x, point.y].into_iter().all(f64::is_finite);
        if let Some(index) = points.iter().position(|point| !is_finite(point)) {
            return Err(TrajectoryError::NotFinite(index));
        }
        if first.time < 0.0 {
            return Err(TrajectoryError::TooEarly);
        }
        match points.windows(2).position(|pair| pair[1].time <= pair[0].time) {
            Some(before) => Err(TrajectoryError::NotLater(before + 1)),
            None => Ok(Self { points, repeats }),
        }
    }

    /// Its points, at least one, in the order of their times.
    pub fn points(&self) -> &[Waypoint] {
        &self.points
    }

    /// Returns whether it goes there and back, again and again.
    pub fn repeats(&self) -> bool {
        self.repeats
    }

    /// The place at a time, seconds since the start of the simulation; metres.
    pub fn at(&self, time: f64) -> (f64, f64) {
        let (first, last) = self.ends();
        let moment = match self.phase(time) {
            Phase::Before => first.time,
            Phase::There(moment) | Phase::Back(moment) => moment,
            Phase::After => last.time,
        };
        let next = self.points.partition_point(|point| point.time <= moment);
        match (next.checked_sub(1).and_then(|from| self.points.get(from)), self.points.get(next)) {
            (Some(from), Some(to)) => {
                let part = (moment - from.time) / (to.time - from.time);
                (from.x + part * (to.x - from.x), from.y + part * (to.y - from.y))
            }
            (Some(end), None) | (None, Some(end)) => (end.x, end.y),
            (None, None) => (first.x, first.y),
        }
    }

    /// The segment at a time, the later one of two that meet there, seconds since the start of the simulation.
    pub fn segment(&self, time: f64) -> TrajectorySegment {
        let (moment, is_back) = match self.phase(time) {
            Phase::Before => return TrajectorySegment { speed: 0.0, until: self.points[0].time },
            Phase::After => return TrajectorySegment { speed: 0.0, until: f64::INFINITY },
            Phase::There(moment) => (moment, false),
            Phase::Back(moment) => (moment, true),
        };
        let is_passed = |point: &Waypoint| point.time < moment || (!is_back && point.time <= moment);
        // There are at least two: a single one has no way there.
        let next = self.points.partition_point(is_passed).clamp(1, self.points.len() - 1);
        let (from, to) = (self.points[next - 1], self.points[next]);
        let rest = if is_back { moment - from.time } else { to.time - moment };
        let speed = (to.x - from.x).hypot(to.y - from.y) / (to.time - from.time);
        TrajectorySegment { speed, until: time + rest.max(MIN_SEGMENT_DURATION) }
    }

    /// When its velocity may change, from 0 s on, in order; without an end if it repeats.
    pub fn changes(&self) -> impl Iterator<Item = f64> {
        std::iter::successors(Some(0.0), |time| {
            Some(self.segment(*time).until).filter(|until| until.is_finite())
        })
    }

    fn ends(&self) -> (Waypoint, Waypoint) {
        (self.points[0], self.points[self.points.len() - 1])
    }

    fn phase(&self, time: f64) -> Phase {
        let (first, last) = self.ends();
        let length = last.time - first.time;
        if time < first.time {
            return Phase::Before;
        }
        if time < last.time {
            return Phase::There(time);
        }
        if !self.repeats || length <= 0.0 {
            return Phase::After;
        }
        let since = (time - first.time) % (2.0 * length);
        if since < length {
            Phase::There(first.time + since)
        } else {
            Phase::Back(last.time - (since - length))
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn points(rows: &[[f64; 3]]) -> Vec<Waypoint> {
        rows.iter().map(|&[time, x, y]| Waypoint { time, x, y }).collect()
    }

    fn trajectory(rows: &[[f64; 3]], repeats: bool) -> Trajectory {
        Trajectory::new(points(rows), repeats).unwrap()
    }

    /// It waits, moves, waits and moves on.
    const WAY: [[f64; 3]; 4] = [[2.0, 1.0, 0.0], [4.0, 1.0, 4.0], [5.0, 1.0, 4.0], [6.0, 0.0, 4.0]];

    #[test]
    fn it_stays_at_its_ends() {
        let once = trajectory(&WAY, false);
        for (time, place) in [
            (-1.0, (1.0, 0.0)),
            (0.0, (1.0, 0.0)),
            (2.0, (1.0, 0.0)),
            (2.5, (1.0, 1.0)),
            (4.0, (1.0, 4.0)),
            (4.5, (1.0, 4.0)),
            (5.25, (0.75, 4.0)),
            (6.0, (0.0, 4.0)),
            (1e6, (0.0, 4.0)),
        ] {
            assert_eq!(once.at(time), place, "{time}");
        }
    }

    #[test]
    fn it_goes_there_and_back_and_waits_for_its_first_time_once() {
        let forever = trajectory(&WAY, true);
        for (time, place) in [
            (1.0, (1.0, 0.0)),
            (3.0, (1.0, 2.0)),
            (6.0, (0.0, 4.0)),
            (6.75, (0.75, 4.0)),
            (7.5, (1.0, 4.0)),
            (9.0, (1.0, 2.0)),
            (10.0, (1.0, 0.0)),
            (11.0, (1.0, 2.0)),
            (14.0, (0.0, 4.0)),
            (18.0 + 8.0 * 1000.0, (1.0, 0.0)),
        ] {
            assert_eq!(forever.at(time), place, "{time}");
        }
        let still = trajectory(&[[3.0, 1.0, 2.0]], true);
        assert_eq!((still.at(0.0), still.at(9.0)), ((1.0, 2.0), (1.0, 2.0)));
        assert_eq!(still.segment(9.0), TrajectorySegment { speed: 0.0, until: f64::INFINITY });
    }

    #[test]
    fn segments_end_where_the_velocity_changes() {
        let segments = |trajectory: &Trajectory| -> Vec<(f64, f64)> {
            trajectory.changes().take(9).map(|time| (time, trajectory.segment(time).speed)).collect()
        };
        let once = [(0.0, 0.0), (2.0, 2.0), (4.0, 0.0), (5.0, 1.0), (6.0, 0.0)];
        assert_eq!(segments(&trajectory(&WAY, false)), once);
        let back = [(6.0, 1.0), (7.0, 0.0), (8.0, 2.0), (10.0, 2.0), (12.0, 0.0)];
        assert_eq!(segments(&trajectory(&WAY, true)), [&once[..4], &back].concat());
    }

    #[test]
    fn what_is_no_trajectory_says_why() {
        let why = |rows: &[[f64; 3]]| Trajectory::new(points(rows), false).unwrap_err();
        assert_eq!(why(&[]), TrajectoryError::Empty);
        assert_eq!(why(&[[-0.5, 0.0, 0.0]]), TrajectoryError::TooEarly);
        assert_eq!(why(&[[0.0, 0.0, 0.0], [1.0, f64::NAN, 0.0]]), TrajectoryError::NotFinite(1));
        assert_eq!(why(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]), TrajectoryError::NotLater(2));
    }

    proptest! {
        /// The search for collisions relies on this.
        #[test]
        fn within_a_segment_it_has_the_speed_of_the_segment(
            first in 0.0..3.0, steps in prop::collection::vec((0.01..4.0, -3.0..3.0, -3.0..3.0), 1..5),
            repeats: bool, time in 0.0..100.0, part in 0.0..1.0,
        ) {
            let mut time_of_point = first;
            let mut rows = vec![[first, 0.0, 0.0]];
            for (seconds, x, y) in steps {
                time_of_point += seconds;
                rows.push([time_of_point, x, y]);
            }
            let trajectory = trajectory(&rows, repeats);
            let segment = trajectory.segment(time);
            prop_assert!(segment.until > time);
            let later = time + part * (segment.until.min(200.0) - time);
            let (from, to) = (trajectory.at(time), trajectory.at(later));
            let way = (to.0 - from.0).hypot(to.1 - from.1);
            prop_assert!((way - segment.speed * (later - time)).abs() < 1e-6, "{way} at {}", segment.speed);
        }
    }
}
