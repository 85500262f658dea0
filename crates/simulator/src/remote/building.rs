//! The calls that create objects, and that read and change those which clients have created.

use std::f64::consts::{PI, TAU};

use ciborium::Value;
use nalgebra::{Isometry3, Matrix3, Quaternion, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::arguments::{self, Arguments, Failure, Outcome};
use super::calls::{CallContext, undetected};
use super::info;
use super::objects::{Handle, Kind, Object};
use super::parts::{Form, JointPart, PartKind, SensorPart, ShapePart};
use super::sight;

/// The maximum length of an alias or the name of custom data.
const MAX_NAME: usize = 200;

/// The maximum length of the custom data of one name, and how many there may be of one object.
const MAX_DATA: usize = 64 << 10;
const MAX_TAGS: usize = 8;

/// The maximum number of corners and of triangles of a shape.
const MAX_CORNERS: usize = 10_000;

/// The maximum length of a list that has a length of its own.
const MAX_NUMBERS: usize = 100;

/// The maximum number of parameters of physics engines that an object has.
const MAX_ENGINE_PARAMETERS: usize = 50;

/// The range of sizes, metres; as in the engine, others are limited to it.
const SIZES: (f64, f64) = (1e-5, 1e5);

/// Nothing is further away than this, metres.
const FAR: f64 = 1e6;

/// The torque of a new motor, N·m.
const FIRST_TORQUE: f64 = 2.5;

/// The handle of the main script, which is no object.
const MAIN_SCRIPT: i64 = 1_000_000;

/// The text of the main script of a new scene.
pub(super) const DEFAULT_MAIN_SCRIPT: &str = "require('defaultMainScript')";

/// Handles a call by its name without `sim.`, whatever its object; `None` if there is no such function.
pub(super) fn call(context: &mut CallContext, function: &str, arguments: &Arguments) -> Option<Outcome> {
    Some(match function {
        "createPrimitiveShape" => create_primitive_shape(context, arguments),
        "createShape" => create_shape(context, arguments),
        "createJoint" => create_joint(context, arguments),
        "createProximitySensor" => create_proximity_sensor(context, arguments),
        "createForceSensor" => create(context, arguments, PartKind::ForceSensor),
        "createDummy" => create(context, arguments, PartKind::Dummy),
        "removeObjects" => remove_objects(context, arguments),
        "getObjectsInTree" => objects_in_tree(context, arguments),
        "setObjectAlias" => set_object_alias(context, arguments),
        "setObjectParent" => set_object_parent(context, arguments),
        "setObjectMatrix" => place(context, arguments, matrix),
        "setObjectPose" => place(context, arguments, pose),
        "setObjectPosition" => set_object_position(context, arguments),
        "getScript" => script(context, arguments),
        "addScript" => add_script(context, arguments),
        "removeScript" => remove_script(context, arguments),
        "getScriptStringParam" => script_text(context, arguments),
        "setScriptStringParam" => set_script_text(context, arguments),
        "readCustomDataBlock" => context.object(arguments).map(|_| vec![Value::from("")]),
        "readCustomDataBlockTags" => context.object(arguments).map(|_| vec![Value::Array(vec![])]),
        // Forces are not simulated; the engine has none while the simulation is stopped.
        "getJointForce" => context.joint_object(arguments).map(|_| vec![]),
        "getJointInterval" => context.joint_object(arguments).map(|_| interval()),
        "checkProximitySensor" => sight::check(context, arguments),
        "getJointType" => context.joint(arguments).map(|_| vec![info::JOINT_REVOLUTE.into()]),
        // The motors of a program's robots reach their rates whatever it takes.
        "getJointTargetForce" => context.joint(arguments).map(|_| vec![Value::from(100.0)]),
        "setEngineFloatParam" | "getEngineFloatParam" => Err(unfit(context, arguments, 1, info::TYPE_SHAPE)),
        "setJointTargetForce" | "setJointMode" => Err(unfit(context, arguments, 0, info::TYPE_JOINT)),
        "writeCustomDataBlock"
        | "setObjectSpecialProperty"
        | "setObjectFloatParam"
        | "setShapeMass"
        | "getShapeMass"
        | "getShapeGeomInfo"
        | "getShapeMesh" => Err(unfit(context, arguments, 0, info::TYPE_SHAPE)),
        "getObjectSpecialProperty" => context.object(arguments).map(|(handle, _)| {
            let is_shape = type_of(context, handle) == Some(info::TYPE_SHAPE);
            vec![Value::from(if is_shape { info::SPECIAL_ALL } else { 0 })]
        }),
        _ => return None,
    })
}

/// Handles a call on an object that a client has created, if it differs there.
pub(super) fn call_on_created(
    context: &mut CallContext,
    function: &str,
    arguments: &Arguments,
) -> Option<Outcome> {
    // The parameters of engines come before their objects.
    let place = usize::from(["setEngineFloatParam", "getEngineFloatParam"].contains(&function));
    let handle = arguments.integer(place).ok()?;
    let kind = context.objects.part(handle)?.kind.clone();
    Some(match (function, kind) {
        ("readCustomDataBlock", _) => read_data(context, handle, arguments),
        ("writeCustomDataBlock", _) => write_data(context, handle, arguments),
        ("readCustomDataBlockTags", _) => Ok(vec![tags(context, handle)]),
        ("getObjectSpecialProperty", _) => {
            Ok(vec![context.objects.part(handle).map_or(0, |part| part.special).into()])
        }
        ("setObjectSpecialProperty", _) => set_special(context, handle, arguments),
        ("getObjectInt32Param" | "setObjectInt32Param", PartKind::Shape(shape)) => {
            shape_integer(context, handle, shape, arguments)
        }
        ("getShapeMass", PartKind::Shape(shape)) => Ok(vec![shape.mass.into()]),
        ("setShapeMass", PartKind::Shape(shape)) => arguments.number(1).map(|mass| {
            set_kind(context, handle, PartKind::Shape(ShapePart { mass: mass.max(1e-7), ..shape }));
            vec![]
        }),
        ("getShapeMesh", PartKind::Shape(shape)) => mesh(&shape.form, arguments),
        ("setEngineFloatParam", PartKind::Shape(_)) => set_engine(context, handle, arguments),
        ("setEngineFloatParam", _) => Ok(vec![Value::from(0)]),
        ("getEngineFloatParam", PartKind::Shape(shape)) => engine(context, handle, &shape.form, arguments),
        ("getObjectFloatParam", kind)
            if matches!(kind, PartKind::Shape(_)) || bound(&kind, arguments).is_some() =>
        {
            Ok(number_of(&kind, arguments))
        }
        ("getShapeGeomInfo", PartKind::Shape(shape)) => Ok(geometry_of(&shape.form)),
        ("getJointType", PartKind::Joint(joint)) => Ok(vec![joint.subtype.into()]),
        ("getJointMode", PartKind::Joint(joint)) => Ok(vec![joint.mode.into(), Value::from(0)]),
        ("getJointTargetForce", PartKind::Joint(joint)) => Ok(vec![joint.torque.into()]),
        (
            "setJointMode" | "setJointTargetForce" | "getObjectInt32Param" | "setObjectInt32Param",
            PartKind::Joint(joint),
        ) => joint_parameter(context, handle, joint, function, arguments),
        (
            "setJointTargetVelocity"
            | "getJointTargetVelocity"
            | "getJointVelocity"
            | "getJointPosition"
            | "getObjectFloatParam",
            PartKind::Joint(joint),
        ) if context.objects.role(handle).is_none() => {
            idle_joint(context, handle, joint, function, arguments)
        }
        ("readProximitySensor", PartKind::Sensor(_)) if context.objects.role(handle).is_none() => {
            Ok(undetected(-1))
        }
        ("getFloatProperty", PartKind::Sensor(sensor)) if arguments.text(1) == Ok("volume_range") => {
            Ok(vec![(sensor.offset + sensor.range).into()])
        }
        ("getFloatArrayProperty", PartKind::Sensor(sensor)) if arguments.text(1) == Ok("volume_angle") => {
            Ok(vec![arguments::list([sensor.angle, 0.0])])
        }
        _ => return None,
    })
}

fn create(context: &mut CallContext, arguments: &Arguments, kind: PartKind) -> Outcome {
    match context.objects.create(kind) {
        Some(handle) => Ok(vec![handle.into()]),
        None => Err(arguments.failure(316, "the scene has too many objects.")),
    }
}

fn create_primitive_shape(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let primitive = arguments.integer(0)?;
    if !(1..=8).contains(&primitive) {
        return Ok(vec![Value::from(-1)]);
    }
    let [x, y, z] = numbers::<3>(arguments, 1)?.map(|size| size.clamp(SIZES.0, SIZES.1));
    create(context, arguments, shape(Form::Primitive(primitive, Vector3::new(x, y, z))))
}

fn create_shape(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let coordinates = list(arguments, 2, 3 * MAX_CORNERS)?;
    let indices = list(arguments, 3, 3 * MAX_CORNERS)?;
    let corner = |index: &f64| -> Option<Vector3<f64>> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // what does not fit has no corner
        let first = 3 * (*index as usize);
        let corner = coordinates.get(first..first.checked_add(3)?)?;
        Some(Vector3::new(corner[0], corner[1], corner[2]))
    };
    let triangles: Option<Vec<[Vector3<f64>; 3]>> = indices
        .chunks_exact(3)
        .map(|indices| Some([corner(&indices[0])?, corner(&indices[1])?, corner(&indices[2])?]))
        .collect();
    let triangles =
        triangles.filter(|triangles| !triangles.is_empty()).ok_or_else(|| arguments.wrong_type())?;
    create(context, arguments, shape(Form::Mesh(triangles)))
}

fn shape(form: Form) -> PartKind {
    let mass = form.mass();
    PartKind::Shape(ShapePart { form, is_static: true, is_respondable: false, mask: 0xffff, mass })
}

fn create_joint(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let (subtype, mode) = (arguments.integer(0)?, arguments.integer(1)?);
    let joint = JointPart { subtype, mode, control: info::CONTROL_FREE, torque: FIRST_TORQUE, target: 0.0 };
    create(context, arguments, PartKind::Joint(joint))
}

fn create_proximity_sensor(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let subtype = arguments.integer(0)?;
    numbers::<8>(arguments, 3)?;
    let volume = numbers::<15>(arguments, 4)?;
    let (offset, range, angle) = (volume[0].max(0.0), volume[1].max(0.0), volume[9]);
    let angle = angle.clamp(0.0, PI);
    let sensor = SensorPart { subtype, offset, range, angle, size: volume[12].max(0.0) };
    create(context, arguments, PartKind::Sensor(sensor))
}

fn remove_objects(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let handles = arguments.get(0).and_then(Value::as_array).ok_or_else(|| arguments.wrong_type())?;
    let handles: Option<Vec<Handle>> = handles.iter().map(arguments::integer).collect();
    let handles = handles.ok_or_else(|| arguments.wrong_type())?;
    let is_own =
        |handle: &Handle| context.objects.get(*handle).is_some() && context.objects.part(*handle).is_none();
    if handles.iter().any(is_own) {
        return Err(arguments.failure(316, "object belongs to the program."));
    }
    for handle in handles {
        context.objects.remove(handle);
    }
    Ok(vec![])
}

fn objects_in_tree(context: &CallContext, arguments: &Arguments) -> Outcome {
    let (base, kind, options) =
        (arguments.integer(0)?, arguments.integer_or(1, info::HANDLE_ALL)?, arguments.integer_or(2, 0)?);
    let (without_base, children_only) = (options & 1 != 0, options & 2 != 0);
    let objects = &*context.objects;
    let root = (base != info::HANDLE_SCENE).then_some(base);
    if root.is_some_and(|root| objects.get(root).is_none()) {
        return Err(arguments.failure(316, "object does not exist."));
    }
    let is_wanted = |handle: &Handle| {
        (kind == info::HANDLE_ALL || type_of(context, *handle) == Some(kind))
            && !(without_base && Some(*handle) == root)
    };
    let found = objects.tree(root, !children_only).into_iter().filter(is_wanted).map(Value::from).collect();
    Ok(vec![Value::Array(found)])
}

/// The created object of the first argument.
fn made(context: &CallContext, arguments: &Arguments) -> Result<Handle, Failure> {
    let (handle, _) = context.object(arguments)?;
    match context.objects.part(handle) {
        Some(_) => Ok(handle),
        None => Err(arguments.failure(316, "object belongs to the program.")),
    }
}

fn set_object_alias(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let handle = made(context, arguments)?;
    let alias = arguments.text(1)?;
    let is_valid = |byte: u8| byte == b'_' || byte.is_ascii_alphanumeric();
    let alias = alias.bytes().take(MAX_NAME).map(|byte| if is_valid(byte) { char::from(byte) } else { '_' });
    let alias: String = alias.collect();
    context.objects.rename(handle, if alias.is_empty() { "_".to_owned() } else { alias });
    Ok(vec![])
}

fn set_object_parent(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let handle = made(context, arguments)?;
    let parent = Some(arguments.integer(1)?).filter(|parent| *parent >= 0);
    if parent.is_some_and(|parent| context.objects.part(parent).is_none()) {
        return Err(arguments.failure(316, "parent does not exist, or belongs to the program."));
    }
    let stays = arguments.get(2).is_none() || arguments.truth(2)?;
    if parent.is_some_and(|parent| parent == handle || context.objects.ancestors(parent).contains(&handle)) {
        return Err(arguments.failure(316, "object is ancestor of desired parent."));
    }
    if context.objects.set_parent(handle, parent, stays) {
        return Ok(vec![Value::from(1)]);
    }
    Err(arguments.failure(316, "the objects would be nested too deep."))
}

/// Places an object by its frame, which is relative to the third argument's object (default: the world).
fn place(
    context: &mut CallContext,
    arguments: &Arguments,
    read: fn(&Arguments) -> Result<Isometry3<f64>, Failure>,
) -> Outcome {
    let handle = made(context, arguments)?;
    let frame = read(arguments)?;
    put(context, arguments, handle, &frame)
}

fn set_object_position(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let handle = made(context, arguments)?;
    let base = arguments.integer_or(2, info::HANDLE_WORLD)?;
    let missing = || arguments.failure(316, "object does not exist.");
    let rotation = context.frame_of(handle, base).ok_or_else(missing)?.rotation;
    let frame = Isometry3::from_parts(Translation3::from(position(arguments)?), rotation);
    put(context, arguments, handle, &frame)
}

fn put(context: &mut CallContext, arguments: &Arguments, handle: Handle, frame: &Isometry3<f64>) -> Outcome {
    let missing = || arguments.failure(316, "object does not exist.");
    let parent = context.objects.get(handle).and_then(|object| object.parent);
    let frame_of = |base| context.objects.frame(base, context.world).ok_or_else(missing);
    let base = match arguments.integer_or(2, info::HANDLE_WORLD)? {
        info::HANDLE_WORLD | info::HANDLE_SCENE => None,
        info::HANDLE_PARENT => parent,
        base => Some(base),
    };
    let in_world = match base {
        Some(base) => frame_of(base)? * frame,
        None => *frame,
    };
    let local = match parent {
        Some(parent) => frame_of(parent)?.inv_mul(&in_world),
        None => in_world,
    };
    if let Some(part) = context.objects.part_mut(handle) {
        part.local = local;
    }
    Ok(vec![])
}

fn position(arguments: &Arguments) -> Result<Vector3<f64>, Failure> {
    numbers(arguments, 1).map(within_reach)
}

fn within_reach(at: [f64; 3]) -> Vector3<f64> {
    Vector3::from(at.map(|along| along.clamp(-FAR, FAR)))
}

fn pose(arguments: &Arguments) -> Result<Isometry3<f64>, Failure> {
    let [x, y, z, i, j, k, w] = numbers::<7>(arguments, 1)?;
    let rotation = UnitQuaternion::try_new(Quaternion::new(w, i, j, k), 1e-6);
    let rotation = rotation.ok_or_else(|| arguments.wrong_type())?;
    Ok(Isometry3::from_parts(Translation3::from(within_reach([x, y, z])), rotation))
}

fn matrix(arguments: &Arguments) -> Result<Isometry3<f64>, Failure> {
    let m = numbers::<12>(arguments, 1)?;
    let rotation = Matrix3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    let is_rotation =
        (rotation * rotation.transpose() - Matrix3::identity()).norm() < 1e-3 && rotation.determinant() > 0.0;
    if !is_rotation {
        return Err(arguments.wrong_type());
    }
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    Ok(Isometry3::from_parts(Translation3::from(within_reach([m[3], m[7], m[11]])), rotation))
}

fn script(context: &CallContext, arguments: &Arguments) -> Outcome {
    let is_there = arguments.integer(0)? == info::MAIN_SCRIPT_TYPE && context.main_script.is_some();
    Ok(vec![Value::from(if is_there { MAIN_SCRIPT } else { -1 })])
}

fn add_script(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    if arguments.integer(0)? != info::MAIN_SCRIPT_TYPE {
        return Err(arguments.failure(316, "invalid script type."));
    }
    *context.main_script = Some(String::new());
    Ok(vec![Value::from(MAIN_SCRIPT)])
}

fn remove_script(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    script_of(context, arguments)?;
    *context.main_script = None;
    Ok(vec![Value::from(1)])
}

fn script_text(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let text = text_of(context, arguments)?;
    Ok(vec![Value::from(text.as_str())])
}

fn set_script_text(context: &mut CallContext, arguments: &Arguments) -> Outcome {
    let new = arguments.text(2)?;
    new.clone_into(text_of(context, arguments)?);
    Ok(vec![])
}

/// The text of a script, of which it is the only parameter here.
fn text_of<'a>(context: &'a mut CallContext, arguments: &Arguments) -> Result<&'a mut String, Failure> {
    if arguments.integer(1)? != info::SCRIPT_TEXT {
        return Err(arguments.failure(316, "invalid parameter."));
    }
    script_of(context, arguments)
}

fn script_of<'a>(context: &'a mut CallContext, arguments: &Arguments) -> Result<&'a mut String, Failure> {
    let is_main = arguments.integer(0)? == MAIN_SCRIPT;
    let text = context.main_script.as_mut().filter(|_| is_main);
    text.ok_or_else(|| arguments.failure(316, "script does not exist."))
}

fn read_data(context: &CallContext, handle: Handle, arguments: &Arguments) -> Outcome {
    let name = arguments.text(1)?;
    let data = context.objects.part(handle).and_then(|part| part.data.get(name));
    Ok(vec![Value::from(data.map_or("", String::as_str))])
}

/// The names of an object's custom data.
fn tags(context: &CallContext, handle: Handle) -> Value {
    let data = context.objects.part(handle).map(|part| &part.data);
    Value::Array(
        data.into_iter().flat_map(|data| data.keys()).map(|name| Value::from(name.as_str())).collect(),
    )
}

fn write_data(context: &mut CallContext, handle: Handle, arguments: &Arguments) -> Outcome {
    let (name, text) = (arguments.text(1)?, arguments.text(2)?);
    let Some(part) = context.objects.part_mut(handle) else { return Ok(vec![]) };
    if text.is_empty() {
        part.data.remove(name);
    } else if name.len() > MAX_NAME || text.len() > MAX_DATA || part.data.len() >= MAX_TAGS {
        return Err(arguments.failure(316, "there is too much custom data."));
    } else {
        part.data.insert(name.to_owned(), text.to_owned());
    }
    Ok(vec![Value::from(1)])
}

fn set_special(context: &mut CallContext, handle: Handle, arguments: &Arguments) -> Outcome {
    let special = arguments.integer(1)?;
    if let Some(part) = context.objects.part_mut(handle) {
        part.special = special;
    }
    Ok(vec![Value::from(1)])
}

/// The number of an object's type.
fn type_of(context: &CallContext, handle: Handle) -> Option<i64> {
    context.objects.get(handle).map(Object::type_number)
}

/// Why the object of an argument cannot be read or changed: it has another type than the one that is needed, or belongs to the
/// program.
fn unfit(context: &CallContext, arguments: &Arguments, index: usize, needed: i64) -> Failure {
    let found = match arguments.integer(index) {
        Ok(handle) => type_of(context, handle),
        Err(failure) => return failure,
    };
    let reason = match found {
        None => "object does not exist.",
        Some(found) if found == needed => "object belongs to the program.",
        Some(_) if needed == info::TYPE_JOINT => "object is not a joint.",
        Some(_) => "object is not a shape.",
    };
    arguments.failure(316, reason)
}

/// Returns whether a joint is cyclic, and its range: the least angle and its width.
fn interval() -> Vec<Value> {
    vec![true.into(), arguments::list([-PI, TAU])]
}

/// Corners, the indices of the triangles, and the normals at each of their corners.
fn mesh(form: &Form, arguments: &Arguments) -> Outcome {
    let Some((corners, triangles)) = form.mesh() else {
        return Err(arguments.failure(316, "round primitives have no mesh in this simulator."));
    };
    let normals = triangles.iter().flat_map(|triangle| {
        let [a, b, c] = triangle.map(|index| corners[index]);
        let normal = (b - a).cross(&(c - a)).try_normalize(1e-12).unwrap_or_default();
        [normal; 3]
    });
    let coordinates =
        |all: Vec<Vector3<f64>>| arguments::list(all.iter().flat_map(|each| [each.x, each.y, each.z]));
    let normals = coordinates(normals.collect());
    let indices = triangles.iter().flatten().map(|index| Value::from(*index as u64)).collect();
    Ok(vec![coordinates(corners), Value::Array(indices), normals])
}

fn set_engine(context: &mut CallContext, handle: Handle, arguments: &Arguments) -> Outcome {
    let (parameter, value) = (arguments.integer(0)?, arguments.number(2)?);
    let Some(part) = context.objects.part_mut(handle) else { return Ok(vec![]) };
    if part.engine.len() >= MAX_ENGINE_PARAMETERS {
        return Err(arguments.failure(316, "there are too many parameters."));
    }
    part.engine.insert(parameter, value);
    Ok(vec![Value::from(1)])
}

fn engine(context: &CallContext, handle: Handle, form: &Form, arguments: &Arguments) -> Outcome {
    let parameter = arguments.integer(0)?;
    let set = context.objects.part(handle).and_then(|part| part.engine.get(&parameter)).copied();
    let first = (parameter == info::BULLET_OLD_FRICTION).then(|| form.friction());
    Ok(set.or(first).map(Value::from).into_iter().collect())
}

fn set_kind(context: &mut CallContext, handle: Handle, kind: PartKind) {
    if let Some(part) = context.objects.part_mut(handle) {
        part.kind = kind;
    }
}

/// Reads or changes an integer parameter of a shape.
fn shape_integer(
    context: &mut CallContext,
    handle: Handle,
    mut shape: ShapePart,
    arguments: &Arguments,
) -> Outcome {
    let parameter = arguments.integer(1)?;
    if arguments.is("sim.getObjectInt32Param") {
        let value = match parameter {
            info::PARAM_STATIC => i64::from(shape.is_static),
            info::PARAM_RESPONDABLE => i64::from(shape.is_respondable),
            info::PARAM_RESPONDABLE_MASK => shape.mask,
            _ => return Ok(vec![]),
        };
        return Ok(vec![value.into()]);
    }
    let value = arguments.integer(2)?;
    match parameter {
        info::PARAM_STATIC => shape.is_static = value != 0,
        info::PARAM_RESPONDABLE => shape.is_respondable = value != 0,
        info::PARAM_RESPONDABLE_MASK => shape.mask = value,
        _ => return Err(arguments.failure(316, "could not set parameter.")),
    }
    set_kind(context, handle, PartKind::Shape(shape));
    Ok(vec![Value::from(1)])
}

/// The mass of a shape, or a corner of an object's bounding box; nothing for other parameters.
fn number_of(kind: &PartKind, arguments: &Arguments) -> Vec<Value> {
    let value = match (kind, arguments.integer(1)) {
        (PartKind::Shape(shape), Ok(info::PARAM_MASS)) => Some(shape.mass),
        _ => bound(kind, arguments),
    };
    value.map(Value::from).into_iter().collect()
}

/// The coordinate of an object's bounding box that the second argument asks for.
fn bound(kind: &PartKind, arguments: &Arguments) -> Option<f64> {
    let place = usize::try_from(arguments.integer(1).ok()? - info::PARAM_BOX).ok()?;
    let (low, high) = kind.reported_bounds();
    [low.x, low.y, low.z, high.x, high.y, high.z].get(place).copied()
}

/// Returns the type of a shape (2: a primitive, 4: convex), the kind of primitive, and its sizes.
fn geometry_of(form: &Form) -> Vec<Value> {
    match form {
        Form::Primitive(kind, size) => {
            vec![Value::from(6), (*kind).into(), arguments::list([size.x, size.y, size.z, 0.0])]
        }
        Form::Mesh(_) => {
            let what = if form.is_convex() { 4 } else { 0 };
            vec![Value::from(what), Value::from(0), arguments::list([0.0; 4])]
        }
    }
}

fn joint_parameter(
    context: &mut CallContext,
    handle: Handle,
    mut joint: JointPart,
    function: &str,
    arguments: &Arguments,
) -> Outcome {
    let is_control = arguments.integer(1) == Ok(info::PARAM_CONTROL_MODE);
    match function {
        "setJointMode" => joint.mode = arguments.integer(1)?,
        "setJointTargetForce" => joint.torque = arguments.number(1)?,
        "getObjectInt32Param" => {
            return Ok(is_control.then(|| Value::from(joint.control)).into_iter().collect());
        }
        _ if is_control => joint.control = arguments.integer(2)?,
        _ => return Err(arguments.failure(316, "could not set parameter.")),
    }
    if let Some(Kind::Wheel { robot, wheel }) = context.objects.role(handle) {
        context.world.set_controlled(robot, wheel, joint.follows_velocity());
    }
    set_kind(context, handle, PartKind::Joint(joint));
    Ok(if function == "setObjectInt32Param" { vec![Value::from(1)] } else { vec![] })
}

/// The rates and angles of a joint that is not simulated.
fn idle_joint(
    context: &mut CallContext,
    handle: Handle,
    mut joint: JointPart,
    function: &str,
    arguments: &Arguments,
) -> Outcome {
    match function {
        "setJointTargetVelocity" => {
            joint.target = arguments.number(1)?;
            set_kind(context, handle, PartKind::Joint(joint));
            Ok(vec![Value::from(1)])
        }
        "getJointTargetVelocity" => Ok(vec![joint.target.into()]),
        "getObjectFloatParam" if arguments.integer(1)? != info::PARAM_VELOCITY => Ok(vec![]),
        _ => Ok(vec![Value::from(0.0)]),
    }
}

/// A list of exactly as many finite numbers.
fn numbers<const COUNT: usize>(arguments: &Arguments, index: usize) -> Result<[f64; COUNT], Failure> {
    list(arguments, index, MAX_NUMBERS)?
        .try_into()
        .map_err(|_| arguments.failure(316, "incorrect table size."))
}

/// A list of finite numbers.
fn list(arguments: &Arguments, index: usize, max: usize) -> Result<Vec<f64>, Failure> {
    let values = arguments.get(index).and_then(Value::as_array).filter(|values| values.len() <= max);
    let numbers: Option<Vec<f64>> =
        values.and_then(|values| values.iter().map(arguments::finite_number).collect());
    numbers.ok_or_else(|| arguments.wrong_type())
}
