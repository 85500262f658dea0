//! The calls of `sim` on objects; calls about time and stepping are in `session`.

use std::collections::BTreeMap;

use ciborium::Value;
use nalgebra::{Isometry3, Point3, Vector3};
use pydslrep_scene::Mount;

use super::arguments::{self, Arguments, Outcome};
use super::building;
use super::info;
use super::objects::{Handle, Kind, Object, Objects};
use super::sight;
use crate::{Sightings, World};

/// The state that calls read and change.
pub(super) struct CallContext<'a> {
    pub(super) world: &'a mut World,
    pub(super) objects: &'a mut Objects,
    /// True if the simulation was started: it is running or paused.
    pub(super) started: bool,
    /// The text of the main script, if there is one.
    pub(super) main_script: &'a mut Option<String>,
    pub(super) drivers: &'a mut Drivers,
    /// The calling connection.
    pub(super) connection: u64,
    pub(super) seen: &'a mut Sightings,
    /// The step of the physics engine, seconds.
    pub(super) physics_step: f64,
}

/// The connection that set the rate of each wheel last, by robot and wheel.
pub(super) type Drivers = BTreeMap<(usize, usize), u64>;

/// The wheel joint of a call.
#[derive(Debug, Clone, Copy)]
pub(super) struct WheelJoint {
    pub(super) robot: usize,
    pub(super) wheel: usize,
    /// −1 if the joint's axis points to the right, so that its rate is the negative rolling rate; otherwise 1.
    pub(super) axis_sign: f64,
}

/// A detection of a proximity sensor, in the sensor's frame.
pub(super) struct Detected {
    /// Metres.
    pub(super) distance: f64,
    /// The nearest point.
    pub(super) point: Vector3<f64>,
    /// The detected object.
    pub(super) handle: Handle,
    /// The surface normal at that point.
    pub(super) normal: Vector3<f64>,
}

/// Handles a call by its name without `sim.`; `None` if there is no such function.
pub(super) fn call(context: &mut CallContext, function: &str, arguments: &Arguments) -> Option<Outcome> {
    if let Some(outcome) = building::call_on_created(context, function, arguments) {
        return Some(outcome);
    }
    Some(match function {
        "getObject" => context.get_object(arguments),
        "getObjectAlias" => context.get_object_alias(arguments),
        "getObjectParent" => context.get_object_parent(arguments),
        "getObjectChild" => context.get_object_child(arguments),
        "getObjectType" => context.get_object_type(arguments),
        "isHandle" => context.is_handle(arguments),
        "getObjectPosition" => context.frame(arguments).map(|frame| vec![arguments::position(&frame)]),
        "getObjectOrientation" => context.frame(arguments).map(|frame| vec![arguments::euler_angles(&frame)]),
        "getObjectPose" => context.frame(arguments).map(|frame| vec![arguments::pose(&frame)]),
        "getObjectMatrix" => context.frame(arguments).map(|frame| vec![arguments::matrix(&frame)]),
        "getObjectQuaternion" => context.frame(arguments).map(|frame| vec![arguments::quaternion(&frame)]),
        "getObjectUid" => context.object(arguments).map(|(handle, _)| vec![handle.into()]),
        "getObjectVelocity" => context.get_object_velocity(arguments),
        "getJointPosition" => context.read_joint(arguments, World::angle),
        "getJointVelocity" => context.read_joint(arguments, World::rate),
        "getJointTargetVelocity" => context.read_joint(arguments, World::target),
        "setJointTargetVelocity" => context.set_joint_target_velocity(arguments),
        "getJointMode" => {
            context.joint(arguments).map(|_| vec![info::JOINT_MODE_DYNAMIC.into(), Value::from(0)])
        }
        "getObjectInt32Param" => context.get_object_int_param(arguments),
        "setObjectInt32Param" => context.set_object_int_param(arguments),
        "getObjectFloatParam" => context.get_object_float_param(arguments),
        "getFloatProperty" => context.property(arguments, "volume_range", |mount| mount.range.into()),
        // The opening angles of the cone and of the gap inside it.
        "getFloatArrayProperty" => {
            context.property(arguments, "volume_angle", |mount| arguments::list([mount.cone, 0.0]))
        }
        "readProximitySensor" => context.read_proximity_sensor(arguments),
        "handleProximitySensor" => context.handle_proximity_sensor(arguments),
        "getInt32Param" => parameter(arguments, info::PARAM_PROGRAM_VERSION, info::PROGRAM_VERSION.into()),
        "getFloatParam" if arguments.integer(0) == Ok(info::PARAM_PHYSICS_STEP) => {
            Ok(vec![context.physics_step.into()])
        }
        "getFloatParam" => parameter(arguments, info::PARAM_TIME_STEP, context.world.step_length().into()),
        "getBoolParam" => parameter(arguments, info::PARAM_REAL_TIME, true.into()),
        "getSimulationTimeStep" => Ok(vec![context.world.step_length().into()]),
        "getSimulationTime" => Ok(vec![context.world.time().into()]),
        // The pace of the clock is an option of the simulator, and there is no log window.
        "setBoolParam" => arguments.integer(0).and_then(|_| arguments.truth(1)).map(|_| vec![]),
        "addLog" => arguments.integer(0).map(|_| vec![]),
        _ => return building::call(context, function, arguments),
    })
}

/// What a proximity sensor that detects nothing returns: a state, distance, point, handle, surface normal.
pub(super) fn undetected(state: i64) -> Vec<Value> {
    let nothing = || arguments::list([0.0; 3]);
    vec![state.into(), Value::from(0.0), nothing(), Value::from(-1), nothing()]
}

/// The only readable parameter of a kind.
fn parameter(arguments: &Arguments, known: i64, value: Value) -> Outcome {
    if arguments.integer(0)? == known {
        return Ok(vec![value]);
    }
    Err(arguments.failure(316, "invalid parameter."))
}

impl CallContext<'_> {
    fn get_object(&self, arguments: &Arguments) -> Outcome {
        let path = arguments.text(0)?;
        let index = arguments.option(1, "index").and_then(arguments::integer).unwrap_or(0);
        let proxy = arguments.option(1, "proxy").and_then(arguments::integer);
        let found = usize::try_from(index).ok().and_then(|index| self.objects.find(path, proxy, index));
        let tolerant = arguments.option(1, "noError").and_then(Value::as_bool).unwrap_or(false);
        match found {
            Some(handle) => Ok(vec![handle.into()]),
            None if tolerant => Ok(vec![Value::from(-1)]),
            None => Err(arguments.failure(1308, "object does not exist, or alias/path is ill formatted.")),
        }
    }

    /// The object named by the first argument.
    pub(super) fn object(&self, arguments: &Arguments) -> Result<(Handle, Kind), arguments::Failure> {
        let handle = arguments.integer(0)?;
        match self.objects.get(handle) {
            Some(object) => Ok((handle, object.kind)),
            None => Err(arguments.failure(316, "object does not exist.")),
        }
    }

    fn get_object_alias(&self, arguments: &Arguments) -> Outcome {
        let (handle, _) = self.object(arguments)?;
        let alias = match arguments.integer_or(1, -1)? {
            1 | 2 => self.objects.path(handle).unwrap_or_default(),
            _ => self.objects.alias(handle),
        };
        Ok(vec![alias.into()])
    }

    fn get_object_parent(&self, arguments: &Arguments) -> Outcome {
        let (handle, _) = self.object(arguments)?;
        let parent = self.objects.get(handle).and_then(|object| object.parent);
        Ok(vec![parent.unwrap_or(-1).into()])
    }

    fn get_object_child(&self, arguments: &Arguments) -> Outcome {
        let (parent, _) = self.object(arguments)?;
        let index = usize::try_from(arguments.integer(1)?).map_err(|_| arguments.wrong_type())?;
        let mut children = self.objects.iter().filter(|(_, object)| object.parent == Some(parent));
        Ok(vec![children.nth(index).map_or(-1, |(handle, _)| handle).into()])
    }

    fn get_object_type(&self, arguments: &Arguments) -> Outcome {
        let (handle, _) = self.object(arguments)?;
        let number = self.objects.get(handle).map_or(-1, Object::type_number);
        Ok(vec![number.into()])
    }

    fn is_handle(&self, arguments: &Arguments) -> Outcome {
        Ok(vec![self.objects.get(arguments.integer(0)?).is_some().into()])
    }

    /// The frame of the first argument's object, relative to the second argument's (default: the world).
    fn frame(&self, arguments: &Arguments) -> Result<Isometry3<f64>, arguments::Failure> {
        let (handle, _) = self.object(arguments)?;
        let base = arguments.integer_or(1, info::HANDLE_WORLD)?;
        self.frame_of(handle, base).ok_or_else(|| arguments.failure(316, "object does not exist."))
    }

    /// The frame of an object relative to another one or to a special handle.
    pub(super) fn frame_of(&self, handle: Handle, base: Handle) -> Option<Isometry3<f64>> {
        let own = self.objects.frame(handle, self.world)?;
        let base = match base {
            info::HANDLE_WORLD | info::HANDLE_SCENE => None,
            info::HANDLE_PARENT => self.objects.get(handle)?.parent,
            base => Some(base),
        };
        match base {
            Some(base) => Some(self.objects.frame(base, self.world)?.inv_mul(&own)),
            None => Some(own),
        }
    }

    /// Linear and angular velocity in the world, m/s and rad/s.
    fn get_object_velocity(&self, arguments: &Arguments) -> Outcome {
        let (_, kind) = self.object(arguments)?;
        let velocity = match kind {
            Kind::Robot(robot) => self.velocity_of(robot),
            Kind::Obstacle(_) | Kind::Made => [Vector3::zeros(); 2],
            _ => return Err(arguments.failure(316, "object is not a shape.")),
        };
        Ok(velocity.map(arguments::vector).into())
    }

    /// Linear and angular velocity of a robot in the world, m/s and rad/s.
    pub(super) fn velocity_of(&self, robot: usize) -> [Vector3<f64>; 2] {
        let (twist, (sin, cos)) = (self.world.twist(robot), self.world.pose(robot).theta.sin_cos());
        let linear = Vector3::new(twist.vx * cos - twist.vy * sin, twist.vx * sin + twist.vy * cos, 0.0);
        [linear, Vector3::new(0.0, 0.0, twist.omega)]
    }

    /// A joint of any kind, as the first argument.
    pub(super) fn joint_object(&self, arguments: &Arguments) -> Result<Handle, arguments::Failure> {
        self.object_of_type(arguments, info::TYPE_JOINT, "object is not a joint.")
    }

    fn object_of_type(
        &self,
        arguments: &Arguments,
        number: i64,
        otherwise: &str,
    ) -> Result<Handle, arguments::Failure> {
        let (handle, _) = self.object(arguments)?;
        let is_one = self.objects.get(handle).map(Object::type_number) == Some(number);
        if is_one { Ok(handle) } else { Err(arguments.failure(316, otherwise)) }
    }

    pub(super) fn joint(&self, arguments: &Arguments) -> Result<WheelJoint, arguments::Failure> {
        let (handle, _) = self.object(arguments)?;
        self.joint_of(handle).ok_or_else(|| arguments.failure(316, "object is not a joint."))
    }

    /// The joint with this handle, if any.
    pub(super) fn joint_of(&self, handle: Handle) -> Option<WheelJoint> {
        let Kind::Wheel { robot, wheel } = self.objects.get(handle)?.kind else { return None };
        let parts = self.world.scene().robots.get(robot).and_then(|robot| robot.wheels.get(wheel));
        let axis_sign = if parts.is_some_and(|wheel| wheel.mirrored) { -1.0 } else { 1.0 };
        Some(WheelJoint { robot, wheel, axis_sign })
    }

    /// Sets the target rate of a joint about its own axis, rad/s.
    pub(super) fn set_rate(&mut self, joint: WheelJoint, rate: f64) {
        self.world.set_target(joint.robot, joint.wheel, joint.axis_sign * rate);
        self.drivers.insert((joint.robot, joint.wheel), self.connection);
    }

    /// A rate or angle of a wheel about its joint's own axis.
    fn read_joint(&self, arguments: &Arguments, read: fn(&World, usize, usize) -> f64) -> Outcome {
        let WheelJoint { robot, wheel, axis_sign } = self.joint(arguments)?;
        Ok(vec![(axis_sign * read(self.world, robot, wheel)).into()])
    }

    fn set_joint_target_velocity(&mut self, arguments: &Arguments) -> Outcome {
        let joint = self.joint(arguments)?;
        self.set_rate(joint, arguments.number(1)?);
        Ok(vec![Value::from(1)])
    }

    fn get_object_int_param(&self, arguments: &Arguments) -> Outcome {
        let ((handle, kind), parameter) = (self.object(arguments)?, arguments.integer(1)?);
        let value = match (parameter, self.joint_of(handle), kind) {
            (info::PARAM_CONTROL_MODE, Some(WheelJoint { robot, wheel, .. }), _) => {
                let is_controlled = self.world.is_controlled(robot, wheel);
                if is_controlled { info::CONTROL_VELOCITY } else { info::CONTROL_FREE }
            }
            // Robots move, and robots and obstacles collide.
            (info::PARAM_STATIC, _, Kind::Robot(_)) => 0,
            (info::PARAM_STATIC, _, Kind::Obstacle(_))
            | (info::PARAM_RESPONDABLE, _, Kind::Robot(_) | Kind::Obstacle(_)) => 1,
            _ => return Ok(vec![]),
        };
        Ok(vec![value.into()])
    }

    fn set_object_int_param(&mut self, arguments: &Arguments) -> Outcome {
        let (handle, parameter, value) =
            (self.object(arguments)?.0, arguments.integer(1)?, arguments.integer(2)?);
        let Some(WheelJoint { robot, wheel, .. }) =
            self.joint_of(handle).filter(|_| parameter == info::PARAM_CONTROL_MODE)
        else {
            return Err(arguments.failure(316, "could not set parameter."));
        };
        self.world.set_controlled(robot, wheel, value == info::CONTROL_VELOCITY);
        Ok(vec![Value::from(1)])
    }

    fn get_object_float_param(&self, arguments: &Arguments) -> Outcome {
        let (handle, parameter) = (self.object(arguments)?.0, arguments.integer(1)?);
        if self.joint_of(handle).is_none() || parameter != info::PARAM_VELOCITY {
            return Ok(vec![]);
        }
        self.read_joint(arguments, World::rate)
    }

    /// The only property of a kind that a proximity sensor has.
    fn property(&self, arguments: &Arguments, known: &str, value: fn(Mount) -> Value) -> Outcome {
        let mount = self.mount(arguments)?;
        if arguments.text(1)? == known {
            return Ok(vec![value(mount)]);
        }
        Err(arguments.failure(316, "unknown property."))
    }

    fn mount(&self, arguments: &Arguments) -> Result<Mount, arguments::Failure> {
        let unknown = || arguments.failure(316, "unknown property.");
        let Kind::Sensor { robot, sensor } = self.object(arguments)?.1 else { return Err(unknown()) };
        let robot = self.world.scene().robots.get(robot).ok_or_else(unknown)?;
        robot.sensors.get(sensor).map(|sensor| sensor.mount).ok_or_else(unknown)
    }

    /// A proximity sensor of any kind, as the first argument.
    pub(super) fn sensor(&self, arguments: &Arguments) -> Result<Handle, arguments::Failure> {
        self.object_of_type(arguments, info::TYPE_SENSOR, "object is not a proximity sensor.")
    }

    /// State, distance, point, handle of the detected object, surface normal.
    fn read_proximity_sensor(&mut self, arguments: &Arguments) -> Outcome {
        let handle = self.sensor(arguments)?;
        let Some(seen) = self.detected(handle) else {
            return Ok(undetected(if self.has_handled_sensors() { 0 } else { -1 }));
        };
        let (point, normal) = (arguments::vector(seen.point), arguments::vector(seen.normal));
        Ok(vec![Value::from(1), seen.distance.into(), point, seen.handle.into(), normal])
    }

    /// The current detection of a proximity sensor; `None` before the first step.
    pub(super) fn detected(&mut self, handle: Handle) -> Option<Detected> {
        let Kind::Sensor { robot, sensor } = self.objects.get(handle)?.kind else { return None };
        if !self.has_handled_sensors() {
            return None;
        }
        let frame = self.objects.frame(handle, self.world)?;
        let seen = self.world.sight(robot, sensor);
        if let Some((floor, seen)) = self.floor_before(handle, seen.map(|seen| seen.distance)) {
            return Some(Detected {
                distance: seen.distance,
                point: frame.inverse_transform_point(&seen.point).coords,
                handle: floor,
                normal: frame.inverse_transform_vector(&seen.normal),
            });
        }
        let seen = seen?;
        // Objects on the floor are as high as the sensor.
        let point = Point3::new(seen.point.0, seen.point.1, frame.translation.z);
        let way = frame.inverse_transform_point(&point).coords;
        self.seen.add(robot, seen.point);
        Some(Detected {
            distance: seen.distance,
            // Scaled to the measured distance.
            point: way.try_normalize(f64::MIN_POSITIVE).map_or(way, |way| way * seen.distance),
            handle: self.objects.handle_of(seen.object).unwrap_or(-1),
            normal: frame.inverse_transform_vector(&Vector3::new(seen.normal.0, seen.normal.1, 0.0)),
        })
    }

    /// The floor that a sensor sees, if it is nearer than anything else.
    fn floor_before(&self, sensor: Handle, other: Option<f64>) -> Option<(Handle, sight::Seen)> {
        sight::nearest_floor(self.objects, self.world, sensor)
            .filter(|(_, floor)| other.is_none_or(|distance| floor.distance < distance))
    }

    /// Returns whether sensors have been evaluated since the start: the first step does it.
    pub(super) fn has_handled_sensors(&self) -> bool {
        self.started && self.world.steps() > 0
    }

    fn handle_proximity_sensor(&self, arguments: &Arguments) -> Outcome {
        self.sensor(arguments)?;
        Err(arguments.failure(316, "object not tagged for explicit handling."))
    }
}
