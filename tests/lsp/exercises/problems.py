"""Diagnostics and their fixes."""

from __future__ import annotations

from editor import apply_edits
from lsprotocol import types
from questions import PROGRAM

from .session import Session, exercises, only


@exercises("diagnosticProvider.identifier")
async def diagnostics_have_their_source(s: Session) -> None:
    report = await s.client.text_document_diagnostic_async(
        types.DocumentDiagnosticParams(s.document, identifier="pydslrep")
    )
    assert isinstance(report, types.RelatedFullDocumentDiagnosticReport)
    [error] = [item for item in report.items if item.code == "unresolved-reference"]
    assert s.text(error.range) == "wheeel"
    assert error.source == "pydslrep"


@exercises(
    "diagnosticProvider.interFileDependencies",
    "diagnosticProvider.workspaceDiagnostics",
)
async def diagnostics_reach_across_files(s: Session) -> None:
    async def codes() -> list[int | str | None]:
        report = await s.client.workspace_diagnostic_async(
            types.WorkspaceDiagnosticParams([])
        )
        [full] = [item for item in report.items if item.uri == s.uri]
        assert isinstance(full, types.WorkspaceFullDocumentDiagnosticReport)
        return [item.code for item in full.items]

    before = await codes()
    parts = s.open("parts.pyr", "wheel near with radius 4.5\n")
    assert (await codes()).count("unresolved-reference") == (
        before.count("unresolved-reference") + 1
    ), "`far` is gone from the other file"
    identifier = types.TextDocumentIdentifier(parts.uri)
    s.client.text_document_did_close(types.DidCloseTextDocumentParams(identifier))
    assert await codes() == before, "the file on the disk counts again"


@exercises("codeActionProvider.codeActionKinds[quickfix]")
async def fixes_repair_programs(s: Session) -> None:
    context = types.CodeActionContext([], only=[types.CodeActionKind.QuickFix])
    params = types.CodeActionParams(s.document, s.span("wheeel"), context)
    found = await s.client.text_document_code_action_async(params)
    fix = only(found, types.CodeAction)
    assert fix.title == "Declare the wheel `wheeel`"
    assert fix.edit
    change = only(fix.edit.document_changes, types.TextDocumentEdit)
    edits = [edit for edit in change.edits if isinstance(edit, types.TextEdit)]
    fixed = apply_edits(PROGRAM, edits)
    assert "wheel wheeel with radius" in fixed
    s.show(fixed)
    params.range = s.span("wheeel }")
    assert not await s.client.text_document_code_action_async(params)


ROUNDABOUT = """\
wheel a with radius 4
wheel b with radius 4
robot rover with port 1 has { a b } wheels
movement tour of rover { move 0 meters move 1 meters at 9.0 turn left }
environment yard has { rover } robots with { tour } moves
"""


@exercises(
    "codeActionProvider.codeActionKinds[refactor.extract]",
    "codeActionProvider.codeActionKinds[refactor.inline]",
    "codeActionProvider.codeActionKinds[refactor.rewrite]",
    "codeActionProvider.codeActionKinds[source.fixAll]",
)
async def refactorings_rewrite_programs(s: Session) -> None:
    for kind, before, after in (
        ("refactor.extract", "turn left", "at 9.0 do tour_2 }"),
        ("refactor.inline", "move 1", "move 1 meters turn"),
        ("refactor.rewrite", "robot", "robot rover type tw with"),
        ("source.fixAll", "wheel a", "rover { move 1 meters at 9.0 turn"),
    ):
        s.show(ROUNDABOUT)
        context = types.CodeActionContext([], only=[kind])
        params = types.CodeActionParams(s.document, s.span(before), context)
        found = await s.client.text_document_code_action_async(params)
        action = only(found, types.CodeAction)
        if action.edit is None:
            action = await s.client.code_action_resolve_async(action)
        assert action.edit
        assert action.edit.document_changes
        change = only(action.edit.document_changes, types.TextDocumentEdit)
        edits = [edit for edit in change.edits if isinstance(edit, types.TextEdit)]
        assert after in apply_edits(ROUNDABOUT, edits)


@exercises("textDocumentSync.save")
async def scripts_are_written_on_save(s: Session) -> None:
    folder = s.folder / "saved"
    folder.mkdir()
    (folder / "pydslrep.toml").write_text("generate-on-save = true", encoding="utf-8")
    document = s.open("saved/main.pyr", ROUNDABOUT)
    identifier = types.TextDocumentIdentifier(document.uri)
    s.client.text_document_did_save(types.DidSaveTextDocumentParams(identifier))
    received = await s.client.wait_for_notification(types.WINDOW_SHOW_MESSAGE)
    assert received.message.startswith("Script written: ")
    assert (folder / "yard.py").is_file()
    s.client.text_document_did_close(types.DidCloseTextDocumentParams(identifier))


@exercises(
    "codeActionProvider.codeActionKinds[scene]",
    "codeActionProvider.codeActionKinds[script]",
)
async def a_menu_at_an_environment_has_its_script_and_scene(s: Session) -> None:
    context = types.CodeActionContext([])
    params = types.CodeActionParams(s.document, s.span("environment"), context)
    found = await s.client.text_document_code_action_async(params)
    kinds = {
        action.title: action.kind
        for action in found or []
        if isinstance(action, types.CodeAction)
    }
    assert kinds["Generate script yard.py"] == "script"
    assert kinds["Create scene yard.scene.toml"] == "scene"


@exercises(
    "codeActionProvider.codeActionKinds[source.generateScript]",
    "codeActionProvider.resolveProvider",
)
async def scripts_are_generated_when_chosen(s: Session) -> None:
    context = types.CodeActionContext([], only=["source.generateScript"])
    params = types.CodeActionParams(s.document, s.span("wheeel"), context)
    found = await s.client.text_document_code_action_async(params)
    action = only(found, types.CodeAction)
    assert action.edit is None
    resolved = await s.client.code_action_resolve_async(action)
    assert resolved.edit
    assert resolved.edit.document_changes
    create, change = resolved.edit.document_changes
    assert isinstance(create, types.CreateFile)
    assert create.uri == (s.folder / "yard.py").as_uri()
    assert isinstance(change, types.TextDocumentEdit)
    script = only(change.edits, types.TextEdit).new_text
    compile(script, "yard.py", "exec")
    assert "rover" in script
