"""Fixtures for the server and the grammars, each created once."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from colours import LanguageServer, TextMate, TreeSitter
from compiled_parser import compiled_parser


@pytest.fixture(scope="session")
def server() -> Iterator[LanguageServer]:
    with LanguageServer() as server:
        yield server


@pytest.fixture(scope="session")
def textmate() -> TextMate:
    return TextMate()


@pytest.fixture(scope="session")
def tree_sitter(tmp_path_factory: pytest.TempPathFactory) -> TreeSitter:
    return TreeSitter(compiled_parser(tmp_path_factory.mktemp("parser")))
