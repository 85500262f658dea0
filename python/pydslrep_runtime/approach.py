"""Speed ramps, arrival and standstill."""

import math
from collections.abc import Callable

from .facts import RIM_ACCELERATION
from .pace import Pace
from .pose import Pose
from .settings import ARRIVAL_TOLERANCE, CLOSE_TOLERANCE, END_DISTANCE, STALL_TIME

# Near the goal, a robot that does not get to this share of its distance within so many steps has arrived: the motion is
# below the tremor of its contacts, or its motors do not turn that slowly.
CLOSE_PROGRESS = 0.9
CLOSE_STEPS = 4
CLOSE_TIME = 1.0  # s that a slow action has for it, at most
# Motors that are slower under load stop before the goal, where they are told to be slow: a robot that has moved less than
# this share of its way in so many steps is told to be faster by ever more.
PUSH_SHARE, PUSH_STEPS = 0.5, 5
PUSH_DISTANCE = 0.01  # m from the goal, at most
PUSH_TIME = 0.2  # s in which what it is told near its goal doubles
CLOSING_RATE, CLOSING_SHARE = 10.0, 0.6  # 1/s, and of the distance per step
CRAWL = 2.0  # times its planned duration, and the time of a stall, after which an action crawls


class Approach:
    """Controls the speed of one action, and detects its arrival or a stall.

    Distances are in metres at the wheels' rims, for moves and turns alike.
    """

    def __init__(
        self, top_speed: float, pace: Pace, tolerance: float = END_DISTANCE
    ) -> None:
        """Within `tolerance` metres of its goal, a robot that stands still has arrived."""
        self.tolerance = tolerance
        self.top_speed = top_speed
        self.speed = 0.0
        self._pace = pace
        # An action may be as slow as that by itself.
        slow_steps = (
            2.0 * (1.0 - CLOSE_PROGRESS) * CLOSE_TOLERANCE / (top_speed * pace.usual)
        )
        self._close_limit = max(CLOSE_STEPS, min(slow_steps, CLOSE_TIME / pace.usual))
        self._push = 0.0  # m/s
        self._before = math.inf  # metres to go one step ago
        self._stuck_steps = 0
        self._close_steps = 0
        self._closest = math.inf
        self._nearest = math.inf
        self._progress_time = math.nan
        self._start_time = self._way = math.nan

    def next_speed(self, remaining: float) -> float:
        """The signed rim speed for the next step, with `remaining` metres to go."""
        self._observe_standstill(remaining)
        gain = self.speed + math.copysign(RIM_ACCELERATION * self._pace.last, remaining)
        braking = self._braking_speed(abs(remaining))
        wanted = math.copysign(min(self.top_speed, braking + self._push), remaining)
        self.speed = min(gain, wanted) if remaining > 0.0 else max(gain, wanted)
        return self.speed

    def _braking_speed(self, distance: float) -> float:
        """The speed from which braking ends at the goal: a root, then a line."""
        # A speed holds for a whole step while the braking curve falls, so brake early.
        deceleration = 0.75 * RIM_ACCELERATION
        # Near the goal the speed is proportional to the distance (1/s), and takes a robot over no more than a share of
        # it per step, so that wheels with a delay do not oscillate.
        closing_rate = min(CLOSING_RATE, CLOSING_SHARE / self._pace.usual)
        linear = deceleration / closing_rate**2
        if distance < linear:
            return closing_rate * distance
        return math.sqrt(2.0 * deceleration * (distance - linear / 2.0))

    def _observe_standstill(self, remaining: float) -> None:
        """Pushes a robot that stands still shortly before its goal."""
        distance = abs(remaining)
        moved, was_before = abs(self._before) - distance, self._before * remaining > 0.0
        self._before = remaining
        if distance > PUSH_DISTANCE or not was_before:
            self._push, self._stuck_steps = 0.0, 0
        elif moved >= PUSH_SHARE * abs(self.speed) * self._pace.last:
            self._stuck_steps = 0
        elif distance > CLOSE_TOLERANCE:
            self._stuck_steps += 1
            if self._stuck_steps >= PUSH_STEPS:
                self._push += CLOSING_RATE * distance * self._pace.last / PUSH_TIME

    def decelerate(self) -> float:
        """The rim speed for the next step while braking to a stop."""
        change = RIM_ACCELERATION * self._pace.last
        self.speed = math.copysign(max(0.0, abs(self.speed) - change), self.speed)
        return self.speed

    def arrived(self, remaining: float) -> bool:
        """Whether the robot is at the goal, or near it and comes no nearer."""
        distance = abs(remaining)
        if distance > CLOSE_TOLERANCE:
            self._close_steps, self._closest = 0, math.inf
        elif distance < CLOSE_PROGRESS * self._closest:
            self._close_steps, self._closest = 0, distance
        else:
            self._close_steps += 1
        return distance <= ARRIVAL_TOLERANCE or self._close_steps >= self._close_limit

    def crawls(self, remaining: float, time: float) -> bool:
        """Whether the action takes far longer than planned, at a simulation time in seconds."""
        if math.isnan(self._start_time):
            self._start_time, self._way = time, abs(remaining)
        ramps = 2.0 * self.top_speed / RIM_ACCELERATION
        planned = self._way / self.top_speed + ramps
        return time - self._start_time > CRAWL * planned + STALL_TIME

    def stalled(self, remaining: float, time: float) -> bool:
        """Whether the robot has made no progress for STALL_TIME, at a simulation time in seconds."""
        least = min(0.001, 0.25 * self.top_speed * STALL_TIME)
        if abs(remaining) < self._nearest - least:
            self._nearest, self._progress_time = abs(remaining), time
        return time - self._progress_time > STALL_TIME - self._pace.usual / 2.0


class Brake:
    """Ends an action early: once it is on, the robot brakes until it stands."""

    def __init__(self, should_stop: Callable[[Pose], bool]) -> None:
        self._should_stop, self.is_on = should_stop, False

    def next_speed(self, approach: Approach, here: Pose, remaining: float) -> float:
        """The signed rim speed for the next step, with `remaining` metres to go."""
        self.is_on = self.is_on or self._should_stop(here)
        return approach.decelerate() if self.is_on else approach.next_speed(remaining)

    def has_stopped(self, approach: Approach) -> bool:
        """Whether the robot has braked to a stop."""
        return self.is_on and approach.speed == 0.0
