"""Motion control: closed-loop control of a connected robot's pose, step by step."""

import math
from collections.abc import Callable, Sequence
from typing import Protocol

from . import events
from .approach import Approach
from .backend import Backend, RobotSpec
from .creep import Creep
from .drives import Drive
from .errors import MovementError
from .event_loop import SimulationLoop
from .facts import RIM_SPEED
from .notes import Notes
from .pose import Pose, wrap_angle
from .settings import MAX_LATERAL_ERROR, STALL_TIME
from .steering import Drift
from .trace import Trace

AT_REST = 1e-5  # m and radians that a robot at rest moves in one step, at most
TREMOR = (
    3e-4  # m and radians that contacts move it, where a physics engine has them tremble
)
REST_STEPS = 20  # to wait for a robot to come to rest, at most


class Odometer(Protocol):
    """An estimate of a robot's pose from the rotation of its wheels."""

    wheel_travel: float
    """Metres that the wheels have rolled, forward or backward; the mean of all wheels."""

    def pose(self) -> Pose:
        """The estimated pose."""

    def correct(self, pose: Pose) -> None:
        """Replaces the estimated pose."""


class Motion:
    """Moves a robot along lines and turns it in place.

    Every motion starts from the planned end of the last one, so errors do not accumulate.
    """

    def __init__(
        self,
        spec: RobotSpec,
        backend: Backend,
        drive: Drive,
        loop: SimulationLoop,
        order: int,
        trace: Trace,
    ) -> None:
        """`order` is the robot's place among those that act in the same step."""
        self.spec, self.backend, self.drive = spec, backend, drive
        self.name = spec.name
        self.movement = self.action_text = ""  # for messages, the trace and events
        self.action_number = 0  # in its movement, from 1
        self._loop, self._order, self._trace = loop, order, trace
        self._planned: Pose | None = None
        self._rates: Sequence[float] = ()
        self._odometer: Odometer | None = None
        self._on_pose: Callable[[Pose], object] | None = None
        self._drift, self._creep = Drift(), Creep()
        self._notes = Notes()
        self._crawling = ("", "")  # the movement and the action that this was said of
        self._is_recorded = False  # whether the trace has the pose that it starts from

    @property
    def action(self) -> str:
        """The action that it does, with its number."""
        return f"{self.action_number}: {self.action_text}" if self.action_number else ""

    def pose(self) -> Pose:
        """The pose of the wheels' centre, by odometry if that is in use."""
        return self.backend.pose() if self._odometer is None else self._odometer.pose()

    def use_odometry(self, odometer: Odometer) -> None:
        """From now on, poses come from an odometer, not from the backend."""
        self._odometer = odometer

    def correct(self, pose: Pose) -> None:
        """Corrects the odometry."""
        if self._odometer is not None:
            self._odometer.correct(pose)
            self._planned = pose

    def wheel_travel(self) -> float:
        """The distance that the wheels have rolled, in metres; 0 without odometry."""
        return 0.0 if self._odometer is None else self._odometer.wheel_travel

    def failure(self, reason: object) -> MovementError:
        """An error with the robot, movement and action that it occurred in."""
        return MovementError(
            f"robot {self.name}, movement {self.movement}, action {self.action}: {reason}",
            self.name,
            self.movement,
            self.action_number,
        )

    def moment(self, here: Pose) -> events.Moment:
        """What it does now, for events."""
        return events.Moment(
            self.backend.clock.time,
            self.name,
            self.movement,
            self.action_number,
            self.action_text,
            here,
        )

    def forget_plan(self) -> None:
        """The next motion starts where the robot is: something has interrupted the last."""
        self._planned = None

    def zero_rates(self) -> list[float]:
        """The rates of wheels at rest."""
        return [0.0] * len(self.spec.wheels)

    async def step(self, rates: Sequence[float]) -> Pose:
        """Sets the wheels' rates in rad/s, waits for the next step, and returns the pose."""
        if self._creep.gain != 1.0:
            rates = [rate * self._creep.gain for rate in rates]
        self._rates = rates
        self.backend.set_wheel_rates(rates)
        clock = self.backend.clock
        await self._loop.next_step(clock, self._order)
        here = self.pose()
        self._record(here, rates)
        return here

    async def wait(self) -> Pose:
        """Waits for one step at rest; from then on, sensors have readings."""
        here = await self.step(self.zero_rates())
        self._planned = self._planned or here
        return here

    async def move(self, distance: float, speed: float) -> Pose:
        """Drives straight, in metres (backwards if negative) and m/s."""
        here = self.pose()
        goal = self._start(here).ahead(distance)
        approach = self._approach(speed)
        while True:
            offset = here.relative_to(goal)
            remaining = -offset.x
            if approach.arrived(remaining):
                break
            self._check_progress(approach, remaining)
            rim_speed = approach.next_speed(remaining)
            here = await self._follow_line(here, rim_speed, offset, remaining)
        self._planned = goal
        self._check_arrival(here.relative_to(goal).y)
        # Correct a residual rotation, and rest.
        return await self._rotate(here, 0.0)

    async def rotate(
        self,
        angle: float,
        on_pose: Callable[[Pose], object] | None = None,
        speed: float = RIM_SPEED,
    ) -> Pose:
        """Turns in place by radians, to the left if positive; may exceed a full turn.

        `speed` is that of the rims in m/s; `on_pose` is called after every step.
        """
        self._on_pose = on_pose
        try:
            return await self._rotate(self.pose(), angle, speed)
        finally:
            self._on_pose = None

    async def rotate_while(
        self, side: float, condition: Callable[[], bool]
    ) -> Pose | None:
        """Turns in place while a condition holds, to the left if `side` is 1, else -1.

        Returns None if it still holds after a full turn.
        """
        here = await self.wait()
        start = self._start(here)
        radius = self.drive.turning_radius
        full_turn = side * math.tau * radius
        approach = self._approach(RIM_SPEED)
        turned = 0.0
        while (holds := condition()) or approach.speed:
            remaining = full_turn - turned * radius
            if approach.arrived(remaining):
                return None
            self._check_progress(approach, remaining)
            rim_speed = (
                approach.next_speed(remaining) if holds else approach.decelerate()
            )
            offset, before = here.relative_to(start), here
            rates = self.drive.turn_in_place(rim_speed, offset, None, 0.0)
            here = await self.step(rates)
            turned += wrap_angle(here.theta - before.theta)
        here = await self._come_to_rest(here)
        self._planned = Pose(start.x, start.y, here.theta)
        return here

    async def drive_to(self, goal: Pose, should_stop: Callable[[Pose], bool]) -> None:
        """Drives to a goal ahead or behind, or until `should_stop` returns True."""
        here = self.pose()
        approach = self._approach(RIM_SPEED)
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
            here = await self._follow_line(here, rim_speed, offset, remaining)
        if is_stopping:
            here = await self._come_to_rest(here)
            self._planned = goal.ahead(here.relative_to(goal).x)
        else:
            self._planned = goal
        await self._rotate(here, 0.0)

    async def _follow_line(
        self, here: Pose, speed: float, offset: Pose, remaining: float
    ) -> Pose:
        """Takes a step along a line."""
        there = await self.step(self.drive.follow_line(speed, offset, remaining))
        moved = there.relative_to(here).x
        self._creep.observe(speed, moved, self.backend.clock.time_step)
        return there

    def _start(self, here: Pose) -> Pose:
        """The planned start of a motion: the planned end of the last one."""
        if not self._is_recorded:
            # The first step has moved it already.
            self._record(here, self.zero_rates())
        return self._planned or here

    def _record(self, here: Pose, rates: Sequence[float]) -> None:
        self._is_recorded = True
        time = self.backend.clock.time
        self._trace.add(time, self.name, here, rates, self.movement, self.action)

    def _approach(self, speed: float) -> Approach:
        return Approach(speed, self.backend.clock.time_step)

    async def _rotate(self, here: Pose, angle: float, speed: float = RIM_SPEED) -> Pose:
        start = self._start(here)
        goal = start.turned(angle)
        approach = self._approach(speed)
        turned = wrap_angle(here.theta - start.theta)
        while not approach.arrived(
            remaining := (angle - turned) * self.drive.turning_radius
        ):
            self._check_progress(approach, remaining)
            rim_speed = approach.next_speed(remaining)
            offset, before = here.relative_to(goal), here
            rates = self.drive.turn_in_place(
                rim_speed, offset, angle - turned, self._drift.left
            )
            here = await self.step(rates)
            step = wrap_angle(here.theta - before.theta)
            turned += step
            self._drift.observe(before, here)
            if not self.drive.scrubs:
                moved = step * self.drive.turning_radius
                self._creep.observe(rim_speed, moved, self.backend.clock.time_step)
            if self._on_pose is not None:
                self._on_pose(here)
        self._planned = goal
        return await self._come_to_rest(here)

    async def _come_to_rest(self, here: Pose) -> Pose:
        """Stops the wheels and waits for the robot to stop."""
        if any(self._rates):
            last = math.inf
            for _ in range(REST_STEPS):
                before, here = here, await self.step(self.zero_rates())
                moved = here.relative_to(before)
                way = max(abs(moved.x), abs(moved.y), abs(moved.theta))
                # A robot that brakes moves less and less; a tremor goes on.
                if way < AT_REST or last / 2.0 < way < TREMOR:
                    break
                last = way
        return here

    def _check_progress(self, approach: Approach, remaining: float) -> None:
        if approach.crawls(remaining, self.backend.clock.time):
            self._say_crawl()
        if approach.stalled(remaining, self.backend.clock.time):
            self._report_contact()
            raise self.failure(
                f"no progress for {STALL_TIME:g} s, {abs(remaining):.3f} m from the goal; "
                + self.backend.stall_reason()
            )

    def _say_crawl(self) -> None:
        """Says once why an action takes so long: to find out takes calls."""
        if self._crawling != (self.movement, self.action):
            self._crawling = self.movement, self.action
            why = self.backend.crawl_reason()
            self._notes.say(
                f"robot {self.name}, movement {self.movement}, action {self.action}: takes more than twice as long "
                f"as planned; {why}"
            )

    def _report_contact(self) -> None:
        if events.current.is_read:
            events.current.contact(self.moment(self.pose()))

    def _check_arrival(self, lateral_error: float) -> None:
        if abs(lateral_error) > MAX_LATERAL_ERROR:
            self._report_contact()
            side = "left" if lateral_error > 0.0 else "right"
            raise self.failure(
                f"ended {abs(lateral_error):.3f} m to the {side} of the goal; "
                "an obstacle may have deflected it"
            )
