"""Drives the article's programs, and the clients written by hand, in the embedded simulator."""

from __future__ import annotations

import contextlib
import json
import math
import pathlib
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from typing import Any, NamedTuple

from rooms import Rooms, Wall

ROOT = pathlib.Path(__file__).parents[2]
PAPER = ROOT / "tests" / "paper"
HERE = pathlib.Path(__file__).parent
AREA = ROOT / "examples" / "rooms.scene.toml"
"""Of the size that the article gives for environment 3."""

# Reach of a place on a map: a step length and a sensor's range, in metres.
REACH = 0.5 + 1.0
HALF = 0.15  # m, of the robots' bodies


class Table(NamedTuple):
    """A program of the article."""

    number: int
    file: str
    what: str
    scene: pathlib.Path | None = None
    picture: str | None = None

    @property
    def program(self) -> str:
        """The program; table 5 with the wheels that it lists."""
        text = (PAPER / f"{self.file}.pyr").read_text(encoding="utf-8")
        if self.number != 5:
            return text
        declared = "".join(
            f"wheel {name} with radius 4.5\n"
            for name in ("wheelL0", "wheelL1", "wheelR0", "wheelR1")
        )
        return re.sub(r"(?:wheel \w+ with radius 4\.5\n)+", declared, text, count=1)


TABLES = [
    Table(2, "table2_two_wheels", "two wheels", picture="table2.svg"),
    Table(3, "table3_four_wheels", "four wheels"),
    Table(4, "table4_holonomic", "four mecanum wheels"),
    Table(
        5, "table5_angles_as_printed", "angles, wheels declared", picture="table5.svg"
    ),
    Table(
        6,
        "table6_sensors",
        "turns until sensors are free",
        HERE / "scenes" / "table6.toml",
        "table6.svg",
    ),
    Table(7, "table7_slam", "slam in a closed area"),
]


class Result(NamedTuple):
    """Of a run."""

    figures: dict[str, Any]
    picture: str
    map: dict[str, Any]
    trace: pathlib.Path


def run(command: str, table: Table, folder: pathlib.Path) -> Result:
    """Runs a program of the article, which must succeed."""
    (folder / "program.pyr").write_text(table.program, encoding="utf-8")
    options: list[str | pathlib.Path] = []
    if table.number == 7:
        (folder / "area.toml").write_text(area(), encoding="utf-8")
        options = ["--scene", "area.toml"]
    elif table.scene:
        options = ["--scene", table.scene]
    for option in ("figures", "picture", "map", "trace"):
        suffix = {"picture": "svg", "trace": "jsonl"}.get(option, "json")
        if option != "map" or table.number == 7:
            options += [f"--{option}", f"{option}.{suffix}"]
    done = subprocess.run(
        [command, "run", "program.pyr", "--no-progress", *options],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    figures = json.loads((folder / "figures.json").read_text(encoding="utf-8"))
    picture = (folder / "picture.svg").read_text(encoding="utf-8")
    mapped = folder / "map.json"
    found = json.loads(mapped.read_text(encoding="utf-8")) if mapped.exists() else {}
    return Result(figures, picture, found, folder / "trace.jsonl")


def row(table: Table, result: Result) -> str:
    """A row of the table."""
    figures = result.figures
    [robot] = figures["robots"]
    goal, end, off = robot["planned"], robot["driven"], robot["off"]
    if table.number == 7:
        covered = rooms().coverage(places(result.map), REACH)
        found = f"{len(result.map['nodes'])} places, {len(result.map['edges'])} ways"
        planned, driven, apart = (
            "unknown before it runs",
            found,
            f"covers {100 * covered:.1f} % of the floor",
        )
    elif goal:
        planned, driven = pose(goal), pose(end)
        apart = f"{1000 * off['distance']:.1f} mm, {math.degrees(off['angle']):.2f}°"
    else:
        planned, driven, apart = "unknown before it runs", pose(end), ""
    time = f"{figures['planned']:.1f} s" if figures["planned"] else ""
    return (
        f"| {table.number} | {table.what} | {planned} | {driven} | {apart} | {time} "
        f"| {figures['simulated']:.1f} s |"
    )


def pose(at: dict[str, float]) -> str:
    """A pose as text; a heading of -180° is one of 180°."""
    x, y = (round(at[axis], 3) + 0.0 for axis in "xy")
    degrees = math.degrees(at["theta"])
    if degrees <= -179.95:
        degrees += 360.0
    return f"{x:.3f} m, {y:.3f} m, {degrees:.1f}°"


def area() -> str:
    """The scene of environment 3 with table 7's robot."""
    text = AREA.read_text(encoding="utf-8")
    return text.replace("[robots.explorer]", "[robots.robot_1]")


def rooms() -> Rooms:
    """Its walls, without what stands in the rooms."""
    scene = tomllib.loads(area())
    found = Rooms(*scene["world"]["size"])
    for wall in scene["wall"]:
        found.walls.append(Wall(tuple(wall["from"]), tuple(wall["to"])))
    x, y, _ = scene["robots"]["robot_1"]["start"]
    found.start = (x, y)
    return found


def places(found: dict[str, Any]) -> list[tuple[float, float]]:
    """The places of a map."""
    return [(node["x"], node["y"]) for node in found["nodes"]]


def check_map(found: dict[str, Any], trace: pathlib.Path) -> None:
    """A map must cover the area, and every way of it must be free; the robot must not have touched a wall."""
    known = rooms()
    assert known.coverage(places(found), REACH) >= 0.95
    at = {node["id"]: (node["x"], node["y"]) for node in found["nodes"]}
    for edge in found["edges"]:
        assert known.is_straight(at[edge["from"]], at[edge["to"]]), edge
    # Ways that form loops, as the rooms do.
    assert len(found["edges"]) > len(found["nodes"])
    with trace.open(encoding="utf-8") as rows:
        for number, line in enumerate(rows):
            if number % 4 == 0:
                now = json.loads(line)
                assert known.holds(now["x"], now["y"], now["theta"], HALF - 0.001), now


@contextlib.contextmanager
def simulator(
    command: str, folder: pathlib.Path, program: str, scene: str = ""
) -> Iterator[int]:
    """The embedded simulator with a program; its port serves all robots. Afterwards there is a trace."""
    (folder / "program.pyr").write_text(program, encoding="utf-8")
    options = []
    if scene:
        (folder / "scene.toml").write_text(scene, encoding="utf-8")
        options = ["--scene", "scene.toml"]
    with subprocess.Popen(
        [command, "sim", "program.pyr", "--trace", "trace.jsonl", *options],
        cwd=folder,
        stdout=subprocess.PIPE,
        text=True,
    ) as running:
        assert running.stdout
        ports: list[int] = []
        while "Ready" not in (line := running.stdout.readline()):
            assert line, "the simulator has ended"
            ports += map(int, re.findall(r"127\.0\.0\.1\s+(\d+)", line))
        try:
            yield ports[0]
        finally:
            running.terminate()


def drive_by_hand(
    number: int, port: int, folder: pathlib.Path
) -> dict[str, tuple[float, float, float]]:
    """Runs the client for an environment; returns the poses that it prints, in metres and degrees."""
    done = subprocess.run(
        [sys.executable, client(number), "--port", str(port)],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found = re.findall(r"^(\w+) is at (\S+) m, (\S+) m, (\S+) deg$", done.stdout, re.M)
    return {name: (float(x), float(y), float(a)) for name, x, y, a in found}


def client(number: int) -> pathlib.Path:
    """The client for an environment, written by hand."""
    return HERE / "by_hand" / f"environment_{number}.py"
