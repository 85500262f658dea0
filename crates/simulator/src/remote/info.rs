//! The description of `sim` for `zmqRemoteApi.info`: its functions and constants.

use ciborium::Value;

/// The constants that scripts use, with the engine's values.
const CONSTANTS: &[(&str, i64)] = &[
    ("handle_world", HANDLE_WORLD),
    ("handle_all", HANDLE_ALL),
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
    ("proximitysensor_ray_subtype", SENSOR_RAY),
    ("proximitysensor_cone_subtype", 33),
    ("scripttype_mainscript", MAIN_SCRIPT_TYPE),
    ("scriptstringparam_text", SCRIPT_TEXT),
    ("object_dummy_type", TYPE_DUMMY),
    ("object_forcesensor_type", TYPE_FORCE_SENSOR),
    ("joint_revolute_subtype", JOINT_REVOLUTE),
    ("joint_prismatic_subtype", JOINT_PRISMATIC),
    ("joint_spherical_subtype", 12),
    ("jointmode_kinematic", 0),
    ("jointmode_dependent", 4),
    ("jointdynctrl_force", 1),
    ("jointdynctrl_spring", 12),
    ("jointdynctrl_callback", 16),
    ("primitiveshape_plane", 1),
    ("primitiveshape_disc", 2),
    ("primitiveshape_cuboid", PRIMITIVE_CUBOID),
    ("primitiveshape_spheroid", PRIMITIVE_SPHERE),
    ("primitiveshape_cylinder", PRIMITIVE_CYLINDER),
    ("primitiveshape_cone", 6),
    ("shapeintparam_static", PARAM_STATIC),
    ("shapeintparam_respondable", PARAM_RESPONDABLE),
    ("shapeintparam_respondable_mask", PARAM_RESPONDABLE_MASK),
    ("shapefloatparam_mass", PARAM_MASS),
    ("objfloatparam_objbbox_min_x", PARAM_BOX),
    ("objfloatparam_objbbox_min_y", PARAM_BOX + 1),
    ("objfloatparam_objbbox_min_z", PARAM_BOX + 2),
    ("objfloatparam_objbbox_max_x", PARAM_BOX + 3),
    ("objfloatparam_objbbox_max_y", PARAM_BOX + 4),
    ("objfloatparam_objbbox_max_z", PARAM_BOX + 5),
    ("objectspecialproperty_collidable", 1),
    ("objectspecialproperty_measurable", 2),
    ("objectspecialproperty_detectable", SPECIAL_DETECTABLE),
    ("bullet_body_friction", 6003),
    ("bullet_body_oldfriction", BULLET_OLD_FRICTION),
    ("ode_body_friction", 15001),
    ("vortex_body_primlinearaxisfriction", 24001),
    ("newton_body_staticfriction", 33001),
    ("newton_body_kineticfriction", 33002),
    ("mujoco_body_friction1", 43001),
    ("floatparam_physicstimestep", PARAM_PHYSICS_STEP),
    ("object_camera_type", 3),
    ("scripttype_childscript", 1),
    ("scripttype_customizationscript", 6),
    ("handle_self", -4),
    ("handle_tree", -6),
    ("jointmode_ik", 2),
    ("jointmode_force", JOINT_MODE_DYNAMIC),
    ("proximitysensor_pyramid_subtype", 30),
    ("proximitysensor_disc_subtype", 32),
    ("objintparam_visibility_layer", 10),
];

pub(super) const HANDLE_ALL: i64 = -2;
pub(super) const HANDLE_WORLD: i64 = -1;
pub(super) const HANDLE_PARENT: i64 = -11;
pub(super) const HANDLE_SCENE: i64 = -12;
pub(super) const TYPE_SHAPE: i64 = 0;
pub(super) const TYPE_JOINT: i64 = 1;
pub(super) const TYPE_SENSOR: i64 = 5;
pub(super) const TYPE_DUMMY: i64 = 4;
pub(super) const TYPE_FORCE_SENSOR: i64 = 12;
pub(super) const JOINT_REVOLUTE: i64 = 10;
pub(super) const JOINT_PRISMATIC: i64 = 11;
pub(super) const SENSOR_RAY: i64 = 34;
pub(super) const PRIMITIVE_CUBOID: i64 = 3;
pub(super) const PRIMITIVE_SPHERE: i64 = 4;
pub(super) const PRIMITIVE_CYLINDER: i64 = 5;
/// The first of six coordinates of a bounding box.
pub(super) const PARAM_BOX: i64 = 15;
pub(super) const PARAM_STATIC: i64 = 3003;
pub(super) const PARAM_RESPONDABLE: i64 = 3004;
pub(super) const PARAM_MASS: i64 = 3005;
pub(super) const PARAM_RESPONDABLE_MASK: i64 = 3019;
/// Collidable, measurable, detectable, renderable.
pub(super) const SPECIAL_ALL: i64 = 0x3f3;
/// Detectable by any kind of sensor.
pub(super) const SPECIAL_DETECTABLE: i64 = 0x1f0;
pub(super) const MAIN_SCRIPT_TYPE: i64 = 0;
pub(super) const BULLET_OLD_FRICTION: i64 = 6002;
pub(super) const JOINT_MODE_DYNAMIC: i64 = 5;
pub(super) const PARAM_CONTROL_MODE: i64 = 2039;
pub(super) const CONTROL_FREE: i64 = 0;
pub(super) const CONTROL_VELOCITY: i64 = 4;
pub(super) const PARAM_VELOCITY: i64 = 2012;
pub(super) const PARAM_PROGRAM_VERSION: i64 = 1;
pub(super) const PARAM_TIME_STEP: i64 = 1;
pub(super) const PARAM_PHYSICS_STEP: i64 = 5;
pub(super) const SCRIPT_TEXT: i64 = 2;
pub(super) const PARAM_REAL_TIME: i64 = 25;

/// The emulated engine version (4.6.0), in the format of `sim.intparam_program_version`.
pub(super) const PROGRAM_VERSION: i64 = 40600;

/// The supported functions of `sim`.
pub(super) const FUNCTIONS: &[&str] = &[
    "addLog",
    "addScript",
    "checkProximitySensor",
    "createDummy",
    "createForceSensor",
    "createJoint",
    "createPrimitiveShape",
    "createProximitySensor",
    "createShape",
    "getBoolParam",
    "getEngineFloatParam",
    "getFloatArrayProperty",
    "getFloatParam",
    "getFloatProperty",
    "getInt32Param",
    "getJointForce",
    "getJointInterval",
    "getJointMode",
    "getJointPosition",
    "getJointTargetForce",
    "getJointTargetVelocity",
    "getJointType",
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
    "getObjectQuaternion",
    "getObjectSpecialProperty",
    "getObjectType",
    "getObjectUid",
    "getObjectVelocity",
    "getObjectsInTree",
    "getScript",
    "getScriptStringParam",
    "getShapeGeomInfo",
    "getShapeMass",
    "getShapeMesh",
    "getSimulationState",
    "getSimulationTime",
    "getSimulationTimeStep",
    "handleProximitySensor",
    "isHandle",
    "pauseSimulation",
    "readCustomDataBlock",
    "readCustomDataBlockTags",
    "readProximitySensor",
    "removeObjects",
    "removeScript",
    "setBoolParam",
    "setEngineFloatParam",
    "setFloatParam",
    "setJointMode",
    "setJointTargetForce",
    "setJointTargetVelocity",
    "setObjectAlias",
    "setObjectFloatParam",
    "setObjectInt32Param",
    "setObjectMatrix",
    "setObjectParent",
    "setObjectPose",
    "setObjectPosition",
    "setObjectSpecialProperty",
    "setScriptStringParam",
    "setShapeMass",
    "setStepping",
    "startSimulation",
    "step",
    "stopSimulation",
    "writeCustomDataBlock",
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
