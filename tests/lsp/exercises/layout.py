"""Formatting."""

from __future__ import annotations

from editor import apply_edits
from lsprotocol import types
from questions import PROGRAM

from .session import OPTIONS, Session, exercises


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
