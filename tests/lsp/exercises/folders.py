"""Folders and files that come and go."""

from __future__ import annotations

from editor import apply_edits
from lsprotocol import types
from questions import PARTS, PROGRAM

from .session import Session, exercises, only


@exercises(
    "workspace.workspaceFolders.supported",
    "workspace.workspaceFolders.changeNotifications",
)
async def folders_come_and_go(s: Session) -> None:
    folder = s.folder / "more"
    folder.mkdir()
    (folder / "more.pyr").write_text("wheel distant with radius 4\n", encoding="utf-8")
    report = await s.client.workspace_diagnostic_async(
        types.WorkspaceDiagnosticParams([])
    )
    known = [
        types.PreviousResultId(item.uri, item.result_id)
        for item in report.items
        if item.result_id
    ]
    added = types.WorkspaceFolder(folder.as_uri(), "more")
    event = types.WorkspaceFoldersChangeEvent(added=[added], removed=[])
    s.client.workspace_did_change_workspace_folders(
        types.DidChangeWorkspaceFoldersParams(event)
    )
    # The response arrives once there is something new: the program in the folder.
    await s.client.workspace_diagnostic_async(types.WorkspaceDiagnosticParams(known))

    async def found() -> list[str]:
        query = types.WorkspaceSymbolParams("distant")
        return [
            item.name for item in await s.client.workspace_symbol_async(query) or []
        ]

    assert await found() == ["distant"]
    event = types.WorkspaceFoldersChangeEvent(added=[], removed=[added])
    s.client.workspace_did_change_workspace_folders(
        types.DidChangeWorkspaceFoldersParams(event)
    )
    assert await found() == []


@exercises("workspace.fileOperations.willRename", "workspace.fileOperations.didRename")
async def imports_follow_files(s: Session) -> None:
    old, new = s.folder / "parts.pyr", s.folder / "lib" / "round parts.pyr"
    renamed = types.FileRename(old.as_uri(), new.as_uri())
    params = types.RenameFilesParams([renamed])
    edit = await s.client.workspace_will_rename_files_async(params)
    assert edit
    change = only(edit.document_changes, types.TextDocumentEdit)
    edits = [item for item in change.edits if isinstance(item, types.TextEdit)]
    s.show(apply_edits(PROGRAM, edits))
    assert s.buffer.text == PROGRAM.replace("parts.pyr", "lib/round parts.pyr")
    assert await codes(s) == ["unresolved-import", *await codes_without_imports(s)]
    new.parent.mkdir(exist_ok=True)
    old.rename(new)
    s.client.workspace_did_rename_files(params)
    assert await codes(s) == await codes_without_imports(s)
    new.rename(old)
    back = types.RenameFilesParams([types.FileRename(new.as_uri(), old.as_uri())])
    s.client.workspace_did_rename_files(back)


@exercises("workspace.fileOperations.didCreate", "workspace.fileOperations.didDelete")
async def files_are_created_and_deleted(s: Session) -> None:
    parts = s.folder / "parts.pyr"
    parts.unlink()
    uri = parts.as_uri()
    deleted = types.DeleteFilesParams([types.FileDelete(uri)])
    s.client.workspace_did_delete_files(deleted)
    assert "unresolved-import" in await codes(s)
    parts.write_text(PARTS, encoding="utf-8")
    s.client.workspace_did_create_files(
        types.CreateFilesParams([types.FileCreate(uri)])
    )
    assert "unresolved-import" not in await codes(s)


async def codes(s: Session) -> list[int | str | None]:
    """The problems of the program."""
    report = await s.client.text_document_diagnostic_async(
        types.DocumentDiagnosticParams(s.document)
    )
    assert isinstance(report, types.RelatedFullDocumentDiagnosticReport)
    return [item.code for item in report.items]


async def codes_without_imports(s: Session) -> list[int | str | None]:
    """The problems of the program, except for its imports."""
    return [code for code in await codes(s) if code != "unresolved-import"]
