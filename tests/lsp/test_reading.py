"""Folding ranges, selection ranges, hints, lenses and signature help."""

from __future__ import annotations

import pathlib

import pytest
from editor import Editor, apply_edits, offset, position
from lsprotocol import types
from pytest_lsp import LanguageClient

pytestmark = pytest.mark.asyncio

# Its columns differ in UTF-8, UTF-16 and UTF-32.
PROGRAM = """\
/* 🤖é */ wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
robot rover type tw with port 23000 has { wheelL wheelR } wheels
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
        # One more, because 🤖 takes two UTF-16 code units.
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
    signature = shown.signatures[0]
    assert signature.parameters
    assert shown.active_parameter is not None
    current = signature.parameters[shown.active_parameter].label
    assert isinstance(current, tuple | list)
    assert signature.label[current[0] : current[1]] == "DISTANCE"


async def test_actions_have_hints(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    text = PROGRAM.replace("turn left", "/* 🤖é */ turn left")
    uri = Editor(client, tmp_path).open("a.pyr", text)
    end = text.index("turn left") + len("turn left")
    line = position(text, end).line
    asked = types.Range(types.Position(line, 0), types.Position(line + 1, 0))
    hints = await client.text_document_inlay_hint_async(
        types.InlayHintParams(identifier(uri), asked)
    )
    assert hints is not None
    assert [hint.label for hint in hints] == ["90", "· 2.9 s → 4.00, 0.00, 90°"]
    assert {(hint.position.line, hint.position.character) for hint in hints} == {
        (line, position(text, end).character)
    }
    edits = hints[0].text_edits
    assert edits
    assert edits[0].new_text == " 90"


async def test_declarations_have_lenses(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    uri = Editor(client, tmp_path).open("a.pyr", PROGRAM)
    lenses = await client.text_document_code_lens_async(
        types.CodeLensParams(identifier(uri))
    )
    assert lenses
    shown = [
        lens if lens.command else await client.code_lens_resolve_async(lens)
        for lens in lenses
    ]
    titles = [
        (text_of(PROGRAM, lens.range), lens.command.title)
        for lens in shown
        if lens.command
    ]
    assert titles[:5] == [
        ("rover", "2 references"),
        ("patrol", "2 references"),
        ("area", "Run"),
        ("area", "Preview"),
        ("area", "Generate script"),
    ]
    script = shown[4].command
    assert script
    assert script.command == "pydslrep.generateScript"
    assert list(script.arguments or []) == [{"uri": uri, "environment": "area"}]


async def test_a_closing_brace_formats_its_movement(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    editor = Editor(client, tmp_path)
    text = PROGRAM.replace("\n  turn left\n}", " turn   left}")
    uri = editor.open("a.pyr", text)
    params = types.DocumentOnTypeFormattingParams(
        identifier(uri),
        position(text, text.index("left}") + len("left}")),
        "}",
        types.FormattingOptions(tab_size=8, insert_spaces=False),
    )
    edits = await client.text_document_on_type_formatting_async(params)
    assert edits is not None
    assert apply_edits(text, edits) == PROGRAM


async def test_settings_choose_the_hints(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    (tmp_path / "pydslrep.toml").write_text(
        "[inlay-hints]\npose = false\ndefaults = false\n", encoding="utf-8"
    )
    uri = Editor(client, tmp_path).open("a.pyr", PROGRAM)
    asked = types.Range(types.Position(0, 0), types.Position(99, 0))
    hints = await client.text_document_inlay_hint_async(
        types.InlayHintParams(identifier(uri), asked)
    )
    assert hints is not None
    assert [hint.label for hint in hints] == ["· 44.8 s", "· 2.9 s"]
