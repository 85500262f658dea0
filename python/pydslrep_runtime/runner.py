"""Runs an environment: its command line, its connections, its errors and its exit code."""

import argparse
import asyncio
import inspect
import signal
import sys
from collections.abc import Callable, Coroutine, Sequence
from contextlib import ExitStack, nullcontext
from types import FrameType
from typing import Any, Literal, NoReturn, Protocol

from . import movements
from .backend import Backend, RobotSpec, load_backend
from .command_line import parse_arguments
from .errors import MovementError, SetupError, SimulatorError
from .event_loop import SimulationLoop
from .movements import Movement
from .outputs import growing_trace
from .robots import Robot
from .slam.session import SlamSession
from .trace import Trace
from .version import __version__

BackendName = Literal["coppeliasim", "vrep"]
Main = Callable[[], Coroutine[Any, Any, object]]

DONE, FAILED, BROKEN, INTERRUPTED = 0, 1, 2, 130  # exit codes


class Simulator(Protocol):
    """A simulator with some of the robots."""

    def connect(self, spec: RobotSpec) -> Backend:
        """Connects a robot; raises SetupError."""

    def start(self) -> None:
        """Starts the simulation if it is stopped; time stands still until the first step."""

    def close(self) -> None:
        """Stops the simulation if it was started here, and disconnects."""


def run(
    main: Main,
    *,
    robots: Sequence[Robot],
    host: str = "127.0.0.1",
    backend: BackendName = "coppeliasim",
    name: str | None = None,
    version: str | None = None,
) -> NoReturn:
    """Connects the robots, runs a coroutine function with them, and ends the process.

    The command line can replace `host` and more; `--help` describes it. `name` is that of the environment if it is not the
    function's, `version` the version of the runtime that the script was generated for. Exit codes: 0 done, 1 an action
    failed, 2 a robot cannot be reached, 130 interrupted.
    """
    warn_of_other_version(version)
    environment = name or main.__name__
    options = parse_arguments(
        robots,
        description=getattr(inspect.unwrap(main), "__globals__", {}).get("__doc__"),
        host=host,
        backend=backend,
        environment=environment,
    )
    handle_signals()
    sys.exit(report(lambda: drive(main, robots, backend, environment, options)))


def warn_of_other_version(version: str | None) -> None:
    """Says if a script was generated for another version of the runtime."""
    if version not in (None, __version__):
        print(
            f"warning: this script was generated for pydslrep_runtime {version}, but runs with "
            f"{__version__}: generate it again with `pydslrep build`",
            file=sys.stderr,
        )


def handle_signals() -> None:
    """Ctrl-C and a request to end interrupt the run at once, even while a call waits."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        # asyncio replaces the default handler by one that waits for the call.
        signal.signal(signal.SIGINT, interrupt)
    signal.signal(signal.SIGTERM, interrupt)


def interrupt(_signal: int, _frame: FrameType | None) -> None:
    """Handles a signal."""
    raise KeyboardInterrupt


def report(run: Callable[[], None]) -> int:
    """Prints the error that ends a run, and returns the exit code."""
    try:
        run()
    except MovementError as error:
        print(f"error: {error}", file=sys.stderr)
        return FAILED
    except (SetupError, SimulatorError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return BROKEN
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    return DONE


def drive(
    main: Main,
    robots: Sequence[Robot],
    backend: BackendName,
    environment: str,
    options: argparse.Namespace,
) -> None:
    """Connects the robots and runs `main`; stops them whatever happens."""
    trace_file = growing_trace(options.trace) if options.trace else nullcontext()
    with trace_file as file, ExitStack() as cleanup:
        fleet = Fleet(robots, backend, options)
        cleanup.callback(fleet.close)
        fleet.connect()
        loop = SimulationLoop()
        runner = cleanup.enter_context(asyncio.Runner(loop_factory=lambda: loop))
        # Before the tasks are cancelled, which runs code of the script.
        cleanup.callback(fleet.stop)
        cleanup.callback(loop.use_clock, None)
        fleet.start(loop, Trace(file), SlamSession(environment, options))
        runner.run(run_main(main, environment))


async def run_main(main: Main, environment: str) -> None:
    """Runs `main`; actions outside of any movement have the environment's name."""
    movements.current.set(Movement(environment))
    await main()


class Fleet:
    """The robots of a run, and their connections."""

    def __init__(
        self, robots: Sequence[Robot], backend: BackendName, options: argparse.Namespace
    ) -> None:
        self._robots, self._backend, self._options = robots, backend, options
        self._simulator: Simulator | None = None
        self._connected: list[tuple[Robot, RobotSpec, Backend]] = []

    def connect(self) -> None:
        """Connects all robots; raises SetupError."""
        options = self._options
        for robot in self._robots:
            spec = robot.spec(options.host, options.ports[robot.name])
            own_class = options.classes[robot.name]
            connect = load_backend(own_class) if own_class else self._simulated
            self._connected.append((robot, spec, connect(spec)))

    def start(
        self, loop: SimulationLoop, trace: Trace, slam_session: SlamSession
    ) -> None:
        """Starts the simulation; its time stands still until the first movement."""
        for order, (robot, spec, backend) in enumerate(self._connected):
            robot.connect(spec, backend, loop, order, trace, slam_session)
        if self._simulator is not None:
            self._simulator.start()
        for _, spec, backend in self._connected:
            # A previous client may have left the wheels turning.
            backend.set_wheel_rates([0.0] * len(spec.wheels))
        if self._connected:
            loop.use_clock(self._connected[0][2].clock)

    def stop(self) -> None:
        """Stops all wheels, even after an error."""
        with ExitStack() as stops:
            for _, _, backend in reversed(self._connected):
                stops.callback(backend.stop)

    def close(self) -> None:
        """Releases all robots, and stops the simulation if it was started here."""
        with ExitStack() as closes:
            if self._simulator is not None:
                closes.callback(self._simulator.close)
            for _, _, backend in reversed(self._connected):
                closes.callback(backend.close)

    def _simulated(self, spec: RobotSpec) -> Backend:
        if self._simulator is None:
            self._simulator = connect_to(self._backend, self._options)
        return self._simulator.connect(spec)


def connect_to(backend: BackendName, options: argparse.Namespace) -> Simulator:
    """A simulator, whose client library is imported only if it is used; raises SetupError."""
    if backend == "vrep":
        from .vrep import VRep

        return VRep(options.host, realtime=options.realtime)
    from .coppeliasim import CoppeliaSim

    return CoppeliaSim(options.host, realtime=options.realtime)
