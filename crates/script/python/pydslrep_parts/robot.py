#: if standalone
"""The actions of robots."""

import math
from collections.abc import Callable, Sequence
from threading import Event
from typing import Literal

from .approach import Approach
from .coppeliasim import Body
from .errors import MovementCancelledError, MovementError
from .odometer import Odometer
from .pose import Pose, wrap_angle
from .settings import MAX_LATERAL_ERROR, RIM_SPEED, STALL_TIME
from .slam_rover import explore_with
from .slam_session import SlamSession
from .trace_file import Trace

#: endif


class Robot:
    """A robot that moves and turns under closed-loop control of its pose.

    Every action starts from the planned end of the last one, so errors do not accumulate.
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
        self.slam_session: SlamSession | None = None
        self._on_pose: Callable[[Pose], object] | None = None
        self._odometer: Odometer | None = None
        #: endif

    def move(self, distance: float, speed: float = RIM_SPEED) -> None:
        """Drives straight, in metres (backwards if negative) and m/s."""
        here = self._begin_action(f"move {distance:g} m")
        goal = self._start_pose(here).ahead(distance)
        approach = Approach(speed, self.body.time_step)
        while True:
            offset = here.relative_to(goal)
            remaining = -offset.x
            if approach.arrived(remaining):
                break
            self._check_progress(approach, remaining)
            rim_speed = approach.next_speed(remaining)
            here = self._step(self.body.drive.follow_line(rim_speed, offset, remaining))
        self._planned = goal
        here = self._come_to_rest(here)
        self._check_arrival(here.relative_to(goal).y)
        # Correct a residual rotation.
        here = self._rotate(here, 0.0)
        self._report(here)

    def turn(self, degrees: float) -> None:
        """Turns in place, to the left if positive."""
        side = "left" if degrees >= 0.0 else "right"
        here = self._begin_action(f"turn {side} {abs(degrees):g} deg")
        here = self._rotate(here, math.radians(degrees))
        self._report(here)

    #: if until
    def turn_until_free(self, side: Literal["left", "right"], *sensors: str) -> None:
        """Turns in place until none of the sensors detects an object."""
        names = ", ".join(sensors)
        nothing = "detects nothing" if len(sensors) == 1 else "detect nothing"
        here = self._begin_action(f"turn {side} until {names} {nothing}")
        here = self._step(
            self._zero_rates()
        )  # sensors have no readings before the first step
        start = self._start_pose(here)
        radius = self.body.drive.turning_radius
        full_turn = math.tau * radius * (1.0 if side == "left" else -1.0)
        approach = Approach(RIM_SPEED, self.body.time_step)
        turned = 0.0
        while (detects := any(map(self.body.detects, sensors))) or approach.speed:
            remaining = full_turn - turned * radius
            if approach.arrived(remaining):
                still = "detects" if len(sensors) == 1 else "detect"
                raise self.failure(f"after a full turn {names} still {still} something")
            self._check_progress(approach, remaining)
            rim_speed = (
                approach.next_speed(remaining) if detects else approach.decelerate()
            )
            offset, before = here.relative_to(start), here
            here = self._step(self.body.drive.turn_in_place(rim_speed, offset))
            turned += wrap_angle(here.theta - before.theta)
        here = self._come_to_rest(here)
        self._planned = Pose(start.x, start.y, here.theta)
        self._report(here)

    #: endif
    #: if slam
    def slam(self) -> None:
        """Explores a closed area and maps it."""
        self._begin_action("slam")
        # Sensors have no readings before the first step.
        self._planned = self._step(self._zero_rates())
        if self.slam_session is not None:
            if self.slam_session.uses_odometry:
                self._odometer = Odometer(self.body)
            explore_with(self, self.slam_session)
        self._report(self.pose())

    def pose(self) -> Pose:
        """The robot's pose, estimated by odometry if the session uses it."""
        return self._locate()

    def correct(self, pose: Pose) -> None:
        """Corrects the odometry."""
        if self._odometer is not None:
            self._odometer.correct(pose)
            self._planned = pose

    def wheel_travel(self) -> float:
        """The distance that the wheels have travelled, in metres; 0 without odometry."""
        return self._odometer.wheel_travel if self._odometer is not None else 0.0

    def rotate(
        self, angle: float, on_pose: Callable[[Pose], object], speed: float = RIM_SPEED
    ) -> None:
        """Turns in place, to the left if positive; calls `on_pose` after every step."""
        self._on_pose = on_pose
        try:
            self._rotate(self.pose(), angle, speed)
        finally:
            self._on_pose = None

    def drive_to(self, goal: Pose, should_stop: Callable[[Pose], bool]) -> None:
        """Drives to a goal ahead or behind, or until `should_stop` returns True."""
        here = self.pose()
        approach = Approach(RIM_SPEED, self.body.time_step)
        is_stopping = False
        while True:
            offset = here.relative_to(goal)
            remaining = -offset.x
            if approach.arrived(remaining) or (is_stopping and approach.speed == 0.0):
                break
            self._check_progress(approach, remaining)
            is_stopping = is_stopping or should_stop(here)
            rim_speed = (
                approach.decelerate() if is_stopping else approach.next_speed(remaining)
            )
            here = self._step(self.body.drive.follow_line(rim_speed, offset, remaining))
        here = self._come_to_rest(here)
        self._planned = goal.ahead(here.relative_to(goal).x) if is_stopping else goal
        self._rotate(here, 0.0)

    #: endif
    def begin(self, movement: str) -> None:
        """Sets the movement that the next actions belong to."""
        self._movement, self._action, self._actions = movement, "start", 0

    def failure(self, reason: object) -> MovementError:
        """An error with the robot, movement and action that it occurred in."""
        name = self.body.model.name
        return MovementError(
            f"robot {name}, movement {self._movement}, action {self._action}: {reason}"
        )

    def _begin_action(self, action: str) -> Pose:
        self._actions += 1
        self._action = f"{self._actions}: {action}"
        return self._locate()

    def _locate(self) -> Pose:
        #: if slam
        if self._odometer is not None:
            return self._odometer.pose()
        #: endif
        return self.body.pose()

    def _start_pose(self, here: Pose) -> Pose:
        """The planned start of an action: the planned end of the last one."""
        return self._planned or here

    def _rotate(self, here: Pose, angle: float, speed: float = RIM_SPEED) -> Pose:
        """Turns by an angle in radians, which may exceed a full turn."""
        start = self._start_pose(here)
        goal = start.turned(angle)
        drive = self.body.drive
        approach = Approach(speed, self.body.time_step)
        turned = wrap_angle(here.theta - start.theta)
        while not approach.arrived(
            remaining := (angle - turned) * drive.turning_radius
        ):
            self._check_progress(approach, remaining)
            rim_speed = approach.next_speed(remaining)
            offset, before = here.relative_to(goal), here
            here = self._step(drive.turn_in_place(rim_speed, offset))
            turned += wrap_angle(here.theta - before.theta)
            #: if slam
            if self._on_pose is not None:
                self._on_pose(here)
            #: endif
        self._planned = goal
        return self._come_to_rest(here)

    def _step(self, rates: Sequence[float]) -> Pose:
        """Sets the wheels' rates, advances one step of time, and returns the new pose."""
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
        """Stops the wheels and waits for the robot to stop."""
        if any(self._rates):
            for _ in range(20):
                before, here = here, self._step(self._zero_rates())
                drift = here.relative_to(before)
                if max(abs(drift.x), abs(drift.y), abs(drift.theta)) < 1e-5:
                    break
        return here

    def _zero_rates(self) -> list[float]:
        return [0.0] * len(self.body.model.wheels)

    def _check_progress(self, approach: Approach, remaining: float) -> None:
        if approach.stalled(remaining):
            raise self.failure(
                f"no progress for {STALL_TIME:g} s, {abs(remaining):.3f} m from the goal; "
                + self.body.stall_reason()
            )

    def _check_arrival(self, lateral_error: float) -> None:
        if abs(lateral_error) > MAX_LATERAL_ERROR:
            side = "left" if lateral_error > 0.0 else "right"
            raise self.failure(
                f"ended {abs(lateral_error):.3f} m to the {side} of the goal; "
                "an obstacle may have deflected it"
            )

    def _report(self, here: Pose) -> None:
        # Adding zero turns -0 into 0. The precision is that of the inlay hints in editors.
        x, y = round(here.x, 2) + 0.0, round(here.y, 2) + 0.0
        degrees = round(math.degrees(here.theta), 1) + 0.0
        print(
            f"{self.body.time:8.2f} s  {self.body.model.name}  {self._movement}  "
            f"{self._action}  at x {x:.2f} m, y {y:.2f} m, {degrees:g} deg",
            flush=True,
        )
