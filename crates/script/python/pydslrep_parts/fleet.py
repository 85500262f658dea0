#: if standalone
"""The robots of an environment, and how they run its movements."""

from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import suppress
from threading import Event, Lock

from .coppeliasim import Body
from .errors import MovementCancelledError, SimulatorError
from .model import RobotModel
from .movement import Movement
from .robot import Robot
from .slam_session import SlamSession
from .trace_file import Trace

#: endif


class Fleet:
    """The robots of the environment, and which of them step the simulation."""

    def __init__(self, trace: Trace) -> None:
        self._trace = trace
        self._robots: dict[str, Robot] = {}
        #: if slam
        self.slam_session: SlamSession | None = None
        #: endif
        #: if parallel
        self._cancelled = Event()
        self._lock = Lock()
        self._driving = 0
        #: endif

    def connect(self, model: RobotModel, host: str, port: int, realtime: bool) -> None:
        """Adds a robot; raises SetupError."""
        robot = Robot(Body(model, host, port, realtime), self._trace)
        #: if parallel
        robot.cancelled = self._cancelled
        #: endif
        #: if slam
        robot.slam_session = self.slam_session
        #: endif
        self._robots[model.name] = robot

    def start(self) -> None:
        """Starts the simulation; its time stands still until the first movement."""
        robots = list(self._robots.values())
        self._enable_stepping(robots[:1])
        for robot in robots:
            robot.body.start()
            # A previous client may have left the wheels turning.
            robot.body.set_wheel_rates([0.0] * len(robot.body.model.wheels))

    def run(self, movement: Movement) -> None:
        """Runs a movement; raises MovementError."""
        self._enable_stepping([self._robots[movement.robot]])
        self._drive(movement)
        self._trace.write()

    #: if parallel
    def run_together(self, *movements: Movement) -> None:
        """Runs movements in parallel, one thread each; raises MovementError."""
        self._enable_stepping([self._robots[movement.robot] for movement in movements])
        self._driving = len(movements)
        with ThreadPoolExecutor(len(movements)) as pool:
            runs = [
                pool.submit(self._drive_in_parallel, movement) for movement in movements
            ]
            try:
                while wait(runs, timeout=0.5).not_done:
                    pass  # waking up regularly lets Ctrl-C through on any system
            except KeyboardInterrupt:
                self._cancelled.set()
                raise
        self._trace.write()
        errors = [error for run in runs if (error := run.exception())]
        # The error that cancelled the others comes first.
        errors.sort(key=lambda error: isinstance(error, MovementCancelledError))
        if errors:
            raise errors[0]

    def _drive_in_parallel(self, movement: Movement) -> None:
        body = self._robots[movement.robot].body
        try:
            self._drive(movement)
        except BaseException:
            self._cancelled.set()
            body.stop()
            with suppress(SimulatorError):
                body.disable_stepping()  # so the others proceed and see the cancellation
            raise
        with self._lock:
            self._driving -= 1
            if self._driving > 0:
                # The others need not wait for this robot; the last one keeps stepping.
                body.disable_stepping()

    #: endif
    def _drive(self, movement: Movement) -> None:
        robot = self._robots[movement.robot]
        robot.begin(movement.name)
        try:
            movement.actions(robot)
        except SimulatorError as error:
            raise robot.failure(error) from error

    def _enable_stepping(self, robots: Iterable[Robot]) -> None:
        """From now on, time passes only when all of these robots advance."""
        stepping = list(robots)
        for robot in stepping:
            robot.body.enable_stepping()
        for robot in self._robots.values():
            if robot not in stepping:
                robot.body.disable_stepping()

    def shut_down(self) -> None:
        """Stops all wheels, and the simulation if the script started it."""
        for robot in self._robots.values():
            robot.body.stop()
        for robot in self._robots.values():
            robot.body.close()
        self._trace.write()
