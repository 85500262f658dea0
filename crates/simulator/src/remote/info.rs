//! The description of `sim` for `zmqRemoteApi.info`: its functions and constants.

use ciborium::Value;

/// The constants that scripts use, with the engine's values.
const CONSTANTS: &[(&str, i64)] = &[
    ("handle_world", HANDLE_WORLD),
    ("handle_all", -2),
    ("handle_parent", HANDLE_PARENT),
    ("handle_scene", HANDLE_SCENE),
    ("simulation_stopped", 0),
    ("simulation_paused", 8),
    ("simulation_advancing", 16),
    ("simulation_advancing_firstafterstop", 16),
    ("simulation_advancing_running", 17),
    ("simulation_advancing_lastbeforestop", 22),
    ("object_shape_type", TYPE_SHAPE),
    ("object_joint_type", TYPE_JOINT),
    ("object_proximitysensor_type", TYPE_SENSOR),
    ("jointmode_dynamic", JOINT_MODE_DYNAMIC),
    ("jointintparam_dynctrlmode", PARAM_CONTROL_MODE),
    ("jointdynctrl_free", CONTROL_FREE),
    ("jointdynctrl_velocity", CONTROL_VELOCITY),
    ("jointdynctrl_position", 8),
    ("jointfloatparam_velocity", PARAM_VELOCITY),
    ("intparam_program_version", PARAM_PROGRAM_VERSION),
    ("floatparam_simulation_time_step", PARAM_TIME_STEP),
    ("boolparam_realtime_simulation", PARAM_REAL_TIME),
    ("proximitysensor_ray_subtype", 34),
    ("proximitysensor_cone_subtype", 33),
    ("scripttype_mainscript", 0),
];

pub(super) const HANDLE_WORLD: i64 = -1;
pub(super) const HANDLE_PARENT: i64 = -11;
pub(super) const HANDLE_SCENE: i64 = -12;
pub(super) const TYPE_SHAPE: i64 = 0;
pub(super) const TYPE_JOINT: i64 = 1;
pub(super) const TYPE_SENSOR: i64 = 5;
pub(super) const JOINT_MODE_DYNAMIC: i64 = 5;
pub(super) const PARAM_CONTROL_MODE: i64 = 2039;
pub(super) const CONTROL_FREE: i64 = 0;
pub(super) const CONTROL_VELOCITY: i64 = 4;
pub(super) const PARAM_VELOCITY: i64 = 2012;
pub(super) const PARAM_PROGRAM_VERSION: i64 = 1;
pub(super) const PARAM_TIME_STEP: i64 = 1;
pub(super) const PARAM_REAL_TIME: i64 = 25;

/// The emulated engine version (4.6.0), in the format of `sim.intparam_program_version`.
pub(super) const PROGRAM_VERSION: i64 = 40600;

/// The supported functions of `sim`.
pub(super) const FUNCTIONS: &[&str] = &[
    "addLog",
    "getBoolParam",
    "getFloatArrayProperty",
    "getFloatParam",
    "getFloatProperty",
    "getInt32Param",
    "getJointMode",
    "getJointPosition",
    "getJointTargetVelocity",
    "getJointVelocity",
    "getObject",
    "getObjectAlias",
    "getObjectChild",
    "getObjectFloatParam",
    "getObjectInt32Param",
    "getObjectMatrix",
    "getObjectOrientation",
    "getObjectParent",
    "getObjectPose",
    "getObjectPosition",
    "getObjectType",
    "getObjectVelocity",
    "getSimulationState",
    "getSimulationTime",
    "getSimulationTimeStep",
    "handleProximitySensor",
    "isHandle",
    "pauseSimulation",
    "readProximitySensor",
    "setBoolParam",
    "setJointTargetVelocity",
    "setObjectInt32Param",
    "setStepping",
    "startSimulation",
    "step",
    "stopSimulation",
];

/// The info map: name → `{"func": {}}` or `{"const": value}`.
pub(super) fn info() -> Value {
    let entry = |name: &str, kind: &str, value: Value| {
        (Value::from(name), Value::Map(vec![(Value::from(kind), value)]))
    };
    let functions = FUNCTIONS.iter().map(|name| entry(name, "func", Value::Map(vec![])));
    let constants = CONSTANTS.iter().map(|&(name, value)| entry(name, "const", Value::from(value)));
    Value::Map(functions.chain(constants).collect())
}
