"""The trace of a run."""

import json
from collections.abc import Sequence
from typing import TextIO

from .pose import Pose


class Trace:
    """Writes one JSON line per robot and step."""

    def __init__(self, file: TextIO | None = None) -> None:
        self._file = file

    def add(
        self,
        time: float,
        robot: str,
        pose: Pose,
        wheels: Sequence[float],
        movement: str,
        action: str,
    ) -> None:
        """Writes a line: seconds, metres, radians, and the wheels' rad/s."""
        if self._file is None:
            return
        row = {
            "t": round(time, 6),
            "robot": robot,
            "x": round(pose.x, 6) + 0.0,  # no -0
            "y": round(pose.y, 6) + 0.0,
            "theta": round(pose.theta, 6) + 0.0,
            "wheels": [round(rate, 6) + 0.0 for rate in wheels],
            "movement": movement,
            "action": action,
        }
        self._file.write(json.dumps(row) + "\n")
