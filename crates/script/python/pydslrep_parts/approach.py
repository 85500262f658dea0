#: if standalone
"""Speed ramps, arrival and standstill."""

import math

from .settings import (
    ARRIVAL_TOLERANCE,
    CLOSE_TIME,
    CLOSE_TOLERANCE,
    RIM_ACCELERATION,
    STALL_TIME,
)

#: endif


class Approach:
    """Controls the speed of one action, and detects its arrival or a stall.

    Distances are in metres at the wheels' rims, for moves and turns alike.
    """

    def __init__(self, top_speed: float, time_step: float) -> None:
        self.time_step = time_step
        self.top_speed = top_speed
        self.speed = 0.0
        # Near the goal the speed is proportional to the distance (1/s): at most half of it
        # per step, so that wheels with a delay do not oscillate.
        self._closing_rate = min(10.0, 0.5 / time_step)
        self._close_steps = 0
        self._nearest = math.inf
        self._steps_without_progress = 0

    def next_speed(self, remaining: float) -> float:
        """The signed rim speed for the next step, with `remaining` metres to go."""
        gain = self.speed + math.copysign(RIM_ACCELERATION * self.time_step, remaining)
        braking = self._braking_speed(abs(remaining))
        wanted = math.copysign(min(self.top_speed, braking), remaining)
        self.speed = min(gain, wanted) if remaining > 0.0 else max(gain, wanted)
        return self.speed

    def _braking_speed(self, distance: float) -> float:
        """The speed from which braking ends at the goal: a root, then a line."""
        # A speed holds for a whole step while the braking curve falls, so brake early.
        deceleration = 0.75 * RIM_ACCELERATION
        linear = deceleration / self._closing_rate**2
        if distance < linear:
            return self._closing_rate * distance
        return math.sqrt(2.0 * deceleration * (distance - linear / 2.0))

    #: if until or slam
    def decelerate(self) -> float:
        """The rim speed for the next step while braking to a stop."""
        change = RIM_ACCELERATION * self.time_step
        self.speed = math.copysign(max(0.0, abs(self.speed) - change), self.speed)
        return self.speed

    #: endif
    def arrived(self, remaining: float) -> bool:
        """Whether the robot is at the goal, or stays near it."""
        self._close_steps = (
            self._close_steps + 1 if abs(remaining) <= CLOSE_TOLERANCE else 0
        )
        close_time = self._close_steps * self.time_step
        return abs(remaining) <= ARRIVAL_TOLERANCE or close_time > CLOSE_TIME

    def stalled(self, remaining: float) -> bool:
        """Whether the robot has made no progress for STALL_TIME."""
        least = min(0.001, 0.25 * self.top_speed * STALL_TIME)
        if abs(remaining) < self._nearest - least:
            self._nearest = abs(remaining)
            self._steps_without_progress = 0
        self._steps_without_progress += 1
        return self._steps_without_progress * self.time_step > STALL_TIME
