#: if standalone
"""How robots carry out their actions."""

import math
from collections.abc import Callable, Sequence
from threading import Event
from typing import Literal

from .approach import Approach
from .coppeliasim import Body
from .errors import MovementCancelledError, MovementError
from .odometer import Odometer
from .pose import Pose, wrap_angle
from .settings import MOST_ASIDE, RIM_SPEED, STALL_TIME
from .slam_rover import survey_with
from .slam_session import Survey
from .trace_file import Trace

#: endif


class Robot:
    """A robot that moves and turns: a command per step, from the pose it has by then.

    Every action starts where the last one should have ended, so errors do not add up.
    """

    def __init__(self, body: Body, trace: Trace) -> None:
        self.body = body
        self._trace = trace
        self._planned: Pose | None = None
        self._rates: Sequence[float] = ()
        self._movement = self._action = ""
        self._actions = 0
        #: if parallel
        self.cancelled = Event()
        #: endif
        #: if slam
        self.survey: Survey | None = None
        self._watch: Callable[[Pose], object] | None = None
        self._odometer: Odometer | None = None
        #: endif

    def move(self, distance: float, speed: float = RIM_SPEED) -> None:
        """Drives straight on, in metres (backwards where negative) and m/s."""
        here = self._begin(f"move {distance:g} m")
        goal = self._start(here).ahead(distance)
        approach = Approach(speed, self.body.time_step)
        while True:
            offset = here.seen_from(goal)
            to_go = -offset.x
            if approach.arrived(to_go):
                break
            self._check_progress(approach, to_go)
            rim_speed = approach.next_speed(to_go)
            here = self._step(self.body.drive.follow_line(rim_speed, offset, to_go))
        self._planned = goal
        here = self._come_to_rest(here)
        self._check_arrival(here.seen_from(goal).y)
        # It may have come to rest slightly turned.
        here = self._rotate(here, 0.0)
        self._report(here)

    def turn(self, degrees: float) -> None:
        """Turns in place, to the left where positive."""
        side = "left" if degrees >= 0.0 else "right"
        here = self._begin(f"turn {side} {abs(degrees):g} deg")
        here = self._rotate(here, math.radians(degrees))
        self._report(here)

    #: if until
    def turn_until_free(self, side: Literal["left", "right"], *sensors: str) -> None:
        """Turns in place until none of the sensors detects anything."""
        names = ", ".join(sensors)
        nothing = "detects nothing" if len(sensors) == 1 else "detect nothing"
        here = self._begin(f"turn {side} until {names} {nothing}")
        here = self._step(
            self._standstill()
        )  # before the first step, sensors are blind
        start = self._start(here)
        radius = self.body.drive.turning_radius
        full_turn = math.tau * radius * (1.0 if side == "left" else -1.0)
        approach = Approach(RIM_SPEED, self.body.time_step)
        turned = 0.0
        while (busy := any(map(self.body.detects, sensors))) or approach.speed != 0.0:
            to_go = full_turn - turned * radius
            if approach.arrived(to_go):
                still = "detects" if len(sensors) == 1 else "detect"
                raise self.failure(f"after a full turn {names} still {still} something")
            self._check_progress(approach, to_go)
            rim_speed = approach.next_speed(to_go) if busy else approach.slowed_down()
            offset, before = here.seen_from(start), here
            here = self._step(self.body.drive.turn_in_place(rim_speed, offset))
            turned += wrap_angle(here.theta - before.theta)
        here = self._come_to_rest(here)
        self._planned = Pose(start.x, start.y, here.theta)
        self._report(here)

    #: endif
    #: if slam
    def slam(self) -> None:
        """Explores a closed area and makes a map of it."""
        self._begin("slam")
        # Before the first step, sensors are blind.
        self._planned = self._step(self._standstill())
        if self.survey is not None:
            if self.survey.by_odometry:
                self._odometer = Odometer(self.body)
            survey_with(self, self.survey)
        self._report(self.pose())

    def pose(self) -> Pose:
        """Where the robot is, or should be by how its wheels turned."""
        return self._locate()

    def correct(self, pose: Pose) -> None:
        """The robot is somewhere else than its wheels have it."""
        if self._odometer is not None:
            self._odometer.correct(pose)
            self._planned = pose

    def rolled(self) -> float:
        """How far the wheels have rolled, in metres; by odometry only."""
        return self._odometer.rolled if self._odometer is not None else 0.0

    def rotate(
        self, angle: float, heed: Callable[[Pose], object], speed: float = RIM_SPEED
    ) -> None:
        """Turns in place, to the left where positive, and shows every pose on the way."""
        self._watch = heed
        try:
            self._rotate(self.pose(), angle, speed)
        finally:
            self._watch = None

    def drive_to(self, goal: Pose, is_enough: Callable[[Pose], bool]) -> None:
        """Drives to a goal ahead or behind, and no further than is enough."""
        here = self.pose()
        approach = Approach(RIM_SPEED, self.body.time_step)
        is_stopping = False
        while True:
            offset = here.seen_from(goal)
            to_go = -offset.x
            if approach.arrived(to_go) or (is_stopping and approach.speed == 0.0):
                break
            self._check_progress(approach, to_go)
            is_stopping = is_stopping or is_enough(here)
            rim_speed = (
                approach.slowed_down() if is_stopping else approach.next_speed(to_go)
            )
            here = self._step(self.body.drive.follow_line(rim_speed, offset, to_go))
        here = self._come_to_rest(here)
        self._planned = goal.ahead(here.seen_from(goal).x) if is_stopping else goal
        self._rotate(here, 0.0)

    #: endif
    def begin(self, movement: str) -> None:
        """Says which movement the next actions belong to."""
        self._movement, self._action, self._actions = movement, "start", 0

    def failure(self, reason: object) -> MovementError:
        """An error that says what the robot was doing."""
        name = self.body.model.name
        return MovementError(
            f"robot {name}, movement {self._movement}, action {self._action}: {reason}"
        )

    def _begin(self, action: str) -> Pose:
        self._actions += 1
        self._action = f"{self._actions}: {action}"
        return self._locate()

    def _locate(self) -> Pose:
        #: if slam
        if self._odometer is not None:
            return self._odometer.pose()
        #: endif
        return self.body.pose()

    def _start(self, here: Pose) -> Pose:
        """Where the action starts: where the last one should have ended."""
        return self._planned or here

    def _rotate(self, here: Pose, angle: float, speed: float = RIM_SPEED) -> Pose:
        """Turns by an angle in radians, of any number of full turns."""
        start = self._start(here)
        goal = start.turned(angle)
        drive = self.body.drive
        approach = Approach(speed, self.body.time_step)
        turned = wrap_angle(here.theta - start.theta)
        while not approach.arrived(to_go := (angle - turned) * drive.turning_radius):
            self._check_progress(approach, to_go)
            rim_speed = approach.next_speed(to_go)
            offset, before = here.seen_from(goal), here
            here = self._step(drive.turn_in_place(rim_speed, offset))
            turned += wrap_angle(here.theta - before.theta)
            #: if slam
            if self._watch is not None:
                self._watch(here)
            #: endif
        self._planned = goal
        return self._come_to_rest(here)

    def _step(self, rates: Sequence[float]) -> Pose:
        """Sets the wheels, lets a step of time pass, and looks where the robot is by then."""
        #: if parallel
        if self.cancelled.is_set():
            raise MovementCancelledError
        #: endif
        self._rates = rates
        self.body.set_wheel_rates(rates)
        self.body.advance()
        here = self._locate()
        name = self.body.model.name
        self._trace.add(self.body.time, name, here, rates, self._movement, self._action)
        return here

    def _come_to_rest(self, here: Pose) -> Pose:
        """Stops the wheels and waits a moment for the robot to stand."""
        if any(self._rates):
            for _ in range(20):
                before, here = here, self._step(self._standstill())
                drift = here.seen_from(before)
                if max(abs(drift.x), abs(drift.y), abs(drift.theta)) < 1e-5:
                    break
        return here

    def _standstill(self) -> list[float]:
        return [0.0] * len(self.body.model.wheels)

    def _check_progress(self, approach: Approach, to_go: float) -> None:
        if approach.stalled(to_go):
            raise self.failure(
                f"came no nearer to its goal for {STALL_TIME:g} s, {abs(to_go):.3f} m before it; "
                + self.body.why_it_stands()
            )

    def _check_arrival(self, aside: float) -> None:
        if abs(aside) > MOST_ASIDE:
            side = "left" if aside > 0.0 else "right"
            raise self.failure(
                f"ended {abs(aside):.3f} m to the {side} of its goal: "
                "it may have slid along something in its way"
            )

    def _report(self, here: Pose) -> None:
        # Adding zero makes a rounded -0 a 0. As many digits as the hints of an editor have.
        x, y = round(here.x, 2) + 0.0, round(here.y, 2) + 0.0
        degrees = round(math.degrees(here.theta), 1) + 0.0
        print(
            f"{self.body.time:8.2f} s  {self.body.model.name}  {self._movement}  "
            f"{self._action}  at x {x:.2f} m, y {y:.2f} m, {degrees:g} deg",
            flush=True,
        )
