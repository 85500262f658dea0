"""Motion control: closed-loop control of a connected robot's pose, step by step."""

import math
from collections.abc import Callable, Sequence
from typing import Protocol, cast

from . import events
from .approach import Approach, Brake
from .backend import Backend, RobotSpec
from .circles import Circle
from .conditions import Condition, Watch
from .drives import Drive
from .errors import MovementError
from .event_loop import SimulationLoop
from .facts import RIM_SPEED
from .noted_readings import NotedReadings
from .notes import Notes
from .pace import Pace
from .places import Place
from .pose import Pose, wrap_angle
from .scrub import Scrub
from .settings import (
    END_ANGLE,
    END_DISTANCE,
    MAX_DEFLECTION,
    MAX_IDLE_ACTIONS,
    MAX_IDLE_ROUNDS,
    STALL_TIME,
)
from .slip_compensation import SlipCompensation
from .steering import Drift
from .trace import Trace

AT_REST = 1e-5  # m and radians that a robot at rest moves in one step, at most
TREMOR = (
    3e-4  # m and radians that contacts move it, where a physics engine has them tremble
)
REST_STEPS = 20  # to wait for a robot to come to rest, at most

StopsAt = Callable[[Pose], bool]
"""Whether a motion has to end early, by the pose after a step."""


def never(_here: Pose) -> bool:
    """A motion that ends at its goal."""
    return False


def apart(here: Pose, there: Pose) -> float:
    """The distance between two positions in metres."""
    return math.hypot(here.x - there.x, here.y - there.y)


class Instant:
    """Counts what happens at one time."""

    def __init__(self) -> None:
        self._time, self._count = math.nan, 0

    def count(self, now: float) -> int:
        """How much has happened now, in seconds of simulation time, this included."""
        self._count = self._count + 1 if now == self._time else 1
        self._time = now
        return self._count


class Odometer(Protocol):
    """An estimate of a robot's pose from the rotation of its wheels."""

    wheel_travel: float
    """Metres that the wheels have rolled, forward or backward; the mean of all wheels."""

    def pose(self) -> Pose:
        """The estimated pose."""

    def correct(self, pose: Pose) -> None:
        """Replaces the estimated pose."""


class Motion:
    """Moves a robot along lines and circles, and turns it in place.

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
        self._readings: NotedReadings | None = None
        if trace.is_written:
            self._readings = NotedReadings(backend, spec.bumpers)
            self.backend = cast("Backend", self._readings)
        self.name = spec.name
        # What it does, for messages, the trace and events.
        self.place, self.action_text = Place(), ""
        self._loop, self._order, self._trace = loop, order, trace
        self._planned: Pose | None = None
        self._rates: Sequence[float] = ()
        self._odometer: Odometer | None = None
        self._on_pose: Callable[[Pose], object] | None = None
        self._drift, self._slip = Drift(), SlipCompensation()
        self._scrub = Scrub(drive.rims_per_radian / drive.turning_radius)
        # Known from the start on, when the clock knows it.
        self._steps: Pace | None = None
        self._elapsed = 0.0  # s of the latest step, as measured
        self._notes = Notes()
        # The action of which it was said that it crawls.
        self._crawling: tuple[Place, str] | None = None
        # Actions and checks of conditions, and rounds of loops, since time has passed.
        self._begun, self._rounds = Instant(), Instant()
        self._has_moved = False  # since the start, which the trace has to have, too

    @property
    def action(self) -> str:
        """The action that it does, with its number."""
        number = self.place.action
        return f"{number}: {self.action_text}" if number else ""

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
        place = self.place
        return MovementError(
            f"{self._who()}: {reason}",
            self.name,
            place.movement,
            place.action,
            line=place.line,
            rounds=place.rounds,
            calls=place.calls,
        )

    def _who(self) -> str:
        """The robot and what it does, for messages."""
        way = self.place.way(self.action_text, "action ")
        return f"robot {self.name}, movement {self.place.movement}, {way}"

    def moment(self, here: Pose) -> events.Moment:
        """What it does now, for events."""
        return events.Moment(
            self.backend.clock.time,
            self.name,
            self.place,
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
        backend, gain = self.backend, self._slip.gain
        if gain != 1.0:
            rates = [rate * gain for rate in rates]
        self._rates = rates
        backend.set_wheel_rates(rates)
        clock, pace = backend.clock, self._pace()
        begun = clock.time
        await self._loop.next_step(clock, self._order)
        # Times are sums of steps; the last digits are not the clock's.
        self._elapsed = elapsed = round(clock.time - begun, 9)
        if elapsed != pace.last or elapsed != pace.usual:
            pace.observe(elapsed)
        odometer = self._odometer
        here = backend.pose() if odometer is None else odometer.pose()
        if self._trace.is_written:
            self._record(here, rates)
        self._has_moved = True
        return here

    async def wait(self) -> Pose:
        """Waits for one step at rest; from then on, sensors have readings."""
        here = await self.step(self.zero_rates())
        self._planned = self._planned or here
        return here

    async def watch(self, condition: Condition | None) -> Watch:
        """What reads a condition during an action; it has read it once."""
        await self._let_others_act()
        watch = Watch(condition, self.backend, self.spec.bumpers)
        if condition is not None:
            await self._read_sensors()
            watch(self.pose())
        return watch

    async def check(self, condition: Condition) -> bool:
        """Whether a condition holds; takes no time, but for the first one of a run."""
        await self._let_others_act()
        await self._read_sensors()
        return condition.holds(self.backend, self.spec.bumpers)

    def has_idled(self) -> bool:
        """Counts a round of a loop; whether no time has passed in very many."""
        return self._rounds.count(self.backend.clock.time) > MAX_IDLE_ROUNDS

    async def _let_others_act(self) -> None:
        """Loops of what takes no time must not hold up the other robots for ever: at some time a step passes."""
        if self._begun.count(self.backend.clock.time) > MAX_IDLE_ACTIONS:
            await self.wait()

    async def _read_sensors(self) -> None:
        """Sensors have readings from the first step of a run on."""
        if not self._loop.has_advanced(self.backend.clock):
            await self.wait()

    async def hold(self, seconds: float, should_stop: StopsAt = never) -> Pose:
        """Stays where it is for seconds of simulation time."""
        clock, here = self.backend.clock, self.pose()
        self._planned = self._start(here)
        end = clock.time + seconds - self._pace().usual / 2.0
        is_over = clock.time >= end
        while not is_over:
            here = await self.step(self.zero_rates())
            is_over = clock.time >= end or should_stop(here)
        return here

    async def move(
        self, distance: float, speed: float, should_stop: StopsAt = never
    ) -> Pose:
        """Drives straight, in metres (backwards if negative) and m/s."""
        here = self.pose()
        goal = self._start(here).ahead(distance)
        brake, aside = Brake(should_stop), abs(here.relative_to(goal).y)
        here = await self._drive_line(here, goal, speed, brake)
        # On its way, a robot may not be back on its line yet.
        self._check_side(here.relative_to(goal).y, aside if brake.is_on else 0.0)
        # Correct a residual rotation, and rest.
        return await self._rotate(here, 0.0)

    async def arc(
        self,
        angle: float,
        radius: float,
        speed: float,
        *,
        reverse: bool,
        should_stop: StopsAt = never,
    ) -> Pose:
        """Drives along a circle until the heading has changed by radians, to the left if positive.

        `radius` is that of the path of the wheels' centre in metres, `speed` that of the rims of the fastest wheel in m/s.
        """
        here = self.pose()
        # In reverse, the robot turns to the left if the centre is to its right.
        side = math.copysign(1.0, angle) * (-1.0 if reverse else 1.0)
        start = self._start(here)
        circle = Circle(start, side / radius)
        brake, aside = Brake(should_stop), abs(here.relative_to(start).y)
        here, turned = await self._drive_circle(here, circle, angle, speed, brake)
        if brake.is_on:
            here = await self._come_to_rest(here)
            angle = circle.angle_at(here, turned)
        self._planned = goal = circle.pose_at(angle)
        self._check_side(here.relative_to(goal).y, aside if brake.is_on else 0.0)
        return await self._rotate(here, 0.0)

    async def rotate(
        self,
        angle: float,
        on_pose: Callable[[Pose], object] | None = None,
        speed: float = RIM_SPEED,
        should_stop: StopsAt = never,
        *,
        may_end: bool = True,
    ) -> Pose:
        """Turns in place by radians, to the left if positive; may exceed a full turn.

        `speed` is that of the rims in m/s; `on_pose` is called after every step. Without `may_end`, the robot will stop
        somewhere on the way.
        """
        here, brake = self.pose(), Brake(should_stop)
        away = apart(here, self._start(here))
        self._on_pose = on_pose
        try:
            here = await self._rotate(here, angle, speed, brake, may_end=may_end)
        finally:
            self._on_pose = None
        # Who looks around on the way goes on from where the robot is.
        if on_pose is None:
            self._check_spot(here, away if brake.is_on else 0.0)
        return here

    async def rotate_while(
        self, side: float, condition: Callable[[], bool]
    ) -> Pose | None:
        """Turns in place while a condition holds, to the left if `side` is 1, else -1.

        Returns None if it still holds after a full turn.
        """
        here = await self.wait()
        start = self._start(here)
        away = apart(here, start)
        radius = self.drive.rims_per_radian
        full_turn = side * math.tau * radius
        approach = self._approach(RIM_SPEED, radius)
        turned = 0.0
        while (holds := condition()) or approach.speed:
            remaining = full_turn - turned * radius
            if self._has_arrived(approach, remaining):
                return None
            rim_speed = (
                approach.next_speed(remaining) if holds else approach.decelerate()
            )
            offset, before = here.relative_to(start), here
            rates = self.drive.turn_in_place(rim_speed, offset, None, 0.0)
            here = await self.step(rates)
            turned += wrap_angle(here.theta - before.theta)
        here = await self._come_to_rest(here)
        self._planned = Pose(start.x, start.y, here.theta)
        self._check_spot(here, away)
        return here

    async def drive_to(self, goal: Pose, should_stop: StopsAt) -> None:
        """Drives to a goal ahead or behind, or until `should_stop` returns True."""
        here = await self._drive_line(self.pose(), goal, RIM_SPEED, Brake(should_stop))
        await self._rotate(here, 0.0)

    async def _drive_line(
        self, here: Pose, goal: Pose, speed: float, brake: Brake
    ) -> Pose:
        """Drives to a goal ahead or behind, or brakes on the way there; the planned pose is on the line."""
        approach = self._approach(speed)
        while True:
            offset = here.relative_to(goal)
            remaining = -offset.x
            if brake.has_stopped(approach) or self._has_arrived(approach, remaining):
                break
            ahead = brake.next_speed(approach, here, remaining)
            # On a line, wheels slide sideways too little to count on it.
            rates = self.drive.follow(
                ahead, offset, remaining, 0.0, self._scrub.min_factor
            )
            there = await self.step(rates)
            self._slip.observe(ahead, there.ahead_of(here), self._elapsed)
            here = there
        if brake.is_on:
            here = await self._come_to_rest(here)
            goal = goal.ahead(here.relative_to(goal).x)
        self._planned = goal
        return here

    async def _drive_circle(
        self, here: Pose, circle: Circle, angle: float, speed: float, brake: Brake
    ) -> tuple[Pose, float]:
        """Drives along a circle to an angle, or brakes on the way there; returns the angle that it has got to, too."""
        curvature = circle.curvature
        # Distances are those of the fastest wheel, as it seems now: what is to go must not grow on the way.
        rims = self._way_of_rims(curvature)
        approach = self._approach(speed, rims)
        turned = circle.angle_at(here, 0.0)
        while not brake.has_stopped(approach):
            remaining = (angle - turned) * rims
            if self._has_arrived(approach, remaining):
                break
            rim_speed = brake.next_speed(approach, here, remaining)
            ahead = rim_speed / self._way_of_rims(curvature) / curvature
            offset = here.relative_to(circle.pose_at(turned))
            to_go = (angle - turned) / curvature
            here = await self._follow(here, ahead, offset, to_go, curvature)
            before, turned = turned, circle.angle_at(here, turned)
            moved = (turned - before) / curvature
            self._slip.observe(ahead, moved, self._elapsed)
        return here, turned

    def _way_of_rims(self, curvature: float) -> float:
        """The way of the fastest wheel on a circle, in metres per radian."""
        return 1.0 / abs(curvature) + self.drive.rims_per_radian * self._scrub.factor

    async def _follow(
        self, here: Pose, ahead: float, offset: Pose, to_go: float, curvature: float
    ) -> Pose:
        """Drives along a circle for one step."""
        factor = self._scrub.factor
        rates = self.drive.follow(ahead, offset, to_go, curvature, factor)
        there = await self.step(rates)
        if self.drive.scrubs:
            asked = self.drive.turn_rate(rates) * self._elapsed
            self._scrub.observe(asked, wrap_angle(there.theta - here.theta))
        return there

    def _start(self, here: Pose) -> Pose:
        """The planned start of a motion: the planned end of the last one."""
        if not self._has_moved:
            # The first step has moved it already.
            self._record(here, self.zero_rates())
            self._has_moved = True
        return self._planned or here

    def _record(self, here: Pose, rates: Sequence[float]) -> None:
        if self._readings is None:
            return
        time, readings = self.backend.clock.time, self._readings.take()
        action, place = self.action, self.place
        self._trace.add(time, self.name, here, rates, place, action, readings)

    def _approach(self, speed: float, rims: float = math.inf) -> Approach:
        """The approach of an action in which rims roll so many metres per radian."""
        tolerance = min(END_DISTANCE, END_ANGLE * rims)
        return Approach(speed, self._pace(), tolerance)

    def _pace(self) -> Pace:
        """How long steps take; simulators tell how long they should when they have started."""
        if self._steps is None:
            self._steps = Pace(self.backend.clock.time_step)
        return self._steps

    async def _rotate(
        self,
        here: Pose,
        angle: float,
        speed: float = RIM_SPEED,
        brake: Brake | None = None,
        *,
        may_end: bool = True,
    ) -> Pose:
        start = self._start(here)
        goal = start.turned(angle)
        radius = self.drive.rims_per_radian
        approach, brake = self._approach(speed, radius), brake or Brake(never)
        turned = wrap_angle(here.theta - start.theta)
        while not brake.has_stopped(approach):
            remaining = (angle - turned) * radius
            if self._has_arrived(approach, remaining):
                break
            rim_speed = brake.next_speed(approach, here, remaining)
            offset, before = here.relative_to(goal), here
            rates = self.drive.turn_in_place(
                rim_speed,
                offset,
                angle - turned if may_end else None,
                self._drift.left,
            )
            here = await self.step(rates)
            step = wrap_angle(here.theta - before.theta)
            turned += step
            self._drift.observe(before, here)
            if not self.drive.scrubs:
                moved = step * radius
                self._slip.observe(rim_speed, moved, self._elapsed)
            if self._on_pose is not None:
                self._on_pose(here)
        here = await self._come_to_rest(here)
        self._planned = Pose(goal.x, goal.y, here.theta) if brake.is_on else goal
        return here

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

    def _has_arrived(self, approach: Approach, remaining: float) -> bool:
        """Whether a robot is where an action ends; fails if it comes no nearer."""
        if approach.arrived(remaining):
            return True
        time = self.backend.clock.time
        if approach.progresses(remaining, time):
            return False
        if approach.crawls(remaining, time):
            self._say_crawl()
        if not approach.stalled(remaining, time):
            return False
        if abs(remaining) <= approach.tolerance:
            return True
        self._report_contact()
        raise self.failure(
            f"no progress for {STALL_TIME:g} s, {abs(remaining):.3f} m from the goal; "
            + self.backend.stall_reason()
        )

    def _say_crawl(self) -> None:
        """Says once why an action takes so long: to find out takes calls."""
        if self._crawling != (self.place, self.action_text):
            self._crawling = self.place, self.action_text
            why = self.backend.crawl_reason()
            self._notes.say(
                f"{self._who()}: takes more than twice as long as planned; {why}"
            )

    def _report_contact(self) -> None:
        if events.current.is_read:
            events.current.contact(self.moment(self.pose()))

    def _check_side(self, aside: float, before: float) -> None:
        """Fails if a robot is far to the side of its path; `before` is how far it may have been before, in metres."""
        side = "left" if aside > 0.0 else "right"
        self._check_end(abs(aside), before, f"to the {side} of")

    def _check_spot(self, here: Pose, before: float) -> None:
        """Fails if a robot has turned far from its spot."""
        self._check_end(apart(here, self._start(here)), before, "from")

    def _check_end(self, away: float, before: float, where: str) -> None:
        if away > before + MAX_DEFLECTION:
            self._report_contact()
            raise self.failure(
                f"ended {away:.3f} m {where} the goal; an obstacle may have deflected it"
            )
