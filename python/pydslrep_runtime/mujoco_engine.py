"""Robots in MuJoCo, a physics engine that runs in the process of the script.

The world is a file in MuJoCo's own format, which `pydslrep plan --mjcf FILE` writes: it has bodies, wheels and obstacles, and
as custom numbers and `user` attributes what scripts need to know of them.
"""

import math
import os
import random
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .backend import Backend, RobotSpec, SensorCone
from .errors import SetupError, SimulatorError
from .obstacle_path import ObstaclePath
from .pose import Pose

try:
    import mujoco  # type: ignore[import-not-found,import-untyped,unused-ignore]
    import numpy as np
except ModuleNotFoundError as missing:
    raise SetupError(
        f"Python module {missing.name} is missing; install it with `python3 -m pip install 'pydslrep[mujoco]'`"
    ) from missing

if mujoco.__version__.partition(".")[0] != "4":
    raise SetupError(
        f"MuJoCo {mujoco.__version__} is installed, but this needs version 4: "
        "`python3 -m pip install 'pydslrep[mujoco]'`"
    )

SETTLING = 0.3  # s in which robots sink into their wheels before time starts
RAY_SPACING = math.radians(1.0)  # between two rays of a sensor, at most
SEEN = np.array(
    [1, 0, 1, 1, 1, 1], dtype=np.uint8
)  # by groups of geoms: wheels are below hulls
SLIP_TIME = 1.0  # s after which a wheel slips otherwise
DRAWING_LIMIT = 5.0  # s that the window may take to close
TIPPED = math.radians(30.0)  # from which on a robot does not stand on its wheels
UNSTABLE = ("mjWARN_BADQPOS", "mjWARN_BADQVEL", "mjWARN_BADQACC")


class MuJoCo:
    """A world, and the clock of its robots."""

    def __init__(
        self, world: Path, *, speed: float | None = None, view: bool = False
    ) -> None:
        """`speed` is in simulated seconds per second, at most; with `view`, a window shows the world. Raises SetupError."""
        self.time = 0.0
        self._world, self._wants_view = world, view
        self._speed = 1.0 if view and speed is None else speed
        self._view: Any = None
        self._drawing: list[threading.Thread] = []  # which ends after the window
        self._due: float | None = None  # when the next step is, in real time
        self._robots: list[MuJoCoRobot] = []
        # Otherwise it writes a log into the current folder.
        mujoco.set_mju_user_warning(lambda _text: None)
        try:
            self.model: Any = mujoco.MjModel.from_xml_path(str(world))
        except ValueError as error:
            raise SetupError(f"MuJoCo cannot read {world}: {error}") from error
        self.data: Any = mujoco.MjData(self.model)
        try:
            self.time_step = self._number("step")
            self.seed = int(self._number("seed"))
        except KeyError as error:
            raise SetupError(
                f"{world} is not a world of `pydslrep plan --mjcf`: {error}"
            ) from error
        self._substeps = max(1, round(self.time_step / self.model.opt.timestep))
        names = [self.model.numeric(index).name for index in range(self.model.nnumeric)]
        noise = self.model.numeric("noise").data if "noise" in names else (0.0, 0.0)
        self.slip, self.sensor_noise = map(float, noise)
        self._movers = [self._mover(name) for name in names if name[:5] == "path/"]
        self._is_seen = False  # whether all places are as of the latest step

    def connect(self, spec: RobotSpec) -> Backend:
        """Finds a robot; raises SetupError."""
        try:
            robot = MuJoCoRobot(spec, self)
        except KeyError as error:
            raise SetupError(
                f"robot {spec.name}: {self._world} lacks it or a part of it: {error.args[0]}. Write it again with "
                "`pydslrep plan --mjcf`"
            ) from error
        self._robots.append(robot)
        return robot

    def start(self) -> None:
        """Lets the robots settle; then time starts."""
        self._place_movers(0.0)
        mujoco.mj_step(self.model, self.data, round(SETTLING / self.model.opt.timestep))
        self.data.time = 0.0
        if self._wants_view:
            before = set(threading.enumerate())
            self._view = show(self.model, self.data)
            self._drawing = [it for it in threading.enumerate() if it not in before]

    def advance(self) -> None:
        """Takes one step."""
        for robot in self._robots:
            robot.drive_wheels()
        if self._movers:
            self._step_with_movers()
        else:
            mujoco.mj_step(self.model, self.data, self._substeps)
        self.time += self.time_step
        self._is_seen = False
        if any(
            self.data.warning[getattr(mujoco.mjtWarning, it)].number for it in UNSTABLE
        ):
            raise SimulatorError(
                "MuJoCo's simulation has become unstable: forces grow without bounds, perhaps because bodies overlap"
            )
        for robot in self._robots:
            robot.measure()
        self._keep_pace()

    def close(self) -> None:
        """Closes the window, if there is one."""
        if self._view is None:
            return
        self._view.close()
        # It draws in a thread of its own. If Python ended meanwhile, MuJoCo would wait for itself for ever.
        for thread in self._drawing:
            thread.join(DRAWING_LIMIT)

    def place_bodies(self) -> None:
        """Computes where everything is, for sensors, as of the latest step."""
        if not self._is_seen:
            mujoco.mj_kinematics(self.model, self.data)
            self._is_seen = True

    def _number(self, name: str) -> float:
        return float(self.model.numeric(name).data[0])

    def _mover(self, path: str) -> tuple[int, ObstaclePath]:
        """An obstacle that moves: the index of its body among those that are moved, and where it is."""
        name = path.removeprefix("path/")
        data = [float(value) for value in self.model.numeric(path).data]
        points = list(zip(data[0::3], data[1::3], data[2::3], strict=True))
        repeats = any(
            self.model.numeric(index).name == f"repeat/{name}"
            for index in range(self.model.nnumeric)
        )
        return int(self.model.body(name).mocapid[0]), ObstaclePath(points, repeats)

    def _place_movers(self, now: float) -> None:
        for index, path in self._movers:
            self.data.mocap_pos[index, :2] = path.at(now)

    def _step_with_movers(self) -> None:
        """Takes the steps of the physics one by one: what jumps would hit robots."""
        for index in range(1, self._substeps + 1):
            self._place_movers(self.time + self.time_step * index / self._substeps)
            mujoco.mj_step(self.model, self.data)

    def _keep_pace(self) -> None:
        """Lets real time pass, if time has to keep to it."""
        if self._view is not None:
            self._view.sync()
        if self._speed is None:
            return
        now = time.monotonic()
        # After a pause, time does not catch up.
        self._due = max((now if self._due is None else self._due), now - 1.0)
        self._due += self.time_step / self._speed
        time.sleep(max(0.0, self._due - now))


def show(model: Any, data: Any) -> Any:
    """MuJoCo's own window; raises SetupError if there is no display."""
    if sys.platform.startswith("linux") and not (
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    ):
        raise SetupError(
            "there is no display to view the world on: neither DISPLAY nor WAYLAND_DISPLAY is set"
        )
    try:
        import mujoco.viewer as viewer  # type: ignore[import-not-found,import-untyped,unused-ignore]

        return viewer.launch_passive(model, data)
    except Exception as error:
        raise SetupError(f"MuJoCo cannot open its window: {error}") from error


class MuJoCoRobot(Backend):
    """A robot in a world of MuJoCo."""

    def __init__(self, spec: RobotSpec, world: MuJoCo) -> None:
        """Finds its parts; raises KeyError."""
        self.clock = self._world = world
        model, name = world.model, spec.name
        self._data, self._spec = world.data, spec
        self._body = model.body(name).id
        self._place = int(model.joint(int(model.body(name).jntadr[0])).qposadr[0])
        joints = [model.joint(f"{name}/{wheel}") for wheel in spec.wheels]
        self._motors = [model.actuator(f"{name}/{wheel}").id for wheel in spec.wheels]
        self._addresses = [int(joint.qposadr[0]) for joint in joints]
        known = [[float(value) for value in joint.user] for joint in joints]
        self._mounts = [(x, y) for _, x, y, _ in known]
        # rad/s by which the rate of a wheel may change in a step.
        self._changes = [
            acceleration / radius * world.time_step
            for radius, _, _, acceleration in known
        ]
        self._cones = {
            sensor: self._cone(sensor) for sensor in (*spec.sensors, *spec.bumpers)
        }
        self._rates = [0.0] * len(joints)
        self._targets: Sequence[float] = self._rates
        self._random = random.Random(f"{world.seed} {name}")  # noqa: S311 (the same seed gives the same run)
        self._slips = [self._random.gauss(0.0, world.slip) for _ in joints]
        self._angles, self._last = [0.0] * len(joints), [0.0] * len(joints)

    def wheel_mounts(self) -> Sequence[tuple[float, float]]:
        """The positions of the wheels on the body."""
        return self._mounts

    def pose(self) -> Pose:
        """The pose of the wheels' centre."""
        place, at = self._data.qpos, self._place
        w, x, y, z = (float(value) for value in place[at + 3 : at + 7])
        theta = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        return Pose(float(place[at]), float(place[at + 1]), theta)

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets the rates of the wheels in rad/s, forward if positive."""
        self._targets = list(rates)

    def drive_wheels(self) -> None:
        """Tells the motors their rates for the next step."""
        for index, (target, change) in enumerate(
            zip(self._targets, self._changes, strict=True)
        ):
            rate = self._rates[index]
            rate += max(-change, min(change, target - rate))
            self._rates[index] = rate
            self._data.ctrl[self._motors[index]] = rate * (1.0 + self._slips[index])

    def measure(self) -> None:
        """Adds a step to the angles of the wheels; what slips is not measured."""
        kept = math.exp(-self._world.time_step / SLIP_TIME)
        for index, address in enumerate(self._addresses):
            angle = float(self._data.qpos[address])
            self._angles[index] += (angle - self._last[index]) / (
                1.0 + self._slips[index]
            )
            self._last[index] = angle
            if self._world.slip > 0.0:
                drawn = self._random.gauss(0.0, self._world.slip)
                slip = kept * self._slips[index] + math.sqrt(1.0 - kept * kept) * drawn
                self._slips[index] = max(-0.9, min(0.9, slip))

    def wheel_angles(self) -> Sequence[float]:
        """The angles of the wheels in radians."""
        return list(self._angles)

    def sensor_cone(self, sensor: str) -> SensorCone:
        """The mount and detection volume of a sensor."""
        return self._cones[sensor]

    def distance(self, sensor: str) -> float | None:
        """The distance that a sensor measures, by rays that end at anything but the robot itself."""
        cone, world = self._cones[sensor], self._world
        reach, opening = cone.range or 0.0, cone.angle or 0.0
        world.place_bodies()
        site = self._data.site(f"{self._spec.name}/{sensor}")
        eye = cone.mount.transformed_by(self.pose())
        count = 2 * math.ceil(opening / 2.0 / RAY_SPACING) + 1
        angles = eye.theta + np.linspace(-opening / 2.0, opening / 2.0, count)
        # A robot that pitches while it brakes still looks ahead.
        rays = np.stack([np.cos(angles), np.sin(angles), np.zeros(count)], axis=1)
        bodies, distances = np.zeros(count, dtype=np.int32), np.zeros(count)
        mujoco.mj_multiRay(
            world.model,
            world.data,
            np.array([eye.x, eye.y, float(site.xpos[2])]),
            rays.ravel(),
            SEEN,
            1,
            self._body,
            bodies,
            distances,
            None,
            count,
            reach,
        )
        found = distances[(bodies >= 0) & (distances <= reach)]
        if found.size == 0:
            return None
        nearest = float(found.min())
        if world.sensor_noise > 0.0:
            nearest += self._random.gauss(0.0, world.sensor_noise)
        return max(0.0, nearest)

    def stall_reason(self) -> str:
        """Why the robot may not move although its wheels should turn."""
        _, x, y, _ = self._data.qpos[self._place + 3 : self._place + 7]
        upright = 1.0 - 2.0 * float(x * x + y * y)
        if upright < math.cos(TIPPED):
            return "it has tipped over"
        return "an obstacle may be in the way, or the wheels spin on a slippery floor"

    def _cone(self, sensor: str) -> SensorCone:
        site = self._world.model.site(f"{self._spec.name}/{sensor}")
        x, y, _ = (float(value) for value in site.pos)
        w, _, _, z = (float(value) for value in site.quat)
        reach, opening = (float(value) for value in site.user)
        return SensorCone(Pose(x, y, 2.0 * math.atan2(z, w)), reach, opening)
