"""The commands for Windows, under wine: paths with drives, spaces and umlauts, line ends, runs, interrupts, the server.

`tests/dist/windows.sh FOLDER` starts these tests.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path, PureWindowsPath
from typing import Any
from urllib.parse import quote

import pytest
from raw import RawServer, notification
from raw import request as message

if "PYDSLREP_WINDOWS" not in os.environ:
    pytest.skip("PYDSLREP_WINDOWS names no commands", allow_module_level=True)

COMMANDS = Path(os.environ["PYDSLREP_WINDOWS"])
DRIVE = Path(os.environ["WINEPREFIX"]) / "drive_c"
PYTHON = r"C:\python\python.exe"
PROGRAM = """\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5

robot scout type tw with port 23000 has { wheelL wheelR } wheels

movement trip of scout {
  move 2 meters
  turn left
}

environment yard has { scout } robots with { trip } moves
"""
SCENE = """\
[world]
size = [8, 8]
"""
WRONG = PROGRAM.replace("move 2 meters", "move 2 metres")


@pytest.fixture
def folder() -> Iterator[Path]:
    """A folder on the drive C with a space and an umlaut."""
    folder = DRIVE / "tests" / "Übung 1"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    yield folder
    shutil.rmtree(folder)


def on_windows(path: Path) -> str:
    """A path as Windows has it."""
    return str(PureWindowsPath("C:\\", *path.relative_to(DRIVE).parts))


def uri(path: Path) -> str:
    """A path as VS Code writes it on Windows."""
    return "file:///c%3A/" + quote(path.relative_to(DRIVE).as_posix())


def wine(folder: Path, *command: str) -> tuple[int, str]:
    """Runs a program of Windows; returns its exit code and what it prints."""
    done = subprocess.run(
        ["wine", *command],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
    )
    return done.returncode, done.stdout


def pydslrep(folder: Path, *arguments: str) -> tuple[int, str]:
    """Runs the command."""
    return wine(folder, str(COMMANDS / "pydslrep.exe"), *arguments)


def write(path: Path, text: str) -> Path:
    """Writes a file with the line ends of Windows."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8", newline="\r\n")
    return path


def write_in_two(folder: Path) -> Path:
    """A program whose wheels are in another folder; returns it."""
    wheels = [line for line in PROGRAM.splitlines() if line.startswith("wheel ")]
    write(folder / "Räder" / "alle.pyr", "\n".join(wheels) + "\n")
    rest = "\n".join(line for line in PROGRAM.splitlines() if line not in wheels)
    return write(folder / "yard.pyr", f'import "Räder/alle.pyr"\n{rest}\n')


def test_mistakes_are_reported_at_their_lines(folder: Path) -> None:
    path = write(folder / "fährt.pyr", WRONG)
    code, output = pydslrep(folder, "check", "--format=json", path.name)
    (problem,) = json.loads(output)
    line = WRONG.splitlines().index("  move 2 metres")
    assert code == 1
    assert problem["range"]["start"] == {"line": line + 1, "column": 10}, problem


@pytest.mark.parametrize("separator", ["/", "\\"])
def test_imports_are_found(folder: Path, separator: str) -> None:
    path = write_in_two(folder / "Projekt")
    for name in (
        f"Projekt{separator}yard.pyr",
        on_windows(path),
        on_windows(path).replace("\\", separator),
        "Projekt",
    ):
        assert pydslrep(folder, "check", name)[0] == 0, name


def test_settings_are_found(folder: Path) -> None:
    write(folder / "yard.pyr", "wheel spare with radius 450\n")
    code, output = pydslrep(folder, "check", "yard.pyr")
    assert "implausible-radius" in output
    write(folder / "pydslrep.toml", '[severity]\nimplausible-radius = "off"\n')
    code, output = pydslrep(folder, "check", "yard.pyr")
    assert (code, "implausible-radius" in output) == (0, False), output


def test_formatting_keeps_line_ends(folder: Path) -> None:
    path = write(folder / "yard.pyr", PROGRAM.replace("  move", "move"))
    assert pydslrep(folder, "fmt", "yard.pyr")[0] == 0
    assert path.read_bytes() == PROGRAM.replace("\n", "\r\n").encode()


def test_scripts_and_pictures_are_those_of_other_systems(
    folder: Path, command: str, tmp_path: Path
) -> None:
    for place in (folder, tmp_path):
        (place / "yard.pyr").write_text(PROGRAM, encoding="utf-8")
        (place / "yard.scene.toml").write_text(SCENE, encoding="utf-8")
    build = ["build", "yard.pyr"]
    plan = ["plan", "yard.pyr", "--picture", "plan.svg"]
    for arguments in (build, plan):
        subprocess.run([command, *arguments], cwd=tmp_path, check=True)
        code, output = pydslrep(folder, *arguments)
        assert code == 0, output
    for name in ("yard.py", "plan.svg", "pydslrep_runtime/drives.py"):
        assert (folder / name).read_bytes() == (tmp_path / name).read_bytes(), name


def test_devices_are_no_names(folder: Path) -> None:
    code, output = pydslrep(folder, "new", "con")
    assert code == 2, output
    renamed = PROGRAM.replace("environment yard", "environment aux")
    write(folder / "yard.pyr", renamed)
    code, output = pydslrep(folder, "build", "yard.pyr")
    assert "script-name" in output, output


def test_a_program_runs_in_the_simulator(folder: Path) -> None:
    write_in_two(folder)
    code, output = pydslrep(
        folder, "run", "yard.pyr", "--python", PYTHON, "--picture", "Bild.svg"
    )
    assert code == 0, output
    assert "driven" in output
    assert (folder / "Bild.svg").is_file()


INTERRUPT = r"""
import ctypes, os, signal, subprocess, sys, time
begun, *command = sys.argv[1:]
kernel = ctypes.windll.kernel32
# A console of its own, so that Ctrl-C reaches this program and its child only.
kernel.FreeConsole()
assert kernel.AllocConsole()
signal.signal(signal.SIGINT, lambda *_: None)
child = subprocess.Popen(
    command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
)
first = b""
if begun == "line":
    first = child.stdout.readline()
else:
    while child.poll() is None and not (os.path.exists(begun) and os.path.getsize(begun)):
        time.sleep(0.05)
kernel.GenerateConsoleCtrlEvent(signal.CTRL_C_EVENT, 0)
rest = child.stdout.read()
sys.stdout.buffer.write(first + rest)
sys.exit(child.wait())
"""


def interrupted(folder: Path, begun: str, *arguments: str) -> tuple[int, str]:
    """Runs the command, and presses Ctrl-C once it has printed a line (`line`), or written to the file `begun`."""
    (folder / "interrupt.py").write_text(INTERRUPT)
    program = str(COMMANDS / "pydslrep.exe")
    return wine(folder, PYTHON, "interrupt.py", begun, program, *arguments)


def test_ctrl_c_stops_a_simulator(folder: Path) -> None:
    write(folder / "yard.pyr", PROGRAM)
    code, output = interrupted(folder, "line", "sim", "yard.pyr")
    assert code == 130, output


def test_ctrl_c_stops_the_robots_of_a_run(folder: Path) -> None:
    endless = PROGRAM.replace("move 2 meters", "move 2 meters at 0.01")
    write(folder / "yard.pyr", endless)
    run = ["run", "yard.pyr", "--python", PYTHON, "--trace", "trace.jsonl"]
    begun = "trace.jsonl.partial"
    code, output = interrupted(folder, begun, *run, "--speed", "1")
    assert code == 130, output
    assert "interrupted" in output
    assert (folder / "trace.jsonl").is_file()


class Session:
    """A session of an editor with the server."""

    def __init__(self, folder: Path, program: str, *arguments: str) -> None:
        self.server = RawServer("wine", str(COMMANDS / program), *arguments)
        self.ident = 0
        markup = {"contentFormat": ["markdown"]}
        self.answer = self.ask(
            "initialize",
            {
                "rootUri": uri(folder),
                "workspaceFolders": [{"uri": uri(folder), "name": folder.name}],
                "capabilities": {
                    "textDocument": {
                        "hover": markup,
                        "codeAction": {
                            "codeActionLiteralSupport": {
                                "codeActionKind": {"valueSet": ["quickfix", "source"]}
                            }
                        },
                    },
                    "workspace": {"workspaceEdit": {"documentChanges": True}},
                },
            },
        )
        self.tell("initialized", {})

    def ask(self, method: str, params: object) -> Any:
        """The result of a request."""
        self.ident += 1
        self.server.send(message(self.ident, method, params))
        answer = self.server.answer(self.ident)
        assert "error" not in answer, answer
        return answer["result"]

    def tell(self, method: str, params: object) -> None:
        """Sends a notification."""
        self.server.send(notification(method, params))

    def open(self, path: Path) -> list[dict[str, Any]]:
        """Opens a file; returns its problems."""
        text = path.read_bytes().decode()
        item = {"uri": uri(path), "languageId": "pydslrep", "version": 1, "text": text}
        self.tell("textDocument/didOpen", {"textDocument": item})
        while True:
            found = self.server.read_until("textDocument/publishDiagnostics")["params"]
            if found["uri"].lower() == uri(path).lower():
                problems: list[dict[str, Any]] = found["diagnostics"]
                return problems


@pytest.fixture(params=["pydslrep.exe lsp --stdio", "pydslrep-lsp.exe --stdio"])
def session(folder: Path, request: pytest.FixtureRequest) -> Iterator[Session]:
    """A session in a folder, with each of the programs that contain the server."""
    session = Session(folder, *request.param.split())
    with session.server:
        yield session
        session.ask("shutdown", None)
        session.tell("exit", None)
        assert session.server.leave() == 0


def at(path: Path, text: str, line: str) -> dict[str, Any]:
    """The position of a text in a line of a file."""
    lines = path.read_text(encoding="utf-8").splitlines()
    number = next(number for number, found in enumerate(lines) if line in found)
    return {
        "textDocument": {"uri": uri(path)},
        "position": {"line": number, "character": lines[number].index(text) + 1},
    }


def test_a_session_over_files_with_drives(folder: Path, session: Session) -> None:
    path = write_in_two(folder)
    problems = session.open(path)
    assert not [found for found in problems if found["severity"] < 3], problems

    wheel = at(path, "wheelL", "robot ")
    (target,) = session.ask("textDocument/definition", wheel) or [None]
    there = target.get("uri") or target["targetUri"]
    # Addresses of files that no editor has opened have the drive in upper case.
    assert there.lower() == uri(folder / "Räder" / "alle.pyr").lower()
    assert "wheelL" in json.dumps(session.ask("textDocument/hover", wheel))
    references = session.ask(
        "textDocument/references", {**wheel, "context": {"includeDeclaration": True}}
    )
    assert {found["uri"] for found in references} == {there, uri(path)}

    edit = session.ask("textDocument/rename", {**wheel, "newName": "links"})
    changed = {change["textDocument"]["uri"] for change in edit["documentChanges"]}
    assert changed == {there, uri(path)}


def test_a_session_with_line_ends_of_windows(folder: Path, session: Session) -> None:
    path = write(folder / "fährt.pyr", WRONG)
    (problem,) = session.open(path)
    line = WRONG.splitlines().index("  move 2 metres")
    assert problem["range"]["start"] == {"line": line, "character": 9}
    document = {"textDocument": {"uri": uri(path)}}
    actions = session.ask(
        "textDocument/codeAction",
        {**document, "range": problem["range"], "context": {"diagnostics": [problem]}},
    )
    assert any("meters" in action["title"] for action in actions)
    assert session.ask("textDocument/semanticTokens/full", document)["data"]
    assert session.ask("textDocument/documentSymbol", document)
    completion = at(path, "metres", "metres")
    assert session.ask("textDocument/completion", completion) is not None
    options = {"tabSize": 2, "insertSpaces": True}
    edits = session.ask("textDocument/formatting", {**document, "options": options})
    assert edits in (None, []), "it is formatted"


def test_a_new_import_completes_paths(folder: Path, session: Session) -> None:
    write_in_two(folder)
    path = write(folder / "neu.pyr", 'import "R"\n')
    session.open(path)
    position = at(path, '"', "import")
    position["position"]["character"] += 1
    # Until the server has searched the folder, it offers nothing, and says that there may be more.
    answer: Any = {"isIncomplete": True, "items": []}
    while answer["isIncomplete"] and not answer["items"]:
        answer = session.ask("textDocument/completion", position)
    assert "Räder/alle.pyr" in [item["label"] for item in answer["items"]], answer
