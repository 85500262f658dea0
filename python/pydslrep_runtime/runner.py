"""Runs an environment: its command line, its connections, its errors and its exit code."""

import argparse
import asyncio
import importlib
import inspect
import os
import sys
from collections.abc import Callable, Coroutine, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, Literal, NoReturn, Protocol, TextIO

from . import events, interrupts, movements
from .backend import Backend, RobotSpec, load_backend
from .checked_backend import CheckedBackend
from .command_line import parse_arguments
from .errors import MovementError, SetupError, SimulatorError
from .event_loop import SimulationLoop
from .movements import Movement
from .outputs import growing_trace
from .robots import Robot
from .slam.session import SlamSession
from .trace import Trace
from .version import __version__

BackendName = Literal["coppeliasim", "vrep", "ros2"]
Main = Callable[[], Coroutine[Any, Any, object]]

DONE, FAILED, BROKEN = 0, 1, 2  # exit codes


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
    environment = name or main.__name__
    options = parse_arguments(
        robots,
        description=getattr(inspect.unwrap(main), "__globals__", {}).get("__doc__"),
        host=host,
        backend=backend,
        environment=environment,
    )
    interrupts.listen()
    with ExitStack() as reports:

        def run_reported() -> None:
            reporter = reports.enter_context(events.use(options.events))
            reporter.started(environment, [robot.name for robot in robots])
            warn_of_other_version(version)
            drive(main, robots, backend, environment, options)

        code = report(run_reported)
    close_outputs()
    sys.exit(code)


def warn_of_other_version(version: str | None) -> None:
    """Says if a script was generated for another version of the runtime."""
    if version not in (None, __version__):
        events.current.warning(
            f"this script was generated for pydslrep_runtime {version}, but runs with "
            f"{__version__}: generate it again with `pydslrep build`"
        )


def report(run: Callable[[], None]) -> int:
    """Reports the error that ends a run, and returns the exit code."""
    try:
        run()
        interrupts.ignore()
    except MovementError as error:
        events.current.failed(error)
        return FAILED
    except (SetupError, SimulatorError, OSError) as error:
        events.current.failed(error)
        return BROKEN
    except KeyboardInterrupt:
        events.current.interrupted()
        return interrupts.EXIT_CODE
    except Exception as error:
        events.current.crashed(error)
        raise
    finally:
        interrupts.ignore()
    return DONE


def close_outputs() -> None:
    """Writes what is left; Python would end with a code of its own if a closed terminal does not take it."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def drive(
    main: Main,
    robots: Sequence[Robot],
    backend: BackendName,
    environment: str,
    options: argparse.Namespace,
) -> None:
    """Connects the robots and runs `main`; stops them whatever happens."""
    with ExitStack() as cleanup:
        file = cleanup.enter_context(trace_file(options.trace))
        fleet = Fleet(robots, backend, options)
        cleanup.callback(fleet.close)
        cleanup.callback(interrupts.hold)
        fleet.connect()
        loop = SimulationLoop()
        runner = cleanup.enter_context(asyncio.Runner(loop_factory=lambda: loop))
        # Before the tasks are cancelled, which runs code of the script.
        cleanup.callback(fleet.stop)
        cleanup.callback(loop.use_clock, None)
        cleanup.callback(interrupts.hold)
        fleet.start(loop, Trace(file), SlamSession(environment, options))
        runner.run(run_main(main, environment))


@contextmanager
def trace_file(path: Path | None) -> Iterator[TextIO | None]:
    """The trace to write, if one is asked for, and reports it when it is complete."""
    if path is None:
        yield None
        return
    with ExitStack() as after, growing_trace(path) as file:
        try:
            yield file
        finally:
            # Up to an error, it is worth reading too.
            if file.tell() > 0:
                after.callback(events.current.file, "trace", path)


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
            if own_class:
                backend: Backend = CheckedBackend(load_backend(own_class)(spec), spec)
            else:
                backend = self._simulated(spec)
            self._connected.append((robot, spec, backend))

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
    """A simulator, whose library is imported only if it is used; raises SetupError."""
    if options.mujoco is not None:
        engine = importlib.import_module("pydslrep_runtime.mujoco_engine")
        speed = 1.0 if options.realtime and options.speed is None else options.speed
        simulator: Simulator = engine.MuJoCo(
            options.mujoco, speed=speed, view=options.view
        )
        return simulator
    if backend == "vrep":
        from .vrep import VRep

        return VRep(options.host, realtime=options.realtime)
    if backend == "ros2":
        from .ros2 import Ros2

        return Ros2(sim_time=options.sim_time)
    from .coppeliasim import CoppeliaSim

    return CoppeliaSim(options.host, realtime=options.realtime, restart=options.restart)
