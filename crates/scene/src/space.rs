//! The geometry of a scene: distances, and what sensors see, by parry2d.

use parry2d_f64::math::{Pose as Placement, Vector};
use parry2d_f64::query::{self, Ray};
use parry2d_f64::shape::{Ball, Cuboid, TriMesh, Triangle};
use pydslrep_kinematics::Pose;

use crate::{Body, Mount, Obstacle, Scene, Shape, Trajectory};

/// The obstacles of a scene, cut into convex parts, at a moment.
#[derive(Debug, Clone, Default)]
pub struct Space {
    parts: Vec<ConvexPart>,
    movers: Vec<PartMotion>,
}

/// The trajectory of a part that moves.
#[derive(Debug, Clone)]
struct PartMotion {
    /// Its index among the parts.
    part: usize,
    /// The centre of the part, in the obstacle's frame.
    centre: Vector,
    /// Radians.
    heading: f64,
    trajectory: Trajectory,
}

/// A convex part of an obstacle, or a robot, on the floor.
#[derive(Debug, Clone, Copy)]
struct ConvexPart {
    /// Which obstacle or robot it belongs to.
    owner: usize,
    solid: Solid,
    placement: Placement,
    /// The centre of a circle around it.
    centre: Vector,
    /// The radius of that circle.
    reach: f64,
}

#[derive(Debug, Clone, Copy)]
enum Solid {
    Cuboid(Cuboid),
    Ball(Ball),
    Triangle(Triangle),
}

/// An obstacle at a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    /// Metres; 0 if it touches or overlaps.
    pub distance: f64,
    /// Its index in [`Scene::obstacles`].
    pub obstacle: usize,
}

/// The nearest point that a sensor sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sighting {
    /// From the sensor to the nearest point in its cone, metres.
    pub distance: f64,
    /// That point on the floor.
    pub point: (f64, f64),
    /// The normal of the surface there: a unit vector on the floor.
    pub normal: (f64, f64),
    /// The robot or obstacle that the point belongs to.
    pub object: SceneObject,
}

/// A robot or an obstacle of a scene: what a sensor can see and a robot can collide with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneObject {
    /// The index in [`Scene::obstacles`].
    Obstacle(usize),
    /// The index in [`Scene::robots`].
    Robot(usize),
}

impl Space {
    /// The obstacles of a scene at its start. A polygon that crosses itself is replaced by the hull of its corners.
    pub fn of(scene: &Scene) -> Self {
        Self::of_those(scene, |_, _| true)
    }

    /// The obstacles of a scene that do not move.
    pub fn of_fixed(scene: &Scene) -> Self {
        Self::of_those(scene, |_, obstacle| obstacle.trajectory.is_none())
    }

    /// A single obstacle of a scene, by its index, at its start; nothing if there is no such obstacle.
    pub fn of_one(scene: &Scene, obstacle: usize) -> Self {
        Self::of_those(scene, |index, _| index == obstacle)
    }

    fn of_those(scene: &Scene, is_wanted: impl Fn(usize, &Obstacle) -> bool) -> Self {
        let mut space = Self::default();
        for (owner, obstacle) in scene.obstacles.iter().enumerate() {
            if !is_wanted(owner, obstacle) {
                continue;
            }
            let first = space.parts.len();
            space.parts.extend(parts_of(owner, obstacle));
            let Some(trajectory) = &obstacle.trajectory else { continue };
            let heading = obstacle.pose.theta;
            let mover = |(part, found): (usize, &ConvexPart)| {
                let centre = found.placement.inverse_transform_point(found.centre);
                PartMotion { part, centre, heading, trajectory: trajectory.clone() }
            };
            space.movers.extend(space.parts.iter().enumerate().skip(first).map(mover));
        }
        space
    }

    /// Moves the obstacles that move to where they are at a time, seconds since the start of the simulation.
    pub fn move_to(&mut self, time: f64) {
        for mover in &self.movers {
            let (x, y) = mover.trajectory.at(time);
            if let Some(part) = self.parts.get_mut(mover.part) {
                part.placement = placement(Pose { x, y, theta: mover.heading });
                part.centre = part.placement.transform_point(mover.centre);
            }
        }
    }

    /// The obstacle nearest to a body, if it is nearer than `within` metres; the first of several equally near.
    pub fn nearest(&self, body: Body, pose: Pose, within: f64) -> Option<Near> {
        let body = ConvexPart::robot(0, body, pose);
        let mut nearest: Option<Near> = None;
        for part in &self.parts {
            let bound = nearest.map_or(within, |near| near.distance);
            if part.is_beyond(&body, bound) {
                continue;
            }
            let distance = part.distance(&body);
            if distance < bound {
                nearest = Some(Near { distance, obstacle: part.owner });
            }
        }
        nearest
    }

    /// The nearest thing that a sensor of a robot at `pose` sees: an obstacle, or one of the `others`, which are robots by
    /// their index, with bodies and poses.
    pub fn sight(&self, pose: Pose, mount: &Mount, others: &[(usize, Body, Pose)]) -> Option<Sighting> {
        let cone = FloorCone::new(pose.compose(&mount.pose), mount);
        let obstacles = self.parts.iter().map(|part| (SceneObject::Obstacle(part.owner), *part));
        let robots = others
            .iter()
            .map(|&(robot, body, pose)| (SceneObject::Robot(robot), ConvexPart::robot(robot, body, pose)));
        let mut first: Option<Sighting> = None;
        for (object, part) in obstacles.chain(robots) {
            let bound = first.map_or(mount.range, |sighting| sighting.distance);
            let seen = cone
                .sees(&part, bound)
                .filter(|(_, distance, _)| first.is_none_or(|first| *distance < first.distance));
            if let Some((point, distance, normal)) = seen {
                let (point, normal) = ((point.x, point.y), (normal.x, normal.y));
                first = Some(Sighting { distance, point, normal, object });
            }
        }
        first
    }
}

/// The distance between two bodies, metres; 0 if they touch or overlap.
pub fn distance_between(a: (Body, Pose), b: (Body, Pose)) -> f64 {
    ConvexPart::robot(0, a.0, a.1).distance(&ConvexPart::robot(0, b.0, b.1))
}

fn placement(pose: Pose) -> Placement {
    Placement::new(Vector::new(pose.x, pose.y), pose.theta)
}

fn parts_of(owner: usize, obstacle: &Obstacle) -> Vec<ConvexPart> {
    match &obstacle.shape {
        Shape::Box(body) => vec![ConvexPart::robot(owner, *body, obstacle.pose)],
        Shape::Cylinder { radius } => {
            let placement = placement(obstacle.pose);
            let (solid, centre) = (Solid::Ball(Ball::new(*radius)), placement.translation);
            vec![ConvexPart { owner, solid, placement, centre, reach: *radius }]
        }
        Shape::Polygon(corners) => {
            let triangles = triangles(corners).into_iter();
            triangles.map(|triangle| ConvexPart::triangle(owner, triangle, obstacle.pose)).collect()
        }
    }
}

/// A polygon as triangles, each by its corners; none if it has fewer than three corners or crosses itself.
pub fn triangulate(corners: &[(f64, f64)]) -> Vec<[(f64, f64); 3]> {
    let corner = |corner: Vector| (corner.x, corner.y);
    triangles(corners)
        .iter()
        .map(|triangle| [corner(triangle.a), corner(triangle.b), corner(triangle.c)])
        .collect()
}

/// A polygon as triangles; none if it has fewer than three corners or crosses itself.
pub(crate) fn triangles(corners: &[(f64, f64)]) -> Vec<Triangle> {
    let mut corners: Vec<Vector> = corners.iter().map(|&(x, y)| Vector::new(x, y)).collect();
    let last = corners.len().saturating_sub(1);
    let twice_area: f64 = (0..corners.len())
        .map(|index| corners[if index == 0 { last } else { index - 1 }].perp_dot(corners[index]))
        .sum();
    if corners.len() < 3 || twice_area == 0.0 {
        return Vec::new();
    }
    if twice_area < 0.0 {
        corners.reverse();
    }
    TriMesh::from_polygon(corners).map_or_else(Vec::new, |mesh| mesh.triangles().collect())
}

impl ConvexPart {
    fn robot(owner: usize, body: Body, pose: Pose) -> Self {
        let half = Vector::new(body.length / 2.0, body.width / 2.0);
        let placement = placement(pose);
        let solid = Solid::Cuboid(Cuboid::new(half));
        Self { owner, solid, placement, centre: placement.translation, reach: half.length() }
    }

    fn triangle(owner: usize, triangle: Triangle, pose: Pose) -> Self {
        let placement = placement(pose);
        let middle = triangle.center();
        let reach = triangle.vertices().iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
        let centre = placement.transform_point(middle);
        Self { owner, solid: Solid::Triangle(triangle), placement, centre, reach }
    }

    /// Returns whether it is certainly further away than `bound`.
    fn is_beyond(&self, other: &Self, bound: f64) -> bool {
        self.centre.distance(other.centre) - self.reach - other.reach > bound
    }

    fn distance(&self, other: &Self) -> f64 {
        let distance =
            query::distance(&self.placement, self.solid.shape(), &other.placement, other.solid.shape());
        // The library supports every pair of our shapes.
        distance.map_or(f64::INFINITY, |found| found.distance)
    }
}

impl Solid {
    fn shape(&self) -> &dyn parry2d_f64::shape::Shape {
        match self {
            Self::Cuboid(cuboid) => cuboid,
            Self::Ball(ball) => ball,
            Self::Triangle(triangle) => triangle,
        }
    }
}

/// The cone of a sensor, on the floor.
struct FloorCone {
    at: Vector,
    heading: Vector,
    /// Cosine of half the cone's opening.
    edge_cosine: f64,
    /// The directions of the cone's edges.
    edges: [Vector; 2],
}

impl FloorCone {
    fn new(pose: Pose, mount: &Mount) -> Self {
        let direction = |angle: f64| Vector::new((pose.theta + angle).cos(), (pose.theta + angle).sin());
        let half = mount.cone / 2.0;
        Self {
            at: Vector::new(pose.x, pose.y),
            heading: direction(0.0),
            edge_cosine: half.cos(),
            edges: [direction(half), direction(-half)],
        }
    }

    /// The nearest point of a convex part within the cone and `range`, with its distance and the normal there.
    ///
    /// The distance of a convex body, as a function of the direction, has a single minimum. So if the nearest point is not
    /// in the cone, the nearest one that is lies on an edge of the cone.
    fn sees(&self, part: &ConvexPart, range: f64) -> Option<(Vector, f64, Vector)> {
        if part.centre.distance(self.at) - part.reach > range {
            return None;
        }
        let shape = part.solid.shape();
        let nearest = shape.project_point(&part.placement, self.at, true);
        let way = nearest.point - self.at;
        let distance = way.length();
        if distance > range {
            return None;
        }
        if nearest.is_inside || distance == 0.0 {
            return Some((self.at, 0.0, -self.heading));
        }
        if way.dot(self.heading) >= distance * self.edge_cosine {
            return Some((nearest.point, distance, -way / distance));
        }
        let hit = |edge: Vector| {
            let ray = Ray::new(self.at, edge);
            let hit = shape.cast_ray_and_get_normal(&part.placement, &ray, range, true)?;
            Some((self.at + edge * hit.time_of_impact, hit.time_of_impact, hit.normal))
        };
        self.edges.into_iter().filter_map(hit).min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use proptest::prelude::*;

    use super::*;

    const BODY: Body = Body { length: 0.4, width: 0.2 };

    fn space(obstacles: Vec<Obstacle>) -> Space {
        Space::of(&Scene { obstacles, ..Scene::default() })
    }

    fn obstacle(pose: Pose, shape: Shape) -> Obstacle {
        Obstacle::fixed("", pose, shape)
    }

    fn looking(range: f64, degrees: f64) -> Mount {
        Mount { pose: Pose::new(0.2, 0.0, 0.0), range, cone: degrees.to_radians() }
    }

    /// A U that opens to the right, 1 m outside and 0.2 m thick.
    fn u_shape() -> Shape {
        Shape::Polygon(vec![
            (0.0, 0.0),
            (1.0, 0.0),
            (1.0, 0.2),
            (0.2, 0.2),
            (0.2, 0.8),
            (1.0, 0.8),
            (1.0, 1.0),
            (0.0, 1.0),
        ])
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-9
    }

    #[test]
    fn distances_to_every_shape() {
        let at = Pose::new(2.0, 0.0, FRAC_PI_2);
        for (shape, distance) in [
            (Shape::Box(Body { length: 1.0, width: 0.6 }), 2.0 - 0.3 - 0.2),
            (Shape::Cylinder { radius: 0.5 }, 2.0 - 0.5 - 0.2),
            (Shape::Polygon(vec![(1.0, 0.4), (-1.0, 0.4), (-1.0, 0.3), (1.0, 0.3)]), 2.0 - 0.4 - 0.2),
        ] {
            let space = space(vec![obstacle(at, shape)]);
            let near = space.nearest(BODY, Pose::default(), 5.0);
            assert!(near.is_some_and(|near| close(near.distance, distance)), "{near:?}");
            assert_eq!(space.nearest(BODY, Pose::default(), distance - 1e-9), None);
        }
    }

    #[test]
    fn inside_of_a_bay_is_free_whichever_way_round_its_corners_go() {
        let mut corners = match u_shape() {
            Shape::Polygon(corners) => corners,
            other => panic!("{other:?}"),
        };
        for _ in 0..2 {
            let space = space(vec![obstacle(Pose::default(), Shape::Polygon(corners.clone()))]);
            let near = space.nearest(BODY, Pose::new(0.6, 0.5, 0.0), 5.0).unwrap();
            assert!(close(near.distance, 0.2), "{near:?}");
            corners.reverse();
        }
    }

    #[test]
    fn obstacles_that_move_are_where_they_are_at_the_time() {
        let points = [(0.0, 1.0), (10.0, 3.0)].map(|(time, x)| crate::Waypoint { time, x, y: 0.0 });
        let shape = || Shape::Box(Body { length: 1.0, width: 0.6 });
        let cart =
            Obstacle::moving("cart", FRAC_PI_2, shape(), Trajectory::new(points.to_vec(), false).unwrap());
        let scene =
            Scene { obstacles: vec![obstacle(Pose::new(9.0, 0.0, 0.0), shape()), cart], ..Scene::default() };
        let mut space = Space::of(&scene);
        let fixed = Space::of_fixed(&scene);
        let distance = |space: &Space| space.nearest(BODY, Pose::default(), 20.0).unwrap();
        for (time, x) in [(0.0, 1.0), (5.0, 2.0), (20.0, 3.0), (0.0, 1.0)] {
            space.move_to(time);
            let near = distance(&space);
            assert!(near.obstacle == 1 && close(near.distance, x - 0.3 - 0.2), "{time}: {near:?}");
            let seen = space.sight(Pose::default(), &looking(9.0, 20.0), &[]).unwrap();
            assert!(
                seen.object == SceneObject::Obstacle(1) && close(seen.distance, x - 0.3 - 0.2),
                "{seen:?}"
            );
        }
        assert_eq!(distance(&fixed).obstacle, 0);
        assert_eq!(distance(&Space::of_one(&scene, 1)), distance(&space), "it keeps its index");
    }

    #[test]
    fn of_equally_near_obstacles_the_first_is_told() {
        let walls = [1.0, -1.0].map(|x| Obstacle::wall("w", (x, -1.0), (x, 1.0), 0.1));
        let near = space(walls.to_vec()).nearest(BODY, Pose::default(), 9.0).unwrap();
        assert!(near.obstacle == 0 && close(near.distance, 0.75), "{near:?}");
    }

    #[test]
    fn the_bound_counts_from_the_edge_of_the_body() {
        let big = Body { length: 2.0, width: 2.0 };
        let post = obstacle(Pose::new(1.5, 0.0, 0.0), Shape::Cylinder { radius: 0.1 });
        let near = space(vec![post]).nearest(big, Pose::default(), 0.41);
        assert!(near.is_some_and(|near| close(near.distance, 0.4)), "{near:?}");
    }

    #[test]
    fn the_nearest_of_several() {
        let walls = [3.0, 1.0, 2.0].map(|x| Obstacle::wall("w", (x, -1.0), (x, 1.0), 0.1));
        let near = space(walls.to_vec()).nearest(BODY, Pose::default(), 9.0).unwrap();
        assert!(near.obstacle == 1 && close(near.distance, 1.0 - 0.05 - 0.2), "{near:?}");
        let other = (BODY, Pose::new(0.0, 1.0, FRAC_PI_2));
        assert!(close(distance_between((BODY, Pose::default()), other), 1.0 - 0.1 - 0.2));
    }

    #[test]
    fn a_sensor_sees_the_nearest_thing_in_its_cone() {
        let wall = Obstacle::wall("w", (1.0, -1.0), (1.0, 1.0), 0.1);
        let space = space(vec![wall]);
        let seen = space.sight(Pose::default(), &looking(1.0, 20.0), &[]).unwrap();
        assert!(close(seen.distance, 0.75) && close(seen.point.0, 0.95) && close(seen.normal.0, -1.0));
        assert_eq!(seen.object, SceneObject::Obstacle(0));
        assert_eq!(space.sight(Pose::default(), &looking(0.7, 20.0), &[]), None);
        assert_eq!(space.sight(Pose::new(0.0, 0.0, PI), &looking(1.0, 20.0), &[]), None);
        // Turned by 30°, only the cone's right edge meets it, under 20°.
        let seen = space.sight(Pose::new(0.5, 0.0, 30_f64.to_radians()), &looking(1.0, 20.0), &[]).unwrap();
        let (x, edge) = (0.5 + 0.2 * 30_f64.to_radians().cos(), 20_f64.to_radians());
        assert!(close(seen.distance, (0.95 - x) / edge.cos()) && close(seen.point.0, 0.95), "{seen:?}");
        assert!(close(seen.normal.0, -1.0) && close(seen.normal.1, 0.0), "{seen:?}");
        let robot = (3, BODY, Pose::new(0.7, 0.0, 0.0));
        let seen = space.sight(Pose::default(), &looking(1.0, 20.0), &[robot]).unwrap();
        assert!(seen.object == SceneObject::Robot(3) && close(seen.distance, 0.3), "{seen:?}");
    }

    #[test]
    fn a_post_thinner_than_any_ray_is_seen() {
        let post = obstacle(Pose::new(0.9, 0.05, 0.0), Shape::Cylinder { radius: 0.001 });
        let seen = space(vec![post]).sight(Pose::default(), &looking(1.0, 20.0), &[]).unwrap();
        assert!((seen.distance - 0.7_f64.hypot(0.05) + 0.001).abs() < 1e-9, "{seen:?}");
    }

    /// The outline of a shape on the floor, without any triangle: corner after corner, or a circle.
    enum Outline {
        Corners(Vec<(f64, f64)>),
        Circle { centre: (f64, f64), radius: f64 },
    }

    impl Outline {
        fn of(obstacle: &Obstacle) -> Self {
            let on_floor = |x, y| {
                let point = obstacle.pose.compose(&Pose::new(x, y, 0.0));
                (point.x, point.y)
            };
            match &obstacle.shape {
                Shape::Box(Body { length, width }) => {
                    let (x, y) = (length / 2.0, width / 2.0);
                    Self::Corners([(x, y), (-x, y), (-x, -y), (x, -y)].map(|(x, y)| on_floor(x, y)).to_vec())
                }
                Shape::Cylinder { radius } => Self::Circle { centre: on_floor(0.0, 0.0), radius: *radius },
                Shape::Polygon(corners) => {
                    Self::Corners(corners.iter().map(|&(x, y)| on_floor(x, y)).collect())
                }
            }
        }

        fn edges(corners: &[(f64, f64)]) -> impl Iterator<Item = ((f64, f64), (f64, f64))> {
            corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
        }

        /// Returns whether a point is inside: a line from it to the right crosses an odd number of edges.
        fn holds(&self, (x, y): (f64, f64)) -> bool {
            match self {
                Self::Circle { centre, radius } => (x - centre.0).hypot(y - centre.1) <= *radius,
                Self::Corners(corners) => {
                    let crosses = |(a, b): &((f64, f64), (f64, f64))| {
                        (a.1 > y) != (b.1 > y) && x < a.0 + (y - a.1) / (b.1 - a.1) * (b.0 - a.0)
                    };
                    Self::edges(corners).filter(crosses).count() % 2 == 1
                }
            }
        }

        /// Returns the distance that a ray goes before it meets the outline.
        fn ray(&self, from: (f64, f64), angle: f64) -> Option<f64> {
            let (dx, dy) = (angle.cos(), angle.sin());
            match self {
                Self::Circle { centre, radius } => {
                    let (cx, cy) = (centre.0 - from.0, centre.1 - from.1);
                    let (along, across) = (cx * dx + cy * dy, cx * dy - cy * dx);
                    let half = (radius * radius - across * across).sqrt();
                    [along - half, along + half].into_iter().find(|way| *way >= 0.0)
                }
                Self::Corners(corners) => {
                    let meets = |(a, b): ((f64, f64), (f64, f64))| {
                        let (ax, ay, ex, ey) = (a.0 - from.0, a.1 - from.1, b.0 - a.0, b.1 - a.1);
                        let cross = dx * ey - dy * ex;
                        let (way, share) = ((ax * ey - ay * ex) / cross, (ax * dy - ay * dx) / cross);
                        (way >= 0.0 && (0.0..=1.0).contains(&share)).then_some(way)
                    };
                    Self::edges(corners).filter_map(meets).min_by(f64::total_cmp)
                }
            }
        }

        /// The points of each edge that can be the nearest to a point: the foot of the perpendicular, or a corner.
        fn nearest(&self, (x, y): (f64, f64)) -> Vec<(f64, f64)> {
            match self {
                Self::Circle { centre, radius } => {
                    let away = (x - centre.0).hypot(y - centre.1);
                    vec![(
                        centre.0 + (x - centre.0) * radius / away,
                        centre.1 + (y - centre.1) * radius / away,
                    )]
                }
                Self::Corners(corners) => {
                    let foot = |(a, b): ((f64, f64), (f64, f64))| {
                        let (ex, ey) = (b.0 - a.0, b.1 - a.1);
                        let share = ((x - a.0) * ex + (y - a.1) * ey) / (ex * ex + ey * ey);
                        (a.0 + share.clamp(0.0, 1.0) * ex, a.1 + share.clamp(0.0, 1.0) * ey)
                    };
                    Self::edges(corners).map(foot).collect()
                }
            }
        }

        /// The distance from a point outside to the outline.
        fn distance(&self, (x, y): (f64, f64)) -> f64 {
            let ways = self.nearest((x, y)).into_iter().map(|point| (point.0 - x).hypot(point.1 - y));
            ways.fold(f64::INFINITY, f64::min)
        }

        /// The distance to the nearest point of the outline in a cone: on one of the cone's edges, or between them.
        fn distance_in_cone(&self, (x, y): (f64, f64), heading: f64, cone: f64) -> f64 {
            let on_edges = [-0.5, 0.5].into_iter().filter_map(|side| self.ray((x, y), heading + side * cone));
            let between = self.nearest((x, y)).into_iter().filter(|point| {
                let bearing = (point.1 - y).atan2(point.0 - x) - heading;
                pydslrep_kinematics::angle_between(0.0, bearing).abs() <= cone / 2.0
            });
            let ways = between.map(|point| (point.0 - x).hypot(point.1 - y));
            on_edges.chain(ways).fold(f64::INFINITY, f64::min)
        }
    }

    prop_compose! {
        /// A box, a cylinder, a U, or a star with notches of any depth: somewhere near the origin.
        fn obstacles()(
            x in -0.5..0.5, y in -0.5..0.5, theta in -3.0..3.0, which in 0..4,
            spokes in prop::collection::vec(0.1..0.8, 3..12),
        ) -> Obstacle {
            let shape = match which {
                0 => Shape::Box(Body { length: 0.7, width: 0.3 }),
                1 => Shape::Cylinder { radius: 0.3 },
                2 => u_shape(),
                _ => {
                    let apart = 2.0 * PI / f64::from(u32::try_from(spokes.len()).unwrap());
                    let angles = (0_u32..).map(|spoke| f64::from(spoke) * apart);
                    let corner = |(angle, spoke): (f64, &f64)| (spoke * angle.cos(), spoke * angle.sin());
                    Shape::Polygon(angles.zip(&spokes).map(corner).collect())
                }
            };
            obstacle(Pose::new(x, y, theta), shape)
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1_000))]

        /// A sensor sees the nearest point of the outline in its cone.
        #[test]
        fn a_cone_sees_the_nearest_point_of_the_outline_in_it(
            obstacle in obstacles(), x in -1.5..1.5, y in -1.5..1.5, theta in -3.0..3.0, cone in 5.0..120.0,
        ) {
            let outline = Outline::of(&obstacle);
            let mount = Mount { pose: Pose::default(), range: 2.0, cone: f64::to_radians(cone) };
            let seen = space(vec![obstacle]).sight(Pose::new(x, y, theta), &mount, &[]);
            if outline.holds((x, y)) {
                prop_assert_eq!(seen.map(|seen| seen.distance), Some(0.0));
                return Ok(());
            }
            let distance = outline.distance_in_cone((x, y), theta, mount.cone);
            match seen {
                None => prop_assert!(distance > mount.range, "{distance}"),
                Some(seen) => {
                    prop_assert!((seen.distance - distance).abs() < 1e-9, "{seen:?} {distance}");
                    let at = (seen.point.0 - x).hypot(seen.point.1 - y);
                    prop_assert!(close(at, distance) && outline.distance(seen.point) < 1e-9, "{seen:?}");
                    let (nx, ny) = seen.normal;
                    let towards = nx * (x - seen.point.0) + ny * (y - seen.point.1);
                    prop_assert!(close(nx.hypot(ny), 1.0) && towards > 0.0, "{seen:?}");
                }
            }
        }

        /// A point is as far from an obstacle as from its outline: nothing of a polygon is lost when it is cut.
        #[test]
        fn a_point_is_as_far_away_as_the_outline(obstacle in obstacles(), x in -1.5..1.5, y in -1.5..1.5) {
            let outline = Outline::of(&obstacle);
            let point = Body { length: 1e-9, width: 1e-9 };
            let near = space(vec![obstacle]).nearest(point, Pose::new(x, y, 0.0), 9.0).unwrap();
            let distance = if outline.holds((x, y)) { 0.0 } else { outline.distance((x, y)) };
            prop_assert!((near.distance - distance).abs() < 1e-6, "{} {distance}", near.distance);
        }
    }
}
