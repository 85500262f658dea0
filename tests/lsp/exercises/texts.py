"""Texts stay in step."""

from __future__ import annotations

from lsprotocol import types

from .session import Session, exercises


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
