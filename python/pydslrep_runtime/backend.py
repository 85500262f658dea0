"""Backends: what the runtime needs from a robot in order to drive it.

`coppeliasim` and `vrep` contain the backends of the simulators. To drive a robot of your own, derive a class from
`Backend` and name it on the command line: `python3 patrol.py --robot my_robot:Rover`.
"""

import importlib
import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from .errors import SetupError, SimulatorError
from .facts import TypeName
from .pose import Pose
from .ros2_topics import Mounts, Ros2Settings


@dataclass(frozen=True)
class RobotSpec:
    """A robot as the program declares it."""

    name: str
    host: str
    port: int
    wheels: Mapping[str, float]  # radius in metres by name, in the order of the drive
    sensors: Sequence[str] = ()  # distance sensors that an action reads
    bumpers: Sequence[str] = ()  # bumpers that an action reads
    # The paths of itself and its parts in the simulator's scene, by name, if their names are others there.
    objects: Mapping[str, Sequence[str]] = field(default_factory=dict)
    type: TypeName = "tw"
    ros2: Ros2Settings = field(default_factory=Ros2Settings)
    mounts: Mounts = field(default_factory=dict)  # of sensors, if the script knows them


@dataclass(frozen=True)
class SensorCone:
    """The mount and detection volume of a distance sensor."""

    mount: Pose  # relative to the wheels' centre; the sensor points along its heading
    range: float | None = None  # m; None if unknown
    angle: float | None = None  # radians from edge to edge; None if unknown


class Clock(Protocol):
    """The time of one robot, or of all robots in one simulator."""

    time: float
    """Seconds, after the latest step."""
    time_step: float
    """Seconds between two steps."""

    def advance(self) -> None:
        """Returns after the next step; raises SimulatorError."""


class RealTimeClock:
    """The clock of a physical robot."""

    def __init__(self, time_step: float = 0.02) -> None:
        """`time_step` is in seconds; 0.02 to 0.05 is a good choice."""
        self.time = 0.0
        self.time_step = time_step
        self._start = self._step_due = -math.inf

    def advance(self) -> None:
        """Waits until `time_step` seconds have passed since the last step."""
        now = time.monotonic()
        if self._start == -math.inf:
            self._start = now
        # After a pause, time does not catch up.
        self._step_due = max(self._step_due + self.time_step, now)
        time.sleep(self._step_due - now)
        self.time = time.monotonic() - self._start


class Backend(Protocol):
    """One robot.

    A class of your own is called with a `RobotSpec`. It raises SetupError if it cannot reach its robot; its methods raise
    SimulatorError, which ends the action with a message. It has to define `clock`, `wheel_mounts`, `pose` and
    `set_wheel_rates`; the rest only as far as the program needs it.
    """

    clock: Clock

    def wheel_mounts(self) -> Sequence[tuple[float, float]]:
        """The positions of the wheels on the body, in the order of the drive.

        x is ahead and y to the left, in metres; the origin does not matter.
        """

    def pose(self) -> Pose:
        """The pose of the wheels' centre after the latest step: metres and radians, counter-clockwise."""

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets the rates of the wheels in rad/s, forward if positive. They hold until the next call."""

    def detects(self, sensor: str) -> bool:
        """Whether a distance sensor or bumper detects an object. Needed for conditions and `turn_until_free`."""
        return self.distance(sensor) is not None

    def distance(self, sensor: str) -> float | None:
        """The distance in metres that a sensor measures; None if it detects nothing.

        Needed for `slam`, and for conditions with `within`.
        """
        raise SimulatorError(
            f"{type(self).__name__} does not read sensors, such as {sensor}"
        )

    def reading_age(self, sensor: str) -> float:  # noqa: ARG002
        """How old the reading of a sensor is, in seconds; infinite if it has none yet.

        Conditions fail with one that is too old. Not needed where sensors measure when they are read, or in every step.
        """
        return 0.0

    def sensor_cone(self, sensor: str) -> SensorCone:
        """The mount and detection volume of a sensor. Needed for `slam`."""
        raise SimulatorError(
            f"{type(self).__name__} does not know the mount of sensor {sensor}"
        )

    def wheel_angles(self) -> Sequence[float]:
        """The angles of the wheels in radians, forward if positive. Needed for `slam` by odometry."""
        raise SimulatorError(
            f"{type(self).__name__} does not measure the angles of its wheels"
        )

    def stall_reason(self) -> str:
        """Why the robot may not move although its wheels should turn."""
        return "an obstacle may be in the way"

    def crawl_reason(self) -> str:
        """Why the robot may be slower than planned."""
        return "something may brake it"

    def stop(self) -> None:
        """Stops the wheels, at the end and after any error. May be called twice."""
        self.set_wheel_rates([0.0] * len(self.wheel_mounts()))

    def close(self) -> None:
        """Releases the robot; the last call."""
        return


# What classes may lack that are not derived from Backend: it was not asked for in earlier versions.
OPTIONAL = {"reading_age"}

METHODS = tuple(
    name
    for name, value in vars(Backend).items()
    if callable(value) and not name.startswith("_") and name not in OPTIONAL
)


def load_backend(name: str) -> Callable[[RobotSpec], Backend]:
    """The class that MODULE:CLASS names, ready to be called; raises SetupError."""
    module_name, _, class_name = name.partition(":")
    try:
        module = importlib.import_module(module_name)
    except ModuleNotFoundError as error:
        # Anything else that the module itself cannot import is shown with its traceback.
        if error.name != module_name.partition(".")[0] and error.name != module_name:
            raise
        raise SetupError(
            f"there is no Python module {module_name}; it must be in the folder of the script or on Python's path"
        ) from error
    factory = getattr(module, class_name, None)
    if not callable(factory):
        raise SetupError(f"module {module_name} has no class {class_name}")

    def backend(spec: RobotSpec) -> Backend:
        robot: Backend = factory(spec)
        if missing := [
            what for what in ("clock", *METHODS) if not hasattr(robot, what)
        ]:
            raise SetupError(
                f"{name} lacks {', '.join(missing)}: derive it from pydslrep_runtime.Backend"
            )
        return robot

    return backend
