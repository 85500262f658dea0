"""Reads robots and obstacles out of a running simulator's scene."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

from ..remote_api import Connection
from .description import (
    ObstacleDescription,
    RobotDescription,
    SceneDescription,
    SensorDescription,
    WheelDescription,
)
from .frames import Frame, inverse, product
from .marks import Marks
from .reader import SceneReader

LEVEL = 0.999  # the least cosine between an axis and its intended direction
FLOOR_TOP = 0.02  # m; what does not rise higher is a floor
T = TypeVar("T")

NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
DEFAULT_RANGE, DEFAULT_CONE = 1.0, math.radians(20.0)
COMPOUND, PRIMITIVE = 1, 2  # bits of what a shape is


def pull(
    connection: Connection, environment: str
) -> tuple[SceneDescription, list[str]]:
    """The scene, and what of it was not understood, in a sentence each; raises SimulatorError."""
    puller = _Puller(connection)
    robots = tuple(puller.understood(puller.robot, puller.bodies()))
    obstacles = tuple(puller.understood(puller.obstacle, puller.solids()))
    return SceneDescription(environment, robots, obstacles), puller.unclear


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
        """The robot with a body, if it is one of the three types."""
        path = self._scene.path(body)
        frame = list(self._scene.matrix(body))
        below = [handle for handle in self._all if body in self._above(handle)]
        wheels = [wheel for each in below if (wheel := self._wheel(each, body, frame))]
        if len(wheels) not in (2, 4):
            raise _UnclearError(
                f"{path} has {len(wheels)} wheels on joints that velocities drive, not two or four"
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
        sensors = [each for each in below if self._kinds[each] == "proximity sensor"]
        return RobotDescription(
            names[0],
            self._type(wheels),
            middle[3],
            middle[7],
            math.atan2(frame[4], frame[0]),
            size[0],
            size[1],
            mark.get("grip", 0.05 if self._type(wheels) == "fwh" else 1.0),
            mark.get("rim_speed"),
            mark.get("rim_acceleration", 1.0),
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

    def obstacle(self, shape: int) -> ObstacleDescription | None:
        """The obstacle that a shape is, unless it is a floor."""
        frame = list(self._scene.matrix(shape))
        mark = self._marks.read(shape) or {}
        low, high = self._bounds(shape)
        corners = [
            frame[8] * x + frame[9] * y + frame[10] * z + frame[11]
            for x in (low[0], high[0])
            for y in (low[1], high[1])
            for z in (low[2], high[2])
        ]
        if max(corners) <= FLOOR_TOP:
            return None
        name = str(mark.get("name") or self._alias(shape))
        if "corners" in mark:
            frame = product(frame, inverse(mark["origin"]))
            place = (frame[3], frame[7], math.atan2(frame[4], frame[0]))
            points = tuple((x, y) for x, y in mark["corners"])
            return ObstacleDescription(name, *place, corners=points)
        place = (frame[3], frame[7], math.atan2(frame[4], frame[0]))
        path, is_upright = self._scene.path(shape), abs(frame[10]) >= LEVEL
        what, kind, size = self._geometry(shape)
        if what & PRIMITIVE and not what & COMPOUND and is_upright:
            sim = self.connection.sim
            if kind == sim.primitiveshape_cuboid:
                return ObstacleDescription(name, *place, size=(size[0], size[1]))
            if kind in (sim.primitiveshape_cylinder, sim.primitiveshape_spheroid):
                return ObstacleDescription(
                    name, *place, radius=max(size[0], size[1]) / 2.0
                )
        if not is_upright:
            raise _UnclearError(f"{path} is tilted")
        self.unclear.append(
            f"{path} is no box and no cylinder: its bounding box is taken"
        )
        center = [(a + b) / 2.0 for a, b in zip(low, high, strict=True)]
        x = frame[0] * center[0] + frame[1] * center[1] + frame[3]
        y = frame[4] * center[0] + frame[5] * center[1] + frame[7]
        return ObstacleDescription(
            name, x, y, place[2], size=(high[0] - low[0], high[1] - low[1])
        )

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

    def _type(self, wheels: Sequence[_Wheel]) -> Any:
        if len(wheels) == 2:
            return "tw"
        return "fwh" if all(wheel.has_rollers for wheel in wheels) else "fw"

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
        if math.hypot(frame[2], frame[6]) < 0.9:
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
            reach or DEFAULT_RANGE,
            cone or DEFAULT_CONE,
        )

    def _geometry(self, shape: int) -> tuple[int, int, Sequence[float]]:
        what, kind, size = self._scene.call("getShapeGeomInfo", shape)
        return what, kind, size

    def _bounds(self, shape: int) -> tuple[list[float], list[float]]:
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
