"""A scene belongs to its program: from names to declarations and back, renames, actions, and what is run from it."""

from __future__ import annotations

import copy
import pathlib
from collections.abc import Iterator
from typing import Any

import pytest
from questions import Buffer
from raw import RawServer
from test_scenes import CRATE, PROGRAM, Yard
from test_workspace import CLIENT

SCENE = f"""\
[robots.rover]
start = [0, 1, 0]

[robots.rover.sensors.front]
range = 2.0

{CRATE}"""
EDITING: dict[str, Any] = copy.deepcopy(CLIENT)
EDITING["workspace"]["workspaceEdit"] = {
    "documentChanges": True,
    "resourceOperations": ["create", "rename"],
}
EDITING["textDocument"]["documentSymbol"] = {"hierarchicalDocumentSymbolSupport": True}
EDITING["textDocument"]["rename"] = {"prepareSupport": True}


@pytest.fixture
def yard(server: str, tmp_path: pathlib.Path) -> Iterator[Yard]:
    folder = tmp_path / "programs"
    folder.mkdir()
    with RawServer(server, "--stdio") as running:
        yield Yard(running, folder)


def opened(
    yard: Yard, capabilities: dict[str, Any] = EDITING, scene: str = SCENE
) -> tuple[Buffer, Buffer]:
    (yard.folder / "main.pyr").write_text(PROGRAM)
    (yard.folder / "yard.scene.toml").write_text(scene)
    yard.start(capabilities)
    yard.indexed()
    return yard.open("main.pyr", PROGRAM), yard.open("yard.scene.toml", scene)


def places(buffers: tuple[Buffer, ...], locations: list[dict[str, Any]]) -> list[str]:
    """Where locations are, by the name of the file and the line from 1."""
    names = {buffer.uri: pathlib.Path(buffer.uri).name for buffer in buffers}
    found = [
        f"{names[place['uri']]}:{place['range']['start']['line'] + 1}"
        for place in locations
    ]
    return sorted(found)


ROVER = ["main.pyr:11", "main.pyr:4", "main.pyr:6", "yard.scene.toml:1"]


def test_references_go_both_ways(yard: Yard) -> None:
    buffers = program, scene = opened(yard)
    context = {"context": {"includeDeclaration": True}}
    everywhere = sorted([*ROVER, "yard.scene.toml:4"])
    for at in (program.at("robot ro"), scene.at("[robots.ro", "ver]")):
        found = yard.question("textDocument/references", {**at, **context})["result"]
        assert places(buffers, found) == everywhere
    found = yard.question(
        "textDocument/references", {**program.at("environment y"), **context}
    )["result"]
    assert places(buffers, found) == ["main.pyr:11", "yard.scene.toml:1"]
    for at, line in (
        (scene.at("[robots.ro", "ver]"), 4),
        (scene.at("sensors.fr"), 3),
        (scene.at("[rob", "ots.rover]"), 11),
    ):
        [found] = yard.question("textDocument/definition", at)["result"]
        assert places(buffers, [found]) == [f"main.pyr:{line}"]
    lit = yard.question(
        "textDocument/documentHighlight", scene.at("[robots.ro", "ver]")
    )
    assert [item["range"]["start"]["line"] for item in lit["result"]] == [0, 3]


def changed(answer: dict[str, Any], buffers: tuple[Buffer, ...]) -> dict[str, str]:
    """The texts after a rename, by the names of files."""
    texts = {buffer.uri: buffer.text for buffer in buffers}
    for change in answer["result"]["documentChanges"]:
        if change.get("kind") == "rename":
            texts[change["newUri"]] = texts.pop(change["oldUri"])
            continue
        uri = change["textDocument"]["uri"]
        lines = texts[uri].split("\n")
        for edit in sorted(
            change["edits"],
            key=lambda edit: (
                edit["range"]["start"]["line"],
                edit["range"]["start"]["character"],
            ),
            reverse=True,
        ):
            start, end = edit["range"]["start"], edit["range"]["end"]
            line = lines[start["line"]]
            lines[start["line"]] = (
                line[: start["character"]] + edit["newText"] + line[end["character"] :]
            )
        texts[uri] = "\n".join(lines)
    return {pathlib.Path(uri).name: text for uri, text in texts.items()}


@pytest.mark.parametrize("door", ["program", "scene"])
def test_a_robot_is_renamed_in_its_scenes(yard: Yard, door: str) -> None:
    buffers = program, scene = opened(yard)
    at = program.at("robot ro") if door == "program" else scene.at("[robots.ro", "ver]")
    prepared = yard.question("textDocument/prepareRename", at)["result"]
    assert prepared["placeholder"] == "rover"
    answer = yard.question("textDocument/rename", {**at, "newName": "guard"})
    assert changed(answer, buffers) == {
        "main.pyr": PROGRAM.replace("rover", "guard"),
        "yard.scene.toml": SCENE.replace("rover", "guard"),
    }


def test_an_environment_is_renamed_with_its_scene(yard: Yard) -> None:
    buffers = program, scene = opened(yard)
    at = {**program.at("environment ya"), "newName": "hall"}
    answer = yard.question("textDocument/rename", at)
    assert changed(answer, buffers) == {
        "main.pyr": PROGRAM.replace("yard", "hall"),
        "hall.scene.toml": SCENE,
    }
    refused = yard.question(
        "textDocument/prepareRename", scene.at("[rob", "ots.rover]")
    )
    assert refused["error"]["message"] == "there is no name to rename here"
    (yard.folder / "taken.scene.toml").write_text("")
    answer = yard.question("textDocument/rename", {**at, "newName": "taken"})
    assert answer["error"]["message"] == "there is already a file `taken.scene.toml`"


def test_a_client_that_cannot_rename_files_is_told(yard: Yard) -> None:
    program, _ = opened(yard, CLIENT)
    at = {**program.at("environment ya"), "newName": "hall"}
    message = yard.question("textDocument/rename", at)["error"]["message"]
    assert "rename `yard.scene.toml` to `hall.scene.toml` first" in message


def test_a_scene_that_is_renamed_renames_its_environment(yard: Yard) -> None:
    buffers = program, scene = opened(yard)
    renames = [{"oldUri": scene.uri, "newUri": yard.uri("hall.scene.toml")}]
    answer = yard.question("workspace/willRenameFiles", {"files": renames})
    assert changed(answer, buffers)["main.pyr"] == PROGRAM.replace("yard", "hall")
    for name in ("not a name.scene.toml", "yard.toml"):
        renames = [{"oldUri": scene.uri, "newUri": yard.uri(name)}]
        answer = yard.question("workspace/willRenameFiles", {"files": renames})
        assert answer["result"] is None
    assert program.text == PROGRAM


def test_a_scene_has_an_outline(yard: Yard) -> None:
    _, scene = opened(yard)
    found = yard.question(
        "textDocument/documentSymbol", {"textDocument": scene.document()}
    )
    robot, crate = found["result"]
    assert (robot["name"], robot["detail"]) == ("rover", "robot")
    [sensor] = robot["children"]
    assert (sensor["name"], sensor["detail"]) == ("front", "sensor")
    assert (crate["name"], crate["detail"]) == ("crate", "box")


def actions(
    yard: Yard, buffer: Buffer, text: str, after: str = ""
) -> dict[str, dict[str, Any]]:
    position = buffer.at(text, after)["position"]
    asked = {
        "textDocument": buffer.document(),
        "range": {"start": position, "end": position},
        "context": {"diagnostics": []},
    }
    found = yard.question("textDocument/codeAction", asked)["result"]
    return {action["title"]: action for action in found}


def test_scenes_are_created_and_completed(yard: Yard) -> None:
    (yard.folder / "main.pyr").write_text(PROGRAM)
    yard.start(EDITING)
    yard.indexed()
    program = yard.open("main.pyr", PROGRAM)
    title = "Create scene yard.scene.toml"
    for place in ("environment y", "robot ro", "sensor fr"):
        create, insert = actions(yard, program, place)[title]["edit"]["documentChanges"]
        assert (create["kind"], create["uri"]) == (
            "create",
            yard.uri("yard.scene.toml"),
        )
        text = insert["edits"][0]["newText"]
        assert "[robots.rover]" in text
        assert "[robots.rover.sensors.front]" in text
    scene = yard.open("yard.scene.toml", text)
    assert yard.published("yard.scene.toml") == []
    assert not [
        title for title in actions(yard, program, "environment y") if "scene" in title
    ]
    yard.type(scene, "[robots.rover]\n")
    added = actions(yard, program, "sensor fr")["Add front to yard.scene.toml"]
    [change] = added["edit"]["documentChanges"]
    assert change["edits"][0]["newText"].startswith("\n[robots.rover.sensors.front]\n")


def test_a_robot_that_the_environment_lacks_has_fixes(yard: Yard) -> None:
    scene = SCENE.replace("rover", "guard")
    program, buffer = opened(yard, EDITING, scene)
    assert yard.published("yard.scene.toml") == ["unknown-name"]
    found = actions(yard, buffer, "[robots.gu", "ard]")
    assert list(found) == ["Change to `rover`", "Remove what the scene says of `guard`"]
    [change] = found["Change to `rover`"]["edit"]["documentChanges"]
    assert len(change["edits"]) == 2
    assert program.text == PROGRAM


def test_a_scene_leads_to_its_environment(yard: Yard) -> None:
    program, scene = opened(yard)
    found = yard.question("pydslrep/plannedAt", scene.at("start ="))["result"]
    assert (found["program"], found["using"]) == (program.uri, ["yard"])
    lenses = yard.question("textDocument/codeLens", {"textDocument": scene.document()})
    commands = [lens["command"] for lens in lenses["result"]]
    assert [command["title"] for command in commands] == [
        "Run",
        "Preview",
        "Generate script",
    ]
    argument = {"uri": program.uri, "environment": "yard"}
    assert all(command["arguments"] == [argument] for command in commands)
    assert all(lens["range"]["start"]["line"] == 0 for lens in lenses["result"])
