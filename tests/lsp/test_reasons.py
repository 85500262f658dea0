"""Why there is no path: the error that is there now, where it is, and what fixes it."""

from __future__ import annotations

import pathlib
from collections.abc import Iterator

import pytest
from raw import RawServer, request
from test_scenes import PROGRAM, Yard
from test_workspace import CLIENT


@pytest.fixture
def yard(server: str, tmp_path: pathlib.Path) -> Iterator[Yard]:
    folder = tmp_path / "programs"
    folder.mkdir()
    with RawServer(server, "--stdio") as running:
        yield Yard(running, folder)


def test_each_error_is_announced_when_its_line_is_left(yard: Yard) -> None:
    yard.start(CLIENT)
    yard.indexed()
    program = yard.open("main.pyr", PROGRAM)
    which = {"uri": program.uri, "environment": "yard"}
    assert "result" in yard.question("pydslrep/plannedPath", which)
    reasons, fixes = [], []
    for typed in ("mo", "move 1", "move 1 parsecs"):
        yard.type(program, PROGRAM.replace("move 2 meters", typed))
        # The line is complete when the cursor leaves it: until then, the next word may fix the problem.
        top = {
            "textDocument": program.document(),
            "position": {"line": 0, "character": 0},
        }
        yard.server.send(
            request(f"leave {typed}", "textDocument/documentHighlight", top)
        )
        while yard.next().get("method") != "pydslrep/plannedPathChanged":
            pass
        error = yard.question("pydslrep/plannedPath", which)["error"]
        assert error["data"]["location"]["uri"] == program.uri
        assert error["data"]["location"]["range"]["start"]["line"] == 7
        reasons.append(error["message"])
        fix = error["data"].get("fix")
        if fix is not None:
            asked = {
                "textDocument": program.document(),
                "range": error["data"]["location"]["range"],
                "context": {"diagnostics": [], "only": ["quickfix"]},
            }
            found = yard.question("textDocument/codeAction", asked)["result"]
            fixes += [action["title"] for action in found if action["title"] == fix]
    assert len(set(reasons)) == 3
    assert "`parsecs`" in reasons[-1]
    assert fixes, "none of them could be fixed"


def test_a_mistake_in_the_scene_has_its_place_and_fix(yard: Yard) -> None:
    yard.start(CLIENT)
    yard.indexed()
    program = yard.open("main.pyr", PROGRAM)
    scene = yard.open("yard.scene.toml", "\n[robots.rovr]\n")
    which = {"uri": program.uri, "environment": "yard"}
    data = yard.question("pydslrep/plannedPath", which)["error"]["data"]
    assert data["location"]["uri"] == scene.uri
    assert data["location"]["range"]["start"]["line"] == 1
    assert data["fix"] == "Change to `rover`"
