"""A folder of programs, with few or no open documents."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from typing import Any

import pytest
from questions import Buffer, edited
from raw import RawServer, answer, notification, request

WHEELS = "wheel a with radius 4\nwheel b with radius 4\n"
ROBOT = 'import "wheels.pyr"\nrobot r with port 1 has { a b } wheels\n'

CLIENT = {
    "workspace": {
        "configuration": True,
        "workspaceFolders": True,
        "didChangeWatchedFiles": {"dynamicRegistration": True},
        "didChangeConfiguration": {"dynamicRegistration": True},
    },
    "window": {"workDoneProgress": True},
    "textDocument": {
        "codeAction": {
            "codeActionLiteralSupport": {"codeActionKind": {"valueSet": ["quickfix"]}}
        }
    },
}
PULLING = {**CLIENT, "textDocument": {"diagnostic": {}}}


class Workspace:
    """A server with an open folder, and a client that replies to the mandatory requests."""

    def __init__(self, server: RawServer, folder: pathlib.Path) -> None:
        self.server = server
        self.folder = folder
        self.settings: dict[str, Any] = {}
        self.ident = 0
        self.asked: list[str] = []

    def start(self, capabilities: dict[str, Any]) -> None:
        folders = [{"uri": self.folder.as_uri(), "name": "it"}]
        params = {"capabilities": capabilities, "workspaceFolders": folders}
        self.server.send(
            request(0, "initialize", params), notification("initialized", {})
        )
        self.server.answer(0)

    def next(self) -> dict[str, Any]:
        """The next message that is not a request; replies to requests."""
        while (message := self.server.read()) is not None:
            if "id" not in message or "method" not in message:
                return message
            self.asked.append(message["method"])
            result = (
                [self.settings]
                if message["method"] == "workspace/configuration"
                else None
            )
            self.server.send(answer(message["id"], result))
        raise AssertionError("the server left")

    def published(self, name: str) -> list[str]:
        """The codes published next for a file."""
        while True:
            message = self.next()
            if message.get("method") != "textDocument/publishDiagnostics":
                continue
            if message["params"]["uri"] == self.uri(name):
                return [item["code"] for item in message["params"]["diagnostics"]]

    def indexed(self) -> None:
        """Waits until the server has searched for programs."""
        while True:
            message = self.next()
            if message.get("method") == "$/progress":
                value = message["params"]["value"]
                if value["kind"] == "end":
                    return

    def uri(self, name: str) -> str:
        return (self.folder / name).as_uri()

    def write(self, name: str, text: str, change: int = 2) -> None:
        """Writes a file and notifies the server; 1 is created, 2 changed."""
        (self.folder / name).write_text(text, encoding="utf-8")
        self.tell(name, change)

    def tell(self, name: str, change: int) -> None:
        changes = [{"uri": self.uri(name), "type": change}]
        self.server.send(
            notification("workspace/didChangeWatchedFiles", {"changes": changes})
        )

    def ask(self, previous: list[dict[str, str]]) -> int:
        self.ident += 1
        params = {"previousResultIds": previous}
        self.server.send(request(self.ident, "workspace/diagnostic", params))
        return self.ident

    def report(self, ident: int) -> dict[str, tuple[str | None, list[str]]]:
        """The result id and codes of each file."""
        while (message := self.next()).get("id") != ident:
            pass
        return {
            item["uri"].rsplit("/", 1)[-1]: (
                item.get("resultId"),
                [found["code"] for found in item["items"]],
            )
            for item in message["result"]["items"]
        }


@pytest.fixture
def workspace(server: str, tmp_path: pathlib.Path) -> Iterator[Workspace]:
    folder = tmp_path / "programs"
    folder.mkdir()
    (folder / "wheels.pyr").write_text(WHEELS, encoding="utf-8")
    (folder / "robot.pyr").write_text(ROBOT, encoding="utf-8")
    with RawServer(server, "--stdio") as running:
        yield Workspace(running, folder)


def test_unopened_files_have_diagnostics_and_follow_their_imports(
    workspace: Workspace,
) -> None:
    (workspace.folder / "wheels.pyr").write_text("wheel a with radius 4\n")
    workspace.start(CLIENT)
    assert workspace.published("robot.pyr") == ["unresolved-reference"]
    workspace.write("wheels.pyr", WHEELS)
    assert workspace.published("robot.pyr") == []
    (workspace.folder / "wheels.pyr").unlink()
    workspace.tell("wheels.pyr", 3)
    assert workspace.published("robot.pyr") == ["unresolved-import"]
    workspace.write("wheels.pyr", WHEELS, 1)
    assert workspace.published("robot.pyr") == []
    assert set(workspace.asked) == {
        "client/registerCapability",
        "workspace/configuration",
        "window/workDoneProgress/create",
    }


def test_typing_in_an_imported_file_shows_in_unopened_ones(
    workspace: Workspace,
) -> None:
    workspace.start(CLIENT)
    workspace.indexed()
    document = {
        "uri": workspace.uri("wheels.pyr"),
        "languageId": "pydslrep",
        "version": 1,
        "text": "wheel a with radius 4\nwheel c with radius 4\n",
    }
    workspace.server.send(
        notification("textDocument/didOpen", {"textDocument": document})
    )
    assert workspace.published("robot.pyr") == ["unresolved-reference"]
    closed = {"textDocument": {"uri": workspace.uri("wheels.pyr")}}
    workspace.server.send(notification("textDocument/didClose", closed))
    assert workspace.published("robot.pyr") == [], "the file on the disk counts again"


def test_settings_hold_and_change(workspace: Workspace) -> None:
    (workspace.folder / "wheels.pyr").write_text("wheel a with radius 4\n")
    workspace.settings = {"severity": {"unresolved-reference": "off"}}
    workspace.start(CLIENT)
    workspace.indexed()
    workspace.write(
        "pydslrep.toml", "[severity]\nunresolved-import = 'hint'\nwheels = 1\n", 1
    )
    assert workspace.published("pydslrep.toml") == ["unknown-key"]
    workspace.settings = {}
    workspace.server.send(
        notification("workspace/didChangeConfiguration", {"settings": None})
    )
    assert workspace.published("robot.pyr") == ["unresolved-reference"]


def test_invalid_settings_are_reported(workspace: Workspace) -> None:
    workspace.settings = {"severety": {}}
    workspace.start(CLIENT)
    while (message := workspace.next()).get("method") != "window/showMessage":
        pass
    assert "did you mean `severity`" in message["params"]["message"]


def test_settings_files_have_completion_hover_and_fixes(
    workspace: Workspace,
) -> None:
    workspace.start(CLIENT)
    workspace.indexed()
    document = {
        "uri": workspace.uri("pydslrep.toml"),
        "languageId": "toml",
        "version": 1,
        "text": "# 🤖\n[sevrity]\nwheel-count = 'off'\n",
    }
    server = workspace.server
    server.send(notification("textDocument/didOpen", {"textDocument": document}))
    assert workspace.published("pydslrep.toml") == ["unknown-key"]

    def ask(method: str, **params: Any) -> Any:
        workspace.ident += 1
        params["textDocument"] = {"uri": document["uri"]}
        server.send(request(workspace.ident, method, params))
        while (message := workspace.next()).get("id") != workspace.ident:
            pass
        return message["result"]

    slip = {
        "start": {"line": 1, "character": 3},
        "end": {"line": 1, "character": 3},
    }
    (fix,) = ask("textDocument/codeAction", range=slip, context={"diagnostics": []})
    assert fix["title"] == "Change to `severity`"
    assert fix["diagnostics"][0]["code"] == "unknown-key"
    ((edit,),) = fix["edit"]["changes"].values()
    assert edit["newText"] == "severity"
    changes = [
        {"range": edit["range"], "text": edit["newText"]},
        {
            "range": {
                "start": {"line": 3, "character": 0},
                "end": {"line": 3, "character": 0},
            },
            "text": "wheel-o",
        },
    ]
    version = {"uri": document["uri"], "version": 2}
    server.send(
        notification(
            "textDocument/didChange",
            {"textDocument": version, "contentChanges": changes},
        )
    )
    found = ask("textDocument/completion", position={"line": 3, "character": 7})
    labels = [item["label"] for item in found["items"]]
    assert "wheel-order" in labels
    assert "wheel-count" not in labels, "it is there already"
    order = found["items"][labels.index("wheel-order")]
    assert order["textEdit"] == {
        "range": {
            "start": {"line": 3, "character": 0},
            "end": {"line": 3, "character": 7},
        },
        "newText": 'wheel-order = ""',
    }
    hover = ask("textDocument/hover", position={"line": 2, "character": 4})
    assert "`wheel-count`" in str(hover["contents"])


def opened(workspace: Workspace, name: str) -> None:
    text = (workspace.folder / name).read_text(encoding="utf-8")
    document = {"uri": workspace.uri(name), "languageId": "pydslrep", "version": 1}
    opened = notification(
        "textDocument/didOpen", {"textDocument": document | {"text": text}}
    )
    workspace.server.send(opened)


def renamed(workspace: Workspace, old: str, new: str) -> dict[str, Any]:
    return {"files": [{"oldUri": workspace.uri(old), "newUri": workspace.uri(new)}]}


def will_rename(workspace: Workspace, old: str, new: str) -> dict[str, str]:
    """The texts of files after the edits of a rename."""
    workspace.ident += 1
    params = renamed(workspace, old, new)
    workspace.server.send(request(workspace.ident, "workspace/willRenameFiles", params))
    while (message := workspace.next()).get("id") != workspace.ident:
        pass
    after = {}
    for uri, edits in ((message["result"] or {}).get("changes") or {}).items():
        name = uri.removeprefix(workspace.folder.as_uri() + "/")
        text = (workspace.folder / name).read_text(encoding="utf-8")
        buffer = Buffer(uri, text, "utf-16")
        after[name] = edited(buffer, edits)
    return after


def test_a_folder_is_renamed_by_the_editor(workspace: Workspace) -> None:
    parts = workspace.folder / "parts"
    parts.mkdir()
    (workspace.folder / "wheels.pyr").rename(parts / "wheels.pyr")
    (parts / "near.pyr").write_text('import "wheels.pyr"\n', encoding="utf-8")
    robot = ROBOT.replace("wheels.pyr", "parts/wheels.pyr")
    (workspace.folder / "robot.pyr").write_text(robot, encoding="utf-8")
    workspace.start(CLIENT)
    workspace.indexed()
    after = will_rename(workspace, "parts", "lib")
    assert after == {"robot.pyr": robot.replace("parts/", "lib/")}
    parts.rename(workspace.folder / "lib")
    received = notification(
        "workspace/didRenameFiles", renamed(workspace, "parts", "lib")
    )
    workspace.server.send(received)
    assert workspace.published("robot.pyr") == ["unresolved-import"]
    workspace.write("robot.pyr", after["robot.pyr"])
    assert workspace.published("robot.pyr") == []
    (workspace.folder / "lib" / "wheels.pyr").unlink()
    workspace.tell("lib/wheels.pyr", 3)
    assert workspace.published("lib/near.pyr") == ["unresolved-import"], (
        "what is in the folder is known again"
    )


def test_a_file_is_moved_by_the_editor(workspace: Workspace) -> None:
    workspace.start(CLIENT)
    workspace.indexed()
    opened(workspace, "robot.pyr")
    assert will_rename(workspace, "robot.pyr", "a/b/robot.pyr") == {
        "robot.pyr": ROBOT.replace("wheels.pyr", "../../wheels.pyr")
    }
    assert will_rename(workspace, "robot.pyr", "robot_2.pyr") == {}
    assert will_rename(workspace, "gone.pyr", "gone_2.pyr") == {}


def test_a_file_is_renamed_outside_and_back(workspace: Workspace) -> None:
    workspace.start(CLIENT)
    workspace.indexed()
    wheels, round_ = workspace.folder / "wheels.pyr", workspace.folder / "round.pyr"

    def tell(gone: str, new: str) -> None:
        changes = [
            {"uri": workspace.uri(new), "type": 1},
            {"uri": workspace.uri(gone), "type": 3},
        ]
        received = notification("workspace/didChangeWatchedFiles", {"changes": changes})
        workspace.server.send(received)

    wheels.rename(round_)
    tell("wheels.pyr", "round.pyr")
    assert workspace.published("robot.pyr") == ["unresolved-import"]
    workspace.write("robot.pyr", ROBOT.replace("wheels.pyr", "round.pyr"))
    assert workspace.published("robot.pyr") == []
    round_.rename(wheels)
    tell("round.pyr", "wheels.pyr")
    assert workspace.published("robot.pyr") == ["unresolved-import"]


def test_clients_ask_for_the_whole_workspace(workspace: Workspace) -> None:
    workspace.start(PULLING)
    workspace.indexed()
    first = workspace.report(workspace.ask([]))
    assert {name: codes for name, (_, codes) in first.items()} == {
        "robot.pyr": [],
        "wheels.pyr": [],
    }
    known = [
        {"uri": workspace.uri(name), "value": ident or ""}
        for name, (ident, _) in first.items()
    ]
    waiting = workspace.ask(known)
    workspace.write("wheels.pyr", "wheel a with radius 4\n")
    changed = workspace.report(waiting)
    assert {name: codes for name, (_, codes) in changed.items()} == {
        "robot.pyr": ["unresolved-reference"]
    }
    waiting = workspace.ask(known)
    assert "robot.pyr" in workspace.report(waiting)
    (workspace.folder / "robot.pyr").unlink()
    workspace.tell("robot.pyr", 3)
    gone = workspace.report(workspace.ask(known))
    assert gone["robot.pyr"] == (None, [])
