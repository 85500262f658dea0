#: if standalone
"""The command line of a script."""

import argparse
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from pathlib import Path

from .coppeliasim import PORT_HELP, REALTIME_HELP, SIMULATOR
from .errors import MovementError, SetupError, SimulatorError
from .fleet import Fleet
from .model import RobotModel
from .slam_session import SlamSession, add_slam_options
from .trace_file import Trace

#: endif


def parse_port(text: str) -> tuple[str | None, int]:
    """Parses PORT or ROBOT=PORT."""
    robot, equals, port = text.rpartition("=")
    if not port.isdecimal() or not 1 <= int(port) <= 65535:
        raise argparse.ArgumentTypeError(f"{port!r} is not a port from 1 to 65535")
    return robot if equals else None, int(port)


def parse_arguments(
    description: str | None,
    host: str,
    models: Sequence[RobotModel],
    #: if slam
    environment: str = "environment",
    #: endif
) -> argparse.Namespace:
    """Parses the command line; `ports` of the result has every robot's port."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--host", default=host, help=f"host of {SIMULATOR} (default: %(default)s)"
    )
    parser.add_argument(
        "--port",
        action="append",
        default=[],
        type=parse_port,
        metavar="[ROBOT=]PORT",
        help=PORT_HELP,
    )
    parser.add_argument(
        "--trace",
        type=Path,
        metavar="FILE",
        help="write every step to FILE, as JSON lines",
    )
    parser.add_argument("--realtime", action="store_true", help=REALTIME_HELP)
    #: if slam
    add_slam_options(parser, environment)
    #: endif
    options = parser.parse_args()
    options.ports = {model.name: model.port for model in models}
    for robot, port in sorted(options.port, key=lambda choice: choice[0] is not None):
        if robot is not None and robot not in options.ports:
            parser.error(f"no robot {robot}; the robots are {', '.join(options.ports)}")
        options.ports.update(dict.fromkeys([robot] if robot else options.ports, port))
    return options


def main(
    description: str | None,
    host: str,
    models: Sequence[RobotModel],
    drive: Callable[[Fleet], None],
    #: if slam
    environment: str = "environment",
    #: endif
) -> int:
    """Runs an environment and returns the exit code."""
    options = parse_arguments(
        description,
        host,
        models,
        #: if slam
        environment,
        #: endif
    )
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        trace_file = (
            options.trace.open("w", encoding="utf-8") if options.trace else None
        )
        with trace_file or nullcontext():
            fleet = Fleet(Trace(trace_file))
            #: if slam
            fleet.slam_session = SlamSession(environment, options)
            #: endif
            try:
                for model in models:
                    port = options.ports[model.name]
                    fleet.connect(model, options.host, port, options.realtime)
                fleet.start()
                drive(fleet)
            finally:
                fleet.shut_down()
    except MovementError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except (SetupError, SimulatorError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130
    return 0
