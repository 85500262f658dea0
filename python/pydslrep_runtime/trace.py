"""The trace of a run."""

import json
from collections.abc import Mapping, Sequence
from typing import TextIO

from .places import Place
from .pose import Pose


class Trace:
    """Writes one JSON line per robot and step."""

    def __init__(self, file: TextIO | None = None) -> None:
        self._file = file
        self.is_written = file is not None

    def add(
        self,
        time: float,
        robot: str,
        pose: Pose,
        wheels: Sequence[float],
        place: Place,
        action: str,
        readings: Mapping[str, float | None],
    ) -> None:
        """Writes a line: seconds, metres, radians, the wheels' rad/s, the action with its number, and what sensors read."""
        if self._file is None:
            return
        row: dict[str, object] = {
            "t": round(time, 6),
            "robot": robot,
            "x": round(pose.x, 6) + 0.0,  # no -0
            "y": round(pose.y, 6) + 0.0,
            "theta": round(pose.theta, 6) + 0.0,
            "wheels": [round(rate, 6) + 0.0 for rate in wheels],
            "movement": place.movement,
            "action": action,
        }
        if place.line is not None:
            row["line"] = place.line
        row |= place.parts()
        if readings:
            row["readings"] = {
                sensor: None if distance is None else round(distance, 6) + 0.0
                for sensor, distance in readings.items()
            }
        self._file.write(json.dumps(row) + "\n")
