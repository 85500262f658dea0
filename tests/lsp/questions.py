"""All requests about programs, with parameters for one program, and comparable results.

The program's columns differ in bytes, UTF-16 and characters wherever something is asked.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any
from urllib.parse import unquote, urlsplit

NOTE = "/* 🤖 日本 e\u0301 */ "
PARTS = "wheel far with radius 4.5\n"
PROGRAM = f"""\
import "parts.pyr"
{NOTE}wheel a with radius 4.5
{NOTE}wheel b with radius 4.5
{NOTE}sensor s
{NOTE}robot rover type tw with port 23000 has {{ a b }} wheels with sensors {{ s }}
{NOTE}movement lap of rover {{ // 日本
  {NOTE}move 4.0 meters
  {NOTE}turn left
}}
{NOTE}environment yard has {{ rover }} robots with {{ lap lap }} moves
{NOTE}robot spare type tw with port 20000 has {{ far wheeel }} wheels
{NOTE}movement idle of rover {{ turn right 0 }}
{NOTE}wheel   untidy with radius 4.5
{NOTE}movement   back of rover {{ turn   right }}
"""
LINE_ENDING = re.compile(r"\r\n|\n|\r")
ENDINGS = {"lf": ["\n"], "crlf": ["\r\n"], "cr": ["\r"], "mixed": ["\r\n", "\n", "\r"]}


def with_endings(text: str, kind: str) -> str:
    """The text with other line endings."""
    endings, lines = ENDINGS[kind], text.split("\n")
    last = len(lines) - 1
    return "".join(
        line + (endings[number % len(endings)] if number < last else "")
        for number, line in enumerate(lines)
    )


class Buffer:
    """A document of a client with one encoding for columns."""

    def __init__(self, uri: str, text: str, encoding: str) -> None:
        self.uri = uri
        self.text = text
        self.encoding = encoding
        self.unit = {"utf-8": 1, "utf-16": 2, "utf-32": 4}[encoding]
        self.codec = encoding if encoding == "utf-8" else f"{encoding}-le"
        ends = [match.end() for match in LINE_ENDING.finditer(text)]
        self.starts = [0, *ends]

    def document(self) -> dict[str, str]:
        """The document's identifier."""
        return {"uri": self.uri}

    def position(self, index: int) -> dict[str, int]:
        """The position of an index in the text."""
        line = max(n for n, start in enumerate(self.starts) if start <= index)
        before = self.text[self.starts[line] : index]
        units = len(before.encode(self.codec)) // self.unit
        return {"line": line, "character": units}

    def index(self, position: dict[str, int]) -> int:
        """The index of a position, which must be valid and between characters."""
        line, column = position["line"], position["character"]
        start = self.starts[line]
        ending = LINE_ENDING.search(self.text, start)
        content = self.text[start : ending.start() if ending else len(self.text)]
        units = content.encode(self.codec)
        assert column * self.unit <= len(units), f"{position} is after its line"
        return start + len(units[: column * self.unit].decode(self.codec))

    def at(self, before: str, following: str = "") -> dict[str, Any]:
        """Parameters for the position between two texts that follow each other once."""
        assert self.text.count(before + following) == 1, before + following
        index = self.text.index(before + following) + len(before)
        return {"textDocument": self.document(), "position": self.position(index)}

    def span(self, start: str, end: str = "") -> dict[str, Any]:
        """The range from one text to the end of another."""
        first = self.text.index(start)
        last = self.text.index(end, first) + len(end) if end else first + len(start)
        return {"start": self.position(first), "end": self.position(last)}

    def everything(self) -> dict[str, Any]:
        """The range of the whole text."""
        last = self.position(len(self.text))
        return {"start": {"line": 0, "character": 0}, "end": last}


OPTIONS = {"tabSize": 8, "insertSpaces": False}


def of(buffer: Buffer, **more: Any) -> dict[str, Any]:
    """Parameters about a whole document."""
    return {"textDocument": buffer.document(), **more}


def call_item(buffer: Buffer, kind: int, start: str, name: str) -> dict[str, Any]:
    """An item of the call hierarchy, as from an earlier result."""
    index = buffer.text.index(f"{start} {name}") + len(start) + 1
    focus = {
        "start": buffer.position(index),
        "end": buffer.position(index + len(name)),
    }
    item = {"name": name, "kind": kind, "uri": buffer.uri}
    return {"item": {**item, "range": focus, "selectionRange": focus}}


def lens(buffer: Buffer) -> dict[str, Any]:
    """An unresolved lens."""
    data = {"uri": buffer.uri, "kind": "wheel", "name": "a"}
    index = buffer.text.index("wheel a ") + len("wheel ")
    start, end = buffer.position(index), buffer.position(index + 1)
    return {"range": {"start": start, "end": end}, "data": data}


def actions(buffer: Buffer, only: str, where: str = "wheeel") -> dict[str, Any]:
    """Code actions of one kind at a text, by default at a misspelt wheel."""
    context = {"diagnostics": [], "only": [only]}
    return of(buffer, range=buffer.span(where), context=context)


def moving(buffer: Buffer) -> dict[str, Any]:
    """Moves the imported file into a folder."""
    folder = buffer.uri.removesuffix("main.pyr")
    renamed = {"oldUri": f"{folder}parts.pyr", "newUri": f"{folder}lib/parts.pyr"}
    return {"files": [renamed]}


def script(buffer: Buffer) -> dict[str, Any]:
    """The parameters for generating a script."""
    return {"uri": buffer.uri, "environment": "yard"}


# By method; a word after `#` distinguishes several requests of one method.
REQUESTS: dict[str, Callable[[Buffer], dict[str, Any]]] = {
    "textDocument/hover": lambda b: b.at("{ a"),
    "textDocument/completion": lambda b: b.at("{ far ", "wh"),
    "completionItem/resolve": lambda b: {
        "label": "b",
        "data": {"home": unquote(urlsplit(b.uri).path), "kind": "wheel", "name": "b"},
    },
    "textDocument/signatureHelp": lambda b: b.at(" meters"),
    "textDocument/definition": lambda b: b.at("{ a"),
    "textDocument/declaration": lambda b: b.at("{ a b"),
    "textDocument/typeDefinition": lambda b: b.at("{ lap"),
    "textDocument/references": lambda b: {
        **b.at("{ lap"),
        "context": {"includeDeclaration": True},
    },
    "textDocument/documentHighlight": lambda b: b.at("movement la"),
    "textDocument/prepareRename": lambda b: b.at("{ lap l"),
    "textDocument/rename": lambda b: {**b.at("{ lap"), "newName": "round_1"},
    "textDocument/linkedEditingRange": lambda b: b.at("{ lap"),
    "textDocument/prepareCallHierarchy": lambda b: b.at("{ lap"),
    "callHierarchy/incomingCalls": lambda b: call_item(b, 12, "movement", "lap"),
    "callHierarchy/outgoingCalls": lambda b: call_item(b, 12, "movement", "lap"),
    "textDocument/inlayHint": lambda b: of(b, range=b.everything()),
    "textDocument/codeLens": of,
    "codeLens/resolve": lens,
    "textDocument/foldingRange": of,
    "textDocument/selectionRange": lambda b: of(
        b, positions=[b.at("{ a")["position"], b.at("move 4")["position"]]
    ),
    "textDocument/documentSymbol": of,
    "workspace/symbol": lambda b: {"query": "lap"},
    "textDocument/documentLink": of,
    "textDocument/semanticTokens/full": of,
    "textDocument/semanticTokens/range": lambda b: of(
        b, range=b.span("robot rover", "port 23000")
    ),
    "textDocument/formatting": lambda b: of(b, options=OPTIONS),
    "textDocument/rangeFormatting": lambda b: of(
        b, range=b.span("wheel   untidy", "4.5"), options=OPTIONS
    ),
    "textDocument/onTypeFormatting": lambda b: {
        **b.at("turn   right }"),
        "ch": "}",
        "options": OPTIONS,
    },
    "textDocument/codeAction#quickfix": lambda b: actions(b, "quickfix"),
    "textDocument/codeAction#rewrite": lambda b: actions(b, "refactor", "turn left"),
    "textDocument/codeAction#script": lambda b: actions(b, "source.generateScript"),
    "codeAction/resolve": lambda b: {
        "title": "Generate script yard.py",
        "kind": "source.generateScript",
        "data": {"edit": "script", **script(b)},
    },
    "codeAction/resolve#all": lambda b: {
        "title": "Fix all",
        "kind": "source.fixAll",
        "data": {"edit": "fix-all", "uri": b.uri, "code": None},
    },
    "workspace/executeCommand": lambda b: {
        "command": "pydslrep.showKinematics",
        "arguments": [{"uri": b.uri, "robot": "rover"}],
    },
    "workspace/willRenameFiles": moving,
    "pydslrep/plannedPath": script,
    "pydslrep/script": script,
    "pydslrep/plannedAt": lambda b: b.at("move 4"),
    "pydslrep/actionLocation": lambda b: {**script(b), "movement": "lap", "index": 0},
    "textDocument/diagnostic": of,
    "workspace/diagnostic": lambda b: {"previousResultIds": []},
}


def comparable(result: Any, buffer: Buffer, method: str) -> Any:
    """A result with every position as its line and text, which is equal in every encoding and line ending."""
    if method == "textDocument/foldingRange":
        result = [fold(item) for item in result]
    if method.startswith("textDocument/semanticTokens"):
        return tokens(result["data"], buffer)
    if method.endswith("ormatting"):
        return LINE_ENDING.sub("\n", edited(buffer, result))
    return places(result, buffer)


def fold(item: dict[str, Any]) -> dict[str, Any]:
    """A folding range as an ordinary range."""
    ends = {
        end: {"line": item[f"{end}Line"], "character": item[f"{end}Character"]}
        for end in ("start", "end")
    }
    return {"kind": item.get("kind"), "range": ends}


def edited(buffer: Buffer, edits: list[dict[str, Any]]) -> str:
    """The text after edits, which must not overlap."""
    text, before = "", 0
    for edit in edits:
        start, end = (buffer.index(edit["range"][place]) for place in ("start", "end"))
        assert before <= start <= end, f"{edit} overlaps"
        text += buffer.text[before:start] + edit["newText"]
        before = end
    return text + buffer.text[before:]


def places(value: Any, buffer: Buffer) -> Any:
    """A part of a result, with its positions as lines and texts."""
    if isinstance(value, list):
        return [places(item, buffer) for item in value]
    if isinstance(value, str):
        return LINE_ENDING.sub("\n", value)
    if not isinstance(value, dict):
        return value
    if value.keys() == {"start", "end"}:
        start, end = value["start"], value["end"]
        if end["line"] >= len(buffer.starts):
            return "everything"
        text = buffer.text[buffer.index(start) : buffer.index(end)]
        return (
            f"{start['line']}-{end['line']}",
            LINE_ENDING.sub("\n", text),
            column(start, buffer),
        )
    if value.keys() == {"line", "character"}:
        return column(value, buffer)
    return {
        key: places(item, buffer)
        for key, item in value.items()
        if key not in ("resultId", "version")
    }


def column(position: dict[str, int], buffer: Buffer) -> str:
    """A position as the text of its line before it."""
    line = buffer.starts[position["line"]]
    return f"{position['line']}: {buffer.text[line : buffer.index(position)]}"


def tokens(data: list[int], buffer: Buffer) -> list[tuple[str, str, int, int]]:
    """Semantic tokens as lines, texts, types and modifiers."""
    found, line, character = [], 0, 0
    for n in range(0, len(data), 5):
        step, right, length, kind, modifiers = data[n : n + 5]
        line, character = line + step, right + (0 if step else character)
        start = buffer.index({"line": line, "character": character})
        end = buffer.index({"line": line, "character": character + length})
        before = column({"line": line, "character": character}, buffer)
        found.append((before, buffer.text[start:end], kind, modifiers))
    return found
