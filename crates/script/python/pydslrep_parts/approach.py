#: if standalone
"""Speed ramps, arrival and standstill."""

import math

from .settings import ARRIVED, CLOSE, CLOSE_TIME, RIM_ACCELERATION, STALL_TIME

#: endif


class Approach:
    """Brings one action to its goal: its speed, its arrival, and whether it is stuck.

    Distances are metres at the rim of the wheels, so that moves and turns are alike.
    """

    def __init__(self, top_speed: float, time_step: float) -> None:
        self.time_step = time_step
        self.top_speed = top_speed
        self.speed = 0.0
        # Near the goal the speed is proportional to the distance (1/s): half of it per step,
        # which wheels that follow with a delay survive without swinging.
        self._closing_rate = min(10.0, 0.5 / time_step)
        self._close_steps = 0
        self._nearest = math.inf
        self._steps_without_progress = 0

    def next_speed(self, to_go: float) -> float:
        """The signed rim speed for the next step with `to_go` left."""
        gain = self.speed + math.copysign(RIM_ACCELERATION * self.time_step, to_go)
        braking = self._braking_speed(abs(to_go))
        wanted = math.copysign(min(self.top_speed, braking), to_go)
        self.speed = min(gain, wanted) if to_go > 0.0 else max(gain, wanted)
        return self.speed

    def _braking_speed(self, distance: float) -> float:
        """The speed from which the ramp down ends at the goal: a root, then a line."""
        # Speeds hold for a whole step, in which the curve goes on falling: start earlier.
        deceleration = 0.75 * RIM_ACCELERATION
        linear = deceleration / self._closing_rate**2
        if distance < linear:
            return self._closing_rate * distance
        return math.sqrt(2.0 * deceleration * (distance - linear / 2.0))

    #: if until or slam
    def slowed_down(self) -> float:
        """The rim speed for the next step where the robot shall come to rest."""
        change = RIM_ACCELERATION * self.time_step
        self.speed = math.copysign(max(0.0, abs(self.speed) - change), self.speed)
        return self.speed

    #: endif
    def arrived(self, to_go: float) -> bool:
        """Whether the goal is reached, or as near as it will get."""
        self._close_steps = self._close_steps + 1 if abs(to_go) <= CLOSE else 0
        close_time = self._close_steps * self.time_step
        return abs(to_go) <= ARRIVED or close_time > CLOSE_TIME

    def stalled(self, to_go: float) -> bool:
        """Whether the robot has come no nearer to its goal for STALL_TIME."""
        least = min(0.001, 0.25 * self.top_speed * STALL_TIME)
        if abs(to_go) < self._nearest - least:
            self._nearest = abs(to_go)
            self._steps_without_progress = 0
        self._steps_without_progress += 1
        return self._steps_without_progress * self.time_step > STALL_TIME
