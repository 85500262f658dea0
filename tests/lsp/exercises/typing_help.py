"""What helps while typing."""

from __future__ import annotations

from editor import apply_edits
from lsprotocol import types
from questions import PROGRAM

from .session import OPTIONS, Session, exercises


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
    (s.folder / "lib").mkdir(exist_ok=True)
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
        ("movement third of rover { turn right until { s }", "}", "clear | detect"),
        ("movement third of rover { turn right until { s } }", "}", None),
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
