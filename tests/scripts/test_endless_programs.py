"""What never comes true ends with a message that names the sensors, and loops in which no time passes do not hang."""

from __future__ import annotations

import json
import pathlib

import pytest
from program_runs import Row, command_line

PROGRAM = """
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
sensor side
robot rover type tw with port 23000 has {{ wheelL wheelR }} wheels with sensors {{ front side }}
robot other type tw with port 23001 has {{ wheelL wheelR }} wheels
movement nothing of rover {{ }}
parallel movement endless of rover {{
  wait 1 seconds
  {action}
}}
parallel movement trip of other {{ move 5 centimeters }}
environment yard has {{ rover other }} robots with {{ endless trip }} moves
"""

# Where the sensors do not see it.
SCENE = "[robots.other]\nstart = [0, 50, 0]\n"

LONG = pytest.mark.long
MILLION = (
    "repeat 100 times { repeat 10000 times { repeat 10000 times { do nothing } } }"
)


@pytest.mark.parametrize(
    ("action", "place", "words"),
    [
        (
            "move at 400 until { front } detect within 40 centimeters",
            {"action": 2},
            "after 100 m front still detects nothing within 0.4 m",
        ),
        (
            "turn right until { front side } detect",
            {"action": 2},
            "after a full turn front, side still detect nothing",
        ),
        (
            "turn left with radius 10 centimeters until { side } detect",
            {"action": 2},
            "after a full circle side still detects nothing",
        ),
        pytest.param(
            "repeat 2 times { wait until { front } detect }",
            {"action": 3, "rounds": [1]},
            "after 600 s front still detects nothing",
            marks=LONG,
        ),
        pytest.param(
            "repeat until { front side } detect within 1 meters { do nothing }",
            {"action": 2},
            "after 10000 rounds front, side still detect nothing within 1 m",
            marks=LONG,
        ),
        pytest.param(
            MILLION,
            {"action": 4, "rounds": [1, 100]},
            "no time has passed in 1000000 rounds",
            marks=LONG,
        ),
    ],
    ids=["move", "turn", "circle", "wait", "repeat until", "no time"],
)
def test_what_never_ends_fails(
    command: str, tmp_path: pathlib.Path, action: str, place: Row, words: str
) -> None:
    file = tmp_path / "program.pyr"
    file.write_text(PROGRAM.format(action=action), encoding="utf-8")
    (tmp_path / "yard.scene.toml").write_text(SCENE, encoding="utf-8")
    run = ("run", "program.pyr", "--no-progress", "--events", "-")
    done = command_line(command, tmp_path, *run)
    assert done.returncode == 1, done.stderr
    events = [json.loads(line) for line in done.stdout.splitlines()]
    [failed] = [event for event in events if event["event"] == "failed"]
    assert failed["message"].endswith(f": {words}")
    assert failed["class"] == "action"
    said = {part: failed.get(part) for part in ("action", "rounds") if part in failed}
    assert {"movement": failed["movement"], "line": failed["line"], **said} == {
        "movement": "endless",
        "line": 11,
        **place,
    }
