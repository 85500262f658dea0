"""Speed ramps, arrival and standstill."""

import math
from collections.abc import Callable

from .facts import RIM_ACCELERATION
from .pace import Pace
from .pose import Pose
from .settings import ARRIVAL_TOLERANCE, CLOSE_TOLERANCE, END_DISTANCE, STALL_TIME

NEAR = 0.01  # m from the goal
# Within CLOSE_TOLERANCE, a robot that does not get to this share of its distance within so many steps has arrived: the motion
# is below the tremor of its contacts, or its motors do not turn that slowly.
CLOSE_PROGRESS = 0.9
CLOSE_STEPS = 4
CLOSE_TIME = 1.0  # s that a slow action has for it, at most
# And so has one that has moved less than this share of what it was told, twice: its motors only just turn.
SLOW_SHARE, SLOW_STEPS = 0.8, 2
# One that has passed its goal does not come back from so many metres, where it comes to rest after half its latest step:
# wheels that follow late would have it swing about the goal for longer than a step is worth.
PASSED = 0.003
# Motors that are slower under load stop before the goal, where they are told to be slow: a robot that has moved less than
# this share of its way in so many steps is told to be faster by ever more.
PUSH_SHARE, PUSH_STEPS = 0.5, 5
PUSH_TIME = 0.2  # s in which what it is told near its goal doubles
# By so many m/s a robot may be too slow near its goal that are added at once.
LOSS = 0.003
CLOSING_RATE, CLOSING_SHARE = 10.0, 0.6  # 1/s, and of the distance per step
# A speed holds for a whole step while the braking curve falls, so brake early.
BRAKING = 0.75 * RIM_ACCELERATION
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
        self._is_near = False
        self._push = self._lost = 0.0  # m/s, near the goal
        self._before = math.inf  # metres to go one step ago
        self._stuck_steps = self._slow_steps = 0
        self._close_steps = 0
        self._closest = math.inf
        self._usual = math.nan  # s of a step that the two following are for
        self._closing_rate = self._braking_way = math.nan
        self._nearest = math.inf
        self._min_progress = min(0.001, 0.25 * top_speed * STALL_TIME)
        self._progress_time = self._crawl_time = math.nan

    def next_speed(self, remaining: float) -> float:
        """The signed rim speed for the next step, with `remaining` metres to go."""
        if self._usual != self._pace.usual:
            self._adapt()
        change = RIM_ACCELERATION * self._pace.last
        distance, wanted = abs(remaining), self.top_speed
        if distance < self._braking_way:
            wanted = self._braking_speed(distance)
            if self._is_near:
                wanted += self._lost + self._push
            wanted = min(wanted, self.top_speed)
        if remaining > 0.0:
            self.speed = min(self.speed + change, wanted)
        else:
            self.speed = max(self.speed - change, -wanted)
        return self.speed

    def _adapt(self) -> None:
        """Adapts the approach to how long steps take."""
        # Near the goal the speed is proportional to the distance (1/s), and takes a robot over no more than a share of it
        # per step, so that wheels with a delay do not oscillate.
        self._usual = self._pace.usual
        self._closing_rate = min(CLOSING_RATE, CLOSING_SHARE / self._usual)
        line = BRAKING / self._closing_rate**2
        root = self.top_speed**2 / (2.0 * BRAKING) + line / 2.0
        # From there on the way is a line for slow actions, too.
        self._braking_way = max(root, line, self.top_speed / self._closing_rate)

    def _braking_speed(self, distance: float) -> float:
        """The speed from which braking ends at the goal: a root, then a line."""
        line = BRAKING / self._closing_rate**2
        if distance < line:
            return self._closing_rate * distance
        return math.sqrt(2.0 * BRAKING * (distance - line / 2.0))

    def decelerate(self) -> float:
        """The rim speed for the next step while braking to a stop."""
        change = RIM_ACCELERATION * self._pace.last
        self.speed = math.copysign(max(0.0, abs(self.speed) - change), self.speed)
        return self.speed

    def arrived(self, remaining: float) -> bool:
        """Whether the robot is at the goal, or near it and comes no nearer."""
        before, self._before = self._before, remaining
        distance = abs(remaining)
        if distance > NEAR:
            self._is_near = False
            return False
        if not self._is_near or before * remaining <= 0.0:
            self._is_near, self._push, self._lost = True, 0.0, 0.0
            self._stuck_steps = self._slow_steps = 0
        if before * remaining < 0.0 and self._comes_to_rest(before, remaining):
            return True
        if before * remaining > 0.0 and abs(before) < math.inf:
            self._observe_step(abs(before) - distance, distance)
        return distance <= ARRIVAL_TOLERANCE or self._comes_no_nearer(distance)

    def _comes_to_rest(self, before: float, remaining: float) -> bool:
        """Whether a robot that has passed its goal will stand near enough."""
        rest = abs(remaining) + abs(before - remaining) / 2.0
        return rest < min(PASSED, self.tolerance)

    def _observe_step(self, moved: float, distance: float) -> None:
        """Helps a robot that moves less near its goal than it was told, and counts its steps."""
        elapsed = self._pace.last
        told = abs(self.speed) * elapsed
        self._lost = max(0.0, min(LOSS, (told - moved) / elapsed)) if elapsed else 0.0
        self._slow_steps = self._slow_steps + 1 if moved < SLOW_SHARE * told else 0
        if moved >= PUSH_SHARE * told:
            self._stuck_steps = 0
        elif distance > CLOSE_TOLERANCE:
            self._stuck_steps += 1
            if self._stuck_steps >= PUSH_STEPS:
                self._push += CLOSING_RATE * distance * elapsed / PUSH_TIME

    def _comes_no_nearer(self, distance: float) -> bool:
        if distance > CLOSE_TOLERANCE:
            self._close_steps, self._closest = 0, math.inf
            return False
        if distance < CLOSE_PROGRESS * self._closest:
            self._close_steps, self._closest = 0, distance
        else:
            self._close_steps += 1
        if self._slow_steps >= SLOW_STEPS:
            return True
        return self._close_steps >= self._close_limit

    def progresses(self, remaining: float, time: float) -> bool:
        """Whether the robot comes nearer and does not crawl, at a simulation time in seconds."""
        distance = abs(remaining)
        if distance < self._nearest - self._min_progress:
            self._nearest, self._progress_time = distance, time
            return time <= self._crawl_time
        return False

    def crawls(self, remaining: float, time: float) -> bool:
        """Whether the action takes far longer than planned, at a simulation time in seconds."""
        if math.isnan(self._crawl_time):
            ramps = 2.0 * self.top_speed / RIM_ACCELERATION
            planned = abs(remaining) / self.top_speed + ramps
            self._crawl_time = time + CRAWL * planned + STALL_TIME
        return time > self._crawl_time

    def stalled(self, remaining: float, time: float) -> bool:
        """Whether the robot has made no progress for STALL_TIME, at a simulation time in seconds."""
        self.progresses(remaining, time)
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
