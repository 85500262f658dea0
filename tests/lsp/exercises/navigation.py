"""From names to definitions, references and callers."""

from __future__ import annotations

from editor import apply_edits, to_path
from lsprotocol import types
from questions import PARTS, PROGRAM

from .session import Session, exercises, only


@exercises("definitionProvider", "declarationProvider")
async def definitions(s: Session) -> None:
    for found in (
        await s.client.text_document_definition_async(
            types.DefinitionParams(*s.at("{ far"))
        ),
        await s.client.text_document_declaration_async(
            types.DeclarationParams(*s.at("{ far"))
        ),
    ):
        link = only(found, types.LocationLink)
        assert to_path(link.target_uri).name == "parts.pyr"
        start = PARTS.index("far")
        assert link.target_selection_range == types.Range(
            types.Position(0, start), types.Position(0, start + 3)
        )


@exercises("typeDefinitionProvider")
async def type_definitions(s: Session) -> None:
    found = await s.client.text_document_type_definition_async(
        types.TypeDefinitionParams(*s.at("{ lap"))
    )
    place = only(found, types.Location)
    assert s.text(place.range) == "rover"


@exercises("referencesProvider")
async def references_in_all_files(s: Session) -> None:
    context = types.ReferenceContext(include_declaration=False)
    found = await s.client.text_document_references_async(
        types.ReferenceParams(context, *s.at("movement la"))
    )
    assert [s.text(place.range) for place in found or []] == ["lap", "lap"]


@exercises("documentHighlightProvider")
async def highlighted_references(s: Session) -> None:
    found = await s.client.text_document_document_highlight_async(
        types.DocumentHighlightParams(*s.at("{ lap"))
    )
    assert [s.text(place.range) for place in found or []] == ["lap", "lap", "lap"]
    assert [place.kind for place in found or []].count(
        types.DocumentHighlightKind.Write
    ) == 1


@exercises("renameProvider.prepareProvider")
async def renames(s: Session) -> None:
    prepared = await s.client.text_document_prepare_rename_async(
        types.PrepareRenameParams(*s.at("{ lap"))
    )
    assert isinstance(prepared, types.PrepareRenamePlaceholder)
    assert prepared.placeholder == "lap"
    edit = await s.client.text_document_rename_async(
        types.RenameParams(*s.at("{ lap"), new_name="round_1")
    )
    assert edit
    change = only(edit.document_changes, types.TextDocumentEdit)
    edits = [item for item in change.edits if isinstance(item, types.TextEdit)]
    assert apply_edits(PROGRAM, edits) == PROGRAM.replace("lap", "round_1")


@exercises("callHierarchyProvider")
async def call_hierarchy(s: Session) -> None:
    prepared = await s.client.text_document_prepare_call_hierarchy_async(
        types.CallHierarchyPrepareParams(*s.at("{ lap"))
    )
    item = only(prepared, types.CallHierarchyItem)
    callers = await s.client.call_hierarchy_incoming_calls_async(
        types.CallHierarchyIncomingCallsParams(item)
    )
    called = await s.client.call_hierarchy_outgoing_calls_async(
        types.CallHierarchyOutgoingCallsParams(item)
    )
    assert only(callers, types.CallHierarchyIncomingCall).from_.name == "yard"
    assert only(called, types.CallHierarchyOutgoingCall).to.name == "rover"


@exercises("documentLinkProvider")
async def imports_lead_to_files(s: Session) -> None:
    found = await s.client.text_document_document_link_async(
        types.DocumentLinkParams(s.document)
    )
    link = only(found, types.DocumentLink)
    assert s.text(link.range) == "parts.pyr"
    assert link.target
    assert to_path(link.target) == s.folder / "parts.pyr"


@exercises("workspaceSymbolProvider")
async def symbols_of_all_files(s: Session) -> None:
    found = await s.client.workspace_symbol_async(types.WorkspaceSymbolParams("far"))
    symbol = only(found, types.SymbolInformation)
    assert symbol.name == "far"
    assert to_path(symbol.location.uri).name == "parts.pyr"
