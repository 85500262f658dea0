"""Completion items while a program is typed, and their documentation when they are selected."""

from __future__ import annotations

import pathlib

import pytest
from editor import Editor, apply_edits, position
from lsprotocol import types
from pytest_lsp import LanguageClient

pytestmark = pytest.mark.asyncio

# Its columns differ in UTF-8, UTF-16 and UTF-32.
WHEELS = "/* 🤖é */ wheel wheelL with radius 4.5\n"
RECOVERY = pathlib.Path(__file__).parents[1] / "programs/0.3/11-recovery.pyr"
ROBOT = "/* 🤖é */ robot rover with port 23000 has { wh"


async def offered(
    client: LanguageClient,
    uri: str,
    text: str,
    context: types.CompletionContext | None = None,
) -> list[types.CompletionItem]:
    place = types.TextDocumentIdentifier(uri)
    found = await client.text_document_completion_async(
        types.CompletionParams(place, position(text, len(text)), context)
    )
    assert isinstance(found, types.CompletionList)
    # Editors send a new request after each character.
    assert found.is_incomplete
    return list(found.items)


@pytest.mark.parametrize("client", ["complete", "eager"], indirect=True)
async def test_a_name_has_documentation(
    client: LanguageClient, tmp_path: pathlib.Path, request: pytest.FixtureRequest
) -> None:
    uri = Editor(client, tmp_path).open("a.pyr", WHEELS + ROBOT)
    [wheel, *_] = await offered(client, uri, WHEELS + ROBOT)
    assert wheel.label == "wheelL"
    if request.node.callspec.params["client"] == "complete":
        assert wheel.documentation is None
        wheel = await client.completion_item_resolve_async(wheel)
    assert isinstance(wheel.documentation, types.MarkupContent)
    assert "wheel wheelL with radius 4.5" in wheel.documentation.value
    assert "28.3 cm per revolution" in wheel.documentation.value


async def test_a_removed_name_has_no_documentation(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open("a.pyr", WHEELS + ROBOT)
    [wheel, *_] = await offered(client, uri, WHEELS + ROBOT)
    editor.replace(uri, "wheel wheelL", "wheel left")
    assert (await client.completion_item_resolve_async(wheel)).documentation is None


async def test_a_name_brings_its_import(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    editor = Editor(client, tmp_path)
    editor.open("wheels.pyr", WHEELS)
    uri = editor.open("a.pyr", ROBOT)
    found = await offered(client, uri, ROBOT)
    [wheel] = [item for item in found if item.label == "wheelL"]
    assert isinstance(wheel.text_edit, types.TextEdit)
    edits = [wheel.text_edit, *(wheel.additional_text_edits or [])]
    done = apply_edits(ROBOT, edits)
    assert done == 'import "wheels.pyr"\n\n' + ROBOT.removesuffix("wh") + "wheelL"


async def test_a_complete_word_closes_the_list(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    """The requests of an editor while `meters` is typed: the last results are empty, so Enter ends the line."""
    editor = Editor(client, tmp_path)
    begun = "movement m of rover {\n  move 2 "
    uri = editor.open("a.pyr", begun + "\n")
    again = types.CompletionContext(
        types.CompletionTriggerKind.TriggerForIncompleteCompletions
    )
    for letter in "meters":
        editor.replace(uri, begun, begun + letter)
        begun += letter
        found = await offered(client, uri, begun, again)
        labels = [item.label for item in found]
        # The list closes early, so that it is not open when Enter is pressed.
        is_short = begun.endswith(("m", "me"))
        assert labels == (["meters"] if is_short else [])


@pytest.mark.parametrize(
    ("typed", "labels"),
    [
        ("movement m of ", ["rover"]),
        ("movement m of rover {", []),
        ("movement m of rover { ", []),
        ("movement m of rover { move 2 ", []),
        ("movement m of rover { move 2 meters ", []),
        ("movement m of rover { turn ", []),
    ],
)
async def test_a_space_opens_the_list_only_where_a_name_must_follow(
    client: LanguageClient, tmp_path: pathlib.Path, typed: str, labels: list[str]
) -> None:
    text = "robot rover with port 23000 has { } wheels\n" + typed
    uri = Editor(client, tmp_path).open("a.pyr", text)
    typed_last = types.CompletionContext(
        types.CompletionTriggerKind.TriggerCharacter, text[-1]
    )
    found = await offered(client, uri, text, typed_last)
    assert [item.label for item in found] == labels


@pytest.mark.parametrize("movement", ["first", "second", "third", "fourth"])
async def test_a_movement_with_a_mistake_is_completed(
    client: LanguageClient, tmp_path: pathlib.Path, movement: str
) -> None:
    """A misspelt word, a missing brace of a block or of a list, an unknown unit or a missing name: the next line is known."""
    text = RECOVERY.read_text(encoding="utf-8")
    begin = text.index(f"movement {movement} ")
    end = text.index("\n}", begin)
    typed = f"{text[:end]}\n  mo{text[end:]}"
    uri = Editor(client, tmp_path).open("a.pyr", typed)
    place = position(typed, end + len("\n  mo"))
    found = await client.text_document_completion_async(
        types.CompletionParams(types.TextDocumentIdentifier(uri), place)
    )
    assert isinstance(found, types.CompletionList)
    assert any(item.label.startswith("move") for item in found.items)
