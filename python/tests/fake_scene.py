"""A scene of objects with the functions of CoppeliaSim that read them."""

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

# The names of the constants below without their beginnings, by their values.
SHAPE, JOINT, DUMMY, PROXIMITY_SENSOR, VISION_SENSOR, FORCE_SENSOR = 0, 1, 4, 5, 9, 12
KINEMATIC, DYNAMIC = 0, 5
FREE, VELOCITY, POSITION = 0, 4, 8
REVOLUTE, PRISMATIC = 10, 11
STOPPED, PAUSED, RUNNING = 0, 8, 17

LEVEL = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
AXLE = ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0))  # z to the left


@dataclass
class FakeObject:
    """An object of any type."""

    alias: str
    kind: int
    parent: "FakeObject | None" = None
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, in the world
    rotation: tuple[tuple[float, float, float], ...] = LEVEL
    static: bool = False
    respondable: bool = True
    mass: float = 1.0  # kg
    size: tuple[float, float, float] = (0.3, 0.2, 0.1)  # m
    joint_type: int = REVOLUTE
    mode: int = DYNAMIC
    control: int = VELOCITY
    torque: float = 5.0  # N·m
    rate: float = 0.0  # rad/s
    speed: float = 0.0  # m/s, along x of the world
    mask: int = 0xFFFF  # what it collides with
    special: int = 1  # collidable
    sees: dict[str, float] = field(default_factory=dict)  # m, by alias


@dataclass
class FakeScene:
    """All objects; their handles are their places."""

    objects: list[FakeObject]
    version: int = 40600
    state: int = STOPPED
    time_step: float = 0.05
    physics_step: float = 0.005
    times: Iterator[float] = field(default_factory=lambda: iter([0.0]))
    main_script: int = 1

    def __getitem__(self, path: str) -> FakeObject:
        """The first object with a path."""
        return next(each for each in self.objects if self.path(each) == path)

    def path(self, each: FakeObject) -> str:
        """The path of an object."""
        return (self.path(each.parent) if each.parent else "") + f"/{each.alias}"

    def add(self, **values: Any) -> FakeObject:
        """Adds an object."""
        self.objects.append(FakeObject(**values))
        return self.objects[-1]


class FakeSim:
    """The functions and constants of the simulator."""

    handle_all, handle_scene = -2, -12
    objectspecialproperty_detectable = 0x1F0
    floatparam_physicstimestep = 5
    shapeintparam_respondable_mask = 3019
    intparam_program_version = 1
    scripttype_mainscript = 0
    simulation_stopped, simulation_paused, simulation_advancing = STOPPED, PAUSED, 16
    object_shape_type, object_joint_type, object_dummy_type = SHAPE, JOINT, DUMMY
    object_proximitysensor_type = PROXIMITY_SENSOR
    object_visionsensor_type = VISION_SENSOR
    object_forcesensor_type = FORCE_SENSOR
    joint_revolute_subtype, joint_prismatic_subtype = REVOLUTE, PRISMATIC
    jointmode_kinematic, jointmode_dynamic = KINEMATIC, DYNAMIC
    jointintparam_dynctrlmode = 2039
    jointdynctrl_free, jointdynctrl_velocity, jointdynctrl_position = 0, 4, 8
    shapeintparam_static, shapeintparam_respondable = 3003, 3004
    shapefloatparam_mass = 3005
    objfloatparam_objbbox_min_x, objfloatparam_objbbox_max_x = 15, 18
    objfloatparam_objbbox_min_y, objfloatparam_objbbox_max_y = 16, 19
    objfloatparam_objbbox_min_z, objfloatparam_objbbox_max_z = 17, 20

    def __init__(self, scene: FakeScene) -> None:
        self._scene = scene
        self._time = 0.0

    def _object(self, handle: int) -> FakeObject:
        return self._scene.objects[handle]

    def _handle(self, each: FakeObject) -> int:
        return next(i for i, other in enumerate(self._scene.objects) if other is each)

    def getObject(self, path: str, options: Mapping[str, Any]) -> int:
        """A handle, or -1; other objects may be between those of a path."""
        assert options["noError"] is True
        pattern = "(/.*)?/".join(re.escape(part) for part in path.split("/"))
        matches = [
            handle
            for handle, each in enumerate(self._scene.objects)
            if re.fullmatch(pattern, self._scene.path(each))
        ]
        matches.sort(
            key=lambda handle: self._scene.path(self._object(handle)).count("/")
        )
        return dict(enumerate(matches)).get(options["index"], -1)

    def getObjectAlias(self, handle: int, options: int) -> str:
        """The full path."""
        assert options == 2
        return self._scene.path(self._object(handle))

    def getObjectType(self, handle: int) -> int:
        """The type."""
        return self._object(handle).kind

    def getObjectParent(self, handle: int) -> int:
        """The object above, or -1."""
        parent = self._object(handle).parent
        return -1 if parent is None else self._handle(parent)

    def getObjectsInTree(self, handle: int, kind: int, options: int) -> Any:
        """All objects below, or all shapes; the server sends an empty list as an empty map."""
        if handle == self.handle_scene:
            shapes = (i for i, o in enumerate(self._scene.objects) if o.kind == kind)
            return list(shapes) or {}
        assert (kind, options) == (self.handle_all, 1)

        def is_below(each: FakeObject) -> bool:
            parent = each.parent
            return parent is not None and (
                parent is self._object(handle) or is_below(parent)
            )

        return [i for i, each in enumerate(self._scene.objects) if is_below(each)] or {}

    def getObjectMatrix(self, handle: int) -> list[float]:
        """Rows of rotation and translation, after the time that has passed."""
        each = self._object(handle)
        x, y, z = each.position
        position = x + each.speed * self._time, y, z
        rows = zip(each.rotation, position, strict=True)
        return [number for row, offset in rows for number in (*row, offset)]

    def getJointType(self, handle: int) -> int:
        """Revolute or not."""
        return self._object(handle).joint_type

    def getJointMode(self, handle: int) -> tuple[int, int]:
        """The mode, and options as in 4.6."""
        return self._object(handle).mode, 0

    def getJointTargetForce(self, handle: int) -> float:
        """The torque of the motor in N·m."""
        return self._object(handle).torque

    def getJointVelocity(self, handle: int) -> float:
        """In rad/s."""
        return self._object(handle).rate

    def getObjectSpecialProperty(self, handle: int) -> int:
        """Collidable and more."""
        return self._object(handle).special

    def checkProximitySensor(self, sensor: int, other: int) -> tuple[Any, ...]:
        """Whether a sensor sees an object, and how far that is."""
        distance = self._object(sensor).sees.get(self._object(other).alias)
        nothing = [0.0, 0.0, 0.0]
        if distance is None:
            return 0, 0.0, nothing, -1, nothing
        return 1, distance, [0.0, 0.0, distance], other, [0.0, 0.0, -1.0]

    def getFloatParam(self, parameter: int) -> float:
        """The step of the physics engine in seconds."""
        assert parameter == self.floatparam_physicstimestep
        return self._scene.physics_step

    def getObjectInt32Param(self, handle: int, parameter: int) -> int:
        """What the checks ask for."""
        each = self._object(handle)
        return {
            self.jointintparam_dynctrlmode: each.control,
            self.shapeintparam_static: int(each.static),
            self.shapeintparam_respondable: int(each.respondable),
            self.shapeintparam_respondable_mask: each.mask,
        }[parameter]

    def getObjectFloatParam(self, handle: int, parameter: int) -> float:
        """The mass, or a corner of the bounding box."""
        each = self._object(handle)
        if parameter == self.shapefloatparam_mass:
            return each.mass
        corner = parameter - self.objfloatparam_objbbox_min_x
        return each.size[corner % 3] / 2.0 * (1.0 if corner >= 3 else -1.0)

    def getInt32Param(self, parameter: int) -> int:
        """The version."""
        assert parameter == self.intparam_program_version
        return self._scene.version

    def getScript(self, kind: int) -> int:
        """The main script, or -1."""
        assert kind == self.scripttype_mainscript
        return self._scene.main_script

    def getSimulationState(self) -> int:
        """Stopped, paused or running."""
        return self._scene.state

    def getSimulationTime(self) -> float:
        """Seconds."""
        self._time = next(self._scene.times, self._time)
        return self._time

    def getSimulationTimeStep(self) -> float:
        """Seconds."""
        return self._scene.time_step


class FakeConnection:
    """Calls functions at once."""

    def __init__(self, scene: FakeScene) -> None:
        self.sim = FakeSim(scene)
        self.address = "127.0.0.1:23000"

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Calls a function."""
        return function(*arguments)


def mecanum_scene(name: str = "robot_1", mask: int = 0xFF00) -> FakeScene:
    """A robot with a mecanum wheel of two rollers that overlap, and three wheels without rollers."""
    scene = FakeScene([])
    body = scene.add(alias=name, kind=SHAPE, mass=4.0)
    for wheel, x, y in (
        ("a", 0.1, 0.1),
        ("b", -0.1, 0.1),
        ("c", 0.1, -0.1),
        ("d", -0.1, -0.1),
    ):
        values = {"parent": body, "position": (x, y, 0.05), "rotation": AXLE}
        joint = scene.add(alias=wheel, kind=JOINT, **values)
        hub = scene.add(alias="hub", kind=SHAPE, parent=joint, size=(0.1, 0.1, 0.02))
        for number in range(2) if wheel == "a" else ():
            axle = scene.add(alias=f"axle{number}", kind=JOINT, parent=hub)
            scene.add(
                alias=f"roller{number}",
                kind=SHAPE,
                parent=axle,
                position=(x + 0.02 * number, y, 0.05),
                size=(0.03, 0.03, 0.03),
                mask=mask,
            )
    return scene


def two_wheel_scene(name: str = "robot_1") -> FakeScene:
    """A robot with two wheels and a sensor, as the checks want it."""
    scene = FakeScene([])
    body = scene.add(alias=name, kind=SHAPE, mass=4.0)
    for wheel, side in (("wheelL", 0.15), ("wheelR", -0.15)):
        joint = scene.add(
            alias=wheel,
            kind=JOINT,
            parent=body,
            position=(0.0, side, 0.045),
            rotation=AXLE,
        )
        scene.add(alias="tyre", kind=SHAPE, parent=joint, size=(0.09, 0.09, 0.02))
    scene.add(alias="fSensor", kind=PROXIMITY_SENSOR, parent=body)
    return scene
