"""What a script says while it waits."""

import math
import time
from collections.abc import Mapping

from . import events
from .pose import Pose


class Notes:
    """Says each thing once."""

    def __init__(self) -> None:
        self._said: set[str] = set()

    def say_paused(self) -> None:
        """Says that the simulation is paused."""
        self.say("the simulation is paused; this script waits until it goes on")

    def say_running(self, time: float, robots: Mapping[str, Pose]) -> None:
        """Says that the simulation runs already, and where robots start: a run may have ended in the middle."""
        places = ", ".join(
            f"{name} at x {pose.x:.2f} m, y {pose.y:.2f} m, {math.degrees(pose.theta):.0f} deg"
            for name, pose in robots.items()
        )
        self.say(
            f"the simulation is running already, at {time:.2f} s, and goes on: {places}. "
            "With --restart it is stopped first, which puts everything back"
        )

    def say(self, note: str) -> None:
        """Says something, once."""
        if note not in self._said:
            self._said.add(note)
            events.current.note(note)


def pause(seconds: float = 0.1) -> None:
    """Lets real time pass."""
    time.sleep(seconds)
