"""The client's settings: each works from the start and after a change."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from typing import Any

import pytest
from conversation import Conversation
from questions import Buffer
from raw import RawServer, notification

PROGRAM = """\
wheel a with radius 4.5
wheel b with radius 4.5
sensor s
robot rover type tw with port 23000 has { a b } wheels
robot other type tw with port 23000 has { a b } wheels
movement lap of rover {
  move 1 meters
  turn left
}
movement back of other { move -1 meters }
environment yard has { rover other } robots with { lap back } moves
"""


class Editor:
    """An editor with settings and an open program."""

    def __init__(self, raw: RawServer, folder: pathlib.Path) -> None:
        self.talk = Conversation(raw)
        self.folder = folder
        self.program = PROGRAM
        self.buffer = Buffer((folder / "main.pyr").as_uri(), PROGRAM, "utf-16")
        self.named = {"textDocument": self.buffer.document()}
        self.version = 1

    def start(self, settings: dict[str, Any], *, at_start: bool) -> None:
        """Starts a session with settings, either from the start or changed later."""
        self.talk.settings = settings if at_start else {}
        self.talk.start(folder=self.folder, pulling=True)
        item = {"languageId": "pydslrep", "version": 1, "text": self.program}
        item |= self.buffer.document()
        self.talk.server.send(
            notification("textDocument/didOpen", {"textDocument": item})
        )
        self.talk.hear_until("workspace/inlayHint/refresh")
        if not at_start:
            self.set(settings)

    def set(self, settings: dict[str, Any]) -> None:
        """Changes the settings and notifies the server."""
        self.talk.settings = settings
        self.talk.server.send(
            notification("workspace/didChangeConfiguration", {"settings": None})
        )
        self.talk.hear_until("workspace/inlayHint/refresh")

    def severities(self) -> dict[str, int]:
        report = self.talk.ask("textDocument/diagnostic", self.named)
        return {item["code"]: item["severity"] for item in report["items"]}

    def hints(self) -> list[str]:
        asked = {**self.named, "range": self.buffer.everything()}
        return [
            hint["label"] for hint in self.talk.ask("textDocument/inlayHint", asked)
        ]

    def script(self) -> str:
        """The path of the environment's script."""
        context = {"diagnostics": [], "only": ["source.generateScript"]}
        asked = {**self.named, "range": self.buffer.everything(), "context": context}
        [action] = self.talk.ask("textDocument/codeAction", asked)
        resolved = self.talk.ask("codeAction/resolve", action)
        document = resolved["edit"]["documentChanges"][-1]["textDocument"]
        return str(document["uri"]).removeprefix(self.folder.as_uri())

    def received(self) -> list[str]:
        return [
            message["params"]["message"]
            for message in self.talk.heard
            if message.get("method") == "window/showMessage"
        ]


@pytest.fixture
def editor(server: str, tmp_path: pathlib.Path) -> Iterator[Editor]:
    folder = tmp_path / "programs"
    folder.mkdir()
    with RawServer(server, "--stdio") as raw:
        yield Editor(raw, folder)


both = pytest.mark.parametrize("at_start", [True, False])


@both
def test_severities(editor: Editor, *, at_start: bool) -> None:
    usual = {"unused-declaration": 4}
    severity = {"unused-declaration": "error", "wheel-count": "off"}
    editor.start({"severity": severity}, at_start=at_start)
    assert editor.severities() == {"unused-declaration": 1}
    editor.set({"severity": {"unused-declaration": "off"}})
    assert editor.severities() == {}
    editor.set({})
    assert editor.severities() == usual


@both
@pytest.mark.parametrize("spelling", ["inlayHints", "inlay-hints"])
def test_inlay_hints(editor: Editor, spelling: str, *, at_start: bool) -> None:
    def shown() -> tuple[bool, bool, bool]:
        labels = editor.hints()
        return (
            any("→ 1.00, 0.00, 0°" in label for label in labels),
            any(" s" in label for label in labels),
            "at 9.0" in labels,
        )

    editor.start({spelling: {"pose": False}}, at_start=at_start)
    assert shown() == (False, True, True)
    editor.set({spelling: {"duration": False}})
    assert shown() == (True, False, True)
    editor.set({spelling: {"defaults": False}})
    assert shown() == (True, True, False)
    editor.set({spelling: {"pose": False, "duration": False, "defaults": False}})
    assert editor.hints() == []
    editor.set({})
    assert shown() == (True, True, True)


@both
def test_the_output_folder(editor: Editor, *, at_start: bool) -> None:
    editor.start({"output": "made/scripts"}, at_start=at_start)
    assert editor.script() == "/made/scripts/yard.py"
    (editor.folder / "pydslrep.toml").write_text("output = 'other'", encoding="utf-8")
    editor.set({})
    received = [{"uri": (editor.folder / "pydslrep.toml").as_uri(), "type": 1}]
    editor.talk.server.send(
        notification("workspace/didChangeWatchedFiles", {"changes": received})
    )
    editor.talk.hear_until("workspace/inlayHint/refresh")
    assert editor.script() == "/other/yard.py"
    editor.set({"output": "mine"})
    assert editor.script() == "/mine/yard.py", "the editor's own settings count more"
    editor.set({"output": "../outside"})
    assert any("output" in message for message in editor.received())
    assert editor.script() == "/other/yard.py"


@both
def test_the_target(editor: Editor, *, at_start: bool) -> None:
    editor.start({"target": "vrep"}, at_start=at_start)
    assert editor.severities() == {"unused-declaration": 4, "duplicate-port": 2}
    editor.set({"target": "coppeliasim"})
    assert editor.severities() == {"unused-declaration": 4}


@both
def test_the_port_of_the_other_target(editor: Editor, *, at_start: bool) -> None:
    editor.program = PROGRAM.replace("23000", "19999")
    editor.start({"target": "coppeliasim"}, at_start=at_start)
    assert editor.severities() == {"unused-declaration": 4, "port-of-other-target": 4}
    editor.set({"target": "vrep"})
    assert editor.severities() == {"unused-declaration": 4, "duplicate-port": 2}


@both
@pytest.mark.parametrize("spelling", ["defaultSpeed", "default-speed"])
def test_the_speed_of_snippets(
    editor: Editor, spelling: str, *, at_start: bool
) -> None:
    def snippets() -> str:
        at = editor.buffer.at("  move 1 meters\n  ")
        return str(editor.talk.ask("textDocument/completion", at)["items"])

    editor.start({spelling: 17.5}, at_start=at_start)
    assert "17.5" in snippets()
    editor.set({spelling: 7})
    assert "17.5" not in snippets()
    assert ":7.0}" in snippets()


@both
def test_scripts_on_save(editor: Editor, *, at_start: bool) -> None:
    def save() -> bool:
        editor.talk.server.send(notification("textDocument/didSave", editor.named))
        editor.talk.ask("textDocument/documentSymbol", editor.named)
        return (editor.folder / "yard.py").exists()

    editor.start({"generateOnSave": True}, at_start=at_start)
    assert save()
    (editor.folder / "yard.py").unlink()
    editor.set({"generateOnSave": False})
    assert not save()


@both
def test_unknown_and_invalid_settings_are_reported(
    editor: Editor, *, at_start: bool
) -> None:
    wrong = {
        "severety": {},
        "target": "gazebo",
        "inlayHints": {"poses": True},
        "severity": {"wheel-cuont": "off", "wheel-order": "loud"},
        "defaultSpeed": -1,
    }
    editor.start(wrong, at_start=at_start)
    editor.severities()
    received = "\n".join(editor.received())
    for word in ("severety", "gazebo", "poses", "wheel-cuont", "loud", "default"):
        assert word in received, word
    assert len(editor.received()) == len(set(editor.received())), "each is told once"
    assert editor.severities() == {"unused-declaration": 4}, "the rest holds"


def test_settings_pushed_by_the_client(server: str, tmp_path: pathlib.Path) -> None:
    """Clients without `workspace/configuration` send all settings at the start and on every change."""
    program = (tmp_path / "main.pyr").as_uri()
    with RawServer(server, "--stdio") as raw:
        raw.initialize({})
        item = {"uri": program, "languageId": "pydslrep", "version": 1, "text": PROGRAM}
        raw.send(notification("textDocument/didOpen", {"textDocument": item}))

        def severities() -> list[int]:
            published = raw.read_until("textDocument/publishDiagnostics")
            return [found["severity"] for found in published["params"]["diagnostics"]]

        assert severities() == [4]
        settings = {"pydslrep": {"severity": {"unused-declaration": "warning"}}}
        raw.send(
            notification("workspace/didChangeConfiguration", {"settings": settings})
        )
        assert severities() == [2]


@both
def test_an_edition_on_the_command_line(
    server: str, tmp_path: pathlib.Path, *, at_start: bool
) -> None:
    """It wins over the editor's settings and over those of the folder, from the first message on."""
    (tmp_path / "pydslrep.toml").write_text("edition = 'current'", encoding="utf-8")
    with RawServer(server, "--stdio", "--edition", "article") as raw:
        editor = Editor(raw, tmp_path)
        editor.program = PROGRAM.replace("turn left", "wait 1 seconds")
        editor.start({"severity": {"unused-declaration": "off"}}, at_start=at_start)
        assert editor.severities() == {"not-in-article": 1}
        editor.set({"edition": "current", "severity": {"unused-declaration": "off"}})
        assert editor.severities() == {"not-in-article": 1}
        place = {"line": 7, "character": 2}
        items = editor.talk.ask(
            "textDocument/completion", {**editor.named, "position": place}
        )
        labels = [item["label"] for item in items["items"]]
        assert "turn" in labels
        assert "repeat" not in labels


def test_the_edition_of_a_folder(editor: Editor) -> None:
    """Without the option, the folder decides, and the editor over it."""
    editor.program = PROGRAM.replace("turn left", "wait 1 seconds")
    (editor.folder / "pydslrep.toml").write_text(
        "edition = 'article'", encoding="utf-8"
    )
    editor.start({"severity": {"unused-declaration": "off"}}, at_start=True)
    assert editor.severities() == {"not-in-article": 1}
    editor.set({"edition": "current", "severity": {"unused-declaration": "off"}})
    assert editor.severities() == {}
