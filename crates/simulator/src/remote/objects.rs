//! The scene as clients see it: a tree of named objects with handles.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::iter;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use pydslrep_kinematics::Pose;
use pydslrep_scene::{Frame, Scene, SceneObject};

use super::info;
use super::parts::{Part, PartKind, ShapePart};
use super::recognition::{Recognized, recognize};
use super::sight;
use crate::World;

/// The maximum number of objects that clients create.
const MAX_MADE: usize = 5000;

/// The maximum number of objects above a created one.
const MAX_DEPTH: usize = 50;

/// The identifier of an object in calls.
pub(super) type Handle = i64;

/// The kind of an object, with indices into the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Robot(usize),
    Wheel {
        robot: usize,
        wheel: usize,
    },
    Sensor {
        robot: usize,
        sensor: usize,
    },
    Obstacle(usize),
    /// Created by a client, and no part of the simulated world.
    Made,
}

/// An object of the scene.
#[derive(Debug, Clone)]
pub(super) struct Object {
    pub(super) alias: String,
    pub(super) parent: Option<Handle>,
    pub(super) kind: Kind,
    /// The description of an object that a client has created.
    part: Option<Box<Part>>,
}

impl Object {
    /// The number of its type.
    pub(super) fn type_number(&self) -> i64 {
        match (&self.part, self.kind) {
            (Some(part), _) => part.kind.type_number(),
            (None, Kind::Wheel { .. }) => info::TYPE_JOINT,
            (None, Kind::Sensor { .. }) => info::TYPE_SENSOR,
            (None, _) => info::TYPE_SHAPE,
        }
    }
}

/// All objects: those of the program, each robot with its wheels and its sensors, then the obstacles, and those that clients
/// have created. The latter are simulated from the next start on, as robots and obstacles.
#[derive(Debug, Clone)]
pub(super) struct Objects {
    all: BTreeMap<Handle, Object>,
    /// The handle of the latest object; none is used twice.
    last: Handle,
    program: Scene,
    /// True if clients have changed the simulated scene since the latest start.
    has_changed: bool,
    /// For created robots, their place relative to the simulated robot; empty while they are not simulated.
    offsets: BTreeMap<Handle, Isometry3<f64>>,
    /// The objects of created obstacles, by their indices in the scene.
    obstacles: BTreeMap<usize, Handle>,
    /// The created floors that sensors see, since the latest start.
    floors: Vec<Handle>,
    /// Paths of the user's own, beside those by names.
    paths: BTreeMap<String, Vec<Handle>>,
}

impl Objects {
    pub(super) fn of(scene: &Scene) -> Self {
        let mut objects = Self {
            all: BTreeMap::new(),
            last: 0,
            program: scene.clone(),
            has_changed: false,
            offsets: BTreeMap::new(),
            obstacles: BTreeMap::new(),
            floors: Vec::new(),
            paths: BTreeMap::new(),
        };
        for (index, robot) in scene.robots.iter().enumerate() {
            let first = objects.add(&robot.name, None, Kind::Robot(index));
            let parent = Some(first);
            for (wheel, part) in robot.wheels.iter().enumerate() {
                objects.add(&part.name, parent, Kind::Wheel { robot: index, wheel });
            }
            for (sensor, part) in robot.sensors.iter().enumerate() {
                objects.add(&part.name, parent, Kind::Sensor { robot: index, sensor });
            }
            objects.add_paths(first, &robot.objects);
        }
        for (index, obstacle) in scene.obstacles.iter().enumerate() {
            objects.add(&obstacle.name, None, Kind::Obstacle(index));
        }
        objects
    }

    /// Adds the paths of a robot and its parts, whose handles begin with a first one.
    fn add_paths(&mut self, first: Handle, objects: &pydslrep_scene::Objects) {
        for (part, paths) in objects {
            let of_name = self.iter().filter(|(handle, object)| *handle >= first && object.alias == *part);
            let handles: Vec<Handle> = of_name.map(|(handle, _)| handle).collect();
            for path in paths {
                self.paths.entry(path.clone()).or_default().extend(&handles);
            }
        }
    }

    /// The handle of a detected object.
    pub(super) fn handle_of(&self, object: SceneObject) -> Option<Handle> {
        if let SceneObject::Obstacle(obstacle) = object
            && let Some(handle) = self.obstacles.get(&obstacle)
        {
            return Some(*handle);
        }
        let kind = match object {
            SceneObject::Robot(robot) => Kind::Robot(robot),
            SceneObject::Obstacle(obstacle) => Kind::Obstacle(obstacle),
        };
        self.iter().find(|(_, object)| object.kind == kind).map(|(handle, _)| handle)
    }

    fn add(&mut self, alias: &str, parent: Option<Handle>, kind: Kind) -> Handle {
        self.last += 1;
        self.all.insert(self.last, Object { alias: alias.to_owned(), parent, kind, part: None });
        self.last
    }

    pub(super) fn get(&self, handle: Handle) -> Option<&Object> {
        self.all.get(&handle)
    }

    /// All objects with their handles, which count from 1.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Handle, &Object)> {
        self.all.iter().map(|(handle, object)| (*handle, object))
    }

    /// Adds an object without parent that a client creates; `None` if there are too many.
    pub(super) fn create(&mut self, kind: PartKind) -> Option<Handle> {
        if self.made().count() >= MAX_MADE {
            return None;
        }
        let handle = self.add(kind.alias(), None, Kind::Made);
        let local = Isometry3::identity();
        let special = kind.special();
        let part = Part { kind, local, data: BTreeMap::new(), special, engine: BTreeMap::new() };
        if let Some(object) = self.all.get_mut(&handle) {
            object.part = Some(Box::new(part));
        }
        self.has_changed = true;
        Some(handle)
    }

    /// Removes a created object; those below it lose their parent and stay where they are.
    pub(super) fn remove(&mut self, handle: Handle) {
        let children: Vec<Handle> =
            self.iter().filter(|(_, object)| object.parent == Some(handle)).map(|(child, _)| child).collect();
        for child in children {
            let frame = self.rest_frame(child);
            if let (Some(frame), Some(object)) = (frame, self.all.get_mut(&child)) {
                object.parent = None;
                if let Some(part) = &mut object.part {
                    part.local = frame;
                }
            }
        }
        self.all.remove(&handle);
        self.floors.retain(|&floor| floor != handle);
        self.offsets.remove(&handle);
        self.has_changed = true;
    }

    /// The handles of the objects that clients have created.
    pub(super) fn made(&self) -> impl Iterator<Item = Handle> {
        self.iter().filter(|(_, object)| object.part.is_some()).map(|(handle, _)| handle)
    }

    /// Returns the description of a created object.
    pub(super) fn part(&self, handle: Handle) -> Option<&Part> {
        self.get(handle)?.part.as_deref()
    }

    /// The created shape of a handle.
    pub(super) fn shape(&self, handle: Handle) -> Option<&ShapePart> {
        match &self.part(handle)?.kind {
            PartKind::Shape(shape) => Some(shape),
            _ => None,
        }
    }

    /// The name of an object; empty if there is none.
    pub(super) fn alias(&self, handle: Handle) -> String {
        self.get(handle).map(|object| object.alias.clone()).unwrap_or_default()
    }

    /// Returns the description of a created object, to change it.
    pub(super) fn part_mut(&mut self, handle: Handle) -> Option<&mut Part> {
        let part = self.all.get_mut(&handle)?.part.as_deref_mut()?;
        self.has_changed = true;
        Some(part)
    }

    pub(super) fn rename(&mut self, handle: Handle, alias: String) {
        if let Some(object) = self.all.get_mut(&handle) {
            object.alias = alias;
            self.has_changed = true;
        }
    }

    /// Puts a created object below another one, where it keeps its relative or its absolute place; false if it is below
    /// itself then, or too deep.
    pub(super) fn set_parent(&mut self, handle: Handle, parent: Option<Handle>, stays: bool) -> bool {
        let above = parent.map(|parent| self.ancestors(parent)).unwrap_or_default();
        if parent == Some(handle) || above.contains(&handle) || above.len() >= MAX_DEPTH {
            return false;
        }
        let (own, base) = (self.rest_frame(handle), parent.and_then(|parent| self.rest_frame(parent)));
        let Some(object) = self.all.get_mut(&handle) else { return false };
        object.parent = parent;
        if let (Some(part), Some(own), true) = (&mut object.part, own, stays) {
            part.local = base.map_or(own, |base| base.inv_mul(&own));
        }
        self.has_changed = true;
        true
    }

    /// The objects above another one, the nearest first.
    pub(super) fn ancestors(&self, handle: Handle) -> Vec<Handle> {
        let parent = |&handle: &Handle| self.get(handle).and_then(|object| object.parent);
        iter::successors(parent(&handle), parent).collect()
    }

    /// All objects below another one.
    pub(super) fn below(&self, handle: Handle) -> Vec<Handle> {
        let all = self.iter().map(|(other, _)| other);
        all.filter(|&other| self.ancestors(other).contains(&handle)).collect()
    }

    /// Returns the role of a created object in the simulated world, if it has one.
    pub(super) fn role(&self, handle: Handle) -> Option<Kind> {
        self.get(handle).map(|object| object.kind).filter(|kind| *kind != Kind::Made)
    }

    /// The world to simulate from now on, if clients have changed it since the last time.
    pub(super) fn take_changes(&mut self) -> Option<Scene> {
        if !std::mem::take(&mut self.has_changed) {
            return None;
        }
        self.release();
        let Recognized { scene, roles, offsets } = recognize(self, &self.program);
        for (handle, kind) in roles {
            if let Kind::Obstacle(obstacle) = kind {
                self.obstacles.insert(obstacle, handle);
            }
            if let Some(object) = self.all.get_mut(&handle) {
                object.kind = kind;
            }
        }
        self.offsets = offsets.into_iter().collect();
        self.floors = self.made().filter(|&handle| sight::is_detectable_floor(self, handle)).collect();
        Some(scene)
    }

    /// The created floors that sensors see.
    pub(super) fn floors(&self) -> &[Handle] {
        &self.floors
    }

    /// While the simulation is stopped, created objects that have changed are where clients have put them.
    pub(super) fn settle(&mut self) {
        if self.has_changed && !self.offsets.is_empty() {
            self.release();
        }
    }

    fn release(&mut self) {
        for object in self.all.values_mut().filter(|object| object.part.is_some()) {
            object.kind = Kind::Made;
        }
        self.offsets.clear();
        self.obstacles.clear();
    }

    /// The `index`-th match of a path. `/a/b` searches the whole scene for an `a` with a `b` anywhere below it, `./b`
    /// searches below `proxy`. A name may have an index among the objects of that name below the same parent, as in
    /// `/a[1]/b`. Matches are sorted by depth: a robot `a` comes before a wheel `a` of any robot.
    pub(super) fn find(&self, path: &str, proxy: Option<Handle>, index: usize) -> Option<Handle> {
        if let Some(handles) = self.paths.get(path) {
            return handles.get(index).copied();
        }
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
                .filter(|&(handle, _)| {
                    candidates.contains(&None)
                        || self.ancestors(handle).iter().any(|&above| candidates.contains(&Some(above)))
                })
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
        self.ancestors(handle).len() + 1
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

    /// An object, if it is not the scene's root, and all objects below it, level by level; only the next level below if they
    /// are not `deep`.
    pub(super) fn tree(&self, root: Option<Handle>, deep: bool) -> Vec<Handle> {
        let mut children: BTreeMap<Option<Handle>, Vec<Handle>> = BTreeMap::new();
        for (handle, object) in self.iter() {
            children.entry(object.parent).or_default().push(handle);
        }
        let below = |handle: Option<Handle>| children.get(&handle).cloned().unwrap_or_default();
        let mut found: Vec<Handle> = root.into_iter().chain(below(root)).collect();
        let mut next = root.iter().count();
        while let Some(handle) = found.get(next).copied().filter(|_| deep) {
            found.extend(below(Some(handle)));
            next += 1;
        }
        found
    }

    /// The frame of a created object in the world while the simulation is stopped.
    pub(super) fn rest_frame(&self, handle: Handle) -> Option<Isometry3<f64>> {
        let mut frame = self.part(handle)?.local;
        for above in self.ancestors(handle) {
            // The parts of a program's robot do not carry created objects.
            frame = self.part(above)?.local * frame;
        }
        Some(frame)
    }

    /// An object's frame in the world. As in CoppeliaSim, a joint's z axis is its axis of rotation and a sensor's z axis its
    /// direction.
    pub(super) fn frame(&self, handle: Handle, world: &World) -> Option<Isometry3<f64>> {
        let object = self.get(handle)?;
        if let Some(part) = &object.part {
            return match (self.offsets.get(&handle), object.kind, object.parent) {
                (Some(offset), Kind::Robot(robot), _) => Some(planar(world.pose(robot), 0.0) * offset),
                (_, _, Some(parent)) => Some(self.frame(parent, world)? * part.local),
                _ => Some(part.local),
            };
        }
        let kind = object.kind;
        let robot = match kind {
            Kind::Made => return None,
            Kind::Obstacle(obstacle) => {
                return Some(planar(world.obstacle_pose(obstacle)?, 0.0));
            }
            Kind::Robot(robot) | Kind::Wheel { robot, .. } | Kind::Sensor { robot, .. } => robot,
        };
        let scene = world.scene().robots.get(robot)?;
        let height = scene.wheels.iter().map(|wheel| wheel.radius).fold(0.0, f64::max);
        let body = planar(world.pose(robot), height);
        Some(match kind {
            Kind::Robot(_) if scene.frame == Frame::Static => planar(scene.start, height),
            Kind::Robot(_) | Kind::Obstacle(_) | Kind::Made => body * rotation_of(scene.frame),
            Kind::Wheel { wheel, .. } => {
                let (x, y) = scene.geometry.wheel_positions(scene.drive).nth(wheel)?;
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

/// The rotation of a robot's named object in the robot's frame.
fn rotation_of(frame: Frame) -> UnitQuaternion<f64> {
    match frame {
        Frame::Ahead | Frame::Static => UnitQuaternion::identity(),
        Frame::XUp => UnitQuaternion::from_axis_angle(&Vector3::y_axis(), -FRAC_PI_2),
        Frame::XLeft => UnitQuaternion::from_axis_angle(&Vector3::z_axis(), FRAC_PI_2),
        Frame::ZAhead => UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2),
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

pub(super) fn planar(pose: Pose, height: f64) -> Isometry3<f64> {
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
        for wrong in [0, -1, 11, i64::MIN, i64::MAX] {
            assert!(objects.get(wrong).is_none());
        }
    }

    #[test]
    fn objects_are_also_found_by_paths_of_the_users_own() {
        let mut scene = world().scene().clone();
        let path = |part: &str, path: &str| (part.to_owned(), vec![path.to_owned()]);
        scene.robots[1].objects = [path("b", "/P3DX"), path("l", "/P3DX/left")].into();
        let objects = Objects::of(&scene);
        assert_eq!((objects.find("/P3DX", None, 0), objects.find("/P3DX", None, 1)), (Some(6), None));
        // A wheel and a sensor share the name.
        let found: Vec<_> = (0..3).map(|index| objects.find("/P3DX/left", None, index)).collect();
        assert_eq!(found, [Some(7), Some(10), None]);
        assert_eq!(objects.find("/b", None, 0), Some(6));
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
    fn named_objects_have_the_frame_of_the_scene() {
        let axes = |frame| {
            let mut scene = world().scene().clone();
            scene.robots[0].frame = frame;
            let mut world = World::new(scene).unwrap();
            world.set_target(0, 1, 5.0);
            (0..20).for_each(|_| world.step());
            let ahead = planar(world.pose(0), 0.0).rotation;
            let object = Objects::of(world.scene()).frame(1, &world).unwrap().rotation;
            [Vector3::x(), Vector3::z()].map(|axis| {
                let axis = ahead.inverse() * (object * axis);
                [axis.x, axis.y, axis.z].map(|part| (part * 1e9).round() / 1e9 + 0.0)
            })
        };
        let (ahead, left, up) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        assert_eq!(axes(Frame::Ahead), [ahead, up]);
        assert_eq!(axes(Frame::XUp), [up, [-1.0, 0.0, 0.0]]);
        assert_eq!(axes(Frame::XLeft), [left, up]);
        assert_eq!(axes(Frame::ZAhead), [[0.0, 0.0, -1.0], ahead]);
        assert_ne!(axes(Frame::Static), [ahead, up], "it has not turned");
    }

    #[test]
    fn sensors_look_along_their_z_axis() {
        let world = world();
        let objects = Objects::of(world.scene());
        let direction = objects.frame(9, &world).unwrap() * Vector3::z();
        assert!((direction - Vector3::y()).norm() < 1e-12, "{direction}");
    }
}
