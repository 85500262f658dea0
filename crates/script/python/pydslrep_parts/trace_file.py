#: if standalone
"""What a run leaves for others to read."""

import json
from collections.abc import Sequence
from typing import TextIO

from .pose import Pose

#: endif


class Trace:
    """Collects a row per robot and step, and writes them as JSON lines in order of time."""

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
        """Keeps a row: seconds, metres, radians, and rad/s of the wheels."""
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
        """Writes what has been collected since the last time."""
        if self._file is not None:
            # Robots that drive at the same time add their rows in any order.
            self._rows.sort(key=lambda row: (round(row[0], 6), row[1]))
            self._file.writelines(f"{row}\n" for _, _, row in self._rows)
            self._file.flush()
            self._rows.clear()
