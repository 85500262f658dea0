"""What goes wrong while a robot explores, and the map that it leaves then."""

import json
import math
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from ideal_rover import MOUNTS, RADIUS, GhostRover, on
from pydslrep_parts.drive_two_wheel import TwoWheelDrive
from pydslrep_parts.errors import MovementError, SimulatorError
from pydslrep_parts.model import Eye
from pydslrep_parts.occupancy_grid import Floor
from pydslrep_parts.pose import Pose
from pydslrep_parts.robot import Robot
from pydslrep_parts.slam_session import Survey
from pydslrep_parts.trace_file import Trace
from rooms import Rooms


class Body:
    """A robot's body in closed rooms, that does at once what its wheels say."""

    time_step = 0.05

    def __init__(self, rooms: Rooms) -> None:
        self.ghost = GhostRover(rooms, Floor(RADIUS))
        eyes = [str(number) for number in range(len(MOUNTS))]
        self.model = SimpleNamespace(name="r", eyes=eyes, wheels={"l": 0.05, "r": 0.05})
        self.drive = TwoWheelDrive([(0.0, 0.15), (0.0, -0.15)], [0.05, 0.05])
        self.here = Pose(*rooms.start, 0.0)
        self.time = 0.0
        self.glass = math.inf  # no sensor sees it, and no robot gets further along x
        self.silent_from = math.inf  # s
        self.range = 1.0
        self._rates: Sequence[float] = (0.0, 0.0)

    def pose(self) -> Pose:
        return self.here

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        self._rates = rates

    def advance(self) -> None:
        self.time += self.time_step
        left, right = (0.05 * rate * self.time_step for rate in self._rates)
        there = self.here.turned((right - left) / 0.3).ahead((left + right) / 2.0)
        if there.x <= self.glass:
            self.here = there

    def distance(self, sensor: str) -> float | None:
        if self.time > self.silent_from:
            raise SimulatorError("no answer from 127.0.0.1:19999 for 10 s")
        away = self.ghost.distance(on(self.here, MOUNTS[int(sensor)]))
        return away if away <= self.range else None

    def eye(self, sensor: str) -> Eye:
        return Eye(MOUNTS[int(sensor)], self.range, math.radians(20.0))

    def why_it_stands(self) -> str:
        return "something may be in its way"


def survey(folder: Path, extent: float = 20.0) -> Survey:
    options = Namespace(
        odometry=False,
        extent=extent,
        range=[],
        cone=[],
        radius=[],
        map=folder / "map.json",
    )
    return Survey("area", options)


def explore(body: Body, found: Survey) -> None:
    driven: Any = body
    robot = Robot(driven, Trace(None))
    robot.survey = found
    robot.begin("m")
    robot.slam()


def nodes_of(folder: Path) -> list[dict[str, Any]]:
    data = json.loads((folder / "map.json").read_text(encoding="utf-8"))
    nodes: list[dict[str, Any]] = data["nodes"]
    return nodes


def test_a_blocked_robot_ends_the_exploration_and_leaves_its_map(
    tmp_path: Path,
) -> None:
    body = Body(Rooms(4.0, 1.0, start=(0.5, 0.5)))
    body.glass = 1.7
    with pytest.raises(MovementError) as error:
        explore(body, survey(tmp_path))
    text = str(error.value)
    assert text.startswith(
        "robot r, movement m, action 1: slam: came no nearer to its goal for 5 s, "
    )
    assert text.endswith("m before it; something may be in its way")
    nodes = nodes_of(tmp_path)
    assert len(nodes) >= 2
    assert all(node["x"] <= body.glass for node in nodes)


def test_a_sensor_that_falls_silent_ends_it_as_well(tmp_path: Path) -> None:
    body = Body(Rooms(4.0, 1.0, start=(0.5, 0.5)))
    body.silent_from = 30.0
    with pytest.raises(SimulatorError, match="no answer from"):
        explore(body, survey(tmp_path))
    assert nodes_of(tmp_path)
    assert body.time < 31.0


def test_sensors_that_see_too_little_are_told_before_the_robot_drives(
    tmp_path: Path,
) -> None:
    body = Body(Rooms(4.0, 1.0, start=(0.5, 0.5)))
    body.range = 0.2
    with pytest.raises(
        MovementError,
        match=r"its sensors see no more than 0\.2 m, which is too little to explore by",
    ):
        explore(body, survey(tmp_path))
    assert body.time < 0.1


def test_an_area_without_end_is_told_soon(tmp_path: Path) -> None:
    body = Body(Rooms(90.0, 90.0, start=(45.0, 45.0)))
    with pytest.raises(MovementError) as error:
        explore(body, survey(tmp_path, extent=2.0))
    assert "action 1: slam: got 2." in str(error.value)
    assert "If it is that large, say --extent with more than 2 m" in str(error.value)
    assert 4 <= len(nodes_of(tmp_path)) < 60


class Axes:
    """What a picture of a map is drawn with; keeps what was drawn."""

    def __init__(self) -> None:
        self.lines: list[tuple[list[float], list[float]]] = []

    def plot(self, xs: list[float], ys: list[float], *_: str, **__: object) -> None:
        self.lines.append((xs, ys))

    def grid(self, **_: object) -> None:
        pass


class Figure:
    """A stand-in for matplotlib's."""

    made: list["Figure"]

    def __init__(self, **_: object) -> None:
        self.axes, self.title, self.file = Axes(), "", Path()
        Figure.made.append(self)

    def add_subplot(self, **options: object) -> Axes:
        self.title = str(options["title"])
        return self.axes

    def savefig(self, file: Path, **_: object) -> None:
        self.file = file


def test_a_picture_of_the_map_is_drawn_where_matplotlib_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Figure.made = []
    module: Any = SimpleNamespace(Figure=Figure)
    monkeypatch.setitem(sys.modules, "matplotlib", module)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", module)
    explore(Body(Rooms(1.9, 1.0, start=(0.5, 0.5))), survey(tmp_path))
    [figure] = Figure.made
    assert figure.title == "area"
    assert figure.file == tmp_path / "map.png"
    nodes = nodes_of(tmp_path)
    *edges, places = figure.axes.lines
    assert places == ([node["x"] for node in nodes], [node["y"] for node in nodes])
    ends = set(zip(*places, strict=True))
    assert edges
    assert all(set(zip(*edge, strict=True)) <= ends for edge in edges)


def test_without_matplotlib_there_is_no_picture(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    explore(Body(Rooms(1.9, 1.0, start=(0.5, 0.5))), survey(tmp_path))
    assert [file.name for file in tmp_path.iterdir()] == ["map.json"]
