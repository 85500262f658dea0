"""Generated files of the grammars match their sources."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import tree_sitter as sitter
from colours import GRAMMAR, ROOT, TABLE, TEXTMATE, TREE_SITTER, TextMate, TreeSitter

CORPUS = re.compile(r"^=+\n([^\n]+)\n=+\n(.*?)\n-{10,}\n(.*?)(?=^=+$|\Z)", re.M | re.S)
# The generator of the parser, and a hash of its sources.
CHECKSUMS = TREE_SITTER / "src" / "checksums.txt"
# Editors with their own names for the colours, and the files with these names.
OTHERS = {
    "helix": ROOT / "editors" / "helix" / "queries" / "pydslrep",
    "zed": ROOT / "editors" / "zed" / "languages" / "pydslrep",
}


def words() -> set[str]:
    """The keywords of the published grammar, which a test in `syntax` compares with the lexer."""
    rules, _, _ = (GRAMMAR / "pydslrep.ebnf").read_text().partition("(* Tokens.")
    return set(re.findall(r'"([A-Za-z]+)"', rules))


def contextual() -> set[str]:
    """Those that are names wherever a name can be: the grammar's comment on tokens lists them."""
    _, _, tokens = (GRAMMAR / "pydslrep.ebnf").read_text().partition("(* Tokens.")
    return set(re.findall(r'"([A-Za-z]+)"', tokens.partition("*)")[0]))


def textmate_keywords(
    textmate: TextMate, before: str, candidates: list[str]
) -> set[str]:
    """The words that are keywords after a text."""
    answers = textmate.read([before + word for word in candidates])
    return {
        word
        for word, (_, colours) in zip(candidates, answers, strict=True)
        if colours[len(before) :] == ["keyword"] * len(word)
    }


def test_the_tree_sitter_grammar_has_all_keywords() -> None:
    grammar = (TREE_SITTER / "src" / "grammar.json").read_text()
    literals = set(re.findall(r'"type": "STRING",\s*"value": "(\w+)"', grammar))
    assert literals == words()


def test_textmate_has_exactly_the_keywords(textmate: TextMate) -> None:
    texts = [*sorted(words()), "colour", "radios", "4wheelx"]
    reserved = words() - contextual()
    assert textmate_keywords(textmate, "at ", texts) == reserved | {"import"}
    actions = contextual() - {"distance", "bumper", "import"}
    for before in (
        "movement m of r { ",
        "movement m of r { repeat 2 times { if { a } ",
    ):
        assert textmate_keywords(textmate, before, texts) == reserved | actions


def test_textmate_is_up_to_date() -> None:
    command = ["node", str(TEXTMATE / "build.mjs"), "--check"]
    assert subprocess.run(command, check=False).returncode == 0


def test_textmate_scopes_of_annotated_examples() -> None:
    program = TEXTMATE / "node_modules" / ".bin" / "vscode-tmgrammar-test"
    result = subprocess.run(
        [program, "tests/*.pyr"], cwd=TEXTMATE, check=False, stdout=subprocess.PIPE
    )
    assert result.returncode == 0, result.stdout.decode()


def test_the_parser_is_generated_from_the_grammar() -> None:
    """Fails if either was changed without `generate.sh`, even without the tree-sitter command."""
    _, *lines = CHECKSUMS.read_text().splitlines()
    noted = {name: digest for digest, name in (line.split() for line in lines)}
    now = {
        name: hashlib.sha256((TREE_SITTER / name).read_bytes()).hexdigest()
        for name in noted
    }
    assert {"grammar.js", "src/parser.c"} <= set(now)
    assert now == noted, "run grammar/tree-sitter/generate.sh"


@pytest.mark.skipif(
    not shutil.which("tree-sitter"), reason="needs the tree-sitter command"
)
def test_tree_sitter_generates_the_same_parser(tmp_path: Path) -> None:
    made = (TREE_SITTER / "src" / "parser.c").read_text()
    maker, *_ = CHECKSUMS.read_text().splitlines()
    version = subprocess.run(
        ["tree-sitter", "--version"], check=True, stdout=subprocess.PIPE
    )
    if version.stdout.decode().strip() not in maker:
        pytest.skip("another tree-sitter made the parser")
    shutil.copy(TREE_SITTER / "grammar.js", tmp_path)
    shutil.copy(TREE_SITTER / "tree-sitter.json", tmp_path)
    subprocess.run(["tree-sitter", "generate", "--abi", "14"], cwd=tmp_path, check=True)
    assert (tmp_path / "src" / "parser.c").read_text() == made


@pytest.mark.parametrize(
    "corpus",
    sorted((TREE_SITTER / "test" / "corpus").iterdir()),
    ids=lambda path: path.stem,
)
def test_trees_match_the_corpus(corpus: Path, tree_sitter: TreeSitter) -> None:
    cases = CORPUS.findall(corpus.read_text())
    assert len(cases) == corpus.read_text().count("====\n") / 2
    for name, text, tree in cases:
        root = tree_sitter.parser.parse(text.encode()).root_node
        assert str(root) == " ".join(tree.split()).replace(" )", ")"), name


@pytest.mark.parametrize("folder", [TREE_SITTER / "queries", *OTHERS.values()], ids=str)
def test_queries_match_the_grammar(folder: Path, tree_sitter: TreeSitter) -> None:
    for file in folder.glob("*.scm"):
        assert sitter.Query(tree_sitter.language, file.read_text()).pattern_count > 0


@pytest.mark.parametrize("editor", OTHERS)
def test_other_editors_have_their_names_of_the_colours(editor: str) -> None:
    expected = (TREE_SITTER / "queries" / "highlights.scm").read_text()
    for row in TABLE.values():
        expected = re.sub(rf"@{row['capture']}\b(?!\.)", f"@{row[editor]}", expected)
    origin = "; Generated from grammar/tree-sitter/queries/highlights.scm.\n"
    expected = re.sub(r"^; .*\n(; .*\n)*", origin, expected, count=1)
    file = OTHERS[editor] / "highlights.scm"
    if os.environ.get("UPDATE_EXPECT"):
        file.write_text(expected)
    assert file.read_text() == expected, "UPDATE_EXPECT=1 writes it"


def test_the_versions_are_the_project_s() -> None:
    version = re.search(r'^version = "(.+)"', (ROOT / "Cargo.toml").read_text(), re.M)
    assert version
    assert (
        json.loads((TREE_SITTER / "package.json").read_text())["version"] == version[1]
    )
    metadata = json.loads((TREE_SITTER / "tree-sitter.json").read_text())["metadata"]
    assert metadata["version"] == version[1]
