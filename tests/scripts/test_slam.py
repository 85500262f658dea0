"""Exploration of generated worlds ends, without collisions and with at least 95 % coverage.

Twenty worlds of 30 to 80 m², with `--long` only; `-s` prints the coverage of each. Without it, tests/vrep explores the article's
area, and python/tests smaller rooms.
"""

from __future__ import annotations

import json
import math
import pathlib
import subprocess
from typing import Any

import pytest
from rooms import Position, Rooms, generate

ROOT = pathlib.Path(__file__).parents[2]

STEP, RANGE, HALF = 0.5, 1.0, 0.15


def explore(
    command: str, folder: pathlib.Path, program: str, rooms: Rooms, *options: str
) -> dict[str, Any]:
    """Runs a program, checks its path for collisions, and returns its map."""
    (folder / "program.pyr").write_text(program, encoding="utf-8")
    done = subprocess.run(
        [command, "run", "program.pyr", "--no-progress", "--trace", "trace", *options],
        cwd=folder,
        capture_output=True,
        encoding="utf-8",
        check=False,
        timeout=1200,
    )
    assert done.returncode == 0, done.stderr
    [file] = folder.glob("*_map.json")
    found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    assert_no_collisions(folder / "trace", rooms)
    return found


def assert_no_collisions(trace: pathlib.Path, rooms: Rooms) -> None:
    with trace.open(encoding="utf-8") as rows:
        for number, line in enumerate(rows):
            if number % 4 == 0:
                row = json.loads(line)
                pose = row["x"], row["y"], row["theta"]
                assert rooms.holds(*pose, HALF - 0.001), (row["t"], pose)


def places(found: dict[str, Any]) -> dict[int, Position]:
    return {node["id"]: (node["x"], node["y"]) for node in found["nodes"]}


def check_map(found: dict[str, Any], rooms: Rooms) -> float:
    """Checks a map and returns the fraction of the floor that it covers."""
    nodes = places(found)
    for edge in found["edges"]:
        start, end = nodes[edge["from"]], nodes[edge["to"]]
        assert rooms.is_straight(start, end), edge
        assert edge["length"] == pytest.approx(math.dist(start, end), abs=0.001)
    for node in found["nodes"]:
        for way in node["exits"]:
            assert way["to"] in nodes
            assert -180.0 <= way["bearing"] <= 180.0
    return rooms.coverage(list(nodes.values()), STEP + RANGE)


def table_7() -> str:
    return (ROOT / "tests/paper/table7_slam.pyr").read_text(encoding="utf-8")


@pytest.mark.long
@pytest.mark.parametrize("seed", range(1, 21))
def test_generated_worlds(command: str, tmp_path: pathlib.Path, seed: int) -> None:
    rooms = generate(seed)
    scene = tmp_path / "area_1.scene.toml"
    scene.write_text(rooms.scene("robot_1"), encoding="utf-8")
    found = explore(command, tmp_path, table_7(), rooms)
    covered = check_map(found, rooms)
    print(
        f"world {seed}: {rooms.width * rooms.height:.1f} m², {len(found['nodes'])} nodes, "
        f"{100 * covered:.2f} % covered"
    )
    assert covered >= 0.95
