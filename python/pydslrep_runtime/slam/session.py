"""The options of slam, and the file that it writes its maps to."""

import argparse
import importlib
import io
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import events
from ..errors import SetupError
from ..facts import SENSOR_CONE, SENSOR_RANGE
from ..outputs import PICTURE_MARK, is_map, is_picture, output_path, write_whole

if TYPE_CHECKING:
    from .topological_map import TopologicalMap

NamedValue = tuple[str | None, float]  # for one sensor or robot, or for all (None)

EXTENT = 20.0  # m from the start; a larger area counts as unbounded


def parse_positive(text: str) -> float:
    """Parses a positive number."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number")
    return value


def parse_named_value(text: str) -> NamedValue:
    """Parses NUMBER or NAME=NUMBER."""
    name, equals, number = text.rpartition("=")
    return name if equals else None, parse_positive(number)


def add_slam_options(parser: argparse.ArgumentParser, environment: str) -> None:
    """Adds the options of scripts with slam."""
    group = parser.add_argument_group("slam")
    numbers = (
        (
            "--range",
            "[SENSOR=]METRES",
            "range of the sensors (default: as the simulator reports, else 1)",
        ),
        (
            "--cone",
            "[SENSOR=]DEGREES",
            "opening angle of the sensors (default: as the simulator reports, else 20)",
        ),
        (
            "--radius",
            "[ROBOT=]METRES",
            "radius of the robot around its wheels' centre (default: up to its sensors)",
        ),
    )
    for option, metavar, text in numbers:
        group.add_argument(
            option,
            action="append",
            default=[],
            type=parse_named_value,
            metavar=metavar,
            help=text,
        )
    group.add_argument(
        "--extent",
        type=parse_positive,
        default=EXTENT,
        metavar="METRES",
        help="largest distance of the area from the start (default: %(default)g)",
    )
    group.add_argument(
        "--odometry",
        action="store_true",
        help="use wheel odometry instead of the simulator's poses",
    )
    group.add_argument(
        "--map",
        type=Path,
        default=Path(f"{environment}_map.json"),
        metavar="FILE",
        help="write the map to FILE (default: %(default)s), and a PNG next to it",
    )


class SlamSession:
    """The options of slam, and the maps of all robots so far."""

    def __init__(self, environment: str, options: argparse.Namespace) -> None:
        """Raises SetupError if modules for the options are missing."""
        self.uses_odometry: bool = options.odometry
        if self.uses_odometry:
            check_modules()
        self.extent: float = options.extent
        self._environment = environment
        self._ranges: dict[str | None, float] = dict(options.range)
        self._cones: dict[str | None, float] = dict(options.cone)
        self._radii: dict[str | None, float] = dict(options.radius)
        self._file: Path = options.map
        self._nodes: list[dict[str, Any]] = []
        self._edges: list[dict[str, Any]] = []

    def range(self, robot: str, sensor: str, reported: float | None) -> float:
        """The range of a sensor in metres; `reported` is the simulator's value."""
        given = lookup(self._ranges, f"{robot}.{sensor}", sensor)
        return given or reported or SENSOR_RANGE

    def cone(self, robot: str, sensor: str, reported: float | None) -> float:
        """The opening angle of a sensor in radians; `reported` is the simulator's."""
        given = lookup(self._cones, f"{robot}.{sensor}", sensor)
        return math.radians(given) if given else reported or SENSOR_CONE

    def radius(self, robot: str, measured: float) -> float:
        """The radius of the circle that encloses a robot, in metres."""
        return lookup(self._radii, robot) or measured

    def check_outputs(self) -> None:
        """Raises SetupError if the map cannot be written: better before hours of driving."""
        output_path(self._file, is_map, "a map")

    def add_map(self, robot: str, found: "TopologicalMap") -> None:
        """Adds a robot's map and writes the file."""
        first = len(self._nodes)
        data = found.as_json()
        for node in data["nodes"]:
            for frontier in node["exits"]:
                if frontier["to"] is not None:
                    frontier["to"] += first
            self._nodes.append({**node, "id": node["id"] + first, "robot": robot})
        for edge in data["edges"]:
            ends = {"from": edge["from"] + first, "to": edge["to"] + first}
            self._edges.append({**edge, **ends})
        self._write()

    def _write(self) -> None:
        data = {
            "environment": self._environment,
            "nodes": self._nodes,
            "edges": self._edges,
        }
        text = json.dumps(data, indent=1) + "\n"
        write_whole(output_path(self._file, is_map, "a map"), text.encode())
        events.current.file("map", self._file)
        self._plot(self._file.with_suffix(".png"))

    def _plot(self, file: Path) -> None:
        """Draws the map if matplotlib is installed; `file` may be something else."""
        try:
            figure_module = importlib.import_module("matplotlib.figure")
        except ImportError:
            return
        figure = figure_module.Figure(figsize=(8, 8), layout="constrained")
        axes = figure.add_subplot(
            aspect="equal", xlabel="x in m", ylabel="y in m", title=self._environment
        )
        for edge in self._edges:
            ends = self._nodes[edge["from"]], self._nodes[edge["to"]]
            axes.plot([n["x"] for n in ends], [n["y"] for n in ends], color="#d55e00")
        xs, ys = ([node[axis] for node in self._nodes] for axis in "xy")
        axes.plot(xs, ys, "o", markersize=4, color="#0072b2", zorder=3)
        axes.grid(color="#e4e8ec")
        content = io.BytesIO()
        figure.savefig(content, metadata={"Comment": PICTURE_MARK})
        try:
            place = output_path(file, is_picture, "a picture of a map")
        except SetupError as error:
            # The map is written, and it is what counts.
            events.current.warning(str(error))
        else:
            write_whole(place, content.getvalue())
            events.current.file("map-picture", file)


def check_modules() -> None:
    """Raises SetupError if a module that odometry needs is missing."""
    try:
        for name in ("numpy", "scipy"):
            importlib.import_module(name)
    except ImportError as error:
        raise SetupError(
            "--odometry needs numpy and scipy: python3 -m pip install numpy scipy"
        ) from error


def lookup(values: dict[str | None, float], *names: str) -> float | None:
    """The value for the first of some names, or else for all (None)."""
    return next((values[name] for name in (*names, None) if name in values), None)
