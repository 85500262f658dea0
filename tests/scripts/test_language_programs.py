"""The programs of tests/programs/0.3 come to what its README says: checked, planned, and driven in the simulator."""

from __future__ import annotations

import itertools
import json
import math
import pathlib
import shutil
from typing import Any

import pytest
from length import few
from program_runs import Row, assert_near, command_line, drive, place

PROGRAMS = pathlib.Path(__file__).parents[1] / "programs" / "0.3"
NAMES = sorted(path.stem for path in PROGRAMS.glob("*.pyr"))
ARTICLE = sorted((PROGRAMS.parents[1] / "paper").glob("*.pyr"))

TARGETS = ("coppeliasim", "vrep")
BODY = 0.15  # m from a robot's centre to its sides
NOISY_POSITION, NOISY_HEADING = 0.02, 1.5  # the same where wheels slip

Pose = tuple[float, float, float]

KNOWN: dict[str, tuple[str, int, Pose]] = {
    "yard": ("01-square", 8, (0, 0, 0)),
    "nested": ("02-nested", 33, (0, 0, 0)),
    "slalom_yard": ("03-arcs", 3, (2, 0, 0)),
    "bow_yard": ("03-arcs", 1, (0, 2, 180)),
    "dock_yard": ("03-arcs", 1, (-1, -1, 90)),
    "procedures": ("04-procedures", 16, (0, 0, 0)),
    "else": ("05-names", 2, (3, 0, 0)),
    "field": ("08-mower", 20, (0, -5, 0)),
}
"""Programs whose path is known: the number of their actions, and where they end."""
SAME_NAME = {"nested": "yard", "procedures": "yard"}


def every(quick: tuple[str, ...]) -> list[Any]:
    """All known programs; those that are not among the quick ones with `--long` only."""
    return [
        pytest.param(name, marks=() if name in quick else pytest.mark.long)
        for name in KNOWN
    ]


def plan_of(
    command: str, folder: pathlib.Path, program: str, environment: str
) -> dict[str, Row]:
    """The planned path of each robot."""
    which = ["--environment", environment]
    done = command_line(command, folder, "plan", f"{program}.pyr", "--json", *which)
    assert done.returncode == 0, done.stderr
    [plan] = json.loads(done.stdout)
    return {robot["name"]: robot for robot in plan["robots"]}


def goal(pose: Pose) -> Row:
    return {"x": pose[0], "y": pose[1], "theta": math.radians(pose[2])}


def copied(folder: pathlib.Path, program: str, scene: str, addition: str) -> None:
    """Copies a program with its scene, to which something is added."""
    shutil.copy(PROGRAMS / f"{program}.pyr", folder)
    text = (PROGRAMS / scene).read_text(encoding="utf-8")
    (folder / scene).write_text(text + addition, encoding="utf-8")


def assert_traced(rows: list[Row], planned: list[Row]) -> None:
    """The lines of a trace name the actions in their order; its `action` is a text that begins with the way there."""
    traced = [
        {part: value for part, value in place(row).items() if part != "action"}
        for row in rows
        if row["action"]
    ]
    expected = [
        {part: value for part, value in action.items() if part != "action"}
        for action in planned
    ]
    assert [each for each, _ in itertools.groupby(traced)] == [
        each for each, _ in itertools.groupby(expected)
    ]


@pytest.mark.parametrize("name", KNOWN)
def test_known_paths_are_planned(command: str, name: str) -> None:
    program, actions, end = KNOWN[name]
    [robot] = plan_of(command, PROGRAMS, program, SAME_NAME.get(name, name)).values()
    assert len(robot["poses"]) == actions
    assert robot["unknown_after"] is None
    assert_near(robot["poses"][-1], goal(end), 1e-9, 1e-7)


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("name", every(("slalom_yard", "bow_yard", "procedures")))
def test_known_paths_are_driven(
    command: str, tmp_path: pathlib.Path, name: str, target: str
) -> None:
    """Each action ends where it is planned, and events and traces say which it is as the plan does."""
    program, _, end = KNOWN[name]
    environment = SAME_NAME.get(name, name)
    [robot] = plan_of(command, PROGRAMS, program, environment).values()
    trace = tmp_path / "trace"
    events, rows = drive(command, PROGRAMS, trace, program, environment, target)
    begun, ended = (
        [event for event in events if event["event"] == kind]
        for kind in ("action-begun", "action-ended")
    )
    planned = [place(action) for action in robot["poses"]]
    assert [place(event) for event in begun] == planned
    assert [place(event) for event in ended] == planned
    for event, action in zip(ended, robot["poses"], strict=True):
        assert_near(event, action)
    assert_near(rows[-1], goal(end))
    assert_traced(rows, planned)


def codes(command: str, folder: pathlib.Path, *words: str) -> list[str]:
    """What `check` says of a program."""
    done = command_line(command, folder, "check", *words, "--format=json")
    return [each["code"] for each in json.loads(done.stdout)]


@pytest.mark.parametrize("name", NAMES[:9])
def test_nine_programs_have_no_problems(command: str, name: str) -> None:
    assert codes(command, PROGRAMS, f"{name}.pyr") == []


def test_the_article_has_none_of_them_and_all_of_its_own(command: str) -> None:
    edition = ("--edition", "article")
    counts = [
        codes(command, PROGRAMS, f"{name}.pyr", *edition).count("not-in-article")
        for name in NAMES
    ]
    assert counts == [1, 4, 7, 5, 2, 4, 4, 5, 2, 9, 6]
    assert ARTICLE
    for path in ARTICLE:
        assert "not-in-article" not in codes(command, path.parent, path.name, *edition)


def test_the_wall_is_unknown_from_the_first_round_on(command: str) -> None:
    rover = plan_of(command, PROGRAMS, "06-wall", "corridor")["rover"]
    assert rover["poses"] == []
    after = {"movement": "follow", "run": 1, "action": 1, "line": 11}
    assert rover["unknown_after"] == after


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("heading", few(1, (-20, 25, 0, 15)))
def test_the_wall_is_followed(
    command: str, tmp_path: pathlib.Path, heading: int, target: str
) -> None:
    """From any of the README's headings."""
    copied(tmp_path, "06-wall", "corridor.scene.toml", "")
    scene = tmp_path / "corridor.scene.toml"
    text = scene.read_text(encoding="utf-8")
    assert "start = [-2.4, -0.45, 15]" in text
    scene.write_text(text.replace("0.45, 15]", f"0.45, {heading}]"), encoding="utf-8")
    events, rows = drive(
        command, tmp_path, tmp_path / "trace", "06-wall", "corridor", target
    )
    begun = [event for event in events if event["event"] == "action-begun"]
    # One action in each round: those of the three branches have their numbers and lines in the text.
    assert [event["rounds"] for event in begun] == [
        [number] for number in range(1, len(begun) + 1)
    ]
    branches = {"turn left": (3, 13), "move 0.1": (5, 15), "turn right": (6, 17)}
    for event in begun:
        [branch] = (key for key in branches if event["text"].startswith(key))
        assert (event["action"], event["line"]) == branches[branch]
    # The README's ranges are those of ideal sensors, and 3 cm more are allowed.
    assert 2.37 <= rows[-1]["x"] <= 2.63
    beside = [row["y"] for row in rows if row["x"] > -2.4 + 1.5]
    assert min(beside) >= -0.53
    assert max(beside) <= -0.37


def person(time: float) -> tuple[float, float]:
    """Where the person of hall.scene.toml is after seconds."""
    return 2.0, -2.0 * min(max((time - 30.0) / 5.0, 0.0), 1.0)


def gap(row: Row, x: float, y: float) -> float:
    """How far a point is from a robot's body."""
    dx, dy = x - row["x"], y - row["y"]
    cos, sin = math.cos(row["theta"]), math.sin(row["theta"])
    ahead, left = cos * dx + sin * dy, cos * dy - sin * dx
    return math.hypot(max(abs(ahead) - BODY, 0.0), max(abs(left) - BODY, 0.0))


def patrol() -> list[Row]:
    """Where the guard's actions are, in their order."""
    found: list[Row] = []
    calls = [{"movement": "round", "action": 2}]
    for side in range(1, 5):
        for step in range(1, 9):
            inner = {"movement": "round", "rounds": [side, step], "calls": calls}
            found += [{**inner, "action": 2, "line": 18}]
            found += [{**inner, "action": 3, "line": 19}]
        found += [{"movement": "round", "rounds": [side], "action": 3, "line": 12}]
    return found


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("seed", few(1, range(1, 21)))
def test_the_guard_waits_for_people(
    command: str, tmp_path: pathlib.Path, seed: int, target: str
) -> None:
    slip = "\n[noise]\nwheel-slip = 2\nsensor = 0\n"
    copied(tmp_path, "07-patrol", "hall.scene.toml", slip)
    trace, which = tmp_path / "trace", ("--seed", str(seed))
    events, rows = drive(command, tmp_path, trace, "07-patrol", "hall", target, *which)
    gaps = {row["t"]: gap(row, *person(row["t"])) - 0.2 for row in rows}
    assert min(gaps.values()) > 0.0
    waiting = max(time for time in gaps if time <= 30.0)
    assert gaps[waiting] == pytest.approx(0.15, abs=NOISY_POSITION)
    begun = [event for event in events if event["event"] == "action-begun"]
    assert [place(event) for event in begun] == patrol()
    moves = [event for event in begun if event["text"].startswith("move")]
    assert moves[2]["t"] < 30.0 < moves[3]["t"]
    assert_near(rows[-1], goal((0, 0, 0)), NOISY_POSITION, NOISY_HEADING)


def test_who_gives_way_is_unknown(command: str) -> None:
    plan = plan_of(command, PROGRAMS, "09-give-way", "crossing")
    assert plan["fast"]["unknown_after"] is None
    assert_near(plan["fast"]["poses"][-1], goal((1.5, 0, 0)), 1e-9, 1e-7)
    assert plan["slow"]["poses"] == []
    after = place(plan["slow"]["unknown_after"])
    assert after == {"movement": "careful", "action": 2, "line": 17, "rounds": [1]}


def distances(rows: list[Row]) -> list[float]:
    """How far the two robots are from each other at each time, in metres; both are parallel to an axis."""
    fast, slow = (
        {row["t"]: row for row in rows if row["robot"] == name}
        for name in ("fast", "slow")
    )
    both = fast.keys() & slow.keys()
    assert len(both) > 100
    return [
        max(abs(fast[time][axis] - slow[time][axis]) for axis in ("x", "y"))
        - 2.0 * BODY
        for time in both
    ]


@pytest.mark.parametrize("target", TARGETS)
def test_two_robots_give_way(command: str, tmp_path: pathlib.Path, target: str) -> None:
    trace = tmp_path / "trace"
    _, rows = drive(command, PROGRAMS, trace, "09-give-way", "crossing", target)
    assert min(distances(rows)) > 0.01
    fast, slow = (
        [row for row in rows if row["robot"] == name] for name in ("fast", "slow")
    )
    assert_near(fast[-1], goal((1.5, 0, 0)))
    assert_near(slow[-1], goal((0, 1.5, 90)))


def test_two_robots_that_do_not_wait_meet(command: str, tmp_path: pathlib.Path) -> None:
    copied(tmp_path, "09-give-way", "crossing.scene.toml", "")
    program = tmp_path / "09-give-way.pyr"
    text = program.read_text(encoding="utf-8").splitlines(keepends=True)
    kept = [line for line in text if not line.lstrip().startswith("wait")]
    assert len(kept) == len(text) - 1
    program.write_text("".join(kept), encoding="utf-8")
    done = command_line(command, tmp_path, "check", program.name, "--format=json")
    [found] = json.loads(done.stdout)
    assert found["code"] == "planned-collision"
    assert "`fast` runs into `slow`" in found["message"]
    _, rows = drive(command, tmp_path, tmp_path / "trace", "09-give-way", "crossing")
    assert min(distances(rows)) < 0.003, "they touch"


def test_each_limit_has_its_diagnostic(command: str) -> None:
    done = command_line(command, PROGRAMS, "check", "10-limits.pyr", "--format=json")
    found = json.loads(done.stdout)
    first, *_ = (PROGRAMS / "10-limits.pyr").read_text(encoding="utf-8").splitlines()
    codes = first.partition("in order: ")[2].rstrip(".").split(", ")
    assert len(codes) == 9
    assert [each["code"] for each in found] == codes
    assert [each["range"]["start"]["line"] for each in found] == list(range(10, 19))


def test_five_mistakes_are_five_diagnostics(command: str) -> None:
    name = "11-recovery.pyr"
    done = command_line(command, PROGRAMS, "check", name, "--format=json")
    found = json.loads(done.stdout)
    assert [each["code"] for each in found] == ["syntax-error"] * 5
    words = ("`repaet`", "`}`", "`secs`", "name of a movement", "`}`")
    for word, each in zip(words, found, strict=True):
        assert word in each["message"]
    refused = command_line(command, PROGRAMS, "fmt", "--check", name)
    assert refused.returncode == 1
    assert "has syntax errors" in refused.stderr
