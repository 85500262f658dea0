"""What helps to read."""

from __future__ import annotations

from lsprotocol import types
from questions import NOTE, PROGRAM

from .session import Session, exercises, only


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
    assert "· 44.8 s → 4.00, 0.00, 0°" in labels
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
    assert titles["yard"] == ["Run", "Preview", "Generate script"]


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
