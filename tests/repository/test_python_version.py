"""The oldest supported Python is the same everywhere: that of the scripts."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

# Documents that state the version, and files that depend on it.
MUST_SAY = [
    "README.md",
    "editors/vscode/README.md",
    "editors/neovim/lua/pydslrep/health.lua",
    "crates/cli/src/commands/run.rs",
    "python/pydslrep_runtime/__init__.py",
]

# "Python 3.11 or later", "Python (3.11 or later)", "Python ≥ 3.11", "needs Python 3.11".
SAID = re.compile(
    r"[Pp]ython\W{1,3}(3\.\d+)\b[^.\n]{0,3}or (?:later|newer)|[Nn]eeds Python (3\.\d+)|[Pp]ython ?[≥>]=? ?(3\.\d+)"
)

# The program `python` is missing on many machines, or is Python 2.
OLD_NAME = re.compile(r"(?:^|`|\$ |^ +)python (?!3)[\w./-]+\.py\b", re.MULTILINE)


def oldest() -> str:
    """The version that scripts and the command require."""
    text = (ROOT / "crates/script/src/lib.rs").read_text(encoding="utf-8")
    found = re.search(r"OLDEST_PYTHON: \(u32, u32\) = \((\d+), (\d+)\);", text)
    assert found
    return ".".join(found.groups())


def texts() -> list[tuple[str, str]]:
    """All hand-written files and documents."""
    endings = ["*.md", "*.rs", "*.py", "*.lua", "*.ts", "*.json", "*.sh"]
    listed = subprocess.run(
        ["git", "ls-files", "--", *endings],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    names = [name for name in listed.stdout.splitlines() if name != own_name()]
    read = ((name, ROOT / name) for name in names)
    return [(name, path.read_text("utf-8")) for name, path in read if path.is_file()]


def own_name() -> str:
    """This file is full of examples."""
    return Path(__file__).resolve().relative_to(ROOT).as_posix()


def said(text: str) -> set[str]:
    """The versions that a text states as required."""
    return {version for found in SAID.findall(text) for version in found if version}


def test_every_text_requires_the_same_version() -> None:
    wrong = {name: said(text) - {oldest()} for name, text in texts()}
    assert {name: versions for name, versions in wrong.items() if versions} == {}


@pytest.mark.parametrize("name", MUST_SAY)
def test_documents_state_the_version(name: str) -> None:
    assert said((ROOT / name).read_text(encoding="utf-8")) == {oldest()}


def test_the_tools_check_for_it() -> None:
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert settings["tool"]["mypy"]["python_version"] == oldest()
    assert settings["tool"]["ruff"]["target-version"] == "py" + oldest().replace(
        ".", ""
    )
    for name in [
        "python/check_scripts.py",
        "tests/scripts/test_names.py",
    ]:
        text = (ROOT / name).read_text(encoding="utf-8")
        assert re.findall(r'"--python-version", "(.*?)"', text) == [oldest()], name


def test_commands_call_python3() -> None:
    found = {name: OLD_NAME.findall(text) for name, text in texts()}
    assert {name: calls for name, calls in found.items() if calls} == {}
