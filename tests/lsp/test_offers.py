"""The command and editors offer the same fixes for every program in `tests/recovery`."""

from __future__ import annotations

import json
import pathlib
import re
import subprocess

import pytest
from editor import Editor
from lsprotocol import types
from pytest_lsp import LanguageClient

pytestmark = pytest.mark.asyncio

RECOVERY = pathlib.Path(__file__).parents[1] / "recovery"
FENCE = re.compile(
    r"^```pyr(?P<kind> following| escaped)?\n(?P<text>.*?)^```$", re.M | re.S
)
ESCAPES = {r"\r": "\r", r"\n": "\n", r"\t": "\t", r"\u{feff}": "\ufeff"}


def programs(page: pathlib.Path) -> list[str]:
    """The programs of a page, each with the common text after them."""
    found = list(FENCE.finditer(page.read_text(encoding="utf-8")))
    after = "".join(match["text"] for match in found if match["kind"] == " following")
    programs = [match for match in found if match["kind"] != " following"]
    return [
        (unescaped(match["text"]) if match["kind"] == " escaped" else match["text"])
        + after
        for match in programs
    ]


def unescaped(text: str) -> str:
    """A text with the escapes of a page replaced."""
    for written, meant in ESCAPES.items():
        text = text.replace(written, meant)
    return text


def shown(command: str, paths: list[pathlib.Path]) -> dict[str, list[str]]:
    """The titles of the fixes that the command offers, by the folder of each program."""
    done = subprocess.run(
        [command, "check", "--format", "sarif", *paths],
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    titles: dict[str, list[str]] = {path.parent.name: [] for path in paths}
    for found in json.loads(done.stdout)["runs"][0]["results"]:
        [location] = found["locations"]
        uri = location["physicalLocation"]["artifactLocation"]["uri"]
        folder = pathlib.PurePosixPath(uri).parent.name
        titles[folder] += [fix["description"]["text"] for fix in found["fixes"]]
    return titles


async def offered(client: LanguageClient, uri: str, text: str) -> list[str]:
    """The titles of all quick fixes that an editor offers in a program."""
    lines = text.splitlines()
    end = types.Position(len(lines), 0)
    everywhere = types.Range(types.Position(0, 0), end)
    context = types.CodeActionContext(
        diagnostics=[], only=[types.CodeActionKind.QuickFix]
    )
    params = types.CodeActionParams(
        types.TextDocumentIdentifier(uri), everywhere, context
    )
    actions = await client.text_document_code_action_async(params) or []
    titles = [
        action.title
        for action in actions
        # Only editors offer actions for several problems at once.
        if isinstance(action, types.CodeAction) and action.edit
    ]
    return sorted(title[0].lower() + title[1:] for title in titles)


@pytest.mark.parametrize(
    "page",
    sorted(path for path in RECOVERY.glob("*.md") if path.stem != "README"),
    ids=lambda page: page.stem,
)
async def test_command_and_editor_offer_the_same(
    client: LanguageClient, tmp_path: pathlib.Path, command: str, page: pathlib.Path
) -> None:
    editor = Editor(client, tmp_path)
    cases = programs(page)
    assert len(cases) > 5
    paths = [tmp_path / str(number) / "case.pyr" for number in range(len(cases))]
    for path, text in zip(paths, cases, strict=True):
        path.parent.mkdir()
        path.write_text(text, encoding="utf-8", newline="")
    received = shown(command, paths)
    for path, text in zip(paths, cases, strict=True):
        uri = editor.open(str(path.relative_to(tmp_path)), text)
        titles = received[path.parent.name]
        assert await offered(client, uri, text) == sorted(
            title[0].lower() + title[1:] for title in titles
        ), text
