"""Runs and previews of environments from an editor, saved or not."""

from __future__ import annotations

import json
import os
import pathlib
import re
import shutil
from collections.abc import Iterator
from typing import Any
from urllib.parse import unquote, urlsplit

import jsonschema  # type: ignore[import-untyped]
import pytest
from raw import RawServer, answer, notification, request

PARTS = """\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
robot rover with port 1 has { wheelL wheelR } wheels with sensors { front }
"""
PROGRAM = """\
import "parts.pyr"
/* 🤖 */ movement patrol of rover {
  move 1 meters
  turn left
}
environment area has { rover } robots with { patrol } moves
"""

# A fake run that lasts until it is interrupted.
ENDLESS = """\
#!/bin/sh
trap 'echo interrupted >&2; exit 130' INT
cat "$2" "$(dirname "$2")/parts.pyr" > "$(dirname "$0")/seen"
echo "$@" > "$(dirname "$0")/arguments"
echo '{"event": "progress", "t": null, "robot": null, "text": "begun"}'
while :; do sleep 0.01; done
"""


# The same, but it has closed its outputs, and reports that through a pipe.
SILENT = """\
#!/bin/sh
trap 'exit 130' INT
exec >&- 2>&-
echo silent > "$(dirname "$0")/report"
while :; do sleep 0.01; done
"""


# Reports through a pipe that it has started, its arguments, and that it was interrupted.
TELLING = """\
#!/bin/sh
report="$(dirname "$0")/report"
trap 'echo interrupted > "$report"; exit 130' INT
echo "$@" > "$report"
while :; do sleep 0.01; done
"""


# Reports through a pipe that it has started, and that its parent process is gone.
LISTENING = """\
#!/bin/sh
report="$(dirname "$0")/report"
if [ -p /dev/stdin ]; then echo begun; else echo nothing to listen to; fi > "$report"
cat > /dev/null
echo no more input > "$report"
"""


class Session:
    """A server with an open program whose text is not on disk."""

    def __init__(
        self, raw: RawServer, folder: pathlib.Path, *, progress: bool = True
    ) -> None:
        self.raw = raw
        self.uri = (folder / "program.pyr").as_uri()
        (folder / "parts.pyr").write_text("older", encoding="utf-8")
        raw.initialize({"window": {"workDoneProgress": progress}})
        self.open((folder / "parts.pyr").as_uri(), PARTS)
        self.open(self.uri, PROGRAM)

    def open(self, uri: str, text: str) -> None:
        item = {"uri": uri, "languageId": "pydslrep", "version": 1, "text": text}
        self.raw.send(notification("textDocument/didOpen", {"textDocument": item}))

    def replace(self, version: int, old: str, new: str) -> None:
        document = {"uri": self.uri, "version": version}
        changes = [{"text": PROGRAM.replace(old, new)}]
        self.raw.send(
            notification(
                "textDocument/didChange",
                {"textDocument": document, "contentChanges": changes},
            )
        )

    @property
    def area(self) -> dict[str, str]:
        return {"uri": self.uri, "environment": "area"}

    def execute(self, ident: int, command: str, argument: object) -> None:
        self.raw.send(
            request(
                ident,
                "workspace/executeCommand",
                {"command": command, "arguments": [argument]},
            )
        )

    def accept_progress(self) -> Any:
        """Accepts the server's progress; returns the token."""
        while True:
            asked = self.raw.read_until("window/workDoneProgress/create")
            self.raw.send(answer(asked["id"], None))
            token = asked["params"]["token"]
            if "run" in str(token):
                return token

    def next_progress(self) -> dict[str, Any]:
        """What is said next of any progress; accepts those that begin meanwhile."""
        while (message := self.raw.read()) is not None:
            if message.get("method") == "window/workDoneProgress/create":
                self.raw.send(answer(message["id"], None))
            elif message.get("method") == "$/progress":
                params: dict[str, Any] = message["params"]
                return params
        raise AssertionError("the server left")


@pytest.fixture
def session(server: str, tmp_path: pathlib.Path) -> Iterator[Session]:
    with RawServer(server, "--stdio") as raw:
        yield Session(raw, tmp_path)


@pytest.fixture
def endless(server: str, tmp_path: pathlib.Path) -> Iterator[Session]:
    bin_folder = tmp_path / "bin"
    bin_folder.mkdir()
    own = shutil.copy2(server, bin_folder / "pydslrep-lsp")
    program = bin_folder / "pydslrep"
    program.write_text(ENDLESS, encoding="utf-8")
    program.chmod(0o755)
    with RawServer(str(own), "--stdio") as raw:
        yield Session(raw, tmp_path)


def test_a_preview_draws_what_the_editor_shows(session: Session, command: str) -> None:
    assert pathlib.Path(command).exists()
    session.execute(1, "pydslrep.previewPath", session.area)
    session.accept_progress()
    done = session.raw.answer(1)
    picture = pathlib.Path(unquote(urlsplit(done["result"]["picture"]).path))
    assert "<svg" in picture.read_text(encoding="utf-8")
    replay = pathlib.Path(unquote(urlsplit(done["result"]["replay"]).path))
    assert "<animate" in replay.read_text(encoding="utf-8")
    assert "rover" in done["result"]["output"]
    picture.unlink()
    replay.unlink()


ROOT = pathlib.Path(__file__).resolve().parents[2]


def read_by_editors() -> dict[str, set[str]]:
    """What the editors read of the answer to a run. They know runs from these answers alone."""
    code = (ROOT / "editors/vscode/src/run.ts").read_text(encoding="utf-8")
    _, _, answer = code.partition("interface RunResult {")
    lua = (ROOT / "editors/neovim/lua/pydslrep/runs.lua").read_text(encoding="utf-8")
    _, _, result = lua.partition("---@class pydslrep.Result")
    return {
        "TypeScript": {*re.findall(r"^  (\w+)\??:", answer.partition("}")[0], re.M)},
        "Lua": {*re.findall(r"^---@field (\w+)", result.partition("\n\n")[0], re.M)},
    }


def test_a_run_answers_with_what_editors_read(session: Session, command: str) -> None:
    assert pathlib.Path(command).exists()
    session.execute(1, "pydslrep.run", session.area)
    session.accept_progress()
    result = session.raw.answer(1)["result"]
    for language, fields in read_by_editors().items():
        assert {"picture", "output"} <= fields <= result.keys(), language
    assert "rover" in result["output"]
    assert (result["figures"]["environment"], result["figures"]["complete"]) == (
        "area",
        True,
    )
    schema = json.loads(
        (ROOT / "editors/run-events.schema.json").read_text(encoding="utf-8")
    )
    event = {
        "event": "figures",
        "figures": result["figures"],
        "table": result["output"],
    }
    jsonschema.validate(event, schema)


def test_the_command_runs_itself_whatever_it_is_called(
    command: str, tmp_path: pathlib.Path
) -> None:
    renamed = shutil.copy2(command, tmp_path / "renamed")
    with RawServer(str(renamed), "lsp", "--stdio") as raw:
        session = Session(raw, tmp_path)
        session.execute(1, "pydslrep.previewPath", session.area)
        session.accept_progress()
        done = session.raw.answer(1)
    assert done["result"]["output"].startswith("area: ")


@pytest.mark.parametrize(
    "wrong",
    [
        "robot other with port 2 has { wheelL wheelX } wheels",
        "environment other has { rover } robots with { patroll } moves",
        "movement other of rover { move",
    ],
)
def test_errors_elsewhere_do_not_prevent_a_path(session: Session, wrong: str) -> None:
    """An environment without errors has a path, a picture and a script."""
    session.open(session.uri, f"{PROGRAM}{wrong}\n")
    session.raw.send(request(1, "pydslrep/plannedPath", session.area))
    assert session.raw.answer(1)["result"]["environment"] == "area"
    session.execute(2, "pydslrep.generateScript", session.area)
    assert session.raw.answer(2)["result"] is None
    session.execute(3, "pydslrep.previewPath", session.area)
    session.accept_progress()
    done = session.raw.answer(3)["result"]
    picture = pathlib.Path(unquote(urlsplit(done["picture"]).path))
    assert "<svg" in picture.read_text(encoding="utf-8")
    assert done["output"].startswith("area: ")
    picture.unlink()


def test_a_run_can_be_cancelled(endless: Session, tmp_path: pathlib.Path) -> None:
    endless.execute(1, "pydslrep.run", endless.area)
    while True:
        progress = endless.next_progress()
        if progress["value"].get("message") == "begun":
            break
    token = progress["token"]
    assert (tmp_path / "bin" / "seen").read_text(encoding="utf-8") == PROGRAM + PARTS
    arguments = (tmp_path / "bin" / "arguments").read_text(encoding="utf-8").split()
    assert arguments[0] == "run"
    assert arguments[2:5] == ["--environment", "area", "--picture"]
    assert arguments[6:13:2] == ["--replay", "--trace", "--map", "--events"]
    assert arguments[13:] == ["-", "--until-input-ends"]
    endless.raw.send(notification("window/workDoneProgress/cancel", {"token": token}))
    assert endless.raw.answer(1)["error"]["code"] == -32800
    assert not pathlib.Path(arguments[1]).exists(), "what was run is tidied up"
    assert not pathlib.Path(arguments[5]).exists(), "nothing was drawn"


def test_a_silent_run_can_be_cancelled(
    endless: Session, tmp_path: pathlib.Path
) -> None:
    (tmp_path / "bin" / "pydslrep").write_text(SILENT, encoding="utf-8")
    received = tmp_path / "bin" / "report"
    os.mkfifo(received)
    endless.execute(1, "pydslrep.run", endless.area)
    token = endless.accept_progress()
    assert received.read_text() == "silent\n"
    endless.raw.send(
        notification("window/workDoneProgress/cancel", {"token": token}),
        request(2, "shutdown", None),
    )
    endless.raw.answer(2)


@pytest.mark.parametrize("progress", [True, False])
@pytest.mark.parametrize("ending", ["end of input", "exit", "shutdown"])
def test_a_run_ends_with_its_session(
    server: str, tmp_path: pathlib.Path, ending: str, *, progress: bool
) -> None:
    received = reporting_program(server, tmp_path)
    with RawServer(str(tmp_path / "bin" / "pydslrep-lsp"), "--stdio") as raw:
        session = Session(raw, tmp_path, progress=progress)
        session.execute(1, "pydslrep.run", session.area)
        if progress:
            session.accept_progress()
        arguments = received.read_text().split()
        program, picture = (pathlib.Path(arguments[at]) for at in (1, 5))
        assert program.exists()
        assert picture.parent.exists()
        if ending == "end of input":
            raw.input.close()
        elif ending == "exit":
            raw.send(notification("exit", None))
        else:
            raw.send(request(2, "shutdown", None), notification("exit", None))
        assert received.read_text() == "interrupted\n"
        assert raw.leave() == (0 if ending == "shutdown" else 1)
    assert not program.parent.exists(), "what was run is tidied up"
    assert not picture.parent.exists(), "pictures are kept as long as the session"


def test_a_run_ends_when_its_server_is_killed(
    server: str, tmp_path: pathlib.Path
) -> None:
    received = reporting_program(server, tmp_path)
    (tmp_path / "bin" / "pydslrep").write_text(LISTENING, encoding="utf-8")
    with RawServer(str(tmp_path / "bin" / "pydslrep-lsp"), "--stdio") as raw:
        session = Session(raw, tmp_path, progress=False)
        session.execute(1, "pydslrep.run", session.area)
        assert received.read_text() == "begun\n"
        raw.process.kill()
        assert received.read_text() == "no more input\n"


def reporting_program(server: str, folder: pathlib.Path) -> pathlib.Path:
    """Puts a program that reports events next to the server, and returns the pipe for its reports."""
    bin_folder = folder / "bin"
    bin_folder.mkdir()
    shutil.copy2(server, bin_folder / "pydslrep-lsp")
    program = bin_folder / "pydslrep"
    program.write_text(TELLING, encoding="utf-8")
    program.chmod(0o755)
    os.mkfifo(bin_folder / "report")
    return bin_folder / "report"


# A fake run that drives, and fails in the end if requested.
DRIVING = """\
#!/bin/sh
beside="$(dirname "$0")"
while [ $# -gt 0 ]; do
  case "$1" in
    --trace) cat "$beside/trace" > "$2" ;;
    --map) cat "$beside/map" > "$2" ;;
    --picture) echo "<svg/>" > "$2" ;;
  esac
  shift
done
[ ! -e "$beside/fails" ] || { echo "rover does not move" >&2; exit 1; }
"""
STEP = '{"t": %s, "robot": "rover", "x": %s, "y": 0, "theta": 0, "wheels": [1, 1]}\n'
MAP = (
    '{"nodes": [{"robot": "rover", "x": 0, "y": 1}, {"robot": "rover", "x": 2, "y": 3}],'
    ' "edges": [{"from": 0, "to": 1}]}'
)


def test_driven_paths_and_their_changes_are_sent(
    endless: Session, tmp_path: pathlib.Path
) -> None:
    bin_folder = tmp_path / "bin"
    (bin_folder / "pydslrep").write_text(DRIVING, encoding="utf-8")
    (bin_folder / "trace").write_text("".join(STEP % (t, t / 8) for t in range(3)))
    (bin_folder / "map").write_text(MAP)
    raw = endless.raw
    raw.send(request(1, "pydslrep/drivenPath", endless.area))
    assert raw.answer(1)["result"] is None, "nothing was driven yet"
    raw.send(request(6, "pydslrep/plannedPath", endless.area))
    planned = raw.answer(6)["result"]

    endless.execute(2, "pydslrep.run", endless.area)
    endless.accept_progress()
    changed = raw.read_until("pydslrep/drivenPathChanged")
    assert changed["params"] == endless.area
    assert "picture" in raw.answer(2)["result"]
    raw.send(request(3, "pydslrep/drivenPath", endless.area))
    driven = raw.answer(3)["result"]
    assert driven["planned"] == planned, "as it was when the run began"
    [rover] = driven["robots"]
    assert rover["name"] == "rover"
    assert [pose["x"] for pose in rover["poses"]] == [0, 0.125, 0.25]
    assert rover["map"] == {"nodes": [[0, 1], [2, 3]], "edges": [[[0, 1], [2, 3]]]}

    (bin_folder / "fails").touch()
    (bin_folder / "trace").write_text(STEP % (0, 7))
    endless.execute(4, "pydslrep.run", endless.area)
    endless.accept_progress()
    raw.read_until("pydslrep/drivenPathChanged")
    error = raw.answer(4)["error"]
    assert error["message"] == "rover does not move"
    raw.send(request(5, "pydslrep/drivenPath", endless.area))
    assert raw.answer(5)["result"]["robots"][0]["poses"][0]["x"] == 7


# Fails as `pydslrep run` does where a collision was planned.
FAILING = """\
#!/bin/sh
cat >&2 << END
warning[planned-collision]: \\`rover\\` runs into \\`crate\\` here after 7.6 s
 --> $2:3:3

1 warning in 1 file.
error: robot rover, movement patrol, action 2: turn left 90: no progress for 5 s
picture: $5
END
cat << END
{"event": "started", "environment": "area", "robots": ["rover"], "version": "0.2.0"}
{"event": "failed", "class": "$(cat "$(dirname "$0")/class")", "message": "robot rover, movement patrol, action 2: turn left 90: no progress for 5 s", "robot": "rover", "movement": "patrol", "action": $(cat "$(dirname "$0")/action"), "help": null, "output": "Traceback"}
END
exit 1
"""


def fails(folder: pathlib.Path, kind: str, action: str) -> None:
    """Replaces the command by one that fails."""
    (folder / "pydslrep").write_text(FAILING, encoding="utf-8")
    (folder / "class").write_text(kind, encoding="utf-8")
    (folder / "action").write_text(action, encoding="utf-8")


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (
            "setup",
            "error: robot rover, movement patrol, action 2: turn left 90: no progress for 5 s",
        ),
        ("crash", "Traceback"),
        ("later", "error: robot rover, movement patrol, action 2"),
    ],
)
def test_a_failure_has_its_reason(
    endless: Session, tmp_path: pathlib.Path, kind: str, message: str
) -> None:
    fails(tmp_path / "bin", kind, "null")
    endless.execute(1, "pydslrep.run", endless.area)
    endless.accept_progress()
    error = endless.raw.answer(1)["error"]
    assert error["message"].startswith(message)
    assert "data" not in error


def test_a_failed_action_has_its_place(
    endless: Session, tmp_path: pathlib.Path
) -> None:
    fails(tmp_path / "bin", "action", "2")
    endless.execute(1, "pydslrep.run", endless.area)
    endless.accept_progress()
    error = endless.raw.answer(1)["error"]
    assert error["message"] == (
        "robot rover, movement patrol, action 2: turn left 90: no progress for 5 s"
        " (program.pyr, line 4)"
    )
    assert error["data"]["reason"] == "failed-run"
    assert error["data"]["location"]["uri"] == endless.uri
    assert error["data"]["location"]["range"] == {
        "start": {"line": 3, "character": 2},
        "end": {"line": 3, "character": 11},
    }


def test_an_environment_with_errors_does_not_run(session: Session) -> None:
    session.replace(2, "turn left", "turn leftt")
    session.execute(1, "pydslrep.run", session.area)
    assert "`area` has errors" in session.raw.answer(1)["error"]["message"]
    session.execute(2, "pydslrep.run", {"uri": session.uri, "environment": "x"})
    assert "no environment `x`" in session.raw.answer(2)["error"]["message"]
    session.execute(3, "pydslrep.run", "area")
    assert session.raw.answer(3)["error"]["code"] == -32602


def test_a_failure_suggests_a_remedy(session: Session) -> None:
    """The error's data has the location of the first problem, or says that there is no file yet."""
    session.replace(2, "turn left", "turn leftt")
    line = PROGRAM.split("\n").index("  turn left")
    for ident, command in enumerate(
        ["pydslrep.run", "pydslrep.previewPath", "pydslrep.generateScript"], 1
    ):
        session.execute(ident, command, session.area)
        error = session.raw.answer(ident)["error"]
        assert error["data"]["reason"] == "errors"
        location = error["data"]["location"]
        assert (location["uri"], location["range"]["start"]["line"]) == (
            session.uri,
            line,
        )
    unsaved = "untitled:Untitled-1"
    session.open(unsaved, PARTS + PROGRAM.split("\n", 1)[1])
    session.execute(
        8, "pydslrep.generateScript", {"uri": unsaved, "environment": "area"}
    )
    assert session.raw.answer(8)["error"] == {
        "code": -32803,
        "message": "save the file first; the script is written next to it",
        "data": {"reason": "unsaved"},
    }


def test_a_code_has_a_page(session: Session) -> None:
    """The page that `pydslrep explain` prints, as Markdown."""
    session.raw.send(request(1, "pydslrep/explain", {"code": "invalid-radius"}))
    page = session.raw.answer(1)["result"]["markdown"]
    assert page.startswith("# invalid-radius\n")
    session.raw.send(request(2, "pydslrep/explain", {"code": "invalid-radios"}))
    error = session.raw.answer(2)["error"]
    assert error["code"] == -32602
    assert "invalid-radios" in error["message"]


def test_codes_link_to_pages_that_the_client_shows(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize(
            {
                "experimental": {"pages": "pydslrep-page"},
                "textDocument": {
                    "publishDiagnostics": {"codeDescriptionSupport": True}
                },
            }
        )
        item = {
            "uri": (tmp_path / "a.pyr").as_uri(),
            "languageId": "pydslrep",
            "version": 1,
            "text": "wheel w with radius -1\n",
        }
        raw.send(notification("textDocument/didOpen", {"textDocument": item}))
        received = raw.read_until("textDocument/publishDiagnostics")
        links = {
            diagnostic["code"]: diagnostic["codeDescription"]["href"]
            for diagnostic in received["params"]["diagnostics"]
        }
        assert links["invalid-radius"] == "pydslrep-page:/invalid-radius.md"


def test_the_kinematics_of_a_robot_are_shown(session: Session) -> None:
    session.open(session.uri, PARTS)
    session.execute(
        1, "pydslrep.showKinematics", {"uri": session.uri, "robot": "rover"}
    )
    assert "right = (v + ω d/2) / r" in session.raw.answer(1)["result"]
    session.execute(2, "pydslrep.showKinematics", {"uri": session.uri, "robot": "x"})
    assert session.raw.answer(2)["error"]["message"] == "there is no robot `x`"


def test_planned_paths_and_their_changes_are_sent(session: Session) -> None:
    session.raw.send(request(1, "pydslrep/plannedPath", session.area))
    path = session.raw.answer(1)["result"]
    [robot] = path["robots"]
    assert (path["environment"], robot["name"]) == ("area", "rover")
    assert robot["poses"][0] == {"t": 0, "x": 0, "y": 0, "theta": 0, "action": None}
    last = robot["poses"][-1]
    assert last["t"] == pytest.approx(path["duration"])
    assert (last["x"], last["y"]) == pytest.approx((1, 0))
    assert last["action"] == {"movement": "patrol", "index": 1, "text": "turn left"}
    assert robot["unknownAfter"] is None

    session.replace(2, "turn left", "turn left until { front }")
    changed = session.raw.read_until("pydslrep/plannedPathChanged")
    assert changed["params"] == session.area
    session.raw.send(request(2, "pydslrep/plannedPath", session.area))
    path = session.raw.answer(2)["result"]
    assert path["duration"] is None
    assert path["robots"][0]["unknownAfter"]["index"] == 1


def test_paths_and_text_lead_to_each_other(session: Session) -> None:
    """Positions use the client's encoding: the movement is after an emoji."""
    raw = session.raw
    line = PROGRAM.split("\n").index("  turn left")
    position = {"line": line, "character": 4}
    at = {"textDocument": {"uri": session.uri}, "position": position}
    raw.send(request(1, "pydslrep/plannedAt", at))
    assert raw.answer(1)["result"] == {
        "environments": ["area"],
        "using": ["area"],
        "action": {"movement": "patrol", "index": 1},
    }
    raw.send(
        request(
            2,
            "pydslrep/actionLocation",
            {**session.area, "movement": "patrol", "index": 1},
        ),
        request(
            3,
            "pydslrep/actionLocation",
            {**session.area, "movement": "patrol", "index": 2},
        ),
    )
    place = {
        "start": {"line": line, "character": 2},
        "end": {"line": line, "character": 11},
    }
    assert raw.answer(2)["result"] == {"uri": session.uri, "range": place}
    assert raw.answer(3)["result"] is None
    at["textDocument"] = {"uri": "untitled:nowhere"}
    raw.send(request(4, "pydslrep/plannedAt", at))
    assert raw.answer(4)["result"] is None


def test_a_planned_path_has_bodies_and_legs(session: Session) -> None:
    session.raw.send(request(1, "pydslrep/plannedPath", session.area))
    path = session.raw.answer(1)["result"]
    [rover] = path["robots"]
    assert rover["body"]["length"] > rover["body"]["width"] / 2 > 0
    assert [sensor["name"] for sensor in rover["sensors"]] == ["front"]
    assert [leg["action"]["index"] for leg in rover["legs"]] == [0, 1]
    for leg in rover["legs"]:
        end = rover["poses"][leg["last"]]
        assert end["action"] == leg["action"]
        assert end["t"] == pytest.approx(leg["start"] + leg["duration"])
    assert (path["obstacles"], path["collisions"]) == ([], [])
