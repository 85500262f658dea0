"""The page on the article shows what its figures and programs give: `UPDATE_EXPECT=1` writes its tables and pictures."""

from __future__ import annotations

import json
import math
import os
import pathlib
import re
import subprocess
from collections.abc import Sequence

import evaluation
import line_counts
import pytest
from driven import (
    ROOT,
    TABLES,
    Table,
    area,
    check_map,
    drive_by_hand,
    row,
    run,
    simulator,
)
from ports import free_ports

PAGE = ROOT / "docs" / "article.md"
PICTURES = ROOT / "docs" / "images" / "article"
NUMBER = re.compile("([-\N{MINUS SIGN}]?\\d+(?:\\.\\d+)?)(?= ?(mm|m|°)?)")
# How far apart runs may be: how robots drive improves more often than the page is written.
METRES, MILLIMETRES, DEGREES = 0.02, 0.5, 1.0
TEXT = re.compile(r">([^<>]+)</text>")
IS_UPDATE = bool(os.environ.get("UPDATE_EXPECT"))


def expect_on_page(name: str, text: str) -> None:
    """The page has that text between the markers of that name."""
    page = PAGE.read_text(encoding="utf-8")
    start, end = f"<!-- {name}: made by tests/article -->\n", f"<!-- end of {name} -->"
    before, rest = page.split(start)
    found, after = rest.split(end)
    if IS_UPDATE:
        PAGE.write_text(f"{before}{start}\n{text}\n\n{end}{after}", encoding="utf-8")
    else:
        assert found == f"\n{text}\n\n", "run it with UPDATE_EXPECT=1"


def expect_row(table: Table, row: str) -> None:
    """The page has a row for a program, which is alike."""
    page = PAGE.read_text(encoding="utf-8")
    [found] = [line for line in page.splitlines() if line.startswith(beginning(table))]
    if IS_UPDATE:
        PAGE.write_text(page.replace(found, row), encoding="utf-8")
    else:
        assert_alike(found, row)


def beginning(table: Table) -> str:
    """The cells of a program's row that no run changes."""
    return f"| {table.number} | {table.what} | "


def expect_picture(path: pathlib.Path, picture: str) -> None:
    """The picture has those words and numbers."""
    if IS_UPDATE:
        path.write_text(picture, encoding="utf-8")
    found = path.read_text(encoding="utf-8")
    assert_alike(*(" ".join(TEXT.findall(one)) for one in (found, picture)))


def assert_alike(found: str, expected: str) -> None:
    """The texts are equal but for small differences of numbers."""
    message = f"run it with UPDATE_EXPECT=1: {found} is now {expected}"
    assert NUMBER.sub("", found) == NUMBER.sub("", expected), message
    for one, other in zip(NUMBER.findall(found), NUMBER.findall(expected), strict=True):
        assert is_near(number(one[0]), number(other[0]), one[1]), message


def number(text: str) -> float:
    return float(text.replace("\N{MINUS SIGN}", "-"))


def is_near(one: float, other: float, unit: str) -> bool:
    """Whether two numbers of runs are alike; those without a length or an angle (times, counts) to 5 %."""
    match unit:
        case "°":
            return abs(math.remainder(one - other, 360.0)) <= DEGREES
        case "m":
            return abs(one - other) <= METRES
        case "mm":
            return abs(one - other) <= MILLIMETRES
        case _:
            return math.isclose(one, other, rel_tol=0.05, abs_tol=0.2)


@pytest.mark.parametrize(
    ("one", "other", "is_alike"),
    [
        ("at 1.00 m, -4.000 m, 180.0°", "at 1.01 m, -4.010 m, -179.9°", True),
        ("at -4.000 m", "at 4.000 m", False),
        ("at \N{MINUS SIGN}4.0 m", "at -4.0 m", True),
        ("at 4.000 m", "at 4.050 m", False),
        ("0.1 mm, 0.00°", "0.9 mm, 0.00°", False),
        ("90.0°", "-90.0°", False),
        ("140.2 s", "145.0 s", True),
        ("140.2 s", "150.0 s", False),
        ("-3", "3", False),
        ("4 m", "4 cm", False),
    ],
)
def test_numbers_have_signs_and_units(one: str, other: str, *, is_alike: bool) -> None:
    if is_alike:
        assert_alike(one, other)
    else:
        with pytest.raises(AssertionError):
            assert_alike(one, other)


def test_lines(command: str) -> None:
    expect_on_page("lines", line_counts.table(command))


def test_lines_are_counted_as_the_command_does(
    command: str, tmp_path: pathlib.Path
) -> None:
    assert line_counts.of_python('"""A\n\nb."""\n# c\n\nx = """d\n# e\n"""  # f\n') == 3
    assert (
        line_counts.of_python(
            'def f():\n    """A."""\n    return (\n        1\n    )\n'
        )
        == 4
    )


@pytest.mark.parametrize(
    "table", ["means", "savings", "scores", "readings", "critical"]
)
def test_statistics(table: str) -> None:
    expect_on_page(table, getattr(evaluation, f"{table}_table")())


def test_the_page_has_a_row_for_each_program() -> None:
    _, rest = PAGE.read_text(encoding="utf-8").split(
        "<!-- runs: made by tests/article -->\n\n"
    )
    table, _ = rest.split("\n\n<!-- end of runs -->")
    header, line, *rows = table.splitlines()
    names = [
        "table",
        "robot",
        "planned end",
        "driven end",
        "apart",
        "planned time",
        "simulated time",
    ]
    assert header == f"| {' | '.join(names)} |"
    assert line == "|" + "---|" * len(names)
    for found, program in zip(rows, TABLES, strict=True):
        assert found.startswith(beginning(program))


@pytest.mark.parametrize(
    "table",
    [
        # Its exploration takes half a minute to compute; other tests explore smaller areas.
        pytest.param(table, marks=pytest.mark.long if table.number == 7 else ())
        for table in TABLES
    ],
    ids=lambda table: f"table {table.number}",
)
def test_a_program_drives(command: str, tmp_path: pathlib.Path, table: Table) -> None:
    result = run(command, table, tmp_path)
    if table.number == 7:
        check_map(result.map, result.trace)
    if table.picture:
        expect_picture(PICTURES / table.picture, result.picture)
    expect_row(table, row(table, result))


def serve(program: pathlib.Path, ports: Sequence[int]) -> str:
    """A program whose robots have these ports."""
    found = iter(ports)
    text = program.read_text(encoding="utf-8")
    return re.sub(r"port \d+", lambda _: f"port {next(found)}", text)


def assert_near(
    end: tuple[float, float, float], x: float, y: float, degrees: float
) -> None:
    assert math.dist(end[:2], (x, y)) < 0.02, end
    assert abs(math.remainder(end[2] - degrees, 360.0)) < 1.5, end


def test_environment_1_by_hand(command: str, tmp_path: pathlib.Path) -> None:
    program = serve(line_counts.PROGRAMS[1], free_ports(1))
    with simulator(command, tmp_path, program) as port:
        ends = drive_by_hand(1, port, tmp_path)
    assert list(ends) == ["robot_1"]
    assert_near(ends["robot_1"], 0.0, -4.0, 180.0)


def test_environment_2_by_hand(command: str, tmp_path: pathlib.Path) -> None:
    example = line_counts.PROGRAMS[2]
    planned = subprocess.run(
        [command, "plan", "--json", example], capture_output=True, check=True
    )
    [plan] = json.loads(planned.stdout)
    scene = example.with_suffix(".scene.toml").read_text(encoding="utf-8")
    with simulator(command, tmp_path, serve(example, free_ports(4)), scene) as port:
        ends = drive_by_hand(2, port, tmp_path)
    assert len(ends) == 4
    for robot in plan["robots"]:
        goal = robot["poses"][-1]
        assert_near(
            ends[robot["name"]], goal["x"], goal["y"], math.degrees(goal["theta"])
        )


@pytest.mark.long
def test_environment_3_by_hand(command: str, tmp_path: pathlib.Path) -> None:
    program = serve(line_counts.PROGRAMS[3], free_ports(1))
    with simulator(command, tmp_path, program, area()) as port:
        drive_by_hand(3, port, tmp_path)
    found = json.loads((tmp_path / "map.json").read_text(encoding="utf-8"))
    check_map(found, tmp_path / "trace.jsonl")
