"""A client with an open program, and the list of what exercises each capability."""

from __future__ import annotations

import pathlib
from collections.abc import Awaitable, Callable
from typing import Any, TypeVar

from lsprotocol import types
from lsprotocol.converters import get_converter
from pytest_lsp import LanguageClient
from questions import PARTS, PROGRAM, Buffer

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
