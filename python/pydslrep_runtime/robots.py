"""Robots: what a program declares, and the actions that it asks for."""

import math
from collections.abc import AsyncIterator, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, ClassVar, Literal

from . import events
from .backend import Backend, RobotSpec
from .conditions import Condition, Watch
from .drives import Drive, DriveType, FourWheelDrive, MecanumDrive, TwoWheelDrive
from .errors import SetupError, SimulatorError
from .event_loop import SimulationLoop
from .facts import RIM_SPEED, ROBOT_TYPES, TypeName
from .loops import Repeat, RepeatUntil
from .motion import Motion
from .movements import place_of
from .pose import Pose
from .ros2_topics import NO_SETTINGS, Mounts, Ros2Settings
from .settings import MAX_DISTANCE, MAX_IDLE_ROUNDS, MAX_ROUNDS, MAX_TURN, MAX_WAIT
from .trace import Trace

if TYPE_CHECKING:
    from .slam.session import SlamSession

Wheel = tuple[str, float]
"""The name of a wheel's joint, and the radius in metres."""


Objects = Mapping[str, str | Sequence[str]]
"""Paths in a simulator's scene by name; several if a wheel and a sensor share a name."""

NO_OBJECTS: Objects = {}
NO_MOUNTS: Mounts = {}

Side = Literal["left", "right"]


class Robot:
    """A robot of any type. It acts within `run`, and does one action at a time."""

    drive_type: ClassVar[DriveType]

    def __init__(
        self,
        name: str,
        *,
        port: int,
        wheels: Sequence[Wheel],
        sensors: Sequence[str] = (),
        bumpers: Sequence[str] = (),
        objects: Objects = NO_OBJECTS,
        ros2: Ros2Settings = NO_SETTINGS,
        mounts: Mounts = NO_MOUNTS,
    ) -> None:
        """`port` is that of its simulator's remote API.

        `objects` are the paths of the robot and its parts in the simulator's scene, by name, if their names are others
        there. `ros2` says what is not as usual of its topics, `mounts` where its sensors are.
        """
        self.name, self.port = name, port
        self.wheels = dict(wheels)
        if len(self.wheels) < len(wheels):
            raise ValueError(f"robot {name} lists a wheel twice")
        self.sensors, self.bumpers = tuple(sensors), tuple(bumpers)
        self.objects = {
            part: (paths,) if isinstance(paths, str) else tuple(paths)
            for part, paths in objects.items()
        }
        parts = {name, *self.wheels, *self.sensors, *self.bumpers}
        if unknown := self.objects.keys() - parts:
            raise ValueError(f"robot {name} has no part {min(unknown)}")
        self.ros2, self.mounts = ros2, mounts
        self._motion: Motion | None = None
        self._slam_session: SlamSession | None = None
        self._is_acting = False

    async def move(
        self,
        distance: float | None = None,
        speed: float = RIM_SPEED,
        *,
        until: Condition | None = None,
    ) -> None:
        """Drives straight, in metres (backwards if negative) and m/s, and stops early when a condition holds.

        Without a distance, it fails if the condition has not held after 100 m.
        """
        is_bounded = has_end(distance, until)
        amount = "" if distance is None else f" {distance:g} m"
        way = MAX_DISTANCE if distance is None else distance
        with self._action(f"move{amount}{stop_text(until)}") as motion:
            watch = await motion.watch(until)
            here = motion.pose()
            if not watch.is_met:
                here = await motion.move(way, speed, watch)
            self._end(here, watch, "" if is_bounded else f"{way:g} m")

    async def turn(
        self,
        degrees: float | Side,
        speed: float = RIM_SPEED,
        *,
        until: Condition | None = None,
    ) -> None:
        """Turns in place, to the left if positive, and stops early when a condition holds.

        `speed` is that of the rims in m/s. With a side instead of an angle, it fails if the condition has not held after a
        full turn.
        """
        is_bounded = has_end(None if isinstance(degrees, str) else degrees, until)
        with self._action(f"turn {turn_text(degrees)}{stop_text(until)}") as motion:
            watch = await motion.watch(until)
            here = motion.pose()
            if not watch.is_met:
                angle = angle_of(degrees)
                here = await motion.rotate(
                    angle, None, speed, watch, may_end=is_bounded
                )
            self._end(here, watch, "" if is_bounded else "a full turn")

    async def arc(
        self,
        degrees: float | Side,
        *,
        radius: float,
        speed: float = RIM_SPEED,
        reverse: bool = False,
        until: Condition | None = None,
    ) -> None:
        """Drives along a circle until the heading has changed by an angle, and stops early when a condition holds.

        The heading turns to the left if the angle is positive, in reverse as well. `radius` is that of the path of the
        wheels' centre in metres, `speed` that of the rims of the fastest wheel in m/s. With a side instead of an angle, it
        fails if the condition has not held after a full circle.
        """
        if radius <= 0.0:
            raise ValueError(f"there is no circle with a radius of {radius:g} m")
        is_bounded = has_end(None if isinstance(degrees, str) else degrees, until)
        text = f"turn {turn_text(degrees)} with radius {radius:g} m"
        text += " in reverse" if reverse else ""
        with self._action(text + stop_text(until)) as motion:
            watch = await motion.watch(until)
            here = motion.pose()
            if not watch.is_met:
                angle = angle_of(degrees)
                here = await motion.arc(
                    angle, radius, speed, reverse=reverse, should_stop=watch
                )
            self._end(here, watch, "" if is_bounded else "a full circle")

    async def wait(
        self, seconds: float | None = None, *, until: Condition | None = None
    ) -> None:
        """Stays where it is for seconds of simulation time, or until a condition holds.

        Without a time, it fails if the condition has not held after 600 s.
        """
        is_bounded = has_end(seconds, until)
        amount = "" if seconds is None else f" {seconds:g} s"
        time = MAX_WAIT if seconds is None else seconds
        with self._action(f"wait{amount}{stop_text(until)}") as motion:
            watch = await motion.watch(until)
            here = motion.pose()
            if not watch.is_met:
                here = await motion.hold(time, watch)
            self._end(here, watch, "" if is_bounded else f"{time:g} s")

    async def check(self, condition: Condition) -> bool:
        """Whether a condition holds. Takes no time, but for the first one of a run: sensors have no readings before."""
        with self._action(f"if {condition}", is_reported=False) as motion:
            return await motion.check(condition)

    def repeat(self, count: int) -> Iterator[int]:
        """Rounds of a loop, from 1: `for _ in rover.repeat(4)`. Messages, events and traces tell in which one it is.

        Loops fail after a million rounds in which no time has passed: nobody else can act meanwhile.
        """
        motion = self._connected()

        def on_round() -> None:
            if not motion.has_idled():
                return
            with self._action(f"repeat {count} times", is_reported=False):
                raise motion.failure(f"no time has passed in {MAX_IDLE_ROUNDS} rounds")

        return Repeat(self, count, on_round)

    def repeat_until(self, condition: Condition) -> AsyncIterator[int]:
        """Rounds of a loop, from 1, until a condition holds: `async for _ in rover.repeat_until(clear("front"))`.

        The condition is read before each round. The loop fails if it has not held after 10 000 of them; one in which no
        time has passed takes a step.
        """
        began = math.nan

        async def is_enough(done: int) -> bool:
            nonlocal began
            with self._action(f"repeat until {condition}", is_reported=False) as motion:
                if motion.backend.clock.time == began:
                    await motion.wait()
                if await motion.check(condition):
                    return True
                if done >= MAX_ROUNDS:
                    raise motion.failure(f"after {done} rounds {condition.unmet()}")
                began = motion.backend.clock.time
            return False

        self._connected()
        return RepeatUntil(self, is_enough)

    async def turn_until_free(self, side: Side, *sensors: str) -> None:
        """Turns in place until none of the sensors and bumpers detects an object."""
        free = Condition(sensors, detection=False)
        with self._action(f"turn {side} until {free}") as motion:
            here = await motion.rotate_while(
                1.0 if side == "left" else -1.0,
                lambda: not free.holds(motion.backend, self.bumpers),
            )
            if here is None:
                raise motion.failure(f"after a full turn {free.unmet()}")
            self._report(here)

    async def slam(self) -> None:
        """Explores a closed area with its distance sensors and maps it."""
        with self._action("slam") as motion:
            motion.forget_plan()
            await motion.wait()
            if self._slam_session is not None:
                from .slam.exploration import explore

                await explore(motion, self._slam_session)
            self._report(motion.pose())

    async def step(self, rates: Sequence[float]) -> Pose:
        """Sets the rates of the wheels in rad/s, waits for the next step, and returns the pose.

        For control loops of your own; it is no action, and prints nothing.
        """
        motion = self._connected()
        motion.forget_plan()
        return await motion.step(rates)

    def pose(self) -> Pose:
        """The pose of the wheels' centre."""
        return self._connected().pose()

    def detects(self, sensor: str) -> bool:
        """Whether a distance sensor or bumper detects an object; needs an earlier step."""
        return self._connected().backend.detects(sensor)

    def distance(self, sensor: str) -> float | None:
        """The distance in metres that a sensor measures, or None; needs an earlier step."""
        return self._connected().backend.distance(sensor)

    @property
    def time(self) -> float:
        """Seconds of simulation time after the latest step."""
        return self._connected().backend.clock.time

    def spec(self, host: str, port: int) -> RobotSpec:
        """What a backend has to know of this robot."""
        return RobotSpec(
            self.name,
            host,
            port,
            self.wheels,
            self.sensors,
            self.bumpers,
            self.objects,
            self._type(),
            self.ros2,
            self.mounts,
        )

    def _type(self) -> TypeName:
        """The type with its drive; one with wheels of its own is like the first."""
        drive = getattr(self.drive_type, "__name__", "")
        found = (name for name, row in ROBOT_TYPES.items() if row.drive == drive)
        return next(found, "tw")

    def connect(
        self,
        spec: RobotSpec,
        backend: Backend,
        loop: SimulationLoop,
        order: int,
        trace: Trace,
        slam_session: "SlamSession | None" = None,
    ) -> None:
        """Connects it with its backend, as `run` does; raises SetupError."""
        try:
            drive: Drive = self.drive_type(
                backend.wheel_mounts(), list(self.wheels.values())
            )
        except SetupError as error:
            raise SetupError(f"robot {self.name}: {error}") from None
        self._motion = Motion(spec, backend, drive, loop, order, trace)
        self._slam_session = slam_session

    def _connected(self) -> Motion:
        if self._motion is None:
            raise RuntimeError(
                f"robot {self.name} acts within pydslrep_runtime.run only"
            )
        return self._motion

    @contextmanager
    def _action(self, what: str, *, is_reported: bool = True) -> Iterator[Motion]:
        """Names an action; after an error, its wheels stop. Not all are reported: conditions of statements are none."""
        motion = self._connected()
        if self._is_acting:
            raise motion.failure(f"cannot begin to {what} before this action has ended")
        motion.place = place_of(self, is_action=is_reported)
        motion.action_text = what
        self._is_acting = True
        try:
            if is_reported and events.current.is_read:
                events.current.action_begun(motion.moment(motion.pose()))
            yield motion
        except SimulatorError as error:
            self._abort(motion)
            raise motion.failure(error) from error
        except BaseException:
            self._abort(motion)
            raise
        finally:
            self._is_acting = False

    @staticmethod
    def _abort(motion: Motion) -> None:
        motion.forget_plan()
        with suppress(SimulatorError):
            motion.backend.stop()

    def _end(self, here: Pose, watch: Watch, limit: str) -> None:
        """Reports the end of an action; at its limit, the condition had to be met."""
        if limit and watch.condition is not None and not watch(here):
            raise self._connected().failure(f"after {limit} {watch.condition.unmet()}")
        self._report(here)

    def _report(self, here: Pose) -> None:
        events.current.action_ended(self._connected().moment(here))


def has_end(amount: float | None, until: Condition | None) -> bool:
    """Whether an action ends by itself; raises ValueError if it never ends."""
    if amount is None and until is None:
        raise ValueError("an action ends by an amount, a condition, or both")
    return amount is not None


def angle_of(degrees: float | Side) -> float:
    """An angle in radians; with a side, the largest one that is turned until a condition holds."""
    if isinstance(degrees, str):
        degrees = MAX_TURN if degrees == "left" else -MAX_TURN
    return math.radians(degrees)


def turn_text(degrees: float | Side) -> str:
    """An angle in words."""
    if isinstance(degrees, str):
        return degrees
    side = "left" if degrees >= 0.0 else "right"
    return f"{side} {abs(degrees):g} deg"


def stop_text(until: Condition | None) -> str:
    """What ends an action early, in words."""
    return "" if until is None else f" until {until}"


class TwoWheelRobot(Robot):
    """A robot with differential drive."""

    drive_type = TwoWheelDrive

    def __init__(
        self,
        name: str,
        *,
        port: int,
        left: Wheel,
        right: Wheel,
        sensors: Sequence[str] = (),
        bumpers: Sequence[str] = (),
        objects: Objects = NO_OBJECTS,
        ros2: Ros2Settings = NO_SETTINGS,
        mounts: Mounts = NO_MOUNTS,
    ) -> None:
        super().__init__(
            name,
            port=port,
            wheels=(left, right),
            sensors=sensors,
            bumpers=bumpers,
            objects=objects,
            ros2=ros2,
            mounts=mounts,
        )


class FourWheelRobot(Robot):
    """A robot with four standard wheels, which turns by skidding."""

    drive_type: ClassVar[DriveType] = FourWheelDrive

    def __init__(
        self,
        name: str,
        *,
        port: int,
        left_front: Wheel,
        left_rear: Wheel,
        right_front: Wheel,
        right_rear: Wheel,
        sensors: Sequence[str] = (),
        bumpers: Sequence[str] = (),
        objects: Objects = NO_OBJECTS,
        ros2: Ros2Settings = NO_SETTINGS,
        mounts: Mounts = NO_MOUNTS,
    ) -> None:
        wheels = (left_front, left_rear, right_front, right_rear)
        super().__init__(
            name,
            port=port,
            wheels=wheels,
            sensors=sensors,
            bumpers=bumpers,
            objects=objects,
            ros2=ros2,
            mounts=mounts,
        )


class MecanumRobot(FourWheelRobot):
    """A robot with four mecanum wheels; seen from above, their rollers form an X."""

    drive_type = MecanumDrive
