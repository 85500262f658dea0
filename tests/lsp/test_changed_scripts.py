"""Scripts that their users changed, or never generated: the server asks, or leaves them alone."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from typing import Any

import pytest
from raw import RawServer, answer, notification, request
from test_runtime import CREATES_FILES

MINE = "print('mine')\n"


class Session:
    """A server with an open program whose script is there already."""

    def __init__(self, raw: RawServer, folder: pathlib.Path, program: str) -> None:
        self.raw, self.script = raw, folder / "area_1.py"
        settings = "write-runtime = false\ngenerate-on-save = true\n"
        (folder / "pydslrep.toml").write_text(settings, encoding="utf-8")
        path = folder / "table2.pyr"
        path.write_text(program, encoding="utf-8")
        self.program = {"uri": path.as_uri()}
        item = {**self.program, "languageId": "pydslrep", "version": 1, "text": program}
        edits = CREATES_FILES["textDocument"]["codeAction"]
        disabled = {"codeAction": {**edits, "disabledSupport": True}}
        raw.initialize({**CREATES_FILES, "textDocument": disabled})
        raw.send(notification("textDocument/didOpen", {"textDocument": item}))
        self.execute()
        assert "result" in raw.answer(1)
        self.generated = self.script.read_text(encoding="utf-8")
        self.changed = self.generated.replace("4.0", "5.0")

    def execute(self) -> None:
        which = {**self.program, "environment": "area_1"}
        command = {"command": "pydslrep.generateScript", "arguments": [which]}
        self.raw.send(request(1, "workspace/executeCommand", command))

    def action(self) -> dict[str, Any]:
        """Generate script, as an editor offers it."""
        start = {"line": 0, "character": 0}
        asked = {
            "textDocument": self.program,
            "range": {"start": start, "end": start},
            "context": {"diagnostics": [], "only": ["source.generateScript"]},
        }
        self.raw.send(request(2, "textDocument/codeAction", asked))
        action: dict[str, Any]
        [action] = self.raw.answer(2)["result"]
        return action

    def resolve(self, action: dict[str, Any]) -> dict[str, Any]:
        self.raw.send(request(3, "codeAction/resolve", action))
        return self.raw.answer(3)


@pytest.fixture
def session(server: str, tmp_path: pathlib.Path, table_2: str) -> Iterator[Session]:
    with RawServer(server, "--stdio") as raw:
        yield Session(raw, tmp_path, table_2)


@pytest.mark.parametrize("chosen", ["Replace It", "Keep It", None])
def test_the_user_is_asked(session: Session, chosen: str | None) -> None:
    session.script.write_text(session.changed, encoding="utf-8")
    session.execute()
    asked = session.raw.read_until("window/showMessageRequest")
    assert "area_1.py was changed" in asked["params"]["message"]
    assert [item["title"] for item in asked["params"]["actions"]] == [
        "Replace It",
        "Keep It",
    ]
    assert session.script.read_text(encoding="utf-8") == session.changed
    session.raw.send(answer(asked["id"], chosen and {"title": chosen}))
    replaced = chosen == "Replace It"
    assert ("result" in session.raw.answer(1)) == replaced
    expected = session.generated if replaced else session.changed
    assert session.script.read_text(encoding="utf-8") == expected


def test_the_action_of_a_changed_script_asks(session: Session) -> None:
    before = session.action()
    assert "edit" in session.resolve(before)["result"]
    session.script.write_text(session.changed, encoding="utf-8")
    assert "was changed" in session.resolve(before)["error"]["message"]
    action = session.action()
    assert action["command"]["command"] == "pydslrep.generateScript"
    assert "edit" not in action
    assert "data" not in action


def test_a_script_of_the_users_own_is_left_alone(session: Session) -> None:
    session.script.write_text(MINE, encoding="utf-8")
    reason = session.action()["disabled"]["reason"]
    assert "area_1.py exists and is not a generated script" in reason
    session.execute()
    assert "not a generated script" in session.raw.answer(1)["error"]["message"]
    assert session.script.read_text(encoding="utf-8") == MINE


def test_saving_keeps_a_changed_script(session: Session) -> None:
    session.script.write_text(session.changed, encoding="utf-8")
    session.raw.send(
        notification("textDocument/didSave", {"textDocument": session.program})
    )
    shown = session.raw.read_until("window/showMessage")["params"]
    while "was changed" not in shown["message"]:
        shown = session.raw.read_until("window/showMessage")["params"]
    assert shown["type"] == 2
    assert session.script.read_text(encoding="utf-8") == session.changed
