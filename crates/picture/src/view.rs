//! The mapping from metres on the floor to pixels in the picture.

use pydslrep_scene::Obstacle;

use crate::route::{Route, is_drawable};

/// The maximum size of the floor, pixels.
const MAX_WIDTH: f64 = 760.0;
const MAX_HEIGHT: f64 = 640.0;

/// The minimum side of the floor, pixels, so that a straight path is not a thin strip.
const MIN_SIDE: f64 = 300.0;

/// The minimum side of the floor, metres, so that a robot at rest has surroundings.
const MIN_SPAN: f64 = 1.5;

/// The margin around everything, relative to the longer side.
const MARGIN: f64 = 0.06;

/// The minimum distance between ticks, pixels, so that labels fit.
const TICK_SPACING: f64 = 52.0;

/// The visible part of the floor and its position in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    /// The floor's position and size in the picture, pixels.
    pub(crate) left: f64,
    pub(crate) top: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// Pixels per metre.
    pub(crate) scale: f64,
    x_min: f64,
    y_max: f64,
}

impl View {
    /// A view of all paths, bodies and obstacles, with its upper left corner at (`left`, `top`).
    pub(crate) fn of(routes: &[Route], obstacles: &[Obstacle], left: f64, top: f64) -> Self {
        let (mut x, mut y) = (Span::EMPTY, Span::EMPTY);
        for route in routes {
            let reach = route.body.reach();
            let known = route.planned.iter().chain(&route.driven);
            for timed in known.chain(route.open_ways().flatten()).filter(|timed| is_drawable(timed)) {
                let pose = timed.pose;
                x.include(pose.x, reach);
                y.include(pose.y, reach);
            }
        }
        for obstacle in obstacles {
            for corner in obstacle.corners_on_its_way() {
                x.include(corner.0, 0.0);
                y.include(corner.1, 0.0);
            }
        }
        let (mut x, mut y) = (x.at_least(MIN_SPAN / 2.0), y.at_least(MIN_SPAN / 2.0));
        let longer = x.length().max(y.length()).max(MIN_SPAN);
        x.widen(x.length() + 2.0 * MARGIN * longer);
        y.widen(y.length() + 2.0 * MARGIN * longer);
        let scale = (MAX_WIDTH / x.length()).min(MAX_HEIGHT / y.length());
        x.widen(MIN_SIDE / scale);
        y.widen(MIN_SIDE / scale);
        let (width, height) = (x.length() * scale, y.length() * scale);
        Self { left, top, width, height, scale, x_min: x.low, y_max: y.high }
    }

    /// The position of a point of the floor in the picture.
    pub(crate) fn place(&self, x: f64, y: f64) -> (f64, f64) {
        (self.left + (x - self.x_min) * self.scale, self.top + (self.y_max - y) * self.scale)
    }

    /// The distance between grid lines, metres: 1, 2 or 5 times a power of ten.
    pub(crate) fn tick(&self) -> f64 {
        let least = TICK_SPACING / self.scale;
        let power = 10_f64.powf(least.log10().floor());
        [1.0, 2.0, 5.0]
            .into_iter()
            .map(|step| step * power)
            .find(|&tick| tick >= least)
            .unwrap_or(10.0 * power)
    }

    /// The x coordinates of vertical grid lines, metres.
    pub(crate) fn x_ticks(&self) -> Vec<f64> {
        ticks(self.x_min, self.x_min + self.width / self.scale, self.tick())
    }

    /// The y coordinates of horizontal grid lines, metres.
    pub(crate) fn y_ticks(&self) -> Vec<f64> {
        ticks(self.y_max - self.height / self.scale, self.y_max, self.tick())
    }
}

fn ticks(low: f64, high: f64, step: f64) -> Vec<f64> {
    let first = (low / step).ceil();
    // Bounded for any input; fewer than a hundred fit.
    (0..100).map(|i| (first + f64::from(i)) * step).take_while(|&tick| tick <= high).collect()
}

#[derive(Debug, Clone, Copy)]
struct Span {
    low: f64,
    high: f64,
}

impl Span {
    const EMPTY: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };

    fn include(&mut self, value: f64, reach: f64) {
        self.low = self.low.min(value - reach);
        self.high = self.high.max(value + reach);
    }

    /// This span, or one around 0 if it is empty, with at least the given length.
    fn at_least(self, length: f64) -> Self {
        let mut span = if self.low <= self.high { self } else { Self { low: 0.0, high: 0.0 } };
        span.widen(length);
        span
    }

    fn length(&self) -> f64 {
        self.high - self.low
    }

    fn widen(&mut self, length: f64) {
        let more = (length - self.length()).max(0.0) / 2.0;
        self.low -= more;
        self.high += more;
    }
}
