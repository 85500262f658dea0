"""Checks a scene against the robots of a program.

The checks start nothing, stop nothing and change nothing: they may run beside a script that drives.
"""

import math
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import chain, combinations

from ..backend import RobotSpec
from ..errors import SimulatorError
from ..facts import RIM_ACCELERATION, STEP
from ..mounting import MAX_MISALIGNMENT, angle_to_left, angle_to_vertical, dot
from ..remote_api import Connection
from .findings import Finding, Severity, finding
from .lookup import part_paths, robot_paths
from .reader import SceneReader

OLDEST = 40600  # the first version of CoppeliaSim that scripts are made for: 4.6.0
PHYSICS_STEP = 0.005  # s; what a scene has that was loaded from a file
ROUNDING = 1.001
HOLD_TIME = 1.0  # s of real time in which a running simulation takes a step
LOOK_PERIOD = 0.02  # s
RADIUS_TOLERANCE = 0.02  # of the program's radius
SPINNING = 0.2  # rad/s, above which a wheel turns
STANDING = 0.1  # of the way of the rims, below which a body does not move
OBSERVED = 1.0  # s of simulation time that a robot is observed: for moments, contacts let a blocked one tremble faster
OBSERVE_LIMIT = 5.0  # s of real time that this may take
FLOOR_TOP = 0.02  # m; what does not rise higher is a floor
FALLEN = 0.1  # m below the height of the floor
LOCAL_MASK = (
    0xFF  # the bits of a respondable mask that count among the parts of a robot
)
SPARE_TORQUE = 2.0  # a recommended torque to the least one

JOINT_MODES = ("kinematic", "dependent")
CONTROL_MODES = ("force", "position", "spring", "callback")
JOINT_TYPES = ("prismatic", "spherical")


def check_simulator(scene: SceneReader) -> Iterator[Finding]:
    """What keeps all robots from driving; raises SimulatorError."""
    version = scene.call("getInt32Param", scene.constant("intparam_program_version"))
    if version < OLDEST:
        major, minor = divmod(version // 100, 100)
        yield finding("old-version", version=f"{major}.{minor}.{version % 100}")
    if scene.call("getScript", scene.constant("scripttype_mainscript")) < 0:
        yield finding("no-main-script")
    yield from _check_time(scene)
    yield from check_steps(scene)


def check_steps(scene: SceneReader) -> Iterator[Finding]:
    """Whether the steps of the simulation and of its physics engine are short enough; raises SimulatorError."""
    step = scene.call("getSimulationTimeStep")
    if step > STEP * ROUNDING:
        yield finding("time-step", milliseconds=round(1000.0 * step, 3))
    step = scene.call("getFloatParam", scene.constant("floatparam_physicstimestep"))
    if step > PHYSICS_STEP * ROUNDING:
        yield finding("physics-step", milliseconds=round(1000.0 * step, 3))


def _check_time(scene: SceneReader) -> Iterator[Finding]:
    state = scene.call("getSimulationState")
    now = scene.call("getSimulationTime")
    if state == scene.constant("simulation_paused"):
        yield finding("paused", time=now)
    elif state != scene.constant("simulation_stopped"):
        deadline = time.monotonic() + HOLD_TIME
        while scene.call("getSimulationTime") == now:
            if time.monotonic() > deadline:
                yield finding("time-held", time=now)
                return
            time.sleep(LOOK_PERIOD)


def check_robot(scene: SceneReader, spec: RobotSpec) -> Iterator[Finding]:
    """What keeps one robot from driving, the most likely causes first; raises SimulatorError."""
    return _RobotChecks(scene, spec).all()


def explain(connection: Connection, spec: RobotSpec) -> str:
    """Why the wheels of a robot do not drive it, and what to do; empty if nothing is found."""
    with suppress(SimulatorError):  # the robot's own error is reported
        checks = _RobotChecks(SceneReader(connection), spec)
        return _first(checks.parts(), Severity.ERROR)
    return ""


def explain_crawl(connection: Connection, spec: RobotSpec) -> str:
    """Why a robot drives slower than planned, and what to do; empty if nothing is found."""
    with suppress(SimulatorError):  # it is a note only
        scene = SceneReader(connection)
        parts = _RobotChecks(scene, spec).parts()
        found = chain(parts, check_steps(scene))
        return _first(found, Severity.ERROR, Severity.WARNING)
    return ""


def _first(findings: Iterable[Finding], *severities: Severity) -> str:
    for each in findings:
        if each.rule.severity in severities:
            return f"{each.message}: {each.help}"
    return ""


@dataclass(frozen=True)
class _Kind:
    """A kind of parts of a robot."""

    name: str  # the rules `NAME-missing` and `NAME-kind` are about it
    fits: frozenset[str] = (
        frozenset()
    )  # the types of objects that it can be; empty: any
    differs: frozenset[str] = frozenset()  # and those that it cannot be

    def accepts(self, kind: str) -> bool:
        """Whether an object of a type can be such a part."""
        return kind not in self.differs and (not self.fits or kind in self.fits)


ROBOT = _Kind("robot", differs=frozenset({"joint", "proximity sensor"}))
WHEEL = _Kind("wheel", fits=frozenset({"joint"}))
SENSOR = _Kind("sensor", fits=frozenset({"proximity sensor"}))


class _RobotChecks:
    """The checks of one robot."""

    def __init__(self, scene: SceneReader, spec: RobotSpec) -> None:
        self._scene, self._spec = scene, spec
        self._findings: list[Finding] = []
        self._body: int | None = None
        self._joints: Mapping[str, int] = {}
        self._floors: Sequence[int] | None = (
            None  # that sensors see, once they are known
        )

    def all(self) -> Iterator[Finding]:
        """All findings."""
        yield from self.parts()
        if self._body is not None and len(self._joints) == len(self._spec.wheels):
            yield from self._check_motion(self._body, self._joints)

    def parts(self) -> Iterator[Finding]:
        """What is wrong with the robot's parts, whether it drives or not."""
        spec = self._spec
        body = self._body = self._find(ROBOT, spec.name, robot_paths(spec))
        if body is None:
            # Where it is, its parts are.
            yield from self._take()
            return
        found = {
            wheel: self._find(WHEEL, wheel, part_paths(spec, wheel))
            for wheel in spec.wheels
        }
        joints = {wheel: joint for wheel, joint in found.items() if joint is not None}
        self._joints = joints
        yield from self._take()
        yield from self._check_body(body, joints)
        yield from self._check_frame(body, joints)
        mass = self._mass(body)
        for wheel, joint in joints.items():
            yield from self._check_joint(joint, spec.wheels[wheel], mass)
            yield from self._check_wheel(joint, spec.wheels[wheel])
        yield from self._check_rollers(joints)
        for sensor in (*spec.sensors, *spec.bumpers):
            handle = self._find(SENSOR, sensor, part_paths(spec, sensor))
            if handle is not None:
                self._check_sight(handle)
        yield from self._take()

    def _add(self, code: str, **values: object) -> None:
        self._findings.append(self._finding(code, **values))

    def _take(self) -> list[Finding]:
        taken, self._findings = self._findings, []
        return taken

    def _finding(self, code: str, **values: object) -> Finding:
        return finding(code, self._spec.name, **values)

    def _find(self, kind: _Kind, name: str, paths: Sequence[str]) -> int | None:
        """The object that the script uses for a part."""
        scene = self._scene
        others: list[tuple[str, str]] = []
        for path in paths:
            objects = [(handle, scene.kind(handle)) for handle in scene.at(path)]
            fitting = [handle for handle, found in objects if kind.accepts(found)]
            if len(fitting) > 1:
                first, second, *_ = (scene.path(handle) for handle in fitting)
                self._add("duplicate-name", object=path, first=first, second=second)
            if fitting:
                return fitting[0]
            others += [(path, found) for _, found in objects]
        if others:
            path, found = others[0]
            self._add(f"{kind.name}-kind", object=path, kind=found, part=name)
        else:
            self._add(f"{kind.name}-missing", paths=" or ".join(paths), part=name)
        return None

    def _check_body(self, body: int, joints: Mapping[str, int]) -> Iterator[Finding]:
        scene = self._scene
        mover = self._mover(body)
        carrier = next(
            (self._mover(scene.parent(joint)) for joint in joints.values()), None
        )
        if carrier is not None and not self._are_linked(carrier, mover):
            yield self._finding(
                "nested-chassis", object=scene.path(body), chassis=scene.path(carrier)
            )
        elif mover is None:
            kind = scene.kind(body)
            what = f"a static {kind}" if kind == "shape" else f"a {kind}"
            yield self._finding("static-body", object=scene.path(body), kind=what)

    def _mover(self, handle: int | None) -> int | None:
        """The shape that moves an object: itself or the nearest one above that is dynamic."""
        scene = self._scene
        while handle is not None:
            if scene.kind(handle) == "shape" and not scene.is_static(handle):
                return handle
            handle = scene.parent(handle)
        return None

    def _are_linked(self, lower: int, upper: int | None) -> bool:
        """Whether a dynamic shape is the upper one, or is held by it through a joint or a force sensor."""
        scene = self._scene
        if upper is None:
            return False
        handle: int | None = lower
        while handle is not None and handle != upper:
            handle = scene.parent(handle)
            if handle is not None and scene.kind(handle) in ("joint", "force sensor"):
                return True
        return lower == upper

    def _check_frame(self, body: int, joints: Mapping[str, int]) -> Iterator[Finding]:
        scene = self._scene
        frame = scene.matrix(body)
        left = (frame[1], frame[5], frame[9])
        if self._has_fallen(frame):
            values = {"depth": -frame[11], "angle": angle_to_vertical(frame)}
            yield self._finding("fallen", object=scene.path(body), **values)
            return
        if (angle := angle_to_vertical(frame)) > MAX_MISALIGNMENT:
            yield self._finding("tilted-body", object=scene.path(body), angle=angle)
            return
        sides = {}
        for wheel, joint in joints.items():
            matrix = scene.matrix(joint)
            if (angle := angle_to_left(frame, matrix)) > MAX_MISALIGNMENT:
                yield self._finding(
                    "wrong-forward",
                    object=scene.path(body),
                    joint=scene.path(joint),
                    angle=angle,
                )
                return
            sides[wheel] = dot(left, (matrix[3], matrix[7], matrix[11]))
        if len(sides) == len(self._spec.wheels):
            yield from self._check_sides(body, sides)

    def _has_fallen(self, body: Sequence[float]) -> bool:
        """Whether a robot has fallen off its floor, or over: at rest, it only has a frame that points elsewhere."""
        scene = self._scene
        if scene.call("getSimulationState") == scene.constant("simulation_stopped"):
            return False
        return body[11] < -FALLEN or angle_to_vertical(body) > MAX_MISALIGNMENT

    def _check_sides(self, body: int, sides: Mapping[str, float]) -> Iterator[Finding]:
        """The wheels on the left are declared before those on the right."""
        wheels = list(self._spec.wheels)
        half = len(wheels) // 2
        for left, right in zip(wheels[:half], wheels[half:], strict=True):
            if sides[left] <= sides[right]:
                path = self._scene.path(body)
                yield self._finding(
                    "swapped-wheels", object=path, left=left, right=right
                )
                return

    def _mass(self, body: int) -> float:
        """The mass in kilograms that a robot's wheels move."""
        scene = self._scene
        shapes = [
            each for each in (body, *scene.below(body)) if scene.kind(each) == "shape"
        ]
        return sum(scene.mass(shape) for shape in shapes if not scene.is_static(shape))

    def _check_joint(self, joint: int, radius: float, mass: float) -> Iterator[Finding]:
        scene = self._scene
        path = scene.path(joint)
        kind = scene.call("getJointType", joint)
        mode = scene.joint_mode(joint)
        if kind != scene.constant("joint_revolute_subtype"):
            name = scene.name_of(kind, "joint_{}_subtype", JOINT_TYPES)
            yield self._finding("joint-type", object=path, kind=name)
        elif mode != scene.constant("jointmode_dynamic"):
            name = scene.name_of(mode, "jointmode_{}", JOINT_MODES)
            yield self._finding("joint-mode", object=path, mode=name)
        else:
            yield from self._check_motor(joint, path, radius, mass)

    def _check_motor(
        self, joint: int, path: str, radius: float, mass: float
    ) -> Iterator[Finding]:
        scene = self._scene
        mode = scene.integer(joint, "jointintparam_dynctrlmode")
        if mode == scene.constant("jointdynctrl_free"):
            yield self._finding("motor-off", object=path)
        elif mode != scene.constant("jointdynctrl_velocity"):
            name = scene.name_of(mode, "jointdynctrl_{}", CONTROL_MODES)
            yield self._finding("control-mode", object=path, mode=name.capitalize())
        torque = abs(scene.call("getJointTargetForce", joint))
        least = mass * RIM_ACCELERATION * radius / len(self._spec.wheels)
        enough = SPARE_TORQUE * least or 1.0
        if torque == 0.0:
            yield self._finding("no-torque", object=path, enough=enough)
        elif torque < least:
            yield self._finding(
                "weak-motor", object=path, torque=torque, mass=mass, enough=enough
            )

    def _check_wheel(self, joint: int, radius: float) -> Iterator[Finding]:
        scene = self._scene
        below = [(each, scene.kind(each)) for each in scene.below(joint)]
        shapes = [each for each, kind in below if kind == "shape"]
        dynamic = [each for each in shapes if not scene.is_static(each)]
        solid = [each for each in dynamic if scene.is_respondable(each)]
        if not shapes:
            yield self._finding("no-wheel-shape", object=scene.path(joint))
        elif not dynamic:
            yield self._finding("static-wheel", object=scene.path(shapes[0]))
        elif not solid:
            yield self._finding("ghost-wheel", object=scene.path(dynamic[0]))
        elif len(shapes) == len(below):
            # The shapes below further joints are rollers.
            radii = {scene.radius(each): each for each in solid}
            found = max((each for each in radii if each is not None), default=radius)
            if abs(found - radius) > RADIUS_TOLERANCE * radius:
                path = scene.path(radii[found])
                yield self._finding(
                    "wheel-radius", object=path, found=found, expected=radius
                )

    def _check_rollers(self, joints: Mapping[str, int]) -> Iterator[Finding]:
        """The rollers of a wheel turn by themselves: where they overlap, they must not push each other."""
        for joint in joints.values():
            for first, second in combinations(self._rollers(joint), 2):
                mask = first.mask & second.mask & LOCAL_MASK
                distance = math.dist(first.middle, second.middle)
                if mask and distance < first.radius + second.radius:
                    paths = (
                        self._scene.path(first.shape),
                        self._scene.path(second.shape),
                    )
                    yield self._finding(
                        "rollers-collide", first=paths[0], second=paths[1]
                    )
                    return

    def _rollers(self, joint: int) -> Sequence["_Roller"]:
        """The solid shapes of a wheel on joints of their own."""
        scene = self._scene
        below = scene.below(joint)
        axles = {each for each in below if scene.kind(each) == "joint"}
        return [
            _Roller(
                each,
                scene.integer(each, "shapeintparam_respondable_mask"),
                scene.matrix(each)[3::4],
                max(scene.size(each)) / 2.0,
            )
            for each in below
            if scene.parent(each) in axles
            and scene.kind(each) == "shape"
            and scene.is_respondable(each)
        ]

    def _check_sight(self, sensor: int) -> None:
        """A sensor that sees its floor has an obstacle ahead wherever the robot is."""
        scene = self._scene
        for floor in self._detectable_floors():
            state, distance, *_ = scene.call("checkProximitySensor", sensor, floor)
            if state > 0:
                paths = {"object": scene.path(sensor), "floor": scene.path(floor)}
                self._add("sensor-sees-floor", distance=distance, **paths)
                return

    def _detectable_floors(self) -> Sequence[int]:
        """The static shapes that sensors see, and that rise nowhere above the floor."""
        if self._floors is None:
            self._floors = [
                each for each in self._scene.shapes() if self._is_floor(each)
            ]
        return self._floors

    def _is_floor(self, shape: int) -> bool:
        scene = self._scene
        seen = scene.constant("objectspecialproperty_detectable")
        if not scene.is_static(shape):
            return False
        if not scene.call("getObjectSpecialProperty", shape) & seen:
            return False
        frame, half = scene.matrix(shape), [size / 2.0 for size in scene.size(shape)]
        reach = sum(abs(frame[8 + axis]) * half[axis] for axis in range(3))
        return frame[11] + reach <= FLOOR_TOP

    def _check_motion(self, body: int, joints: Mapping[str, int]) -> Iterator[Finding]:
        """Whether a body moves while its wheels turn."""
        scene, radii = self._scene, self._spec.wheels.values()
        if min(self._rates(joints)) < SPINNING:
            return
        before, began = scene.matrix(body), scene.call("getSimulationTime")
        passed = self._let_pass(began)
        after, rates = scene.matrix(body), self._rates(joints)
        if passed <= 0.0 or min(rates) < SPINNING:
            return
        rolled = passed * min(
            rate * radius for rate, radius in zip(rates, radii, strict=True)
        )
        origins = [scene.matrix(joint)[3::4] for joint in joints.values()]
        arm = max(math.dist(a, b) / 2.0 for a, b in combinations(origins, 2))
        way = [after[axis] - before[axis] for axis in (3, 7, 11)]
        ahead = abs(dot((before[0], before[4], before[8]), way))
        turned = math.atan2(
            before[0] * after[4] - before[4] * after[0],
            before[0] * after[0] + before[4] * after[4],
        )
        if ahead + arm * abs(turned) < STANDING * rolled:
            yield self._finding("wheels-spin", object=scene.path(body))

    def _rates(self, joints: Mapping[str, int]) -> Sequence[float]:
        call = self._scene.call
        return [abs(call("getJointVelocity", joint)) for joint in joints.values()]

    def _let_pass(self, began: float) -> float:
        """Waits while a robot is observed; returns how much simulation time has passed, in seconds."""
        deadline = time.monotonic() + OBSERVE_LIMIT
        while True:
            passed: float = self._scene.call("getSimulationTime") - began
            if passed >= OBSERVED or time.monotonic() > deadline:
                return passed
            time.sleep(LOOK_PERIOD)


@dataclass(frozen=True)
class _Roller:
    """A roller of a mecanum wheel."""

    shape: int
    mask: int
    middle: Sequence[float]
    radius: float  # m
