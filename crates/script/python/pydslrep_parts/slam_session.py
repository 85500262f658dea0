#: if standalone
"""What slam is told, and what it leaves: the map of an environment."""

import argparse
import importlib
import json
import math
from pathlib import Path
from typing import Any

from .topological_map import TopologicalMap

#: endif


Choice = tuple[str | None, float]  # of a sensor or robot, or for all of them


EXTENT = 20.0  # m from the start: further off, an area has no end


def parse_length(text: str) -> float:
    """A number above zero."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text!r} is no number above zero")
    return value


def parse_choice(text: str) -> Choice:
    """NUMBER or NAME=NUMBER, above zero."""
    name, equals, number = text.rpartition("=")
    return name if equals else None, parse_length(number)


def add_survey_options(parser: argparse.ArgumentParser, environment: str) -> None:
    """The options of scripts with slam."""
    group = parser.add_argument_group("slam")
    numbers = (
        (
            "--range",
            "[SENSOR=]METRES",
            "how far sensors see (what the simulator says, else 1)",
        ),
        (
            "--cone",
            "[SENSOR=]DEGREES",
            "how wide sensors see (what the simulator says, else 20)",
        ),
        (
            "--radius",
            "[ROBOT=]METRES",
            "of the robot about the middle of its wheels (what holds these and its sensors)",
        ),
    )
    for option, metavar, text in numbers:
        group.add_argument(
            option,
            action="append",
            default=[],
            type=parse_choice,
            metavar=metavar,
            help=text,
        )
    group.add_argument(
        "--extent",
        type=parse_length,
        default=EXTENT,
        metavar="METRES",
        help="how far an area may go on from where the robot starts (%(default)g)",
    )
    group.add_argument(
        "--odometry",
        action="store_true",
        help="tell where the robot is by how its wheels turn, not by the simulator",
    )
    group.add_argument(
        "--map",
        type=Path,
        default=Path(f"{environment}_map.json"),
        metavar="FILE",
        help="write the map here (%(default)s), and its picture beside it as PNG",
    )


class Survey:
    """What slam is told on the command line, and the maps that it made so far."""

    def __init__(self, environment: str, options: argparse.Namespace) -> None:
        self.by_odometry: bool = options.odometry
        self.extent: float = options.extent
        self._environment = environment
        self._ranges: dict[str | None, float] = dict(options.range)
        self._cones: dict[str | None, float] = dict(options.cone)
        self._radii: dict[str | None, float] = dict(options.radius)
        self._file: Path = options.map
        self._nodes: list[dict[str, Any]] = []
        self._edges: list[dict[str, Any]] = []

    def range(self, robot: str, sensor: str, told: float | None) -> float:
        """How far a sensor sees in metres; `told` is by the simulator."""
        chosen = choice(self._ranges, f"{robot}.{sensor}", sensor)
        return chosen or told or 1.0

    def cone(self, robot: str, sensor: str, told: float | None) -> float:
        """The opening angle of a sensor in radians; `told` is by the simulator."""
        chosen = choice(self._cones, f"{robot}.{sensor}", sensor)
        return math.radians(chosen) if chosen else told or math.radians(20.0)

    def radius(self, robot: str, spanned: float) -> float:
        """That of a circle that holds a robot, in metres."""
        return choice(self._radii, robot) or spanned

    def add(self, robot: str, found: TopologicalMap) -> None:
        """Adds a robot's map to what is written."""
        first = len(self._nodes)
        data = found.as_json()
        for node in data["nodes"]:
            for exit_ in node["exits"]:
                if exit_["to"] is not None:
                    exit_["to"] += first
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
        self._file.write_text(text, encoding="utf-8")
        self._draw(self._file.with_suffix(".png"))

    def _draw(self, file: Path) -> None:
        """Draws the map where matplotlib is installed."""
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
        figure.savefig(file)


def choice(choices: dict[str | None, float], *names: str) -> float | None:
    """What was chosen for the first of some names, or for all."""
    return next((choices[name] for name in (*names, None) if name in choices), None)
