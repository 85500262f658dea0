"""The command line of a script."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from .robots import Robot
from .slam.session import add_slam_options, parse_positive

T = TypeVar("T")


@dataclass(frozen=True)
class Simulator:
    """What the help says of a simulator."""

    name: str
    ports: str
    realtime: str


SIMULATORS: Mapping[str, Simulator] = {
    "coppeliasim": Simulator(
        "CoppeliaSim",
        "port of the ZeroMQ remote API, for all robots or one; repeatable",
        "run no faster than real time",
    ),
    "vrep": Simulator(
        "V-REP",
        "port of the remote API, for all robots or one; repeatable",
        "run in real time instead of triggering every step",
    ),
}


@dataclass(frozen=True)
class Named(Generic[T]):
    """A value for one robot, or for all."""

    robot: str | None
    value: T


def parse_port(text: str) -> Named[int]:
    """Parses PORT or ROBOT=PORT."""
    robot, equals, port = text.rpartition("=")
    if not port.isdecimal() or not 1 <= int(port) <= 65535:
        raise argparse.ArgumentTypeError(f"{port!r} is not a port from 1 to 65535")
    return Named(robot if equals else None, int(port))


def parse_class(text: str) -> Named[str]:
    """Parses MODULE:CLASS or ROBOT=MODULE:CLASS."""
    robot, equals, name = text.rpartition("=")
    module, _, class_name = name.partition(":")
    if not (module and class_name.isidentifier()):
        raise argparse.ArgumentTypeError(f"{name!r} is not of the form MODULE:CLASS")
    return Named(robot if equals else None, name)


def parse_arguments(
    robots: Sequence[Robot],
    *,
    description: str | None,
    host: str,
    backend: str,
    environment: str,
) -> argparse.Namespace:
    """Parses the command line; in the result, `ports` and `classes` are by robot."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    if backend == "ros2":
        add_ros2_options(parser)
    else:
        add_simulator_options(parser, SIMULATORS[backend], host)
        add_mujoco_options(parser)
    parser.add_argument(
        "--robot",
        action="append",
        default=[],
        type=parse_class,
        metavar="[ROBOT=]MODULE:CLASS",
        help="drive with a class of your own instead, all robots or one; repeatable",
    )
    parser.add_argument(
        "--trace",
        type=Path,
        metavar="FILE",
        help="write every step to FILE, as JSON lines",
    )
    parser.add_argument(
        "--events",
        metavar="FILE",
        help="write what happens to FILE, as JSON lines for programs; "
        "- is standard output, in place of the lines for people",
    )
    if backend == "coppeliasim":
        # V-REP often listens only while its simulation runs.
        parser.add_argument(
            "--restart",
            action="store_true",
            help="stop a simulation that runs already, which puts everything back, and start it again",
        )
    add_slam_options(parser, environment)
    options = parser.parse_args()
    if options.mujoco is None and (options.view or options.speed is not None):
        parser.error("--view and --speed are for --mujoco")
    ports = {robot.name: robot.port for robot in robots}
    options.ports = by_robot(ports, options.port, parser.error)
    classes: dict[str, str | None] = dict.fromkeys(ports)
    options.classes = by_robot(classes, options.robot, parser.error)
    return options


def add_mujoco_options(parser: argparse.ArgumentParser) -> None:
    """Adds the options of scripts whose robots drive in MuJoCo."""
    group = parser.add_argument_group("MuJoCo")
    group.add_argument(
        "--mujoco",
        type=Path,
        metavar="FILE",
        help="drive in MuJoCo instead, in the world that `pydslrep plan --mjcf FILE` has written",
    )
    group.add_argument("--view", action="store_true", help="show the world in a window")
    group.add_argument(
        "--speed",
        type=parse_positive,
        metavar="X",
        help="simulated seconds per second (default: as fast as possible, with --view 1)",
    )


def add_simulator_options(
    parser: argparse.ArgumentParser, simulator: Simulator, host: str
) -> None:
    """Where a simulator is, and how fast it runs."""
    parser.add_argument(
        "--host", default=host, help=f"host of {simulator.name} (default: %(default)s)"
    )
    parser.add_argument(
        "--port",
        action="append",
        default=[],
        type=parse_port,
        metavar="[ROBOT=]PORT",
        help=simulator.ports,
    )
    parser.add_argument("--realtime", action="store_true", help=simulator.realtime)


def add_ros2_options(parser: argparse.ArgumentParser) -> None:
    """In ROS 2 there are no ports, and time may be that of a simulation."""
    parser.set_defaults(host="", port=[], mujoco=None, view=False, speed=None)
    parser.add_argument(
        "--sim-time",
        action="store_true",
        help="time is that of the topic /clock; without it, real time",
    )


def by_robot(
    defaults: Mapping[str, T],
    chosen: Sequence[Named[T]],
    fail: Callable[[str], object],
) -> Mapping[str, T]:
    """The value of each robot; those for one robot have priority over those for all."""
    values = dict(defaults)
    for choice in sorted(chosen, key=lambda choice: choice.robot is not None):
        if choice.robot is not None and choice.robot not in values:
            fail(f"no robot {choice.robot}; the robots are {', '.join(values)}")
        names = list(values) if choice.robot is None else [choice.robot]
        values.update(dict.fromkeys(names, choice.value))
    return values
