//! Still pictures.

use pydslrep_scene::Obstacle;
use svg::Document;
use svg::node::Comment;
use svg::node::element::{Group, Rectangle};

use crate::legend::Key;
use crate::route::{Picture, Route};
use crate::style::{FONT, PAPER, colour, pixels, shorten, text};
use crate::view::View;
use crate::{MARK, floor, legend, robots, time_marks};

/// The margins around the floor for title, tick labels and legend, pixels.
const LEFT: f64 = 62.0;
const TOP: f64 = 56.0;
const BOTTOM: f64 = 54.0;
const RIGHT: f64 = 24.0;

/// The maximum width of a letter in the title, pixels.
const TITLE_LETTER: f64 = 12.0;

impl Picture<'_> {
    /// Draws an SVG: the floor with a grid in metres, obstacles where they start with the paths of those that move, planned paths (dashed), what may be driven where they end (short dashes), and driven paths (solid) with time marks, bodies
    /// at start and end, sensor detections, maps, planned collisions, and a legend with the end of each route and its
    /// deviation from the plan.
    pub fn svg(&self) -> String {
        let (view, sheet) = self.sheet(0.0);
        let step = time_marks::step(self.routes);
        let sheet = match self.movers().next() {
            Some(_) => sheet.add(floor::obstacles(&view, self.movers())),
            None => sheet,
        };
        let sheet = sheet
            .add(self.each(|route, colour| robots::lines(&view, route, colour)))
            .add(self.each(|route, colour| robots::bodies(&view, route, colour)));
        let sheet = self
            .with_ways(&view, sheet)
            .add(self.each(|route, colour| robots::sightings(&view, route, colour)))
            .add(self.each(|route, _| robots::map(&view, &route.map)))
            .add(time_marks::draw(&view, self.routes, step))
            .add(floor::collisions(&view, self.collisions));
        sheet.add(legend::draw(self, Key::Still(step), Picture::beside(&view))).to_string()
    }

    /// Adds what may be driven where plans end, if there is any.
    pub(crate) fn with_ways(&self, view: &View, sheet: Document) -> Document {
        if self.routes.iter().all(|route| route.open_ways().next().is_none()) {
            return sheet;
        }
        sheet.add(self.each(|route, colour| robots::ways(view, route, colour)))
    }

    /// The obstacles that move.
    pub(crate) fn movers(&self) -> impl Iterator<Item = &Obstacle> {
        self.obstacles.iter().filter(|obstacle| obstacle.trajectory.is_some())
    }

    /// A sheet with the title and the floor without what moves, and `below` pixels of space under it.
    pub(crate) fn sheet(&self, below: f64) -> (View, Document) {
        let view = View::of(self.routes, self.obstacles, LEFT, TOP);
        let width = view.left + view.width + RIGHT + legend::WIDTH + RIGHT;
        let height = TOP + view.height.max(legend::height(self)) + BOTTOM + below;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a width in pixels
        let title = shorten(self.title, ((width - LEFT - RIGHT) / TITLE_LETTER) as usize);
        let paper = Rectangle::new().set("width", "100%").set("height", "100%").set("fill", PAPER);
        let fixed = self.obstacles.iter().filter(|obstacle| obstacle.trajectory.is_none());
        let sheet = Document::new()
            .set("viewBox", (0, 0, pixels(width), pixels(height)))
            .set("width", pixels(width))
            .set("height", pixels(height))
            .set("font-family", FONT)
            .add(Comment::new(MARK))
            .add(paper)
            .add(text(&title, LEFT, 32.0, 18).set("font-weight", "bold"))
            .add(floor::grid(&view))
            .add(floor::obstacles(&view, fixed));
        let sheet = match self.movers().next() {
            Some(_) => sheet.add(floor::obstacle_paths(&view, self.obstacles)),
            None => sheet,
        };
        (view, sheet)
    }

    /// The position of the legend beside the floor.
    pub(crate) fn beside(view: &View) -> (f64, f64) {
        (view.left + view.width + RIGHT, TOP)
    }

    /// A group with one drawing per route, in the route's colour.
    pub(crate) fn each(&self, draw: impl Fn(&Route, &str) -> Group) -> Group {
        let routes = self.routes.iter().enumerate();
        routes.fold(Group::new(), |group, (index, route)| group.add(draw(route, colour(index))))
    }
}

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::{Drive, Geometry, Model, MotionPrimitive, Pose, TimedPose, plan_movement};
    use pydslrep_scene::{Body, Shape, Trajectory, Waypoint};
    use pydslrep_trace::Map;

    use super::*;
    use crate::style::{FINE_DASHES, OBSTACLE, SHORT_DASHES, list};
    use crate::testing::route;

    fn draw(title: &str, routes: &[Route], obstacles: &[Obstacle]) -> String {
        Picture { title, routes, obstacles, collisions: &[] }.svg()
    }

    fn square() -> Route {
        let geometry = Geometry { track: 0.3, wheelbase: 0.25 };
        let model = Model::new(Drive::TwoWheel, &[0.035, 0.035], geometry).unwrap();
        let turn = MotionPrimitive::Turn { angle: std::f64::consts::FRAC_PI_2, speed: 0.09 };
        let side = [MotionPrimitive::Move { distance: 1.0, speed: 0.09 }, turn];
        let planned = plan_movement(&model, Pose::default(), &side.repeat(3)).sample(50);
        let off =
            |timed: &TimedPose| TimedPose { pose: Pose { x: timed.pose.x + 0.002, ..timed.pose }, ..*timed };
        let driven = planned.iter().map(off).collect();
        Route { driven, ..route(planned) }
    }

    fn untimed(poses: impl IntoIterator<Item = Pose>) -> Vec<TimedPose> {
        poses.into_iter().map(|pose| TimedPose { time: None, pose }).collect()
    }

    #[test]
    fn a_route_with_its_error() {
        let picture = draw("area_1", &[square()], &[]);
        for part in [
            "<svg",
            "area_1",
            "robot_1",
            "2.0 mm",
            "stroke-dasharray",
            "x in m",
            "\n0.0\n",
            "\n−0.2\n",
            "every 5 s",
        ] {
            assert!(picture.contains(part), "no {part} in {picture}");
        }
        assert_eq!(picture, draw("area_1", &[square()], &[]), "the same picture each time");
    }

    #[test]
    fn lines_have_no_more_points_than_visible() {
        let mut route = square();
        route.driven = untimed((0..100_000).map(|i| Pose::new(f64::from(i) * 1e-5, 0.0, 0.0)));
        assert!(draw("fine", &[route], &[]).len() < 40_000);
    }

    #[test]
    fn names_are_escaped() {
        let mut route = square();
        route.name = "</text><script>\u{1}".to_owned();
        let picture = draw("a & b", &[route], &[]);
        assert!(!picture.contains("<script") && !picture.contains('\u{1}') && picture.contains("a &amp; b"));
    }

    #[test]
    fn unusual_routes_are_valid_pictures() {
        let mut route = square();
        route.driven =
            untimed([Pose { x: f64::NAN, y: 0.0, theta: 0.0 }, Pose { x: f64::INFINITY, ..Pose::default() }]);
        let still = Route { planned: untimed([Pose::default()]), driven: vec![], ..square() };
        let far = Route { planned: untimed([Pose::new(-1e12, 1e12, 0.0), Pose::default()]), ..square() };
        let empty = Route { planned: vec![], driven: vec![], ..square() };
        for routes in [vec![], vec![route], vec![still], vec![far], vec![empty]] {
            let picture = draw("strange", &routes, &[]);
            assert!(
                picture.contains("</svg>") && !picture.contains("NaN") && !picture.contains("inf"),
                "{picture}"
            );
        }
    }

    #[test]
    fn obstacles_and_detections_are_drawn() {
        let wall = Obstacle::wall("w", (3.0, -1.0), (3.0, 1.0), 0.1);
        let route = Route { seen: vec![(2.95, 0.0), (2.95, 0.0001), (2.95, 0.5)], ..square() };
        let with = draw("w", std::slice::from_ref(&route), std::slice::from_ref(&wall));
        let without = draw("w", &[Route { seen: vec![], ..route }], &[]);
        let dots = |picture: &str| picture.matches("<circle").count();
        // Two distinguishable points, and one in the legend.
        assert_eq!(dots(&with), dots(&without) + 3);
        assert!(
            with.contains(OBSTACLE) && with.contains("obstacle") && with.contains("detected by a sensor")
        );
        assert!(!without.contains(OBSTACLE) && !without.contains("obstacle"));
        let view = View::of(&[square()], &[wall], 0.0, 0.0);
        assert!(view.place(3.05, 0.0).0 < view.width, "the picture contains all of it");
    }

    #[test]
    fn obstacles_that_move_are_where_they_start_with_their_path() {
        let points = [(0.0, 3.0, 0.5), (4.0, 5.0, 0.5)].map(|(time, x, y)| Waypoint { time, x, y });
        let cart = Obstacle::moving(
            "cart",
            0.0,
            Shape::Box(Body { length: 0.4, width: 0.2 }),
            Trajectory::new(points.to_vec(), true).unwrap(),
        );
        let fixed = Obstacle { trajectory: None, ..cart.clone() };
        let dashes = format!("stroke-dasharray=\"{FINE_DASHES}\"");
        let obstacles = [cart];
        let with = draw("m", &[square()], &obstacles);
        assert!(with.contains(&dashes) && with.contains("path of an obstacle"), "{with}");
        assert!(!draw("m", &[square()], &[fixed]).contains(&dashes));
        let view = View::of(&[square()], &obstacles, LEFT, TOP);
        let at = |x: f64, y: f64| list(&[view.place(x, y)]);
        for (corner, is_drawn) in [(at(2.8, 0.4), true), (at(4.8, 0.4), false), (at(5.0, 0.5), true)] {
            assert_eq!(with.contains(&corner), is_drawn, "{corner} in {with}");
        }
        assert!(view.place(5.2, 0.5).0 < LEFT + view.width, "the picture contains all of its path");
    }

    #[test]
    fn what_is_possible_has_dashes_of_its_own_until_the_robot_drives() {
        let ways = vec![
            untimed([Pose::default(), Pose::new(3.0, 0.0, 0.0)]),
            untimed([Pose::default(), Pose::new(0.0, 2.0, 1.0)]),
            untimed([Pose::default(), Pose::new(0.0, 0.0, 1.0)]),
        ];
        let planned = Route { driven: vec![], unknown_after: true, possible: ways, ..square() };
        let routes = [planned.clone()];
        let picture = draw("p", &routes, &[]);
        let dashes = format!("stroke-dasharray=\"{SHORT_DASHES}\"");
        // Two ways with a body at their ends, of which a turn in place is none, and the legend.
        assert_eq!(picture.matches(&dashes).count(), 5, "{picture}");
        assert!(picture.contains("possible, sensors decide"), "{picture}");
        let view = View::of(&routes, &[], LEFT, TOP);
        assert!(view.place(3.2, 0.0).0 < LEFT + view.width, "the picture contains all of them");
        let replay = Picture { title: "p", routes: &routes, obstacles: &[], collisions: &[] }.replay();
        assert_eq!(replay.matches(&dashes).count(), 5, "{replay}");
        let driven = draw("p", &[Route { driven: square().driven, ..planned }], &[]);
        assert!(!driven.contains(&dashes) && !driven.contains("possible"), "{driven}");
    }

    #[test]
    fn a_map_over_the_world() {
        let found = Map { nodes: vec![(0.0, 0.0), (0.5, 0.0)], edges: vec![((0.0, 0.0), (0.5, 0.0))] };
        let with = draw("m", &[Route { map: found, ..square() }], &[]);
        let without = draw("m", &[square()], &[]);
        let count = |picture: &str, part: &str| picture.matches(part).count();
        // Two nodes and one edge, and one of each in the legend.
        assert_eq!(count(&with, "<circle"), count(&without, "<circle") + 3);
        assert_eq!(count(&with, "<line"), count(&without, "<line") + 2);
        assert!(with.contains("\nmap\n") && !without.contains("\nmap\n"));
    }

    #[test]
    fn planned_collisions_are_crossed() {
        let routes = [square()];
        let with = Picture { title: "c", routes: &routes, obstacles: &[], collisions: &[(0.5, 0.0)] }.svg();
        assert!(with.contains("planned collision") && !draw("c", &routes, &[]).contains("planned collision"));
    }
}
