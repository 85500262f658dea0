"""Reads robots and obstacles out of a running simulator's scene."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import TypeVar

from ..facts import (
    MOTOR_ACCELERATION,
    ROBOT_TYPES,
    SENSOR_CONE,
    SENSOR_RANGE,
    TypeName,
)
from ..remote_api import Connection
from .description import (
    ObstacleDescription,
    RobotDescription,
    SceneDescription,
    SensorDescription,
    WheelDescription,
)
from .frames import Frame, Vector, inverse, product
from .marks import Marks
from .outlines import Polygon, Triangle, hull, outlines
from .reader import SceneReader

ALONG_FLOOR = 0.5  # the least cosine between a sensor's direction and the floor
LEVEL = 0.999  # the least cosine between an axis and its intended direction
FLOOR_TOP = 0.02  # m; what does not rise higher is a floor
T = TypeVar("T")

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
COMPOUND, PRIMITIVE, CONVEX = 1, 2, 4  # bits of what a shape is


def pull(
    connection: Connection, environment: str
) -> tuple[SceneDescription, list[str]]:
    """The scene, and what of it was not understood, in a sentence each; raises SimulatorError."""
    puller = _Puller(connection)
    robots = tuple(puller.understood(puller.robot, puller.bodies()))
    obstacles = chain(*puller.understood(puller.obstacles, puller.solids()))
    return SceneDescription(environment, robots, tuple(obstacles)), puller.unclear


class _UnclearError(Exception):
    """An object that is not understood."""


@dataclass(frozen=True)
class _Wheel:
    joint: int
    frame: Frame  # of the joint, on the body
    radius: float
    has_rollers: bool


@dataclass
class _Puller:
    connection: Connection
    unclear: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._marks = Marks(self.connection)
        self._scene = SceneReader(self.connection)
        self._all = self._marks.objects()
        self._kinds = {handle: self._scene.kind(handle) for handle in self._all}
        self._parents = {handle: self._scene.parent(handle) for handle in self._all}
        self._dynamic = {
            handle
            for handle, kind in self._kinds.items()
            if kind == "shape" and not self._scene.is_static(handle)
        }

    def bodies(self) -> list[int]:
        """The dynamic shapes that no other one carries, with joints below."""
        joints = [handle for handle, kind in self._kinds.items() if kind == "joint"]
        carriers = {above for joint in joints for above in self._above(joint)}
        return [
            handle
            for handle in self._all
            if handle in self._dynamic
            and handle in carriers
            and not self._dynamic.intersection(self._above(handle))
        ]

    def solids(self) -> list[int]:
        """The static shapes that robots can touch."""
        return [
            handle
            for handle, kind in self._kinds.items()
            if kind == "shape"
            and handle not in self._dynamic
            and not self._dynamic.intersection(self._above(handle))
            and self._scene.is_respondable(handle)
        ]

    def robot(self, body: int) -> RobotDescription:
        """The robot with a body, if it is one of the known types."""
        path = self._scene.path(body)
        frame = list(self._scene.matrix(body))
        below = [handle for handle in self._all if body in self._above(handle)]
        wheels = [wheel for each in below if (wheel := self._wheel(each, body, frame))]
        if len(wheels) not in {len(each.wheels) for each in ROBOT_TYPES.values()}:
            numbers = dict.fromkeys(each.number for each in ROBOT_TYPES.values())
            raise _UnclearError(
                f"{path} has {len(wheels)} wheels on joints that velocities drive, not {' or '.join(numbers)}"
            )
        if frame[10] < LEVEL:
            raise _UnclearError(f"the z axis of {path} does not point up")
        if any(abs(wheel.frame[6]) < LEVEL for wheel in wheels):
            raise _UnclearError(f"the wheels of {path} do not turn about its y axis")
        half = len(wheels) // 2
        wheels.sort(key=lambda wheel: -wheel.frame[7])
        sides = (wheels[:half], wheels[half:])
        wheels = [
            wheel
            for side in sides
            for wheel in sorted(side, key=lambda wheel: -wheel.frame[3])
        ]
        names = [self._alias(handle) for handle in (body, *(w.joint for w in wheels))]
        for name in names:
            if not NAME.fullmatch(name):
                raise _UnclearError(
                    f"`{name}` of {path} cannot be a name in a program; change its alias"
                )
        x, y = (sum(w.frame[axis] for w in wheels) / len(wheels) for axis in (3, 7))
        middle = product(
            frame, [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, 0.0]
        )
        size = self._size(body)
        mark = self._marks.read(body) or {}
        kind = self._type(wheels)
        sensors = [each for each in below if self._kinds[each] == "proximity sensor"]
        return RobotDescription(
            names[0],
            kind,
            middle[3],
            middle[7],
            math.atan2(frame[4], frame[0]),
            size[0],
            size[1],
            mark.get("grip", ROBOT_TYPES[kind].grip),
            mark.get("rim_speed"),
            mark.get("rim_acceleration", MOTOR_ACCELERATION),
            tuple(
                WheelDescription(
                    name,
                    wheel.radius,
                    wheel.frame[3] - x,
                    wheel.frame[7] - y,
                    wheel.frame[6] < 0.0,
                )
                for name, wheel in zip(names[1:], wheels, strict=True)
            ),
            tuple(
                self.understood(lambda sensor: self._sensor(sensor, middle), sensors)
            ),
        )

    def obstacles(self, shape: int) -> Sequence[ObstacleDescription]:
        """The obstacles that a shape is: none if it is a floor, several if it consists of several parts."""
        frame = list(self._scene.matrix(shape))
        mark = self._marks.read(shape) or {}
        name = str(mark.get("name") or self._alias(shape))
        if "corners" in mark:
            frame = product(frame, inverse(mark["origin"]))
            place = (frame[3], frame[7], math.atan2(frame[4], frame[0]))
            points = tuple((x, y) for x, y in mark["corners"])
            return [ObstacleDescription(name, *place, corners=points)]
        if self._is_primitive(shape):
            return self._primitive(shape, name, frame)
        return self._mesh_obstacles(shape, name, frame)

    def _primitive(
        self, shape: int, name: str, frame: Frame
    ) -> Sequence[ObstacleDescription]:
        low, high = self._bounds(shape)
        corners = [
            frame[8] * x + frame[9] * y + frame[10] * z + frame[11]
            for x in (low[0], high[0])
            for y in (low[1], high[1])
            for z in (low[2], high[2])
        ]
        if max(corners) <= FLOOR_TOP:
            return []
        if abs(frame[10]) < LEVEL:
            raise _UnclearError(f"{self._scene.path(shape)} is tilted")
        place = (frame[3], frame[7], math.atan2(frame[4], frame[0]))
        _, kind, size = self._geometry(shape)
        sim = self.connection.sim
        if kind in (sim.primitiveshape_cylinder, sim.primitiveshape_spheroid):
            radius = max(size[0], size[1]) / 2.0
            return [ObstacleDescription(name, *place, radius=radius)]
        if kind != sim.primitiveshape_cuboid:
            self.unclear.append(
                f"{self._scene.path(shape)} is no box and no cylinder: its bounding box is taken"
            )
        return [ObstacleDescription(name, *place, size=(size[0], size[1]))]

    def _mesh_obstacles(
        self, shape: int, name: str, frame: Frame
    ) -> Sequence[ObstacleDescription]:
        """The outline of a mesh: its bounding box has axes that no function tells."""
        own, triangles = self._mesh(shape)
        vertices = [_moved(frame, vertex) for vertex in own]
        if max(z for _, _, z in vertices) <= FLOOR_TOP:
            return []
        is_convex = bool(self._geometry(shape)[0] & CONVEX)
        found = outlines(vertices, triangles, is_convex=is_convex)
        if found is None:
            path = self._scene.path(shape)
            self.unclear.append(
                f"the outline of {path} is not clear: the convex hull is taken"
            )
            found = [hull(vertices)]
        if any(len(corners) < 3 for corners in found):
            raise _UnclearError(f"{self._scene.path(shape)} covers no area")
        names = [name, *(f"{name}_{number}" for number in range(2, len(found) + 1))]
        return [
            _polygon(name, corners) for name, corners in zip(names, found, strict=True)
        ]

    def understood(
        self, read: Callable[[int], T | None], handles: Iterable[int]
    ) -> Iterator[T]:
        """What objects are; notes those that are not understood."""
        for handle in handles:
            try:
                found = read(handle)
            except _UnclearError as error:
                self.unclear.append(f"{error}: it is left out")
            else:
                if found is not None:
                    yield found

    def _above(self, handle: int) -> list[int]:
        """The objects above one, the nearest first."""
        above = []
        parent = self._parents.get(handle)
        while parent is not None:
            above.append(parent)
            parent = self._parents.get(parent)
        return above

    def _alias(self, handle: int) -> str:
        return str(self._scene.call("getObjectAlias", handle, -1))

    def _type(self, wheels: Sequence[_Wheel]) -> TypeName:
        """The type of a robot with as many wheels, of their kind if there are several."""
        mecanum = all(wheel.has_rollers for wheel in wheels)
        fitting = [
            name
            for name, each in ROBOT_TYPES.items()
            if len(each.wheels) == len(wheels)
        ]
        kinds = (name for name in fitting if ROBOT_TYPES[name].mecanum == mecanum)
        return next(kinds, fitting[0])

    def _wheel(self, joint: int, body: int, frame: Frame) -> _Wheel | None:
        """A joint below a body, if it drives a wheel."""
        scene = self._scene
        above = self._above(joint)
        between = above[: above.index(body)]
        if self._kinds[joint] != "joint" or any(
            self._kinds[each] == "joint" for each in between
        ):
            return None
        velocity = scene.constant("jointdynctrl_velocity")
        if (
            scene.call("getJointType", joint)
            != scene.constant("joint_revolute_subtype")
            or scene.joint_mode(joint) != scene.constant("jointmode_dynamic")
            or scene.integer(joint, "jointintparam_dynctrlmode") != velocity
        ):
            return None
        own = list(scene.matrix(joint))
        below = [handle for handle in self._all if joint in self._above(handle)]
        to_joint = inverse(own)
        reaches = []
        for each in self._dynamic.intersection(below):
            if scene.is_respondable(each):
                at = product(to_joint, list(scene.matrix(each)))
                reaches.append(math.hypot(at[3], at[7]) + max(self._size(each)) / 2.0)
        rollers = any(self._kinds[each] == "joint" for each in below)
        relative = product(inverse(frame), own)
        return _Wheel(joint, relative, max(reaches), rollers) if reaches else None

    def _sensor(self, sensor: int, body: Frame) -> SensorDescription:
        path, name = self._scene.path(sensor), self._alias(sensor)
        frame = product(inverse(body), list(self._scene.matrix(sensor)))
        if not NAME.fullmatch(name):
            raise _UnclearError(
                f"{path} cannot be a name in a program; change its alias"
            )
        if math.hypot(frame[2], frame[6]) < ALONG_FLOOR:
            raise _UnclearError(f"sensor {path} does not look along the floor")
        mark = self._marks.read(sensor) or {}
        get = self.connection.try_call
        reach = mark.get("range") or get("getFloatProperty", sensor, "volume_range")
        angles = get("getFloatArrayProperty", sensor, "volume_angle")
        cone = mark.get("cone") or (angles[0] if angles else None)
        if reach is None or cone is None:
            self.unclear.append(
                f"range and cone of {path} cannot be read from this version of CoppeliaSim; "
                "correct them in the scene file"
            )
        return SensorDescription(
            name,
            mark.get("sensor", "distance"),
            frame[3],
            frame[7],
            math.atan2(frame[6], frame[2]),
            reach or SENSOR_RANGE,
            cone or SENSOR_CONE,
        )

    def _geometry(self, shape: int) -> tuple[int, int, Sequence[float]]:
        what, kind, size = self._scene.call("getShapeGeomInfo", shape)
        return what, kind, size

    def _is_primitive(self, shape: int) -> bool:
        what, _, _ = self._geometry(shape)
        return bool(what & PRIMITIVE and not what & COMPOUND)

    def _mesh(self, shape: int) -> tuple[Sequence[Vector], Sequence[Triangle]]:
        """The vertices of a mesh in its frame, and its triangles."""
        numbers, indices = self._scene.call("getShapeMesh", shape)
        is_whole = len(numbers) % 3 == 0 and len(indices) % 3 == 0
        if not is_whole or 3 * max(indices) >= len(numbers):
            raise _UnclearError(f"the mesh of {self._scene.path(shape)} is incomplete")
        vertices = list(zip(numbers[::3], numbers[1::3], numbers[2::3], strict=True))
        triangles = list(zip(indices[::3], indices[1::3], indices[2::3], strict=True))
        return vertices, triangles

    def _bounds(self, shape: int) -> tuple[list[float], list[float]]:
        """The corners of a box around a shape, along the axes of its frame."""
        if not self._is_primitive(shape):
            columns = list(zip(*self._mesh(shape)[0], strict=True))
            return [min(each) for each in columns], [max(each) for each in columns]
        low, high = (
            [
                self._scene.number(shape, f"objfloatparam_objbbox_{end}_{axis}")
                for axis in "xyz"
            ]
            for end in ("min", "max")
        )
        return low, high

    def _size(self, shape: int) -> list[float]:
        low, high = self._bounds(shape)
        return [b - a for a, b in zip(low, high, strict=True)]


def _moved(frame: Frame, point: Vector) -> Vector:
    """Where a point of a frame is."""
    x, y, z = (
        sum(frame[row + axis] * point[axis] for axis in range(3)) + frame[row + 3]
        for row in (0, 4, 8)
    )
    return x, y, z


def _polygon(name: str, corners: Polygon) -> ObstacleDescription:
    """An obstacle of an outline, which is placed by the middle of its corners."""
    x, y = (sum(each) / len(corners) for each in zip(*corners, strict=True))
    points = tuple((a - x, b - y) for a, b in corners)
    return ObstacleDescription(name, x, y, 0.0, corners=points)
