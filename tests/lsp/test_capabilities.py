"""Every announced capability works, and all capabilities of the contract are announced.

The client library acts as an editor would; the capabilities are read from the result of `initialize`.
"""

from __future__ import annotations

import pathlib
from collections.abc import AsyncIterator, Awaitable, Callable
from typing import Any, TypeVar

import pytest
import pytest_lsp
from editor import apply_edits, capabilities, to_path
from lsprotocol import types
from lsprotocol.converters import get_converter
from pygls.exceptions import JsonRpcException
from pytest_lsp import ClientServerConfig, LanguageClient
from questions import NOTE, PARTS, PROGRAM, Buffer
from raw import SERVER

CONVERTER = get_converter()
OPTIONS = types.FormattingOptions(tab_size=8, insert_spaces=False)
T = TypeVar("T")


class Session:
    """A client, the capabilities announced to it, and an open program."""

    def __init__(
        self,
        client: LanguageClient,
        announced: types.ServerCapabilities,
        folder: pathlib.Path,
    ) -> None:
        self.client = client
        self.announced = announced
        self.folder = folder
        self.version = 1
        (folder / "parts.pyr").write_text(PARTS, encoding="utf-8")
        self.buffer = Buffer((folder / "main.pyr").as_uri(), PROGRAM, "utf-16")
        self.uri = self.buffer.uri
        self.document = types.TextDocumentIdentifier(self.uri)
        self.open("main.pyr", PROGRAM)

    def open(self, name: str, text: str) -> Buffer:
        """Opens another document."""
        uri = (self.folder / name).as_uri()
        document = types.TextDocumentItem(uri, "pydslrep", self.version, text)
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(document))
        return Buffer(uri, text, "utf-16")

    def show(self, text: str) -> None:
        """Replaces the program's whole text."""
        self.version += 1
        self.buffer = Buffer(self.uri, text, "utf-16")
        whole = types.TextDocumentContentChangeWholeDocument(text)
        document = types.VersionedTextDocumentIdentifier(self.version, self.uri)
        self.client.text_document_did_change(
            types.DidChangeTextDocumentParams(document, [whole])
        )

    def at(
        self, before: str, following: str = ""
    ) -> tuple[types.TextDocumentIdentifier, types.Position]:
        """The position between two texts that follow each other once."""
        place = self.buffer.at(before, following)["position"]
        return self.document, types.Position(**place)

    def span(self, start: str, end: str = "") -> types.Range:
        """The range from one text to the end of another."""
        return CONVERTER.structure(self.buffer.span(start, end), types.Range)

    def text(self, span: types.Range) -> str:
        """The text of a range of the program."""
        ends = CONVERTER.unstructure(span)
        start, end = self.buffer.index(ends["start"]), self.buffer.index(ends["end"])
        return self.buffer.text[start:end]


Exercise = Callable[[Session], Awaitable[None]]
EXERCISES: dict[str, Exercise] = {}


def exercises(*names: str) -> Callable[[Exercise], Exercise]:
    """Marks a function that tests capabilities."""

    def mark(exercise: Exercise) -> Exercise:
        for name in names:
            assert name not in EXERCISES, name
            EXERCISES[name] = exercise
        return exercise

    return mark


def only(found: Any, kind: type[T]) -> T:
    """The only element of a result."""
    assert found is not None
    [element] = found
    assert isinstance(element, kind)
    return element


#### The text ####


@exercises("textDocumentSync.openClose", "textDocumentSync.change", "positionEncoding")
async def text_is_kept_in_step(s: Session) -> None:
    assert s.announced.position_encoding == types.PositionEncodingKind.Utf16
    sync = s.announced.text_document_sync
    assert isinstance(sync, types.TextDocumentSyncOptions)
    assert sync.change == types.TextDocumentSyncKind.Incremental
    document = s.open("sync.pyr", "/* 🤖 */ wheel a with radius 4\n")
    identifier = types.TextDocumentIdentifier(document.uri)
    start = types.Position(**document.at("wheel ")["position"])
    end = types.Position(start.line, start.character + 1)
    change = types.TextDocumentContentChangePartial(types.Range(start, end), "ü🤖b")
    versioned = types.VersionedTextDocumentIdentifier(2, document.uri)
    s.client.text_document_did_change(
        types.DidChangeTextDocumentParams(versioned, [change])
    )
    hover = types.HoverParams(identifier, types.Position(0, start.character + 6))
    shown = await s.client.text_document_hover_async(hover)
    assert shown
    assert shown.range
    assert shown.range.start.character == start.character + 5, "after `b with`"
    s.client.text_document_did_close(types.DidCloseTextDocumentParams(identifier))
    assert await s.client.text_document_hover_async(hover) is None


#### Diagnostics ####


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
        ("refactor.extract", "turn left", "with { tour tour_2 } moves"),
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


#### While typing ####


async def completed(s: Session, before: str, trigger: str) -> set[str]:
    document, place = s.at(before)
    context = types.CompletionContext(
        types.CompletionTriggerKind.TriggerCharacter, trigger
    )
    params = types.CompletionParams(document, place, context)
    found = await s.client.text_document_completion_async(params)
    assert isinstance(found, types.CompletionList)
    return {item.label for item in found.items}


@exercises("completionProvider.triggerCharacters[ ]")
async def completions_in_programs(s: Session) -> None:
    s.show(PROGRAM + "robot third has { ")
    assert {"a", "b", "untidy", "far"} <= await completed(s, "third has { ", " ")
    assert not {"rover", "lap", "s"} & await completed(s, "third has { ", " ")
    s.show(PROGRAM + "robot third ")
    assert not await completed(s, "third ", " ")
    s.show(PROGRAM + "movement third of ")
    assert {"rover", "spare"} <= await completed(s, "third of ", " ")


@exercises(
    "completionProvider.triggerCharacters[/]", "completionProvider.triggerCharacters[^]"
)
async def completions_of_paths_and_escaped_names(s: Session) -> None:
    (s.folder / "lib").mkdir()
    other = s.open("lib/other.pyr", "sensor ^robots")
    s.show('import "lib/"\n')
    assert "lib/other.pyr" in await completed(s, 'import "lib/', "/")
    s.show(PROGRAM + "sensor ^until movement third of rover { turn left until { ^")
    assert "s" in await completed(s, "until { ^", "^")
    s.client.text_document_did_close(
        types.DidCloseTextDocumentParams(types.TextDocumentIdentifier(other.uri))
    )


@exercises("completionProvider.resolveProvider")
async def completions_are_explained(s: Session) -> None:
    s.show(PROGRAM + "movement third of ")
    document, place = s.at("third of ")
    found = await s.client.text_document_completion_async(
        types.CompletionParams(document, place)
    )
    assert isinstance(found, types.CompletionList)
    [rover] = [item for item in found.items if item.label == "rover"]
    received = (await s.client.completion_item_resolve_async(rover)).documentation
    text = received.value if isinstance(received, types.MarkupContent) else received
    assert text
    assert "port 23000" in text


@exercises(
    "completionProvider.triggerCharacters[[]",
    'completionProvider.triggerCharacters["]',
)
async def completions_in_settings(s: Session) -> None:
    async def labels(text: str, trigger: str, name: str = "pydslrep.toml") -> set[str]:
        settings = s.open(name, text)
        identifier = types.TextDocumentIdentifier(settings.uri)
        place = types.Position(**settings.position(len(text)))
        context = types.CompletionContext(
            types.CompletionTriggerKind.TriggerCharacter, trigger
        )
        params = types.CompletionParams(identifier, place, context)
        found = await s.client.text_document_completion_async(params)
        s.client.text_document_did_close(types.DidCloseTextDocumentParams(identifier))
        assert isinstance(found, types.CompletionList)
        return {item.label for item in found.items}

    assert {"severity", "inlay-hints"} <= await labels("[", "[")
    assert {"world", "box"} <= await labels("[", "[", "yard.scene.toml")
    levels = await labels('[severity]\nsyntax-error = "', '"')
    assert {'"error"', '"hint"', '"off"'} <= levels


@exercises(
    "signatureHelpProvider.retriggerCharacters[ ]",
    "signatureHelpProvider.retriggerCharacters[,]",
    "signatureHelpProvider.retriggerCharacters[{]",
    "signatureHelpProvider.retriggerCharacters[}]",
)
async def signatures_of_statements(s: Session) -> None:
    shown: types.SignatureHelp | None = None
    kinds = types.SignatureHelpTriggerKind
    for typed, trigger, expected in (
        ("movement third of rover { turn right ", None, "DEGREES"),
        ("movement third of rover { turn right until {", "{", "SENSORS"),
        ("movement third of rover { turn right until { s,", ",", "SENSORS"),
        ("movement third of rover { turn right until { s ", " ", "SENSORS"),
        ("movement third of rover { turn right until { s }", "}", None),
    ):
        s.show(PROGRAM + typed)
        context = types.SignatureHelpContext(
            kinds.TriggerCharacter if trigger else kinds.Invoked,
            is_retrigger=shown is not None,
            trigger_character=trigger,
            active_signature_help=shown,
        )
        params = types.SignatureHelpParams(*s.at(typed), context)
        shown = await s.client.text_document_signature_help_async(params)
        if expected is None:
            assert shown is None
            continue
        assert shown
        signature = shown.signatures[shown.active_signature or 0]
        assert signature.parameters
        assert shown.active_parameter is not None
        label = signature.parameters[shown.active_parameter].label
        assert not isinstance(label, str)
        assert expected in signature.label[label[0] : label[1]]


@exercises(
    "documentOnTypeFormattingProvider.firstTriggerCharacter[}]",
    "documentOnTypeFormattingProvider.moreTriggerCharacter[\n]",
)
async def formatting_while_typing(s: Session) -> None:
    async def typed(before: str, key: str) -> str:
        params = types.DocumentOnTypeFormattingParams(*s.at(before), key, OPTIONS)
        edits = await s.client.text_document_on_type_formatting_async(params)
        return apply_edits(s.buffer.text, edits or [])

    assert (await typed("turn   right }", "}")).endswith(
        "of rover {\n  turn right\n}\n"
    )
    s.show(PROGRAM.replace("{ // 日本\n", "{ // 日本\n\n"))
    assert "// 日本\n  \n" in await typed("{ // 日本\n", "\n")


@exercises("linkedEditingRangeProvider")
async def linked_editing(s: Session) -> None:
    params = types.LinkedEditingRangeParams(*s.at("{ lap"))
    linked = await s.client.text_document_linked_editing_range_async(params)
    assert linked
    assert [s.text(span) for span in linked.ranges] == ["lap", "lap", "lap"]


#### Reading ####


@exercises("hoverProvider")
async def hovers(s: Session) -> None:
    shown = await s.client.text_document_hover_async(types.HoverParams(*s.at("{ a")))
    assert shown
    assert isinstance(shown.contents, types.MarkupContent)
    assert "28.3 cm per revolution" in shown.contents.value, "2 pi 4.5 cm"
    assert shown.range
    assert s.text(shown.range) == "a"


@exercises("inlayHintProvider")
async def hints_after_actions(s: Session) -> None:
    span = s.span("move 4.0", "turn left")
    params = types.InlayHintParams(s.document, span)
    # The cursor is not on the last changed line.
    elsewhere = types.DocumentHighlightParams(*s.at("{ a"))
    await s.client.text_document_document_highlight_async(elsewhere)
    hints = await s.client.text_document_inlay_hint_async(params)
    assert hints
    labels = [hint.label for hint in hints]
    assert "· 44.6 s → 4.00, 0.00, 0°" in labels
    assert any(str(label).endswith("→ 4.00, 0.00, 90°") for label in labels)


@exercises("codeLensProvider.resolveProvider")
async def lenses_above_declarations(s: Session) -> None:
    lenses = await s.client.text_document_code_lens_async(
        types.CodeLensParams(s.document)
    )
    titles: dict[str, list[str]] = {}
    for lens in lenses or []:
        shown = lens if lens.command else await s.client.code_lens_resolve_async(lens)
        assert shown.command
        titles.setdefault(s.text(shown.range), []).append(shown.command.title)
    assert titles["lap"] == ["2 references"]
    assert titles["yard"][0] == "Generate script"


@exercises("documentSymbolProvider")
async def outline(s: Session) -> None:
    found = await s.client.text_document_document_symbol_async(
        types.DocumentSymbolParams(s.document)
    )
    names = [symbol.name for symbol in found or []]
    assert names[:6] == ["a", "b", "s", "rover", "lap", "yard"]
    robot = (found or [])[3]
    assert isinstance(robot, types.DocumentSymbol)
    assert s.text(robot.selection_range) == "rover"


@exercises("foldingRangeProvider")
async def folds(s: Session) -> None:
    found = await s.client.text_document_folding_range_async(
        types.FoldingRangeParams(s.document)
    )
    lines = [(fold.start_line, fold.end_line) for fold in found or []]
    assert lines == [(5, 8)]


@exercises("selectionRangeProvider")
async def selections(s: Session) -> None:
    _, place = s.at("move 4.0 met")
    found = await s.client.text_document_selection_range_async(
        types.SelectionRangeParams(s.document, [place])
    )
    grown = only(found, types.SelectionRange)
    assert s.text(grown.range) == "meters"
    assert grown.parent
    assert s.text(grown.parent.range) == "4.0 meters"


@exercises(
    "semanticTokensProvider.full.delta",
    "semanticTokensProvider.range",
    *(
        f"semanticTokensProvider.legend.{part}"
        for part in ("tokenTypes", "tokenModifiers")
    ),
)
async def colours(s: Session) -> None:
    provider = s.announced.semantic_tokens_provider
    assert isinstance(provider, types.SemanticTokensOptions)
    whole = types.SemanticTokensParams(s.document)
    full = await s.client.text_document_semantic_tokens_full_async(whole)
    assert full
    span = s.span(f"{NOTE}wheel a", "wheel a")
    part = await s.client.text_document_semantic_tokens_range_async(
        types.SemanticTokensRangeParams(s.document, span)
    )
    assert part
    length = len(part.data) // 5
    kinds = [provider.legend.token_types[kind] for kind in part.data[3::5]]
    name = kinds.index("variable")
    declaration = provider.legend.token_modifiers.index("declaration")
    assert part.data[5 * name + 4] & (1 << declaration)
    assert 0 < length < len(full.data) // 5
    assert full.result_id
    s.show(PROGRAM + "wheel last with radius 1\n")
    changed = await s.client.text_document_semantic_tokens_full_delta_async(
        types.SemanticTokensDeltaParams(s.document, full.result_id)
    )
    assert isinstance(changed, types.SemanticTokensDelta)
    data = list(full.data)
    for edit in reversed(changed.edits):
        data[edit.start : edit.start + edit.delete_count] = edit.data or []
    fresh = await s.client.text_document_semantic_tokens_full_async(whole)
    assert fresh
    assert data == list(fresh.data)
    assert len(data) > len(full.data)


#### Navigation ####


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


#### Editing ####


@exercises("documentFormattingProvider", "documentRangeFormattingProvider")
async def layout(s: Session) -> None:
    whole = await s.client.text_document_formatting_async(
        types.DocumentFormattingParams(s.document, OPTIONS)
    )
    text = apply_edits(PROGRAM, whole or [])
    assert "wheel untidy with" in text
    assert "{\n  turn right\n}" in text
    part = await s.client.text_document_range_formatting_async(
        types.DocumentRangeFormattingParams(s.document, s.span("untidy"), OPTIONS)
    )
    text = apply_edits(PROGRAM, part or [])
    assert "wheel untidy with" in text
    assert "turn   right" in text, "this one was not requested"


#### The workspace ####


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


#### Commands ####


async def execute(s: Session, command: str, argument: dict[str, str]) -> Any:
    params = types.ExecuteCommandParams(command, [{"uri": s.uri, **argument}])
    return await s.client.workspace_execute_command_async(params)


@exercises("executeCommandProvider.commands[pydslrep.generateScript]")
async def scripts_are_written(s: Session) -> None:
    await execute(s, "pydslrep.generateScript", {"environment": "yard"})
    script = (s.folder / "yard.py").read_text(encoding="utf-8")
    compile(script, "yard.py", "exec")
    assert "rover" in script
    (s.folder / "yard.py").unlink()


@exercises("executeCommandProvider.commands[pydslrep.showKinematics]")
async def kinematics_are_shown(s: Session) -> None:
    shown = await execute(s, "pydslrep.showKinematics", {"robot": "rover"})
    assert "right = (v + ω d/2) / r" in shown


@exercises("executeCommandProvider.commands[pydslrep.previewPath]")
async def paths_are_drawn(s: Session) -> None:
    s.show(PROGRAM.replace("wheeel", "a"))
    done = CONVERTER.unstructure(
        await execute(s, "pydslrep.previewPath", {"environment": "yard"})
    )
    picture = to_path(done["picture"] if isinstance(done, dict) else done.picture)
    assert "<svg" in picture.read_text(encoding="utf-8")
    picture.unlink()


@exercises("executeCommandProvider.commands[pydslrep.run]")
async def runs_of_what_has_errors_are_refused(s: Session) -> None:
    """Runs are in `test_runs.py`: they need a replacement for `pydslrep`."""
    s.show(PROGRAM.replace("{ a b }", "{ a c }"))
    with pytest.raises(JsonRpcException, match="`yard` has errors"):
        await execute(s, "pydslrep.run", {"environment": "yard"})


def names_of(value: Any, path: str = "") -> set[str]:
    """Capabilities by name: enabled ones, each element of a list, and the name of any other value."""
    if value is None or value is False:
        return set()
    if path.startswith(("semanticTokensProvider.legend.", "workspace.fileOperations.")):
        return {path}
    if isinstance(value, dict) and value:
        parts = [names_of(v, f"{path}.{k}".strip(".")) for k, v in value.items()]
        return set().union(*parts)
    if isinstance(value, list):
        return {f"{path}[{item}]" for item in value}
    if path.endswith("TriggerCharacter"):
        return {f"{path}[{value}]"}
    return {path}


@pytest_lsp.fixture(config=ClientServerConfig(server_command=[SERVER, "--stdio"]))  # type: ignore[untyped-decorator]
async def newcomer(lsp_client: LanguageClient) -> AsyncIterator[None]:
    """A client that has sent nothing yet."""
    yield
    await lsp_client.shutdown_session()


@pytest.mark.asyncio
async def test_capabilities_match_the_contract_and_work(
    newcomer: LanguageClient, tmp_path: pathlib.Path
) -> None:
    hello = types.InitializeParams(capabilities=capabilities("pulling"))
    result = await newcomer.initialize_session(hello)
    session = Session(newcomer, result.capabilities, tmp_path)
    announced = names_of(CONVERTER.unstructure(session.announced))
    assert sorted(announced - EXERCISES.keys()) == [], "announced, but not exercised"
    assert sorted(EXERCISES.keys() - announced) == [], "exercised, but not announced"
    for exercise in dict.fromkeys(EXERCISES.values()):
        session.show(PROGRAM)
        await exercise(session)
