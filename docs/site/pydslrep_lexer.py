"""The colours of programs: a lexer for Pygments, with the keywords of the published grammar."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pygments.lexer import RegexLexer, words  # type: ignore[import-untyped]
from pygments.token import (  # type: ignore[import-untyped]
    Comment,
    Keyword,
    Name,
    Number,
    Punctuation,
    String,
    Whitespace,
)

GRAMMAR = Path(__file__).resolve().parents[2] / "grammar" / "pydslrep.ebnf"

# A name follows these keywords.
BEFORE_NAMES = {
    *("wheel", "wheelH", "sensor", "ip"),
    *("robot", "movement", "environment", "of", "do"),
}
# A brace after these opens a list of names, other braces a block.
BEFORE_LISTS = {"has", "with", "sensors", "until", "if"}

QUOTED = re.compile(r'"([A-Za-z]+)"')


def grammar() -> tuple[str, str]:
    """The rules of the published grammar, and what it says of tokens."""
    rules, _, tokens = GRAMMAR.read_text(encoding="utf-8").partition("(* Tokens.")
    return rules, tokens


def keywords() -> list[str]:
    """The keywords of the language."""
    return sorted(set(QUOTED.findall(grammar()[0])))


def contextual() -> set[str]:
    """The keywords that are names wherever a name can be."""
    return set(QUOTED.findall(grammar()[1].partition("*)")[0]))


class PydslrepLexer(RegexLexer):  # type: ignore[misc]
    """A program."""

    name = "PyDSLRep"
    aliases = ("pydslrep",)
    filenames = ("*.pyr",)
    tokens = {  # noqa: RUF012
        "root": [
            (r"\s+", Whitespace),
            (r"//.*?$", Comment.Single),
            (r"/\*(.|\n)*?\*/", Comment.Multiline),
            (r'"[^"\n]*"', String),
            (words(keywords(), prefix=r"\b", suffix=r"\b"), Keyword),
            (r"-?\d+(\.\d+)*", Number),
            (r"\^?[A-Za-z_]\w*", Name),
            (r".", Punctuation),
        ]
    }

    def get_tokens_unprocessed(
        self, text: str, stack: tuple[str, ...] = ("root",)
    ) -> Iterator[tuple[int, Any, str]]:
        """The tokens; words are no keywords where they are names."""
        names = contextual()
        is_list, before = False, ""
        for start, kind, value in super().get_tokens_unprocessed(text, stack):
            shown = kind
            if kind is Keyword and value in names:
                if is_list or before in BEFORE_NAMES:
                    shown = Name
            elif value in "{}":
                is_list = value == "{" and before in BEFORE_LISTS
            if shown not in (Whitespace, Comment.Single, Comment.Multiline):
                before = value if shown is Keyword else ""
            yield start, shown, value
