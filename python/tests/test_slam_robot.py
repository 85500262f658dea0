"""Failures during exploration, and the map written then."""

import json
import math
import subprocess
import sys
from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any, BinaryIO

import pytest
from ideal_robot import MOUNTS, RADIUS, IdealRobot, at_once, on
from pydslrep_runtime.backend import Clock, RobotSpec, SensorCone
from pydslrep_runtime.drives import TwoWheelDrive
from pydslrep_runtime.errors import MovementError, SetupError, SimulatorError
from pydslrep_runtime.motion import Motion
from pydslrep_runtime.places import Place
from pydslrep_runtime.pose import Pose
from pydslrep_runtime.slam import exploration
from pydslrep_runtime.slam.occupancy_grid import OccupancyGrid
from pydslrep_runtime.slam.session import SlamSession
from pydslrep_runtime.slam.topological_map import TopologicalMap
from pydslrep_runtime.trace import Trace
from rooms import Rooms

SENSORS = [str(number) for number in range(len(MOUNTS))]


class Body:
    """A robot in closed rooms, and its clock; its wheels neither slip nor lag."""

    time_step = 0.05

    def __init__(self, rooms: Rooms) -> None:
        self.ideal = IdealRobot(rooms, OccupancyGrid(RADIUS))
        self.clock = self
        self.here = Pose(*rooms.start, 0.0)
        self.time = 0.0
        self.glass = math.inf  # a wall at this x that no sensor detects
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
            raise SimulatorError("no reply from 127.0.0.1:19999 for 10 s")
        away = self.ideal.distance(on(self.here, MOUNTS[int(sensor)]))
        return away if away <= self.range else None

    def sensor_cone(self, sensor: str) -> SensorCone:
        return SensorCone(MOUNTS[int(sensor)], self.range, math.radians(20.0))

    def stall_reason(self) -> str:
        return "an obstacle may be in the way"


class Loop:
    """An event loop in which the clock's steps take no time."""

    async def next_step(self, clock: Clock, order: int) -> None:
        clock.advance()


def session(
    folder: Path, extent: float = 20.0, *, odometry: bool = False
) -> SlamSession:
    options = Namespace(
        odometry=odometry,
        extent=extent,
        range=[],
        cone=[],
        radius=[],
        map=folder / "map.json",
    )
    return SlamSession("area", options)


def explore(body: Body, found: SlamSession) -> None:
    backend: Any = body
    loop: Any = Loop()
    spec = RobotSpec("r", "127.0.0.1", 19999, {"l": 0.05, "r": 0.05}, SENSORS)
    drive = TwoWheelDrive([(0.0, 0.15), (0.0, -0.15)], [0.05, 0.05])
    motion = Motion(spec, backend, drive, loop, 0, Trace())
    motion.place, motion.action_text = Place("m", 1), "slam"
    at_once(exploration.explore(motion, found))


def nodes_of(folder: Path) -> list[dict[str, Any]]:
    data = json.loads((folder / "map.json").read_text(encoding="utf-8"))
    nodes: list[dict[str, Any]] = data["nodes"]
    return nodes


def test_a_blocked_robot_ends_the_exploration_and_writes_its_map(
    tmp_path: Path,
) -> None:
    body = Body(Rooms(4.0, 1.0, start=(0.5, 0.5)))
    body.glass = 1.7
    with pytest.raises(MovementError) as error:
        explore(body, session(tmp_path))
    text = str(error.value)
    assert text.startswith("robot r, movement m, action 1: slam: no progress for 5 s, ")
    assert text.endswith("m from the goal; an obstacle may be in the way")
    nodes = nodes_of(tmp_path)
    assert len(nodes) >= 2
    assert all(node["x"] <= body.glass for node in nodes)


def test_a_sensor_without_reply_ends_it_too(tmp_path: Path) -> None:
    body = Body(Rooms(4.0, 1.0, start=(0.5, 0.5)))
    body.silent_from = 30.0
    with pytest.raises(SimulatorError, match="no reply from"):
        explore(body, session(tmp_path))
    assert nodes_of(tmp_path)
    assert body.time < 31.0


def test_a_short_range_is_reported_before_the_robot_drives(
    tmp_path: Path,
) -> None:
    body = Body(Rooms(4.0, 1.0, start=(0.5, 0.5)))
    body.range = 0.2
    with pytest.raises(
        MovementError,
        match=r"its sensors' range of 0\.2 m is too short to explore with",
    ):
        explore(body, session(tmp_path))
    assert body.time < 0.1


def test_an_unbounded_area_is_reported_soon(tmp_path: Path) -> None:
    body = Body(Rooms(90.0, 90.0, start=(45.0, 45.0)))
    with pytest.raises(MovementError) as error:
        explore(body, session(tmp_path, extent=2.0))
    assert "action 1: slam: the area is still open 2." in str(error.value)
    assert "If it is larger, set --extent to more than 2 m" in str(error.value)
    assert 4 <= len(nodes_of(tmp_path)) < 60


@pytest.mark.parametrize("module", ["numpy", "scipy"])
def test_odometry_needs_modules_that_exploration_does_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    message = "--odometry needs numpy and scipy: python3 -m pip install numpy scipy"
    with pytest.raises(SetupError, match=message):
        session(tmp_path, odometry=True)
    explore(Body(Rooms(1.9, 1.0, start=(0.5, 0.5))), session(tmp_path))


def test_exploration_imports_neither() -> None:
    code = (
        "import sys, pydslrep_runtime.slam.exploration\n"
        "print({'numpy', 'scipy'} & {*sys.modules})"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=Path(exploration.__file__).parents[2],
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    assert done.stdout == "set()\n"


class Axes:
    """A stand-in for matplotlib's axes; records what is drawn."""

    def __init__(self) -> None:
        self.lines: list[tuple[list[float], list[float]]] = []

    def plot(self, xs: list[float], ys: list[float], *_: str, **__: object) -> None:
        self.lines.append((xs, ys))

    def grid(self, **_: object) -> None:
        pass


class Figure:
    """A stand-in for matplotlib's figure."""

    made: list["Figure"]

    def __init__(self, **_: object) -> None:
        self.axes, self.title = Axes(), ""
        Figure.made.append(self)

    def add_subplot(self, **options: object) -> Axes:
        self.title = str(options["title"])
        return self.axes

    def savefig(self, file: BinaryIO, *, metadata: dict[str, str]) -> None:
        file.write(metadata["Comment"].encode())


def test_matplotlib_draws_a_picture_of_the_map(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    Figure.made = []
    module: Any = SimpleNamespace(Figure=Figure)
    monkeypatch.setitem(sys.modules, "matplotlib", module)
    monkeypatch.setitem(sys.modules, "matplotlib.figure", module)
    explore(Body(Rooms(1.9, 1.0, start=(0.5, 0.5))), session(tmp_path))
    [figure] = Figure.made
    assert figure.title == "area"
    assert (tmp_path / "map.png").read_bytes() == b"Drawn by PyDSLRep"
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
    explore(Body(Rooms(1.9, 1.0, start=(0.5, 0.5))), session(tmp_path))
    assert [file.name for file in tmp_path.iterdir()] == ["map.json"]


def test_uncertain_nodes_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    found = TopologicalMap()
    for x in range(4):
        found.add(float(x), 0.0).is_uncertain = x > 1
    exploration.warn_of_uncertain_nodes("r", found)
    message = capsys.readouterr().err
    assert message.startswith("warning: robot r lost its way and did not find it again")
    assert message.endswith("these nodes are uncertain: 2, 3\n")
    exploration.warn_of_uncertain_nodes("r", TopologicalMap())
    assert not capsys.readouterr().err
