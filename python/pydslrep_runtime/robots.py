"""Robots: what a program declares, and the actions that it asks for."""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, ClassVar, Literal

from . import events, movements
from .backend import Backend, RobotSpec
from .drives import Drive, DriveType, FourMecanumDrive, FourWheelDrive, TwoWheelDrive
from .errors import SetupError, SimulatorError
from .event_loop import SimulationLoop
from .facts import RIM_SPEED
from .motion import Motion
from .movements import Movement
from .pose import Pose
from .trace import Trace

if TYPE_CHECKING:
    from .slam.session import SlamSession

Wheel = tuple[str, float]
"""The name of a wheel's joint, and the radius in metres."""


Objects = Mapping[str, str | Sequence[str]]
"""Paths in a simulator's scene by name; several if a wheel and a sensor share a name."""

NO_OBJECTS: Objects = {}


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
    ) -> None:
        """`port` is that of its simulator's remote API.

        `objects` are the paths of the robot and its parts in the simulator's scene, by name, if their names are others
        there.
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
        self._motion: Motion | None = None
        self._slam_session: SlamSession | None = None
        self._movement: Movement | None = None
        self._actions = 0  # of the movement so far
        self._is_acting = False

    async def move(self, distance: float, speed: float = RIM_SPEED) -> None:
        """Drives straight, in metres (backwards if negative) and m/s."""
        with self._action(f"move {distance:g} m") as motion:
            self._report(await motion.move(distance, speed))

    async def turn(self, degrees: float) -> None:
        """Turns in place, to the left if positive."""
        side = "left" if degrees >= 0.0 else "right"
        with self._action(f"turn {side} {abs(degrees):g} deg") as motion:
            self._report(await motion.rotate(math.radians(degrees)))

    async def turn_until_free(
        self, side: Literal["left", "right"], *sensors: str
    ) -> None:
        """Turns in place until none of the sensors and bumpers detects an object."""
        names = ", ".join(sensors)
        detect = "detects" if len(sensors) == 1 else "detect"
        with self._action(f"turn {side} until {names} {detect} nothing") as motion:
            here = await motion.rotate_while(
                1.0 if side == "left" else -1.0,
                lambda: any(map(motion.backend.detects, sensors)),
            )
            if here is None:
                raise motion.failure(
                    f"after a full turn {names} still {detect} something"
                )
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
        )

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
    def _action(self, what: str) -> Iterator[Motion]:
        """Names an action; after an error, its wheels stop."""
        motion = self._connected()
        if self._is_acting:
            raise motion.failure(f"cannot begin to {what} before this action has ended")
        self._count(motion, what)
        self._is_acting = True
        try:
            if events.current.is_read:
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

    def _count(self, motion: Motion, what: str) -> None:
        movement = movements.current.get()
        if movement is not self._movement:
            self._movement, self._actions = movement, 0
        self._actions += 1
        motion.movement = movement.name
        motion.action_number, motion.action_text = self._actions, what

    @staticmethod
    def _abort(motion: Motion) -> None:
        motion.forget_plan()
        with suppress(SimulatorError):
            motion.backend.stop()

    def _report(self, here: Pose) -> None:
        events.current.action_ended(self._connected().moment(here))


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
    ) -> None:
        super().__init__(
            name,
            port=port,
            wheels=(left, right),
            sensors=sensors,
            bumpers=bumpers,
            objects=objects,
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
    ) -> None:
        wheels = (left_front, left_rear, right_front, right_rear)
        super().__init__(
            name,
            port=port,
            wheels=wheels,
            sensors=sensors,
            bumpers=bumpers,
            objects=objects,
        )


class MecanumRobot(FourWheelRobot):
    """A robot with four mecanum wheels; seen from above, their rollers form an X."""

    drive_type = FourMecanumDrive
