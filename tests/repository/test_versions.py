"""Everything that is released together has the version of the command."""

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]


def toml(name: str) -> dict[str, Any]:
    return tomllib.loads((ROOT / name).read_text(encoding="utf-8"))


VERSION = toml("Cargo.toml")["workspace"]["package"]["version"]


@pytest.mark.parametrize(
    "name",
    [
        "editors/vscode/package.json",
        "grammar/textmate/package.json",
        "grammar/tree-sitter/package.json",
    ],
)
def test_node_packages_have_it(name: str) -> None:
    assert json.loads((ROOT / name).read_text(encoding="utf-8"))["version"] == VERSION


def test_the_other_packages_have_it() -> None:
    tree_sitter = (ROOT / "grammar/tree-sitter/tree-sitter.json").read_text("utf-8")
    assert json.loads(tree_sitter)["metadata"]["version"] == VERSION
    assert toml("editors/zed/extension.toml")["version"] == VERSION
    assert toml("editors/zed/Cargo.toml")["package"]["version"] == VERSION
    runtime = (ROOT / "python/pydslrep_runtime/version.py").read_text("utf-8")
    assert f'__version__ = "{VERSION}"' in runtime


@pytest.mark.parametrize("name", ["CHANGELOG.md", "editors/vscode/CHANGELOG.md"])
def test_the_changelogs_begin_with_it(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    first = re.search(r"^## (\S+)", text, re.M)
    assert first is not None
    assert first[1] in {VERSION, "Unreleased"}
