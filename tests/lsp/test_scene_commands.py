"""The commands on the scene of a running simulator: built, checked and removed from an editor."""

from __future__ import annotations

import json
import pathlib
from collections.abc import Iterator
from typing import Any

import pytest
from raw import RawServer, answer, notification, request

PROGRAM = """\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover type tw with port 19999 has { wheelL wheelR } wheels
movement patrol of rover { move 1 meters }
environment area has { rover } robots with { patrol } moves
"""
SCENE = '[[box]]\nname = "crate"\nat = [2, 1]\nsize = [0.6, 0.4]\n'


class Session:
    """A server with an open program, whose settings say where the simulator is."""

    def __init__(self, raw: RawServer, folder: pathlib.Path, port: int) -> None:
        self.raw, self.place = raw, f"127.0.0.1:{port}"
        (folder / "pydslrep.toml").write_text(f"[coppeliasim]\nport = {port}\n")
        (folder / "area.scene.toml").write_text(SCENE)
        self.which = {"uri": (folder / "a.pyr").as_uri(), "environment": "area"}
        self._last = 0
        raw.initialize()
        item = {"languageId": "pydslrep", "version": 1, "text": PROGRAM}
        item["uri"] = self.which["uri"]
        raw.send(notification("textDocument/didOpen", {"textDocument": item}))

    def start(self, command: str, **more: object) -> int:
        """Executes a command; returns the number of the request."""
        self._last += 1
        params = {"command": command, "arguments": [{**self.which, **more}]}
        self.raw.send(request(self._last, "workspace/executeCommand", params))
        return self._last

    def message(self) -> Any:
        return self.raw.read_until("window/showMessage")["params"]

    def choose(self, title: str | None) -> str:
        """Answers a question of the server; returns the question."""
        asked = self.raw.read_until("window/showMessageRequest")
        self.raw.send(answer(asked["id"], title and {"title": title}))
        params = asked["params"]
        offered = [action["title"] for action in params["actions"]]
        assert offered == ["Replace Them", "Keep Them"]
        return str(params["message"])

    def done(self, ident: int) -> Any:
        answered = self.raw.answer(ident)
        return answered.get("result", answered.get("error"))


@pytest.fixture
def session(server: str, tmp_path: pathlib.Path, port: int) -> Iterator[Session]:
    with RawServer(server, "--stdio") as raw:
        yield Session(raw, tmp_path, port)


def codes(answer: Any) -> list[str]:
    return [finding["code"] for finding in answer["findings"]]


def test_a_scene_is_built_checked_and_removed(session: Session) -> None:
    ident = session.start("pydslrep.pushScene")
    shown = session.message()
    assert shown["type"] == 3
    built = f"Built 1 robot and 1 obstacle in CoppeliaSim at {session.place}"
    assert shown["message"] == built
    answered = session.done(ident)
    assert (answered["robots"], answered["obstacles"]) == (1, 1)
    ident = session.start("pydslrep.checkScene")
    shown = session.message()
    assert shown["message"] == f"The scene at {session.place} fits the program"
    assert codes(session.done(ident)) == []
    ident = session.start("pydslrep.removeScene")
    shown = session.message()["message"]
    removed = session.done(ident)["removed"]
    assert removed > 5
    assert shown == f"Removed {removed} objects from CoppeliaSim at {session.place}"
    ident = session.start("pydslrep.checkScene")
    shown = session.message()
    assert shown["type"] == 1
    assert "robot rover: " in shown["message"]
    assert "pydslrep scene push" in shown["message"], "and what to do about it"
    assert "robot-missing" in codes(session.done(ident))


def test_what_was_built_is_replaced_on_request_only(session: Session) -> None:
    session.done(session.start("pydslrep.pushScene"))
    for kept in ("Keep Them", None):
        ident = session.start("pydslrep.pushScene")
        question = session.choose(kept)
        assert question == (
            f"CoppeliaSim at {session.place}: the scene has objects already that were built for "
            "environment `area`. Replace them?"
        )
        assert session.done(ident)["code"] == -32800
    ident = session.start("pydslrep.pushScene")
    session.choose("Replace Them")
    assert session.message()["message"].startswith("Built 1 robot")
    assert session.done(ident)["robots"] == 1
    ident = session.start("pydslrep.pushScene", replace=True)
    assert session.done(ident)["robots"] == 1, "without a question"


def test_a_client_that_cannot_ask_keeps_what_is_there(session: Session) -> None:
    session.done(session.start("pydslrep.pushScene"))
    ident = session.start("pydslrep.pushScene")
    asked = session.raw.read_until("window/showMessageRequest")
    error = {"code": -32601, "message": "method not found"}
    body = json.dumps({"jsonrpc": "2.0", "id": asked["id"], "error": error}).encode()
    session.raw.send(b"Content-Length: %d\r\n\r\n" % len(body) + body)
    failed = session.done(ident)
    assert failed["code"] == -32803
    assert '"replace": true' in failed["message"]


def test_a_simulator_that_does_not_reply_is_reported(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        session = Session(raw, tmp_path, 1)
        for command in ("pydslrep.pushScene", "pydslrep.removeScene"):
            failed = session.done(session.start(command))
            assert failed["code"] == -32803
            assert "127.0.0.1:1" in failed["message"]
            assert "start CoppeliaSim there" in failed["message"]
        answered = session.done(session.start("pydslrep.checkScene"))
        assert codes(answered) == ["no-connection"]


def test_a_program_with_errors_is_not_built(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        session = Session(raw, tmp_path, 1)
        document = {"uri": session.which["uri"], "version": 2}
        changes = [{"text": PROGRAM.replace("of rover", "of rove")}]
        change = {"textDocument": document, "contentChanges": changes}
        raw.send(notification("textDocument/didChange", change))
        failed = session.done(session.start("pydslrep.pushScene"))
        assert "`area` has errors" in failed["message"]
        assert failed["data"]["reason"] == "errors"
