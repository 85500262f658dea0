"""A robot of a user's own, whose answers are checked as those of simulators are."""

from collections.abc import Sequence
from typing import Any

from .backend import Backend, Clock, RobotSpec, SensorCone
from .errors import SetupError, SimulatorError
from .pose import Pose
from .readings import (
    ANGLE,
    DISTANCE,
    LENGTH,
    MAX_ANGLE,
    MAX_LENGTH,
    TIME,
    TIME_STEP,
    Form,
    check,
    is_number,
    numbers,
    optional,
    shortened,
)

# Infinite if there is no reading yet.
AGE = Form("seconds, 0 or more", lambda value: is_number(value) and value >= 0.0)

TRUTH = Form("True or False", lambda value: isinstance(value, int))
POSE = Form("a Pose", lambda value: isinstance(value, Pose))
CONE = Form("a SensorCone", lambda value: isinstance(value, SensorCone))
DISTANCE_OR_NONE = optional(DISTANCE)


def is_sound(pose: Any) -> bool:
    """Whether a pose is one as it should be, with Python's own numbers: any other is looked at more closely."""
    return (
        type(pose) is Pose
        and type(pose.x) is type(pose.y) is type(pose.theta) is float
        and -MAX_LENGTH <= pose.x <= MAX_LENGTH
        and -MAX_LENGTH <= pose.y <= MAX_LENGTH
        and -MAX_ANGLE <= pose.theta <= MAX_ANGLE
    )


class CheckedBackend(Backend):
    """Passes on what another backend answers, if that can be."""

    def __init__(self, backend: Backend, spec: RobotSpec) -> None:
        """Raises SetupError if its clock is none."""
        self._backend, self._count = backend, len(spec.wheels)
        self._name = type(backend).__name__
        angles = numbers(self._count, self._count, MAX_ANGLE)
        self._angles = Form(
            f"the angles of {self._count} wheels",
            lambda value: isinstance(value, Sequence) and angles.accepts([*value]),
        )
        self.clock: Clock = backend.clock
        try:
            self._check(
                "clock.time_step", getattr(self.clock, "time_step", None), TIME_STEP
            )
            self._check("clock.time", getattr(self.clock, "time", None), TIME)
        except SimulatorError as error:
            raise SetupError(f"robot {spec.name}: {error}") from None

    def wheel_mounts(self) -> Sequence[tuple[float, float]]:
        """The positions of the wheels on the body."""
        mounts: Any = self._backend.wheel_mounts()
        point = numbers(2, 2, MAX_LENGTH)
        form = Form(
            f"the positions of {self._count} wheels",
            lambda value: (
                isinstance(value, Sequence)
                and len(value) == self._count
                and all(map(point.accepts, value))
            ),
        )
        self._check("wheel_mounts", mounts, form)
        return [(float(x), float(y)) for x, y in mounts]

    def pose(self) -> Pose:
        """The pose of the wheels' centre."""
        pose = self._backend.pose()
        return pose if is_sound(pose) else self._pose("pose", pose)

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets the rates of the wheels."""
        self._backend.set_wheel_rates(rates)

    def detects(self, sensor: str) -> bool:
        """Whether a sensor detects an object."""
        found: Any = self._backend.detects(sensor)
        # Those of numpy are not Python's own.
        found = found.item() if hasattr(found, "item") else found
        self._check("detects", found, TRUTH)
        return bool(found)

    def distance(self, sensor: str) -> float | None:
        """The distance that a sensor measures."""
        found = self._backend.distance(sensor)
        self._check("distance", found, DISTANCE_OR_NONE)
        return None if found is None else float(found)

    def reading_age(self, sensor: str) -> float:
        """How old the reading of a sensor is."""
        age_of = getattr(self._backend, "reading_age", None)
        age: Any = 0.0 if age_of is None else age_of(sensor)
        self._check("reading_age", age, AGE)
        return float(age)

    def sensor_cone(self, sensor: str) -> SensorCone:
        """The mount and detection volume of a sensor."""
        cone: Any = self._backend.sensor_cone(sensor)
        self._check("sensor_cone", cone, CONE)
        self._check("sensor_cone", cone.range, DISTANCE_OR_NONE)
        self._check("sensor_cone", cone.angle, DISTANCE_OR_NONE)
        return SensorCone(self._pose("sensor_cone", cone.mount), cone.range, cone.angle)

    def wheel_angles(self) -> Sequence[float]:
        """The angles of the wheels."""
        angles: Any = self._backend.wheel_angles()
        self._check("wheel_angles", angles, self._angles)
        return [float(angle) for angle in angles]

    def stall_reason(self) -> str:
        """Why the robot may not move although its wheels should turn."""
        return shortened(str(self._backend.stall_reason()))

    def stop(self) -> None:
        """Stops the wheels."""
        self._backend.stop()

    def close(self) -> None:
        """Releases the robot."""
        self._backend.close()

    def _pose(self, call: str, pose: Any) -> Pose:
        self._check(call, pose, POSE)
        for axis, form in (("x", LENGTH), ("y", LENGTH), ("theta", ANGLE)):
            self._check(f"{call}().{axis}", getattr(pose, axis), form)
        return Pose(float(pose.x), float(pose.y), float(pose.theta))

    def _check(self, call: str, value: Any, form: Form) -> None:
        if not form.accepts(value):  # most do: then there is no name to put together
            check(f"{self._name}.{call}", value, form)
