"""Code actions other than quick fixes: one of each kind, selected and applied as in an editor."""

from __future__ import annotations

import pathlib

import pytest
from editor import Editor, position
from lsprotocol import types
from pytest_lsp import LanguageClient

pytestmark = pytest.mark.asyncio

PROGRAM = """\
wheel port_side with radius 4.5
wheel far_side with radius 4.5

robot rover with port 23000 has { port_side far_side } wheels

movement tour of rover {
  move 0 meters
  move 1 meters at 9.0
  turn left 0
  move 0 meters
  turn left
}

environment yard has { rover } robots with { tour } moves
"""


async def offered(
    client: LanguageClient, editor: Editor, uri: str, selected: str, kind: str
) -> list[types.CodeAction]:
    """The code actions for the first occurrence of a text."""
    text = editor.text(uri)
    start = text.index(selected)
    span = types.Range(position(text, start), position(text, start + len(selected)))
    context = types.CodeActionContext(diagnostics=[], only=[kind])
    params = types.CodeActionParams(types.TextDocumentIdentifier(uri), span, context)
    actions = await client.text_document_code_action_async(params) or []
    return [action for action in actions if isinstance(action, types.CodeAction)]


@pytest.mark.parametrize("client", ["complete", "eager"], indirect=True)
@pytest.mark.parametrize(
    ("kind", "selected", "title", "gone", "come"),
    [
        (
            "quickfix",
            "move 0",
            "Fix all `zero-distance` problems",
            "  move 0 meters\n",
            "",
        ),
        (
            "source.fixAll",
            "wheel",
            "Apply all safe fixes",
            "turn left 0",
            "",
        ),
        ("refactor.rewrite", "move 1", "Convert to centimeters", "", "move 100 cent"),
        (
            "refactor.inline",
            "move 1",
            "Omit the default speed of 9.0 cm/s",
            " at 9.0",
            "",
        ),
        (
            "refactor.extract",
            "move 1 meters at 9.0\n  turn",
            "Extract into new movement `tour_2`",
            "",
            "  do tour_2\n",
        ),
        ("refactor", "robot rover", "Add `type tw`", "", "robot rover type tw with"),
    ],
)
async def test_one_of_each_kind(
    client: LanguageClient,
    tmp_path: pathlib.Path,
    kind: str,
    selected: str,
    title: str,
    gone: str,
    come: str,
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open("tour.pyr", PROGRAM)
    actions = await offered(client, editor, uri, selected, kind)
    assert all((action.kind or "").startswith(kind) for action in actions)
    [action] = [action for action in actions if action.title == title]
    if not action.edit:
        action = await client.code_action_resolve_async(action)
    assert action.edit
    editor.apply(action.edit)
    after = editor.text(uri)
    assert after != PROGRAM
    assert not gone or gone not in after
    assert come in after


SQUARE = """\
movement square of rover {
  // ahead
  move 1 meters
  turn left
  move 1 meters // again
  turn left
}
"""

ROLLED_UP = """\
movement square of rover {
  // ahead
  repeat 2 times {
    move 1 meters // again
    turn left
  }
}
"""


@pytest.mark.parametrize("client", ["complete", "eager"], indirect=True)
async def test_equal_actions_are_rolled_up_and_unrolled(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open("square.pyr", SQUARE)
    for selected, title, after in [
        ("turn", "Roll up into `repeat 2 times`", ROLLED_UP),
        (
            "repeat",
            "Unroll `repeat 2 times`",
            SQUARE.replace("meters\n", "meters // again\n"),
        ),
    ]:
        found = await offered(client, editor, uri, selected, "refactor.rewrite")
        [action] = [action for action in found if action.title == title]
        assert action.edit
        editor.apply(action.edit)
        assert editor.text(uri) == after


async def test_unavailable_actions_give_a_reason(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open("tour.pyr", PROGRAM)
    [action] = [
        action
        for action in await offered(client, editor, uri, "movement", "refactor")
        if action.disabled
    ]
    assert action.title == "Make `tour` parallel"
    assert action.disabled
    assert "no environment lists it" in action.disabled.reason


async def test_scripts_are_written_on_save_where_the_settings_say(
    client: LanguageClient, tmp_path: pathlib.Path
) -> None:
    settings = 'generate-on-save = true\noutput = "scripts"\n'
    (tmp_path / "pydslrep.toml").write_text(settings, encoding="utf-8")
    editor = Editor(client, tmp_path)
    uri = editor.open("tour.pyr", PROGRAM)
    saved = types.DidSaveTextDocumentParams(types.TextDocumentIdentifier(uri))
    client.text_document_did_save(saved)
    received = await client.wait_for_notification(types.WINDOW_SHOW_MESSAGE)
    assert received.message.startswith("Script written: ")
    script = tmp_path / "scripts" / "yard.py"
    assert script.is_file()
    script.write_text("mine\n", encoding="utf-8")
    client.text_document_did_save(saved)
    while "not a generated script" not in received.message:
        # There is also news of what the script imports.
        received = await client.wait_for_notification(types.WINDOW_SHOW_MESSAGE)
    assert script.read_text(encoding="utf-8") == "mine\n"
