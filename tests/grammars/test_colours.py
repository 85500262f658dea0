"""Both grammars accept every program that the parser accepts, with the colours of the server."""

from __future__ import annotations

from pathlib import Path

import pytest
from colours import (
    TABLE,
    Colours,
    LanguageServer,
    TextMate,
    TreeSitter,
    differences,
    examples,
    random_programs,
)

ACTIONS = Path(__file__).with_name("actions.pyr")

# The server's answers about each program.
Programs = list[tuple[str, Colours]]


@pytest.fixture(scope="module")
def programs(server: LanguageServer) -> Programs:
    texts = [path.read_bytes().decode() for path in [*examples(), ACTIONS]]
    texts += [*random_programs(200, 25), "", "\ufeff", "\n", "// a", "/**/ /***/ /*/*/"]
    answers = [(text, *server.read(text)) for text in texts]
    assert [text for text, is_program, _ in answers if not is_program] == []
    return [(text, colours) for text, _, colours in answers]


def test_the_table_has_the_types_that_the_server_announces(
    server: LanguageServer,
) -> None:
    assert list(TABLE) == server.types


def test_the_programs_have_all_colours(programs: Programs) -> None:
    assert {colour for _, colours in programs for colour in colours} == {*TABLE, None}


def test_textmate_colours_as_the_server_does(
    programs: Programs, textmate: TextMate
) -> None:
    answers = textmate.read([text for text, _ in programs])
    for (text, expected), (is_valid, colours) in zip(programs, answers, strict=True):
        assert is_valid, text
        assert list(differences(text, expected, colours)) == []


def test_tree_sitter_colours_as_the_server_does(
    programs: Programs, tree_sitter: TreeSitter
) -> None:
    for text, expected in programs:
        is_valid, colours = tree_sitter.read(text)
        assert is_valid, text
        assert list(differences(text, expected, colours)) == []
