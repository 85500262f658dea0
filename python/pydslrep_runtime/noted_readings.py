"""What a robot's sensors read, noted for its trace."""

from collections.abc import Collection
from contextlib import suppress
from typing import Any

from .backend import Backend
from .errors import SimulatorError


class NotedReadings:
    """Stands in for a backend, and notes what is read of the robot's sensors."""

    def __init__(self, backend: Backend, bumpers: Collection[str]) -> None:
        self._backend, self._bumpers = backend, bumpers
        self._noted: dict[str, float | None] = {}

    def __getattr__(self, name: str) -> Any:
        return getattr(self._backend, name)

    def detects(self, sensor: str) -> bool:
        """Whether a distance sensor or bumper detects an object."""
        found = self._backend.detects(sensor)
        if not found:
            self._noted[sensor] = None
        elif sensor in self._bumpers:
            self._noted[sensor] = 0.0
        else:
            # A class of the user's own may have no more to tell than that something is there.
            with suppress(SimulatorError):
                self.distance(sensor)
        return found

    def distance(self, sensor: str) -> float | None:
        """The distance in metres that a sensor measures; None if it detects nothing."""
        found = self._backend.distance(sensor)
        self._noted[sensor] = found
        return found

    def take(self) -> dict[str, float | None]:
        """What has been read since the last call: metres or None by the sensors' names; 0 for a bumper that is pressed."""
        noted, self._noted = self._noted, {}
        return noted
