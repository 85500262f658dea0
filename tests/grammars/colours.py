"""What the language server, the TextMate grammar and the tree-sitter grammar call every character of a program.

All three answers are made comparable by `grammar/colours.json`, the one table of what goes with what.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import tree_sitter
from raw import DEBUG, SERVER, RawServer, notification, request

ROOT = Path(__file__).resolve().parents[2]
GRAMMAR = ROOT / "grammar"
TEXTMATE = GRAMMAR / "textmate"
TREE_SITTER = GRAMMAR / "tree-sitter"

TABLE: dict[str, dict[str, str]] = json.loads((GRAMMAR / "colours.json").read_text())
TABLE.pop("$comment")

# One per character: a key of the table, or None.
Colours = list[str | None]

# What makes a text no program.
SYNTAX_ERRORS = {
    "syntax-error",
    "invalid-character",
    "unterminated-comment",
    "unterminated-string",
}

SEMANTIC_TOKENS: dict[str, Any] = {
    "requests": {"full": True},
    "tokenTypes": list(TABLE),
    "tokenModifiers": [],
    "formats": ["relative"],
}


def random_programs(count: int, lines: int) -> list[str]:
    """Grammatical programs from a fixed seed."""
    program = os.environ.get("RANDOM_PROGRAMS", str(DEBUG / "random-programs"))
    output = subprocess.run(
        [program, str(count), str(lines)], check=True, stdout=subprocess.PIPE
    ).stdout
    return output.decode().split("\0")[:-1]


def line_starts(text: str) -> list[int]:
    """The offsets of the lines."""
    return [0, *(match.end() for match in re.finditer(r"\r\n|\r|\n", text))]


class LanguageServer:
    """The server's semantic tokens."""

    def __init__(self) -> None:
        self.server = RawServer(SERVER, "--stdio")
        self.asked = 0
        self.types: list[str] = []

    def __enter__(self) -> LanguageServer:
        capabilities = {
            "general": {"positionEncodings": ["utf-32"]},
            "textDocument": {"diagnostic": {}, "semanticTokens": SEMANTIC_TOKENS},
        }
        self.server.send(request(0, "initialize", {"capabilities": capabilities}))
        announced = self.server.answer(0)["result"]["capabilities"]
        assert announced["positionEncoding"] == "utf-32"
        self.types = announced["semanticTokensProvider"]["legend"]["tokenTypes"]
        self.server.send(notification("initialized", {}))
        return self

    def __exit__(self, *exception: object) -> None:
        self.server.__exit__(*exception)

    def _ask(self, method: str, params: object) -> Any:
        self.asked += 1
        self.server.send(request(self.asked, method, params))
        return self.server.answer(self.asked)["result"]

    def read(self, text: str) -> tuple[bool, Colours]:
        """Whether the text is a valid program, and its colours."""
        uri = f"file:///nowhere/{self.asked}.pyr"
        item = {"uri": uri, "languageId": "pydslrep", "version": 1, "text": text}
        document = {"textDocument": {"uri": uri}}
        self.server.send(notification("textDocument/didOpen", {"textDocument": item}))
        problems = self._ask("textDocument/diagnostic", document)["items"]
        tokens = self._ask("textDocument/semanticTokens/full", document)["data"]
        self.server.send(notification("textDocument/didClose", document))
        is_program = not any(problem["code"] in SYNTAX_ERRORS for problem in problems)
        return is_program, self._colours(text, tokens)

    def _colours(self, text: str, numbers: list[int]) -> Colours:
        starts, colours = line_starts(text), blank(text)
        line = column = 0
        for index in range(0, len(numbers), 5):
            lines, columns, length, kind, _ = numbers[index : index + 5]
            line, column = line + lines, columns + (0 if lines else column)
            paint(colours, starts[line] + column, length, self.types[kind])
        return colours


class TextMate:
    """The TextMate grammar in VS Code's tokenizer."""

    def __init__(self, grammar: Path = TEXTMATE / "pydslrep.tmLanguage.json") -> None:
        self.grammar = grammar

    def read(self, texts: list[str]) -> list[tuple[bool, Colours]]:
        """Whether no scope in the text is `invalid`, and its colours."""
        output = subprocess.run(
            ["node", str(TEXTMATE / "tokenize.mjs"), str(self.grammar)],
            input=json.dumps(texts).encode(),
            check=True,
            stdout=subprocess.PIPE,
        ).stdout
        answers = zip(texts, json.loads(output), strict=True)
        return [self._colours(text, lines) for text, lines in answers]

    def _colours(self, text: str, lines: list[Any]) -> tuple[bool, Colours]:
        colours, is_valid = blank(text), True
        for start, tokens in zip(line_starts(text), lines, strict=True):
            place = units(text, start)
            for first, after, scopes in tokens:
                kind = kind_of(scopes)
                is_valid &= not any(scope.startswith("invalid") for scope in scopes)
                if kind:
                    begin, end = place[first], place[after]
                    paint(colours, start + begin, end - begin, kind)
        return is_valid, colours


def kind_of(scopes: list[str]) -> str | None:
    """The table's key for the innermost scope that it contains."""
    for scope in reversed(scopes):
        for kind, row in TABLE.items():
            if f"{scope}.".startswith(f"{row['scope']}."):
                return kind
    return None


def units(text: str, start: int) -> list[int]:
    """The character of each UTF-16 code unit of a line."""
    places: list[int] = []
    for index, character in enumerate(text[start:]):
        if character in "\r\n":
            break
        places.extend([index] * (2 if ord(character) > 0xFFFF else 1))
    return [*places, places[-1] + 1 if places else 0]


class TreeSitter:
    """The tree-sitter grammar and its query for colours."""

    def __init__(self, language: tree_sitter.Language) -> None:
        self.language = language
        self.parser = tree_sitter.Parser(language)
        query = (TREE_SITTER / "queries" / "highlights.scm").read_text()
        self.query = tree_sitter.Query(language, query)

    def read(self, text: str) -> tuple[bool, Colours]:
        """Whether the tree has no errors, and its colours."""
        source = text.encode()
        root = self.parser.parse(source).root_node
        kinds = {row["capture"]: kind for kind, row in TABLE.items()}
        place = characters(text)
        colours, painted = blank(text), set()
        for capture, nodes in (
            tree_sitter.QueryCursor(self.query).captures(root).items()
        ):
            for node in nodes:
                assert node.id not in painted, f"{node} has two captures"
                painted.add(node.id)
                if capture in kinds:
                    begin, end = place[node.start_byte], place[node.end_byte]
                    paint(colours, begin, end - begin, kinds[capture])
        return not root.has_error, colours

    def entities(self, text: str) -> list[int]:
        """The offsets of the entities."""
        place, root = characters(text), self.parser.parse(text.encode()).root_node
        entities = (
            node for node in root.named_children if node.type.endswith("_definition")
        )
        return [place[node.start_byte] for node in entities]


def characters(text: str) -> list[int]:
    """The character of each byte."""
    places: list[int] = []
    for index, character in enumerate(text):
        places.extend([index] * len(character.encode()))
    return [*places, len(text)]


def blank(text: str) -> Colours:
    """A text without colours."""
    return [None] * len(text)


def paint(colours: Colours, start: int, length: int, kind: str) -> None:
    """Sets the colour of a range of characters."""
    colours[start : start + length] = [kind] * length


def differences(text: str, ours: Colours, theirs: Colours) -> Iterator[str]:
    """The differences between two colourings, as readable text."""
    line_ends = {index for index, character in enumerate(text) if character in "\r\n"}
    index = 0
    while index < len(text):
        pair = ours[index], theirs[index]
        end = index + 1
        while end < len(text) and (ours[end], theirs[end]) == pair:
            end += 1
        if pair[0] != pair[1] and not line_ends.issuperset(range(index, end)):
            before = text[max(0, index - 30) : index]
            yield f"{before!r} {text[index:end]!r} is {pair[0]} to the server and {pair[1]} here"
        index = end


def examples() -> Iterable[Path]:
    """The programs of the article and the examples; without the one that is about syntax errors."""
    for folder in ("tests/paper", "tests/programs", "examples"):
        for path in sorted((ROOT / folder).rglob("*.pyr")):
            if path.name != "11-recovery.pyr":
                yield path
