"""Examples that people copy use CoppeliaSim's port."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

# Programs that people start from. Several robots have consecutive ports.
TO_COPY = [
    *sorted((ROOT / "examples").rglob("*.pyr")),
    ROOT / "README.md",
    ROOT / "crates/cli/src/commands/new.rs",
    *sorted((ROOT / "editors/vscode/snippets").glob("*.json")),
    *sorted((ROOT / "editors/vscode/walkthrough").glob("*.md")),
    *sorted((ROOT / "editors/neovim").rglob("*.md")),
    *(path for path in sorted((ROOT / "docs").glob("*.md")) if path.stem != "vrep"),
]


def default_ports() -> dict[str, int]:
    """The default port of each target in the code."""
    text = (ROOT / "crates/analysis/src/target.rs").read_text(encoding="utf-8")
    body = text.split("fn default_port", 1)[1].split("fn ", 1)[0]
    return {
        target: int(port) for target, port in re.findall(r"Self::(\w+) => (\d+)", body)
    }


def test_each_target_has_its_port() -> None:
    assert default_ports() == {"CoppeliaSim": 23000, "VRep": 19999}


@pytest.mark.parametrize(
    "path", TO_COPY, ids=lambda path: path.relative_to(ROOT).as_posix()
)
def test_robots_to_copy_are_found_by_coppeliasim(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    if any(target == "vrep" for target in configured(path)):
        return
    written = re.findall(r"with port (?:\$\{\d:)?(\d+)", text)
    first = default_ports()["CoppeliaSim"]
    assert sorted(set(map(int, written))) == list(
        range(first, first + len(set(written)))
    )


def configured(path: Path) -> list[str]:
    """The target in the settings file next to a program."""
    settings = path.parent / "pydslrep.toml"
    if not settings.is_file():
        return []
    return [str(tomllib.loads(settings.read_text(encoding="utf-8")).get("target"))]


def test_the_script_names_the_same_ports() -> None:
    part = ROOT / "python/pydslrep_runtime/coppeliasim.py"
    named = re.findall(
        r"^(?:DEFAULT|LEGACY)_PORT = (\d+)", part.read_text("utf-8"), re.M
    )
    assert list(map(int, named)) == list(default_ports().values())
