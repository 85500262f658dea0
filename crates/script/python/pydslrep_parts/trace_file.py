#: if standalone
"""The trace of a run."""

import json
from collections.abc import Sequence
from typing import TextIO

from .pose import Pose

#: endif


class Trace:
    """Collects one row per robot and step, and writes them as JSON lines by time."""

    def __init__(self, file: TextIO | None) -> None:
        self._file = file
        self._rows: list[tuple[float, str, str]] = []

    def add(
        self,
        time: float,
        robot: str,
        pose: Pose,
        wheels: Sequence[float],
        movement: str,
        action: str,
    ) -> None:
        """Adds a row: seconds, metres, radians, and the wheels' rad/s."""
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
        self._rows.append((time, robot, json.dumps(row)))

    def write(self) -> None:
        """Writes the rows added since the last call."""
        if self._file is not None:
            # Robots that drive in parallel add their rows in any order.
            self._rows.sort(key=lambda row: (round(row[0], 6), row[1]))
            self._file.writelines(f"{row}\n" for _, _, row in self._rows)
            self._file.flush()
            self._rows.clear()
