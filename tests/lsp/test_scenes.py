"""Scene files in an editor: their effect on the program, and their own diagnostics."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from typing import Any

import pytest
from questions import Buffer
from raw import RawServer, notification, request
from test_workspace import CLIENT, Workspace

PROGRAM = """\
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front
robot rover with port 1 has { wheelL wheelR } wheels with sensors { front }

movement trip of rover {
  move 50 centimeters
  move 2 meters
}

environment yard has { rover } robots with { trip } moves
"""
CRATE = '[[box]]\nname = "crate"\nat = [1, 0]\nsize = [0.4, 0.4]\n'
ASIDE = CRATE.replace("[1, 0]", "[1, 1]")


class Yard(Workspace):
    """A program and its scene."""

    def open(self, name: str, text: str) -> Buffer:
        buffer = Buffer(self.uri(name), text, "utf-16")
        item = {"languageId": "x", "version": 1, "text": text, **buffer.document()}
        opened = notification("textDocument/didOpen", {"textDocument": item})
        self.server.send(opened)
        return buffer

    def type(self, buffer: Buffer, text: str) -> None:
        document = {**buffer.document(), "version": 2}
        params = {"textDocument": document, "contentChanges": [{"text": text}]}
        self.server.send(notification("textDocument/didChange", params))

    def close(self, buffer: Buffer) -> None:
        params = {"textDocument": buffer.document()}
        self.server.send(notification("textDocument/didClose", params))

    def question(self, method: str, params: dict[str, Any]) -> dict[str, Any]:
        self.ident += 1
        self.server.send(request(self.ident, method, params))
        while (message := self.next()).get("id") != self.ident:
            pass
        return message


@pytest.fixture
def yard(server: str, tmp_path: pathlib.Path) -> Iterator[Yard]:
    folder = tmp_path / "programs"
    folder.mkdir()
    with RawServer(server, "--stdio") as running:
        yield Yard(running, folder)


def test_a_scene_on_the_disk_is_followed(yard: Yard) -> None:
    (yard.folder / "yard.scene.toml").write_text(CRATE)
    yard.start(CLIENT)
    yard.indexed()
    program = yard.open("main.pyr", PROGRAM)
    assert yard.published("main.pyr") == ["planned-collision"]
    yard.write("yard.scene.toml", ASIDE)
    assert yard.published("main.pyr") == []
    yard.write("yard.scene.toml", CRATE)
    assert yard.published("main.pyr") == ["planned-collision"]
    (yard.folder / "yard.scene.toml").unlink()
    yard.tell("yard.scene.toml", 3)
    assert yard.published("main.pyr") == []
    yard.write("yard.scene.toml", CRATE, 1)
    assert yard.published("main.pyr") == ["planned-collision"]
    yard.type(program, PROGRAM.replace("environment yard", "environment garden"))
    assert yard.published("main.pyr") == []
    yard.type(program, PROGRAM)
    assert yard.published("main.pyr") == ["planned-collision"]


def test_what_is_typed_in_a_scene_shows_in_the_program(yard: Yard) -> None:
    (yard.folder / "yard.scene.toml").write_text(ASIDE)
    yard.start(CLIENT)
    yard.indexed()
    yard.open("main.pyr", PROGRAM)
    assert yard.published("main.pyr") == []
    scene = yard.open("yard.scene.toml", CRATE)
    assert yard.published("main.pyr") == ["planned-collision"]
    yard.write("yard.scene.toml", ASIDE)
    yard.type(scene, ASIDE)
    assert yard.published("main.pyr") == []
    yard.type(scene, CRATE)
    assert yard.published("main.pyr") == ["planned-collision"]
    yard.close(scene)
    assert yard.published("main.pyr") == [], "the file on the disk counts again"


def test_an_unopened_scene_has_diagnostics(yard: Yard) -> None:
    (yard.folder / "main.pyr").write_text(PROGRAM)
    (yard.folder / "yard.scene.toml").write_text("[robots.rovr]\nstart = [1, 0]\n")
    (yard.folder / "alone.scene.toml").write_text("[wrold]\n")
    yard.start(CLIENT)
    received: dict[str, list[str]] = {}
    while len(received) < 2:
        message = yard.next()
        if message.get("method") == "textDocument/publishDiagnostics":
            name = message["params"]["uri"].rsplit("/", 1)[-1]
            received[name] = [item["code"] for item in message["params"]["diagnostics"]]
    assert received == {
        "yard.scene.toml": ["unknown-name"],
        "alone.scene.toml": ["unknown-key"],
    }
    program = yard.open("main.pyr", PROGRAM.replace("rover", "rovr"))
    assert yard.published("yard.scene.toml") == [], "there is such a robot now"
    yard.close(program)
    assert yard.published("yard.scene.toml") == ["unknown-name"]


def test_a_planned_path_starts_where_the_scene_says(yard: Yard) -> None:
    yard.start(CLIENT)
    yard.indexed()
    program = yard.open("main.pyr", PROGRAM)
    scene = yard.open("yard.scene.toml", "[robots.rover]\nstart = [1, 2, 90]\n")
    which = {"uri": program.uri, "environment": "yard"}
    path = yard.question("pydslrep/plannedPath", which)["result"]
    start = path["robots"][0]["poses"][0]
    assert (start["x"], start["y"]) == (1, 2)
    yard.type(scene, "[robots.rover]\nstart = [3, 2, 90]\n")
    while (received := yard.next()).get("method") != "pydslrep/plannedPathChanged":
        pass
    assert received["params"] == which
    path = yard.question("pydslrep/plannedPath", which)["result"]
    assert path["robots"][0]["poses"][0]["x"] == 3
    yard.type(scene, "[robots.rovr]\n")
    error = yard.question("pydslrep/plannedPath", which)["error"]
    assert "`yard.scene.toml`" in error["message"]


def test_a_planned_path_has_obstacles_and_collisions(yard: Yard) -> None:
    yard.start(CLIENT)
    yard.indexed()
    program = yard.open("main.pyr", PROGRAM)
    scene = """\
[[cylinder]]
name = "pole"
at = [1, 0]
radius = 0.1

[[box]]
name = "crate"
at = [0, 5]
size = [2, 1]
"""
    yard.open("yard.scene.toml", scene)
    which = {"uri": program.uri, "environment": "yard"}
    path = yard.question("pydslrep/plannedPath", which)["result"]
    pole, crate = path["obstacles"]
    assert pole == {"name": "pole", "centre": [1, 0], "radius": 0.1}
    assert crate["name"] == "crate"
    assert sorted(map(tuple, crate["corners"])) == [
        (-1, 4.5),
        (-1, 5.5),
        (1, 4.5),
        (1, 5.5),
    ]
    [collision] = path["collisions"]
    assert collision["robot"] == "rover"
    assert collision["with"] == {"obstacle": "pole"}
    front = collision["x"] + path["robots"][0]["body"]["length"] / 2
    assert front == pytest.approx(0.9, abs=0.002)
    assert 0 < collision["t"] < path["duration"]


def test_scenes_have_completion_hover_and_fixes(yard: Yard) -> None:
    yard.start(CLIENT)
    yard.indexed()
    yard.open("main.pyr", PROGRAM)
    text = "# 🤖\n[robots.rovr]\ntrack = 0.2\n\n[robots.rover.sensors.]\n"
    scene = yard.open("yard.scene.toml", text)
    assert yard.published("yard.scene.toml") == ["invalid-toml"]
    at = scene.at("sensors.")
    found = yard.question("textDocument/completion", at)["result"]["items"]
    assert [item["label"] for item in found] == ["front"]
    hover = yard.question("textDocument/hover", scene.at("tra"))["result"]
    assert "left and right wheels" in str(hover["contents"])
    yard.type(scene, text.replace("sensors.]", "sensors.front]"))
    assert yard.published("yard.scene.toml") == ["unknown-name"]
    asked = {
        "textDocument": scene.document(),
        "range": scene.span("rovr"),
        "context": {"diagnostics": []},
    }
    action, _ = yard.question("textDocument/codeAction", asked)["result"]
    assert action["title"] == "Change to `rover`"
    [edits] = action["edit"]["changes"].values()
    assert edits == [{"range": scene.span("rovr"), "newText": "rover"}]


def test_a_preview_uses_the_scene_as_it_is_in_the_editor(yard: Yard) -> None:
    yard.start(CLIENT)
    yard.indexed()
    program = yard.open("main.pyr", PROGRAM)
    scene = yard.open("yard.scene.toml", CRATE)
    arguments = [{"uri": program.uri, "environment": "yard"}]
    preview = {"command": "pydslrep.previewPath", "arguments": arguments}

    def picture() -> str:
        address = yard.question("workspace/executeCommand", preview)["result"]
        return pathlib.Path(address["picture"].removeprefix("file://")).read_text()

    with_crate = picture()
    assert "obstacle" in with_crate
    yard.type(scene, ASIDE)
    aside = picture()
    assert "obstacle" in aside
    assert aside != with_crate
    assert not (yard.folder / "yard.scene.toml").exists()
