"""The events of a run: every one fits the schema, whatever becomes of the run."""

import json
import os
import stat
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest
from driving import drive_alone, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import MovementError, Robot, SetupError, SimulatorError, events
from pydslrep_runtime.events import Moment, Reporter
from pydslrep_runtime.places import Place
from pydslrep_runtime.pose import Pose

ROOT = Path(__file__).resolve().parents[2]
SCHEMA = json.loads(
    (ROOT / "editors" / "run-events.schema.json").read_text(encoding="utf-8")
)
FITS = jsonschema.Draft7Validator(SCHEMA)
PLACE = Place("trip", 2)
MOMENT = Moment(1.5, "rover", PLACE, "turn left 90 deg", Pose(1.0, -0.0, 1.5))

Event = dict[str, Any]

# Only `pydslrep run` writes these.
OF_THE_COMMAND = {"figures"}


def read(file: Path) -> list[Event]:
    """The events in a file; each fits the schema."""
    found = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
    for event in found:
        FITS.validate(event)
    return found


@pytest.fixture(name="file")
def fixture_file(tmp_path: Path) -> Iterator[Path]:
    """A file that the events of this process go to."""
    file = tmp_path / "events.jsonl"
    with events.use(str(file)):
        yield file


def everything(reporter: Reporter) -> None:
    """Reports all that there is to report."""
    reporter.started("yard", ["rover"])
    for tell in (reporter.action_begun, reporter.action_ended, reporter.contact):
        tell(MOMENT)
    reporter.progress(2.0, "rover", "slam: 1 nodes, 2 exits to explore")
    reporter.note("it is paused")
    reporter.warning("it is older")
    reporter.file("trace", Path("a\udcff.jsonl"))
    reporter.failed(MovementError("no progress", "rover", "trip", 2))
    reporter.failed(SetupError("no robot"))
    reporter.failed(SimulatorError("no reply"))
    reporter.failed(OSError("no space"))
    reporter.interrupted()
    reporter.crashed(ZeroDivisionError("division by zero"))


def test_every_event_fits_the_schema(file: Path) -> None:
    everything(events.current)
    found = read(file)
    assert {event["event"] for event in found} | OF_THE_COMMAND == {
        kind["$ref"].rpartition("/")[2] for kind in SCHEMA["oneOf"]
    }
    classes = [event["class"] for event in found if event["event"] == "failed"]
    known = SCHEMA["$defs"]["failed"]["properties"]["class"]["enum"]
    assert {*classes, "program"} == {*known}, "programs with errors have no script"
    assert (found[8]["robot"], found[8]["movement"], found[8]["action"]) == (
        "rover",
        "trip",
        2,
    )
    assert found[7]["path"] == "a?.jsonl"


def test_people_read_lines_besides(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert file.exists()
    everything(events.current)
    printed = capsys.readouterr()
    assert printed.out == (
        "    1.50 s  rover  trip  2: turn left 90 deg  at x 1.00 m, y 0.00 m, 85.9 deg\n"
    )
    assert printed.err.splitlines() == [
        "note: it is paused",
        "warning: it is older",
        "error: no progress",
        "error: no robot",
        "error: no reply",
        "error: no space",
        "interrupted",
    ]


def drive(robot: FakeRobot, monkeypatch: pytest.MonkeyPatch) -> None:
    async def actions(robot: Robot) -> None:
        await robot.turn(90.0)
        await robot.move(1.0)

    drive_alone(FakeWorld(robot), monkeypatch, "two-wheel", actions)


def test_actions_begin_and_end_with_their_poses(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drive(FakeRobot("r", joints("two-wheel")), monkeypatch)
    found = read(file)
    assert [(event["event"], event["action"], event["text"]) for event in found] == [
        ("action-begun", 1, "turn left 90 deg"),
        ("action-ended", 1, "turn left 90 deg"),
        ("action-begun", 2, "move 1 m"),
        ("action-ended", 2, "move 1 m"),
    ]
    assert (found[0]["t"], found[0]["x"], found[0]["theta"]) == (0.0, 0.0, 0.0)
    assert found[1]["theta"] == pytest.approx(1.5708, abs=0.01)
    assert found[3]["y"] == pytest.approx(1.0, abs=0.005)


def test_a_blocked_robot_has_met_something(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeRobot("r", joints("two-wheel"), wall=0.4)

    async def actions(robot: Robot) -> None:
        await robot.move(1.0)

    with pytest.raises(MovementError) as error:
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", actions)
    last = read(file)[-1]
    assert (last["event"], last["action"]) == ("contact", 1)
    assert last["x"] == pytest.approx(0.4, abs=0.01)
    place = error.value.robot, error.value.movement, error.value.number
    assert place == ("r", "m", 1)


def test_events_replace_events_only(tmp_path: Path) -> None:
    file = tmp_path / "square.pyr"
    file.write_text("wheel a with radius 4\n", encoding="utf-8")
    with pytest.raises(SetupError, match="is not a file of events"):
        events.use(str(file)).__enter__()
    file = tmp_path / "events.jsonl"
    for environment in ("first", "second"):
        with events.use(str(file)) as reporter:
            reporter.started(environment, [])
    assert [event["environment"] for event in read(file)] == ["second"]
    assert not events.current.is_read


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no such pipes")
def test_events_go_to_pipes(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)

    def write() -> None:
        with events.use(str(pipe)) as reporter:
            reporter.started("yard", [])

    writer = threading.Thread(target=write)
    writer.start()
    assert json.loads(pipe.read_text(encoding="utf-8"))["environment"] == "yard"
    writer.join()
    assert stat.S_ISFIFO(pipe.stat().st_mode)


# Whatever is in the way of lines goes elsewhere: what is not ended, and what other processes print.
SCRIPT = """
import os, sys
sys.path.insert(0, {package!r})
from pydslrep_runtime import run

async def yard():
    print("printed", end="")
    sys.stdout.flush()
    os.system("echo other")
    {then}

run(yard, robots=[])
"""

Start = Callable[[str], tuple[int, list[Event], str]]


@pytest.fixture(name="start")
def fixture_start() -> Start:
    """Starts a script whose events go to standard output; returns its code, its events, and what it says besides."""

    def start(then: str) -> tuple[int, list[Event], str]:
        program = SCRIPT.format(package=str(ROOT / "python"), then=then)
        done = subprocess.run(
            [sys.executable, "-c", program, "--events", "-"],
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        return (
            done.returncode,
            [json.loads(line) for line in done.stdout.splitlines()],
            done.stderr,
        )

    return start


@pytest.mark.parametrize(
    ("then", "code", "failure"),
    [
        ("pass", 0, None),
        ("raise OSError('no')", 2, ("file", "no")),
        ("raise KeyboardInterrupt", 130, ("interrupted", "interrupted")),
        ("1 / 0", 1, ("crash", "ZeroDivisionError: division by zero")),
    ],
)
def test_standard_output_has_events_alone(
    start: Start, then: str, code: int, failure: tuple[str, str] | None
) -> None:
    ended, found, said = start(then)
    assert ended == code
    assert found[0]["event"] == "started"
    failures = [(event["class"], event["message"]) for event in found[1:]]
    assert failures == ([] if failure is None else [failure])
    assert said.startswith("printedother\n")
    assert ("Traceback" in said) == (code == 1), "Python itself tells people of it"
    assert "error: " not in said
