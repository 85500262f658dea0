"""The Neovim plugin's copies of other files: `UPDATE_EXPECT=1` updates the queries."""

import json
import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PLUGIN = ROOT / "editors" / "neovim"
QUERIES = ROOT / "grammar" / "tree-sitter" / "queries"
COPIES = PLUGIN / "queries" / "pydslrep"

# Neovim does not use the queries for tags.
NOT_FOR_NEOVIM = {"tags.scm"}


def names(folder: Path) -> set[str]:
    return {query.name for query in folder.glob("*.scm")}


def test_all_queries_exist() -> None:
    assert names(COPIES) == names(QUERIES) - NOT_FOR_NEOVIM


@pytest.mark.parametrize("name", sorted(names(QUERIES) - NOT_FOR_NEOVIM))
def test_queries_are_those_of_the_grammar(name: str) -> None:
    original = (QUERIES / name).read_text(encoding="utf-8")
    if os.environ.get("UPDATE_EXPECT"):
        (COPIES / name).write_text(original, encoding="utf-8")
    copy = (COPIES / name).read_text(encoding="utf-8")
    assert copy == original, "run it with UPDATE_EXPECT=1"


def test_the_syntax_file_has_all_keywords() -> None:
    # A test in `syntax` compares the published grammar with the lexer.
    grammar = (ROOT / "grammar" / "pydslrep.ebnf").read_text(encoding="utf-8")
    rules, _, tokens = grammar.partition("(* Tokens.")
    words = set(re.findall(r'"([A-Za-z]+)"', rules))
    names = set(re.findall(r'"([A-Za-z]+)"', tokens.partition("*)")[0]))

    syntax = (PLUGIN / "syntax" / "pydslrep.vim").read_text(encoding="utf-8")
    plain, contextual = set[str](), set[str]()
    for line in re.findall(r"^syn keyword pydslrepKeyword (.*)", syntax, re.M):
        plain |= set(re.sub(r" (nextgroup|skip).*", "", line).split())
    for line in re.findall(
        r"^syn keyword pydslrep(?:Kind|Word) contained (.*)", syntax, re.M
    ):
        contextual |= set(re.sub(r" nextgroup.*", "", line).split())
    contextual |= set(re.findall(r"^syn match pydslrepImport /\\<(\w+)", syntax, re.M))
    assert plain | contextual == words
    assert contextual == names
    assert not plain & contextual


def test_the_server_s_colours_are_the_parser_s() -> None:
    table = json.loads((ROOT / "grammar" / "colours.json").read_text(encoding="utf-8"))
    table.pop("$comment")
    pairs = {kind: row["capture"] for kind, row in table.items()}
    colours = PLUGIN / "lua" / "pydslrep" / "colours.lua"
    entry = re.compile(r"^  (?:\['?)?(\w+)(?:'?\])? = '(\w+)',$", re.M)
    assert dict(entry.findall(colours.read_text(encoding="utf-8"))) == pairs

    syntax = (PLUGIN / "syntax" / "pydslrep.vim").read_text(encoding="utf-8")
    links = set(re.findall(r"^hi def link pydslrep\w+ @(\w+)$", syntax, re.M))
    assert links == set(pairs.values())
