"""Checks a scene against the robots of a program.

The checks start nothing, stop nothing and change nothing: they may run beside a script that drives.
"""

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations

from ..backend import RobotSpec
from ..errors import SimulatorError
from ..mounting import MAX_MISALIGNMENT, angle_to_left, angle_to_vertical, dot
from ..remote_api import Connection
from ..settings import RIM_ACCELERATION
from .findings import Finding, Severity, finding
from .lookup import part_paths, robot_paths
from .reader import SceneReader

OLDEST = 40600  # the first version of CoppeliaSim that scripts are made for: 4.6.0
USUAL_STEP = 0.05  # s
HOLD_TIME = 1.0  # s of real time in which a running simulation takes a step
LOOK_PERIOD = 0.02  # s
RADIUS_TOLERANCE = 0.02  # of the program's radius
SPINNING = 0.2  # rad/s, above which a wheel turns
STANDING = 0.1  # of the speed of the rims, below which a body does not move
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
    step = scene.call("getSimulationTimeStep")
    if step > USUAL_STEP * 1.001:
        yield finding("time-step", milliseconds=round(1000.0 * step, 3))


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
        for each in check_robot(SceneReader(connection), spec):
            is_cause = each.rule.code != "wheels-spin"
            if each.rule.severity is Severity.ERROR and is_cause:
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

    def all(self) -> Iterator[Finding]:
        """All findings."""
        spec = self._spec
        body = self._find(ROBOT, spec.name, robot_paths(spec))
        found = {
            wheel: self._find(WHEEL, wheel, part_paths(spec, wheel))
            for wheel in spec.wheels
        }
        joints = {wheel: joint for wheel, joint in found.items() if joint is not None}
        yield from self._take()
        if body is not None:
            yield from self._check_body(body, joints)
            yield from self._check_frame(body, joints)
        mass = self._mass(body)
        for wheel, joint in joints.items():
            yield from self._check_joint(joint, spec.wheels[wheel], mass)
            yield from self._check_wheel(joint, spec.wheels[wheel])
        for sensor in (*spec.sensors, *spec.bumpers):
            self._find(SENSOR, sensor, part_paths(spec, sensor))
        yield from self._take()
        if body is not None and len(joints) == len(spec.wheels):
            yield from self._check_motion(body, joints)

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

    def _mass(self, body: int | None) -> float:
        """The mass in kilograms that a robot's wheels move."""
        if body is None:
            return 0.0
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

    def _check_motion(self, body: int, joints: Mapping[str, int]) -> Iterator[Finding]:
        scene = self._scene
        rates = [
            abs(scene.call("getJointVelocity", joint)) for joint in joints.values()
        ]
        if min(rates) < SPINNING:
            return
        radii = self._spec.wheels.values()
        rim = min(rate * radius for rate, radius in zip(rates, radii, strict=True))
        origins = [scene.matrix(joint)[3::4] for joint in joints.values()]
        arm = max(math.dist(a, b) / 2.0 for a, b in combinations(origins, 2))
        linear, angular = scene.call("getObjectVelocity", body)
        if math.hypot(*linear) + arm * abs(angular[2]) < STANDING * rim:
            yield self._finding("wheels-spin", object=scene.path(body))
