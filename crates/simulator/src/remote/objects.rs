//! The scene as clients see it: a tree of named objects with handles.

use std::f64::consts::FRAC_PI_2;
use std::iter;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use pydslrep_kinematics::Pose;
use pydslrep_scene::{Scene, Thing};

use crate::World;

/// The identifier of an object in calls.
pub(super) type Handle = i64;

/// The kind of an object, with indices into the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Robot(usize),
    Wheel { robot: usize, wheel: usize },
    Sensor { robot: usize, sensor: usize },
    Obstacle(usize),
}

/// An object of the scene.
#[derive(Debug, Clone)]
pub(super) struct Object {
    pub(super) alias: String,
    pub(super) parent: Option<Handle>,
    pub(super) kind: Kind,
}

/// All objects: each robot with its wheels and its sensors, then the obstacles.
#[derive(Debug, Clone)]
pub(super) struct Objects(Vec<Object>);

impl Objects {
    pub(super) fn of(scene: &Scene) -> Self {
        let mut objects = Self(Vec::new());
        for (index, robot) in scene.robots.iter().enumerate() {
            let parent = Some(objects.add(&robot.name, None, Kind::Robot(index)));
            for (wheel, part) in robot.wheels.iter().enumerate() {
                objects.add(&part.name, parent, Kind::Wheel { robot: index, wheel });
            }
            for (sensor, part) in robot.sensors.iter().enumerate() {
                objects.add(&part.name, parent, Kind::Sensor { robot: index, sensor });
            }
        }
        for (index, obstacle) in scene.obstacles.iter().enumerate() {
            objects.add(&obstacle.name, None, Kind::Obstacle(index));
        }
        objects
    }

    /// The handle of a detected object.
    pub(super) fn handle_of(&self, thing: Thing) -> Option<Handle> {
        let kind = match thing {
            Thing::Robot(robot) => Kind::Robot(robot),
            Thing::Obstacle(obstacle) => Kind::Obstacle(obstacle),
        };
        self.iter().find(|(_, object)| object.kind == kind).map(|(handle, _)| handle)
    }

    fn add(&mut self, alias: &str, parent: Option<Handle>, kind: Kind) -> Handle {
        self.0.push(Object { alias: alias.to_owned(), parent, kind });
        i64::try_from(self.0.len()).unwrap_or(i64::MAX)
    }

    pub(super) fn get(&self, handle: Handle) -> Option<&Object> {
        self.0.get(usize::try_from(handle.checked_sub(1)?).ok()?)
    }

    /// All objects with their handles, which count from 1.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Handle, &Object)> {
        (1..).zip(&self.0)
    }

    /// The `index`-th match of a path. `/a/b` searches the whole scene for an `a` with a `b` anywhere below it, `./b`
    /// searches below `proxy`. A name may have an index among the objects of that name below the same parent, as in
    /// `/a[1]/b`. Matches are sorted by depth: a robot `a` comes before a wheel `a` of any robot.
    pub(super) fn find(&self, path: &str, proxy: Option<Handle>, index: usize) -> Option<Handle> {
        let mut parts = path.split('/');
        let mut candidates: Vec<Option<Handle>> = match parts.next()? {
            "" => vec![None],
            "." => vec![proxy],
            ".." => vec![self.get(proxy?)?.parent],
            _ => return None,
        };
        for part in parts {
            let (alias, nth) = split_index(part)?;
            let mut below: Vec<Handle> = self
                .iter()
                .filter(|(_, object)| object.alias == alias)
                .filter(|&(handle, _)| candidates.iter().any(|&root| self.is_below(handle, root)))
                .filter(|&(handle, _)| nth.is_none_or(|nth| self.namesakes(handle).nth(nth) == Some(handle)))
                .map(|(handle, _)| handle)
                .collect();
            below.sort_by_key(|&handle| self.depth(handle));
            candidates = below.into_iter().map(Some).collect();
        }
        *candidates.get(index)?
    }

    /// All objects with the name and parent of an object, including itself, in order.
    fn namesakes(&self, handle: Handle) -> impl Iterator<Item = Handle> {
        let object = self.get(handle);
        let is_namesake = move |other: &Object| {
            object.is_some_and(|object| object.alias == other.alias && object.parent == other.parent)
        };
        self.iter().filter(move |(_, other)| is_namesake(other)).map(|(handle, _)| handle)
    }

    fn depth(&self, handle: Handle) -> usize {
        let parent = |&handle: &Handle| self.get(handle).and_then(|object| object.parent);
        iter::successors(Some(handle), parent).count()
    }

    fn is_below(&self, handle: Handle, root: Option<Handle>) -> bool {
        let mut parent = self.get(handle).and_then(|object| object.parent);
        if root.is_none() {
            return true;
        }
        while parent.is_some() && parent != root {
            parent = parent.and_then(|parent| self.get(parent)).and_then(|object| object.parent);
        }
        parent.is_some()
    }

    /// The full path of an object, such as `/robot_1/wheelL`; objects of the same name and parent have an index.
    pub(super) fn path(&self, handle: Handle) -> Option<String> {
        let object = self.get(handle)?;
        let twins: Vec<Handle> = self.namesakes(handle).collect();
        let parent = object.parent.and_then(|parent| self.path(parent)).unwrap_or_default();
        let index = twins.iter().position(|&twin| twin == handle).filter(|_| twins.len() > 1);
        let index = index.map_or_else(String::new, |index| format!("[{index}]"));
        Some(format!("{parent}/{}{index}", object.alias))
    }

    /// The shortest unique path of an object.
    pub(super) fn short_path(&self, handle: Handle) -> Option<String> {
        let object = self.get(handle)?;
        let unique = self.iter().filter(|(_, other)| other.alias == object.alias).count() == 1;
        if unique { Some(format!("/{}", object.alias)) } else { self.path(handle) }
    }

    /// An object's frame in the world. As in CoppeliaSim, a joint's z axis is its axis of rotation and a sensor's z axis its
    /// direction.
    pub(super) fn frame(&self, handle: Handle, world: &World) -> Option<Isometry3<f64>> {
        let kind = self.get(handle)?.kind;
        let robot = match kind {
            Kind::Obstacle(obstacle) => {
                return Some(planar(world.scene().obstacles.get(obstacle)?.pose, 0.0));
            }
            Kind::Robot(robot) | Kind::Wheel { robot, .. } | Kind::Sensor { robot, .. } => robot,
        };
        let scene = world.scene().robots.get(robot)?;
        let height = scene.wheels.iter().map(|wheel| wheel.radius).fold(0.0, f64::max);
        let body = planar(world.pose(robot), height);
        Some(match kind {
            Kind::Robot(_) | Kind::Obstacle(_) => body,
            Kind::Wheel { wheel, .. } => {
                let &(x, y) = scene.geometry.wheel_positions(scene.drive).get(wheel)?;
                let wheel = scene.wheels.get(wheel)?;
                let tilt = if wheel.mirrored { FRAC_PI_2 } else { -FRAC_PI_2 };
                let rotation = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt);
                body * Isometry3::from_parts(Translation3::new(x, y, wheel.radius - height), rotation)
            }
            Kind::Sensor { sensor, .. } => {
                let forward = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2);
                body * planar(scene.sensors.get(sensor)?.mount.pose, 0.0) * forward
            }
        })
    }
}

/// A name and its index, as in `wheel[1]`; `None` if malformed.
fn split_index(part: &str) -> Option<(&str, Option<usize>)> {
    match part.strip_suffix(']').and_then(|part| part.split_once('[')) {
        Some((alias, index)) => Some((alias, Some(index.parse().ok()?))),
        None if part.is_empty() => None,
        None => Some((part, None)),
    }
}

fn planar(pose: Pose, height: f64) -> Isometry3<f64> {
    Isometry3::from_parts(
        Translation3::new(pose.x, pose.y, height),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), pose.theta),
    )
}

#[cfg(test)]
mod tests {
    use pydslrep_kinematics::Drive;
    use pydslrep_scene::{Robot, SensorKind, Wheel};

    use super::*;

    fn world() -> World {
        let robot = |name: &str, mirrored: bool| {
            let mut wheels = vec![Wheel::new("l", 0.05), Wheel::new("r", 0.04)];
            wheels[1].mirrored = mirrored;
            let sensors =
                vec![("front".to_owned(), SensorKind::Distance), ("l".to_owned(), SensorKind::Distance)];
            Robot::new(name, Drive::TwoWheel, wheels, sensors)
        };
        let mut scene = Scene::empty_floor(vec![robot("a", false), robot("b", true)]);
        scene.robots[1].start = Pose::new(1.0, 2.0, FRAC_PI_2);
        World::new(scene).unwrap()
    }

    #[test]
    fn paths_and_handles() {
        let world = world();
        let objects = Objects::of(world.scene());
        let find = |path: &str| objects.find(path, None, 0);
        assert_eq!(
            (find("/a"), find("/a/l"), find("/b"), find("/b/r")),
            (Some(1), Some(2), Some(6), Some(8))
        );
        assert_eq!(
            (find("/r"), objects.find("/r", None, 1), objects.find("/r", None, 2)),
            (Some(3), Some(8), None)
        );
        assert_eq!((find("/a/l[1]"), find("/a/l[2]"), find("/b[0]/r")), (Some(5), None, Some(8)));
        assert_eq!((objects.find("./r", Some(6), 0), objects.find("./a", Some(6), 0)), (Some(8), None));
        assert_eq!(objects.find("..", Some(8), 0), Some(6));
        // Indices count siblings: no two `r` have the same parent.
        assert_eq!((find("/l[1]"), find("/r[0]"), find("/r[1]")), (Some(5), Some(3), None));
        for wrong in ["", "a", "/", "//", "/a/", "/a/nothing", "/a[", "/a[x]", "/l/a", "/a/r/r", ".", "./"] {
            assert_eq!(find(wrong), None, "{wrong}");
        }
        for handle in 1..=10 {
            let path = objects.path(handle).unwrap();
            assert_eq!(find(&path), Some(handle), "{path}");
        }
        assert_eq!(
            (objects.path(3).unwrap(), objects.path(5).unwrap()),
            ("/a/r".to_owned(), "/a/l[1]".to_owned())
        );
        assert_eq!(objects.short_path(1).as_deref(), Some("/a"));
        for wrong in [0, -1, 11, i64::MIN, i64::MAX] {
            assert!(objects.get(wrong).is_none());
        }
    }

    #[test]
    fn a_robot_comes_before_parts_of_the_same_name() {
        let robot = |name: &str| {
            let wheels = vec![Wheel::new("x", 0.05), Wheel::new("r", 0.05)];
            Robot::new(name, Drive::TwoWheel, wheels, vec![("x".to_owned(), SensorKind::Distance)])
        };
        let objects = Objects::of(&Scene::empty_floor(vec![robot("a"), robot("x")]));
        let all = |path: &str| -> Vec<Handle> {
            (0..).map_while(|index| objects.find(path, None, index)).collect()
        };
        assert_eq!(all("/x"), [5, 2, 4, 6, 8]);
        assert_eq!((all("/x/x"), all("/a/x")), (vec![6, 8], vec![2, 4]));
    }

    #[test]
    fn joints_have_their_axis_and_height() {
        let world = world();
        let objects = Objects::of(world.scene());
        let axis = |handle| {
            let body = objects.frame(objects.get(handle).unwrap().parent.unwrap(), &world).unwrap();
            body.inverse() * (objects.frame(handle, &world).unwrap() * Vector3::z())
        };
        assert!((axis(2) - Vector3::y()).norm() < 1e-12 && (axis(8) + Vector3::y()).norm() < 1e-12);
        let right = objects.frame(8, &world).unwrap().translation.vector;
        assert!((right - Vector3::new(1.15, 2.0, 0.04)).norm() < 1e-12, "{right}");
    }

    #[test]
    fn sensors_look_along_their_z_axis() {
        let world = world();
        let objects = Objects::of(world.scene());
        let direction = objects.frame(9, &world).unwrap() * Vector3::z();
        assert!((direction - Vector3::y()).norm() < 1e-12, "{direction}");
    }
}
