"""From a program with a typo to its script, with a client library."""

from __future__ import annotations

import pathlib

import pytest
from editor import Editor, built, position
from lsprotocol import types
from pytest_lsp import LanguageClient

pytestmark = pytest.mark.asyncio

KIND = "source.generateScript"


async def script_actions(client: LanguageClient, uri: str) -> list[types.CodeAction]:
    anywhere = types.Range(types.Position(0, 0), types.Position(0, 0))
    context = types.CodeActionContext(diagnostics=[], only=[KIND])
    params = types.CodeActionParams(
        types.TextDocumentIdentifier(uri), anywhere, context
    )
    actions = await client.text_document_code_action_async(params) or []
    assert all(isinstance(action, types.CodeAction) for action in actions)
    return [action for action in actions if isinstance(action, types.CodeAction)]


async def chosen(client: LanguageClient, action: types.CodeAction) -> types.CodeAction:
    return action if action.edit else await client.code_action_resolve_async(action)


async def test_from_a_typo_to_the_script(
    client: LanguageClient, tmp_path: pathlib.Path, table_2: str, command: str
) -> None:
    editor = Editor(client, tmp_path)
    broken = table_2.replace("{ wheelL wheelR }", "{ wheelL weelR }")
    uri = editor.open("table2.pyr", broken)

    [error] = await editor.diagnostics(uri)
    at = broken.index("weelR")
    assert error.range == types.Range(
        position(broken, at), position(broken, at + len("weelR"))
    )
    assert error.severity == types.DiagnosticSeverity.Error
    assert error.code == "unresolved-reference"
    assert "wheelR" in error.message

    [disabled] = await script_actions(client, uri)
    assert disabled.disabled
    assert "weelR" in disabled.disabled.reason

    editor.replace(uri, "weelR", "w")
    await editor.diagnostics(uri)
    cursor = position(editor.text(uri), editor.text(uri).index("w }") + 1)
    params = types.CompletionParams(types.TextDocumentIdentifier(uri), cursor)
    answer = await client.text_document_completion_async(params)
    assert isinstance(answer, types.CompletionList)
    labels = [item.label for item in answer.items]
    assert "wheelR" in labels
    assert "wheelL" not in labels, "the robot has that one already"
    assert not {"robot_1", "mov_1", "area_1"} & set(labels), (
        "only wheels can stand here"
    )
    completion = next(item.text_edit for item in answer.items if item.label == "wheelR")
    assert isinstance(completion, types.TextEdit)
    editor.edit(uri, completion)
    assert editor.text(uri) == table_2
    assert await editor.diagnostics(uri) == []

    [action] = await script_actions(client, uri)
    assert not action.disabled
    resolved = await chosen(client, action)
    assert resolved.edit
    editor.apply(resolved.edit)
    assert editor.text(editor.uri("area_1.py")) == built(command, tmp_path, table_2)


@pytest.mark.parametrize("client", ["complete", "eager"], indirect=True)
@pytest.mark.parametrize(
    "there",
    ["nothing", "file", "buffer over a file", "changed buffer", "unsaved buffer"],
)
async def test_a_script_replaces_any_older_script(
    client: LanguageClient,
    tmp_path: pathlib.Path,
    table_2: str,
    command: str,
    there: str,
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open("table2.pyr", table_2)
    script = editor.uri("area_1.py")
    old = built(command, tmp_path, table_2.replace("4.0", "3.0"))
    if there not in ("nothing", "unsaved buffer"):
        (tmp_path / "area_1.py").write_text(old, encoding="utf-8")
    if there == "buffer over a file":
        editor.open("area_1.py", old)
    elif there == "changed buffer":
        editor.open("area_1.py", old + "and more\n" * 2000)
    elif there == "unsaved buffer":
        editor.open("area_1.py", "")
    [action] = await script_actions(client, uri)
    resolved = await chosen(client, action)
    assert resolved.edit
    editor.apply(resolved.edit)
    assert editor.text(script) == built(command, tmp_path, table_2)


@pytest.mark.parametrize("client", ["pulling"], indirect=True)
async def test_a_client_that_pulls_diagnostics_is_not_pushed_to(
    client: LanguageClient, tmp_path: pathlib.Path, table_2: str
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open(
        "table2.pyr", table_2.replace("{ wheelL wheelR }", "{ wheelL weelR }")
    )
    params = types.DocumentDiagnosticParams(types.TextDocumentIdentifier(uri))
    first = await client.text_document_diagnostic_async(params)
    assert isinstance(first, types.RelatedFullDocumentDiagnosticReport)
    assert [item.code for item in first.items] == ["unresolved-reference"]
    params.previous_result_id = first.result_id
    again = await client.text_document_diagnostic_async(params)
    assert isinstance(again, types.RelatedUnchangedDocumentDiagnosticReport)
    editor.replace(uri, "weelR", "wheelR")
    fixed = await client.text_document_diagnostic_async(params)
    assert isinstance(fixed, types.RelatedFullDocumentDiagnosticReport)
    assert list(fixed.items) == []
    assert client.diagnostics == {}


async def test_diagnostics_are_published_once_and_cleared_on_close(
    client: LanguageClient, tmp_path: pathlib.Path, table_2: str
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open(
        "table2.pyr", table_2.replace("{ wheelL wheelR }", "{ wheelL weelR }")
    )
    assert len(await editor.diagnostics(uri)) == 1
    client.diagnostics.clear()
    editor.edit(
        uri,
        types.TextEdit(
            types.Range(types.Position(99, 0), types.Position(99, 0)), "// the end\n"
        ),
    )
    params = types.DocumentSymbolParams(types.TextDocumentIdentifier(uri))
    await client.text_document_document_symbol_async(params)
    assert client.diagnostics == {}, "nothing has changed for the reader"
    client.text_document_did_close(
        types.DidCloseTextDocumentParams(types.TextDocumentIdentifier(uri))
    )
    cleared = await client.wait_for_notification(
        types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS
    )
    assert (cleared.uri, list(cleared.diagnostics)) == (uri, [])


async def test_a_quick_fix_corrects_the_typo(
    client: LanguageClient, tmp_path: pathlib.Path, table_2: str
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open(
        "table2.pyr", table_2.replace("{ wheelL wheelR }", "{ wheelL weelR }")
    )
    [error] = await editor.diagnostics(uri)
    context = types.CodeActionContext(
        diagnostics=[error], only=[types.CodeActionKind.QuickFix]
    )
    params = types.CodeActionParams(
        types.TextDocumentIdentifier(uri), error.range, context
    )
    actions = await client.text_document_code_action_async(params) or []
    fix = next(action for action in actions if "`wheelR`" in action.title)
    assert isinstance(fix, types.CodeAction)
    assert list(fix.diagnostics or []) == [error]
    assert fix.edit
    editor.apply(fix.edit)
    assert editor.text(uri) == table_2
    assert await editor.diagnostics(uri) == []


async def test_features_of_a_program(
    client: LanguageClient, tmp_path: pathlib.Path, table_2: str
) -> None:
    editor = Editor(client, tmp_path)
    uri = editor.open("table2.pyr", table_2)
    document = types.TextDocumentIdentifier(uri)
    reference = position(table_2, table_2.index("{ wheelL") + 2)
    declaration = table_2.index("wheelL")

    links = await client.text_document_definition_async(
        types.DefinitionParams(document, reference)
    )
    assert isinstance(links, list)
    [link] = links
    assert isinstance(link, types.LocationLink)
    assert link.target_uri == uri
    assert link.target_selection_range.start == position(table_2, declaration)

    hover = await client.text_document_hover_async(
        types.HoverParams(document, reference)
    )
    assert hover
    assert isinstance(hover.contents, types.MarkupContent)
    assert "4.5" in hover.contents.value

    symbols = await client.text_document_document_symbol_async(
        types.DocumentSymbolParams(document)
    )
    assert [symbol.name for symbol in symbols or []] == [
        "wheelR",
        "wheelL",
        "robot_1",
        "mov_1",
        "area_1",
    ]

    tokens = await client.text_document_semantic_tokens_full_async(
        types.SemanticTokensParams(document)
    )
    assert tokens
    whole = types.Range(types.Position(0, 0), types.Position(99, 0))
    part = await client.text_document_semantic_tokens_range_async(
        types.SemanticTokensRangeParams(document, whole)
    )
    assert part
    assert part.data == tokens.data
    assert len(tokens.data) % 5 == 0
    assert len(tokens.data) > 5 * 20


async def test_a_document_is_formatted(
    client: LanguageClient, tmp_path: pathlib.Path, table_2: str
) -> None:
    editor = Editor(client, tmp_path)
    untidy = table_2.replace("  move", "\tmove").replace(
        " with radius", "   with  radius"
    )
    uri = editor.open("table2.pyr", untidy)
    options = types.FormattingOptions(tab_size=8, insert_spaces=False)
    document = types.TextDocumentIdentifier(uri)
    whole = types.DocumentFormattingParams(document, options)
    edits = await client.text_document_formatting_async(whole)
    assert edits
    for edit in reversed(edits):  # they are in order and do not overlap
        editor.edit(uri, edit)
    assert editor.text(uri) == table_2
    assert not await client.text_document_formatting_async(whole)
