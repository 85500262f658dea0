"""Actions in nested blocks, whose words are keywords only in some places: in the grammars, the queries and the rules that
editors have of their own."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
import tree_sitter as sitter
from colours import (
    ROOT,
    TREE_SITTER,
    Colours,
    TextMate,
    TreeSitter,
    blank,
    differences,
    examples,
    paint,
)
from pydslrep_lexer import PydslrepLexer
from pygments.token import Keyword  # type: ignore[import-untyped]

ACTIONS = Path(__file__).with_name("actions.pyr").read_text(encoding="utf-8")
NESTED = """\
movement m of r {
  repeat 2 times {
    if { a } clear {
      do wait
    } else {
      slam
    }
  }
}
"""
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)


def test_both_grammars_read_every_action(
    textmate: TextMate, tree_sitter: TreeSitter
) -> None:
    [(is_valid, theirs)] = textmate.read([ACTIONS])
    is_tree, ours = tree_sitter.read(ACTIONS)
    assert is_valid
    assert is_tree
    assert list(differences(ACTIONS, ours, theirs)) == []


def test_the_name_after_do_is_a_movement(
    textmate: TextMate, tree_sitter: TreeSitter
) -> None:
    names = ["side", "^robots", "wait", "repeat", "if", "do", "else", "times"]
    programs = [f"movement m of r {{ do {name} }}" for name in names]
    answers = textmate.read(programs)
    for program, (_, theirs) in zip(programs, answers, strict=True):
        start, end = program.index("do ") + 3, program.index(" }")
        for colours in (theirs, tree_sitter.read(program)[1]):
            assert colours[start - 3 : start - 1] == ["keyword"] * 2, program
            assert colours[start:end] == ["function"] * (end - start), program


def captured(tree_sitter: TreeSitter, name: str, *kinds: str) -> list[int]:
    """The lines of `NESTED` where these captures of a query begin, counted from 0."""
    text = (TREE_SITTER / "queries" / name).read_text(encoding="utf-8")
    query = sitter.Query(tree_sitter.language, text)
    root = tree_sitter.parser.parse(NESTED.encode()).root_node
    captures = sitter.QueryCursor(query).captures(root)
    return sorted(
        node.start_point.row for kind in kinds for node in captures.get(kind, [])
    )


@pytest.mark.parametrize(
    ("name", "kind", "expected"),
    [
        ("folds.scm", "fold", [0, 1, 2, 4]),
        # The list of sensors, too.
        ("indents.scm", "indent.begin", [0, 1, 2, 2, 4]),
        ("textobjects.scm", "block.outer", [1, 2, 4]),
        ("textobjects.scm", "loop.outer", [1]),
        ("textobjects.scm", "conditional.outer", [2]),
        ("textobjects.scm", "call.outer", [3]),
        ("locals.scm", "local.reference", [0, 2, 3]),
        ("tags.scm", "reference.call", [3]),
    ],
)
def test_queries_know_blocks_and_what_do_names(
    name: str, kind: str, expected: list[int], tree_sitter: TreeSitter
) -> None:
    assert captured(tree_sitter, name, kind) == expected


def kakoune(text: str) -> Colours:
    """The faces that the regular expressions for Kakoune give to a program."""
    code = COMMENT.sub(lambda comment: re.sub(r"[^\n]", " ", comment[0]), text)
    source = (ROOT / "editors" / "kakoune" / "pydslrep.kak").read_text(encoding="utf-8")
    rules = re.findall(
        r"^add-highlighter shared/pydslrep/code/ regex '(.*)' (.*)$", source, re.M
    )
    colours = blank(text)
    for pattern, faces in rules:
        for match in re.finditer(pattern.replace(r"\h", r"[ \t]"), code, re.M):
            for group, face in (pair.split(":") for pair in faces.split()):
                start, end = match.span(int(group))
                paint(colours, start, end - start, face)
    return colours


def site(text: str) -> Colours:
    """The keywords that the documentation's site shows in a program."""
    colours = blank(text)
    for start, kind, word in PydslrepLexer().get_tokens_unprocessed(text):
        if kind is Keyword:
            paint(colours, start, len(word), "keyword")
    return colours


def keywords(text: str, colours: Colours) -> list[tuple[int, str]]:
    """The keywords of a program, with their lines."""
    words = re.finditer(r"\^?[A-Za-z_]\w*", text)
    return [
        (text.count("\n", 0, word.start()) + 1, word[0])
        for word in words
        if colours[word.start()] == "keyword"
    ]


@pytest.mark.parametrize("other", [kakoune, site])
def test_others_have_the_same_keywords(
    other: Callable[[str], Colours], textmate: TextMate
) -> None:
    texts = [path.read_text(encoding="utf-8") for path in examples()]
    texts += [NESTED, ACTIONS]
    for text, (_, colours) in zip(texts, textmate.read(texts), strict=True):
        assert keywords(text, other(text)) == keywords(text, colours)


def test_only_a_brace_ends_a_list_of_sensors(tree_sitter: TreeSitter) -> None:
    """The words of actions are names there, so that an action cannot end it."""
    begun = "movement m of r { repeat 2 times { turn left until { a wait repeat if"
    assert tree_sitter.read(f"{begun} }} clear wait 1 seconds }} }}")[0]
    assert not tree_sitter.read(f"{begun} clear wait 1 seconds }} }}")[0]
