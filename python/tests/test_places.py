"""Where an action is: its number in the text, its line in the program, rounds and calls.

The movements here are laid out as generated ones are, with the lines of a program that is not there.
"""

import ast
import json
import linecache
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

import pytest
from driving import drive_all, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import (
    MovementError,
    Robot,
    clear,
    detects,
    events,
    movement,
    parallel,
    statements,
)

Robots = dict[str, Robot]
Main = Callable[[Robots], Coroutine[Any, Any, None]]
Event = dict[str, Any]


def places(
    main: Main, file: Path, monkeypatch: pytest.MonkeyPatch, *arguments: str
) -> list[Event]:
    """The actions of a run with robots a and b, as they have begun."""
    world = FakeWorld(
        *(
            FakeRobot(
                name,
                joints("two-wheel"),
                y=-float(index),
                sensors={"f": lambda robot: robot.x > 0.15, "c": lambda _: False},
            )
            for index, name in enumerate("ab")
        )
    )
    with events.use(str(file)):
        drive_all(world, monkeypatch, ("two-wheel", "two-wheel"), main, *arguments)
    found = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    return [event for event in found if event["event"] == "action-begun"]


def short(event: Event) -> tuple[Any, ...]:
    """What an event says of its place."""
    keys = ("movement", "action", "line", "rounds", "calls")
    return tuple(event[key] for key in keys if key in event)


@pytest.fixture(name="file")
def fixture_file(tmp_path: Path) -> Path:
    return tmp_path / "events.jsonl"


def test_statements_are_counted_as_they_stand_in_the_text(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    @movement
    async def follow(rover: Robot) -> None:
        """Has all statements."""
        for _ in rover.repeat(2):  # line 7: repeat 2 times
            await rover.move(0.1)  # line 8: move 10 centimeters
            # line 9: turn right
            await rover.turn(
                -0.5,
                speed=0.5,
            )
        # shared.pyr, line 31: repeat until {f} detect
        async for _ in rover.repeat_until(
            detects("f", within=None),
        ):
            pass
        for _ in rover.repeat(2):  # line 13: repeat 2 times
            for _ in rover.repeat(1):  # line 14: repeat 1 times
                if await rover.check(detects("c", "f")):  # line 15: if {c} detect
                    await rover.wait(0.1)  # line 16: wait 0.1 seconds
                else:
                    await rover.wait(99.0)  # line 18: wait 99.0 seconds
            if await rover.check(detects("c")):  # line 20: if {c} detect
                await rover.wait(99.0)  # line 21: wait 99.0 seconds
            elif await rover.check(clear("c")):  # line 22: else if {c} clear
                await rover.wait(0.15)  # line 23: wait 0.15 seconds
            elif await rover.check(clear("f")):
                await rover.wait(99.0)
            else:
                await rover.wait(99.0)
        await rover.wait(0.2)

    found = places(lambda robots: follow(robots["a"]), file, monkeypatch)
    assert [short(event) for event in found] == [
        ("follow", 2, 8, [1]),
        ("follow", 3, 9, [1]),
        ("follow", 2, 8, [2]),
        ("follow", 3, 9, [2]),
        ("follow", 8, 16, [1, 1]),
        ("follow", 13, 23, [1]),
        ("follow", 8, 16, [2, 1]),
        ("follow", 13, 23, [2]),
        ("follow", 17, None),
    ]


def program(rover: Robot) -> Callable[[], Coroutine[Any, Any, None]]:
    """Movements of one robot that do each other."""

    @movement
    async def side() -> None:
        await rover.move(0.05)  # line 31: move 5 centimeters

    @movement
    async def square() -> None:
        for _ in rover.repeat(2):  # line 21: repeat 2 times
            await side()  # line 22: do side
            await side()  # line 23: do side

    @movement(name="twice")
    async def movement_2() -> None:
        await rover.wait(0.05)  # line 11: wait 0.05 seconds
        for _ in rover.repeat(2):  # line 12: repeat 2 times
            await square()  # line 13: do square
        await side()  # line 15: do side

    return movement_2


def call(movement: str, action: int) -> Event:
    return {"movement": movement, "action": action}


def test_calls_lead_from_the_listed_movement(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = places(lambda robots: program(robots["a"])(), file, monkeypatch)
    calls = [call("twice", 3), call("square", 2)], [call("twice", 3), call("square", 3)]
    assert [short(event) for event in found] == [
        ("twice", 1, 11),
        *(
            ("twice", 1, 31, [outer, inner], calls[which])
            for outer in (1, 2)
            for inner in (1, 2)
            for which in (0, 1)
        ),
        ("twice", 1, 31, [call("twice", 4)]),
    ]


def test_parallel_movements_have_places_of_their_own(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def main(robots: Robots) -> None:
        await parallel(program(robots["a"])(), program(robots["b"])())

    found = places(main, file, monkeypatch)
    alone = places(lambda robots: program(robots["a"])(), file, monkeypatch)
    for name in "ab":
        own = [short(event) for event in found if event["robot"] == name]
        assert own == [short(event) for event in alone]


def test_a_movement_of_another_robot_is_no_call(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def main(robots: Robots) -> None:
        @movement
        async def other() -> None:
            await robots["b"].wait(0.05)

        @movement
        async def own() -> None:
            await robots["a"].wait(0.05)
            await other()
            await parallel(other())
            await robots["a"].wait(0.1)

        await own()

    found = places(main, file, monkeypatch)
    assert [short(event) for event in found] == [
        ("own", 1, None),
        ("other", 1, None),
        ("other", 1, None),
        ("own", 4, None),
    ]


def test_a_failure_says_the_way(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    async def main(robots: Robots) -> None:
        rover = robots["a"]

        @movement
        async def side() -> None:
            for _ in rover.repeat(3):  # line 31: repeat 3 times
                await rover.wait(until=detects("c"))  # line 32: wait until {c} detect

        @movement
        async def square() -> None:
            await side()  # line 21: do side

        @movement
        async def trip() -> None:
            await rover.wait(0.05)  # line 11: wait 0.05 seconds
            for _ in rover.repeat(2):  # line 12: repeat 2 times
                await square()  # line 13: do square

        await trip()

    with pytest.raises(MovementError) as failure:
        places(main, file, monkeypatch)
    error = failure.value
    assert str(error) == (
        "robot a, movement trip, action 3: do square, action 1: do side, action 2 in rounds 1, 1: "
        "wait until c detects something: after 600 s c still detects nothing"
    )
    assert (error.robot, error.movement, error.number, error.line, error.rounds) == (
        "a",
        "trip",
        2,
        32,
        (1, 1),
    )
    assert [(each.movement, each.action) for each in error.calls] == [
        ("trip", 3),
        ("square", 1),
    ]


def test_people_and_traces_are_told_the_same(
    file: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    trace = tmp_path / "trace.jsonl"

    async def main(robots: Robots) -> None:
        await program(robots["a"])()

    places(main, file, monkeypatch, "--trace", str(trace))
    lines = capsys.readouterr().out.splitlines()
    assert "  a  twice  1: wait 0.05 s  at" in lines[0]
    assert (
        "  a  twice  3: do square, 2: do side, 1 in rounds 1, 1: move 0.05 m  at"
        in (lines[1])
    )
    first, *_, last = map(json.loads, trace.read_text(encoding="utf-8").splitlines())
    assert (first["action"], first["line"]) == ("1: wait 0.05 s", 11)
    assert "rounds" not in first
    assert "calls" not in first
    assert (last["movement"], last["action"], last["line"], last["calls"]) == (
        "twice",
        "1: move 0.05 m",
        31,
        [call("twice", 4)],
    )


# A script without a file, as in a notebook or a browser.
NO_SOURCE = """
@movement
async def side():
    await rover.wait(0.05)

@movement
async def trip():
    await rover.wait(0.05)
    for _ in rover.repeat(2):
        await side()
    await rover.wait(0.05)
    await rover.wait(0.05)
"""


def test_without_source_actions_are_counted_as_they_happen(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def main(robots: Robots) -> None:
        names: dict[str, Any] = {"movement": movement, "rover": robots["a"]}
        exec(compile(NO_SOURCE, "<page>", "exec"), names)
        await names["trip"]()
        await names["trip"]()

    found = [short(event) for event in places(main, file, monkeypatch)]
    assert found[: len(found) // 2] == found[len(found) // 2 :]
    assert found[: len(found) // 2] == [
        ("trip", 1, None),
        ("trip", 1, None, [1], [call("trip", 2)]),
        ("trip", 1, None, [2], [call("trip", 3)]),
        ("trip", 4, None),
        ("trip", 5, None),
    ]


def test_actions_of_other_functions_are_counted_as_they_happen(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def main(robots: Robots) -> None:
        rover = robots["a"]

        async def helper() -> None:
            for _ in range(2):
                await rover.wait(0.05)

        @movement
        async def trip() -> None:
            await helper()

        await rover.wait(0.05)
        await trip()
        await rover.wait(0.05)

    found = [short(event) for event in places(main, file, monkeypatch)]
    assert found == [
        ("m", 1, None),
        ("trip", 1, None),
        ("trip", 2, None),
        ("m", 2, None),
    ]


def test_a_file_is_parsed_once(monkeypatch: pytest.MonkeyPatch, file: Path) -> None:
    parsed: list[str] = []
    parse = ast.parse

    def count(text: str) -> ast.Module:
        parsed.append(text)
        return parse(text)

    monkeypatch.setattr(ast, "parse", count)
    statements._tables.cache_clear()

    async def main(robots: Robots) -> None:
        for _ in range(3):
            await program(robots["a"])()

    places(main, file, monkeypatch)
    assert len(parsed) == 1


def table_of(text: str) -> dict[int, tuple[int, int | None]]:
    """The statements of the first function of a text, by their lines."""
    file = "<text of a test>"
    linecache.cache[file] = (len(text), None, text.splitlines(keepends=True), file)
    statements._tables.cache_clear()
    names: dict[str, Any] = {}
    exec(compile(text, file, "exec"), names)
    table = statements.statements_of(names["f"].__code__)
    assert table is not None
    return {line: (each.number, each.line) for line, each in table.items()}


def test_a_long_chain_of_conditions_has_a_table() -> None:
    branches = "".join(
        f"    elif await c({n}):  # line {n}: else if\n        await a()  # line {n + 1}: x\n"
        for n in range(4, 600, 2)
    )
    text = f"async def f(a, c):\n    if await c(2):\n        await a()\n{branches}"
    table = table_of(text)
    assert table[2] == (1, None)
    assert table[400] == (399, 400)
    assert len(table) == text.count("\n") - 1


def test_what_is_no_statement_of_its_own_does_not_count() -> None:
    table = table_of(
        "async def f(a):\n"
        "    '''line 1: not here'''\n"
        "    x = 3\n"
        "    async def g():\n"
        "        await a()\n"
        "    try:\n"
        "        await a()  # my, line 9: file.pyr, line 5: x\n"
        "    finally:\n"
        "        x = await a()  # a remark on line 7\n"
        "    match x:\n"
        "        case 3:\n"
        "            await a()  # line 8: x\n"
    )
    assert table == {7: (1, 5), 9: (2, None), 12: (3, 8)}
