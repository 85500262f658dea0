"""The colours of programs: a lexer for Pygments, with the keywords of the published grammar."""

from __future__ import annotations

import re
from pathlib import Path

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


def keywords() -> list[str]:
    """The keywords of the language."""
    rules = GRAMMAR.read_text(encoding="utf-8").split("(* Tokens.")[0]
    return sorted(set(re.findall(r'"([A-Za-z]+)"', rules)))


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
