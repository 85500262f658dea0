"""What an editor shows around a program: folds, growing selections, hints, lenses, signatures."""

from __future__ import annotations

import pathlib

import pytest
from editor import Editor, offset, position
from lsprotocol import types
from pytest_lsp import LanguageClient

pytestmark = pytest.mark.asyncio

# Columns in it differ in UTF-8, UTF-16 and UTF-32.
PROGRAM = """\
/* 🤖é */ wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover type tw with port 19999 has { wheelL wheelR } wheels
/* 🤖é */ movement patrol of rover {
  move 4.0 meters
  turn left
}
environment area has { rover } robots with { patrol patrol } moves
"""


def identifier(uri: str) -> types.TextDocumentIdentifier:
    return types.TextDocumentIdentifier(uri)


def text_of(text: str, span: types.Range) -> str:
    return text[offset(text, span.start) : offset(text, span.end)]


@pytest.mark.parametrize("client", ["complete", "lines"], indirect=True)
async def test_movements_fold(
    client: LanguageClient, tmp_path: pathlib.Path, request: pytest.FixtureRequest
) -> None:
    uri = Editor(client, tmp_path).open("a.pyr", PROGRAM)
    folds = await client.text_document_folding_range_async(
        types.FoldingRangeParams(identifier(uri))
    )
    assert folds is not None
    [fold] = folds
    if request.node.callspec.params["client"] == "lines":
        expected = types.FoldingRange(start_line=3, end_line=5)
    else:
        brace = PROGRAM.splitlines()[3].index("{")
        # One more, for 🤖 takes two units of UTF-16.
        expected = types.FoldingRange(
            start_line=3, start_character=brace + 2, end_line=6, end_character=0
        )
    assert fold == expected


async def test_selections_grow(client: LanguageClient, tmp_path: pathlib.Path) -> None:
    uri = Editor(client, tmp_path).open("a.pyr", PROGRAM)
    places = [
        position(PROGRAM, PROGRAM.index("wheelL with")),
        position(PROGRAM, PROGRAM.index("4.0")),
    ]
    found = await client.text_document_selection_range_async(
        types.SelectionRangeParams(identifier(uri), places)
    )
    assert found is not None
    grown: list[list[str]] = []
    for selection in found:
        step: types.SelectionRange | None = selection
        grown.append([])
        while step:
            grown[-1].append(text_of(PROGRAM, step.range))
            step = step.parent
    assert [texts[0] for texts in grown] == ["wheelL", "4.0"]
    assert [texts[1] for texts in grown] == [
        "wheel wheelL with radius 4.5",
        "4.0 meters",
    ]
    assert {texts[-1] for texts in grown} == {PROGRAM}


async def test_a_statement_shows_its_shape(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    text = PROGRAM.replace("  turn left\n", "  move \n")
    uri = Editor(client, tmp_path).open("a.pyr", text)
    cursor = position(text, text.index("move \n") + len("move "))
    shown = await client.text_document_signature_help_async(
        types.SignatureHelpParams(identifier(uri), cursor)
    )
    assert shown
    assert shown.active_signature == 0
    [signature] = shown.signatures
    assert signature.parameters
    assert shown.active_parameter is not None
    current = signature.parameters[shown.active_parameter].label
    assert isinstance(current, tuple | list)
    assert signature.label[current[0] : current[1]] == "DISTANCE"
