"""The package that scripts import: written next to them by the server as by the command."""

from __future__ import annotations

import pathlib
import subprocess
from collections.abc import Iterator
from typing import Any

import pytest
from raw import RawServer, notification, request

NAME = "pydslrep_runtime"
CREATES_FILES: dict[str, Any] = {
    "workspace": {
        "workspaceEdit": {"documentChanges": True, "resourceOperations": ["create"]}
    },
    "textDocument": {
        "codeAction": {
            "codeActionLiteralSupport": {"codeActionKind": {"valueSet": ["source"]}},
            "dataSupport": True,
            "resolveSupport": {"properties": ["edit"]},
        }
    },
}


class Session:
    """A server with an open program."""

    def __init__(self, raw: RawServer, folder: pathlib.Path, program: str) -> None:
        self.raw, self.folder = raw, folder
        path = folder / "table2.pyr"
        path.write_text(program, encoding="utf-8")
        self.program = {"uri": path.as_uri()}
        item = {**self.program, "languageId": "pydslrep", "version": 1, "text": program}
        raw.initialize(CREATES_FILES)
        raw.send(notification("textDocument/didOpen", {"textDocument": item}))

    def execute(self, command: dict[str, Any]) -> None:
        params = {key: command[key] for key in ("command", "arguments")}
        self.raw.send(request(1, "workspace/executeCommand", params))
        assert self.raw.answer(1)["result"] is None

    def generate(self) -> None:
        which = {**self.program, "environment": "area_1"}
        command = {"command": "pydslrep.generateScript", "arguments": [which]}
        self.execute(command)

    def action(self) -> dict[str, Any]:
        """Generate script, as an editor offers it."""
        start = {"line": 0, "character": 0}
        asked = {
            "textDocument": self.program,
            "range": {"start": start, "end": start},
            "context": {"diagnostics": [], "only": ["source.generateScript"]},
        }
        self.raw.send(request(2, "textDocument/codeAction", asked))
        [action] = self.raw.answer(2)["result"]
        self.raw.send(request(3, "codeAction/resolve", action))
        resolved: dict[str, Any] = self.raw.answer(3)["result"]
        return resolved

    def heard_of_runtime(self) -> tuple[int, str]:
        """The kind and text of the next message about the package."""
        while True:
            shown = self.raw.read_until("window/showMessage")["params"]
            if NAME in shown["message"]:
                return shown["type"], shown["message"]

    def save(self) -> None:
        self.raw.send(
            notification("textDocument/didSave", {"textDocument": self.program})
        )


@pytest.fixture
def session(server: str, tmp_path: pathlib.Path, table_2: str) -> Iterator[Session]:
    with RawServer(server, "--stdio") as raw:
        yield Session(raw, tmp_path, table_2)


def files(folder: pathlib.Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_both_doors_write_the_same(
    session: Session, command: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    session.generate()
    by_server = files(session.folder)
    folder = tmp_path_factory.mktemp("command")
    (folder / "table2.pyr").write_bytes(by_server["table2.pyr"])
    subprocess.run([command, "build", "table2.pyr"], cwd=folder, check=True)
    assert {"area_1.py", f"{NAME}/__init__.py", f"{NAME}/_written.json"} < set(
        by_server
    )
    assert files(folder) == by_server


def test_an_edit_creates_the_script_and_a_command_the_package(session: Session) -> None:
    action = session.action()
    assert action["edit"]["documentChanges"][0]["kind"] == "create"
    assert set(files(session.folder)) == {"table2.pyr"}, "nothing is written yet"
    session.execute(action["command"])
    written = set(files(session.folder))
    assert f"{NAME}/__init__.py" in written
    assert "area_1.py" not in written, "the editor does that"


def test_the_settings_can_say_no(session: Session) -> None:
    settings = session.folder / "pydslrep.toml"
    settings.write_text("write-runtime = false\n", encoding="utf-8")
    change = {"uri": settings.as_uri(), "type": 1}
    session.raw.send(
        notification("workspace/didChangeWatchedFiles", {"changes": [change]})
    )
    assert "command" not in session.action()
    session.generate()
    assert not (session.folder / NAME).exists()
    assert (session.folder / "area_1.py").exists()


def test_a_changed_copy_is_kept(session: Session) -> None:
    session.generate()
    changed = session.folder / NAME / "pose.py"
    changed.write_text("mine = 1\n", encoding="utf-8")
    which = {**session.program, "environment": "area_1"}
    params = {"command": "pydslrep.writeRuntime", "arguments": [which]}
    session.raw.send(request(4, "workspace/executeCommand", params))
    kind, message = session.heard_of_runtime()
    assert kind == 2
    assert "is not replaced: pose.py in it was changed; delete it to have" in message
    assert changed.read_text(encoding="utf-8") == "mine = 1\n"


def test_it_is_written_on_save(
    server: str, tmp_path: pathlib.Path, table_2: str
) -> None:
    settings = 'generate-on-save = true\noutput = "scripts"\n'
    (tmp_path / "pydslrep.toml").write_text(settings, encoding="utf-8")
    with RawServer(server, "--stdio") as raw:
        session = Session(raw, tmp_path, table_2)
        session.save()
        kind, message = session.heard_of_runtime()
        assert kind == 3
        assert message.startswith("Runtime of scripts: ")
        assert (tmp_path / "scripts" / NAME / "__init__.py").exists()
        assert (tmp_path / "scripts" / "area_1.py").exists()
