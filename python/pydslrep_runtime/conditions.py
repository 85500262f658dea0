"""Conditions: what sensors have to detect for an action to end, or for a block to run."""

from collections.abc import Collection
from dataclasses import dataclass

from .backend import Backend
from .errors import SimulatorError
from .pose import Pose
from .settings import MAX_READING_AGE

ROUNDING = 1e-9  # s


@dataclass(frozen=True)
class Condition:
    """Whether any of several sensors detects something. `detects` and `clear` make conditions."""

    sensors: tuple[str, ...]
    detection: bool  # whether it holds while one detects something, or while none does
    within: float | None = None  # m; what is further away does not count

    def __str__(self) -> str:
        """The condition in words."""
        if self.detection:
            # At least one: "a or b detects", "a, b or c detects".
            *others, last = self.sensors
            names = f"{', '.join(others)} or {last}" if others else last
            return f"{names} detects something{self._limit()}"
        return f"{', '.join(self.sensors)} {self._detect()} nothing{self._limit()}"

    def unmet(self) -> str:
        """What is the case while it does not hold."""
        what = "nothing" if self.detection else "something"
        names = ", ".join(self.sensors)
        return f"{names} still {self._detect()} {what}{self._limit()}"

    def holds(self, backend: Backend, bumpers: Collection[str]) -> bool:
        """Whether it holds after the latest step; raises SimulatorError if a sensor has no recent reading."""
        detection = any(
            self._counts(sensor, backend, sensor in bumpers) for sensor in self.sensors
        )
        return detection == self.detection

    def _counts(self, sensor: str, backend: Backend, is_bumper: bool) -> bool:
        """Whether a sensor detects something that counts."""
        age = backend.reading_age(sensor)
        if age > MAX_READING_AGE + ROUNDING:
            raise SimulatorError(
                f"the reading of sensor {sensor} is {age:.2f} s old; conditions need one of the last "
                f"{MAX_READING_AGE:g} s"
            )
        if self.within is None:
            return backend.detects(sensor)
        if is_bumper:
            return False  # it measures no distance
        distance = backend.distance(sensor)
        return distance is not None and distance < self.within

    def _detect(self) -> str:
        return "detects" if len(self.sensors) == 1 else "detect"

    def _limit(self) -> str:
        return "" if self.within is None else f" within {self.within:g} m"


def detects(*sensors: str, within: float | None = None) -> Condition:
    """The condition that at least one of the sensors detects something, nearer than `within` metres if that is given."""
    return _condition(sensors, True, within)


def clear(*sensors: str, within: float | None = None) -> Condition:
    """The condition that none of the sensors detects anything, or nothing nearer than `within` metres."""
    return _condition(sensors, False, within)


def _condition(
    sensors: tuple[str, ...], detection: bool, within: float | None
) -> Condition:
    if not sensors:
        raise ValueError("a condition needs a sensor")
    if within is not None and within <= 0.0:
        raise ValueError(f"nothing is nearer than {within:g} m")
    return Condition(sensors, detection, within)


class Watch:
    """Reads a condition during an action; once it has held, it counts as met."""

    def __init__(
        self, condition: Condition | None, backend: Backend, bumpers: Collection[str]
    ) -> None:
        """Without a condition, nothing is read."""
        self.condition, self.is_met = condition, False
        self._backend, self._bumpers = backend, bumpers

    def __call__(self, _here: Pose) -> bool:
        """Whether the condition holds or has held."""
        if self.condition is not None and not self.is_met:
            self.is_met = self.condition.holds(self._backend, self._bumpers)
        return self.is_met
