"""Examples that people copy use CoppeliaSim's port, and tests use ports that no other program is given."""

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
        target: int(port)
        for targets, port in re.findall(r"((?:Self::\w+(?: \| )?)+) => (\d+)", body)
        for target in re.findall(r"Self::(\w+)", targets)
    }


def test_each_target_has_its_port() -> None:
    # In ROS 2, ports have no meaning.
    assert default_ports() == {"CoppeliaSim": 23000, "Ros2": 23000, "VRep": 19999}


def configured(path: Path) -> str:
    """The target in the settings file next to a program."""
    settings = path.parent / "pydslrep.toml"
    if not settings.is_file():
        return "coppeliasim"
    found = tomllib.loads(settings.read_text(encoding="utf-8"))
    return str(found.get("target", "coppeliasim"))


def ports(path: Path) -> set[int]:
    """The ports of the robots in a file."""
    text = path.read_text(encoding="utf-8")
    return set(map(int, re.findall(r"with port (?:\$\{\d:)?(\d+)", text)))


# Most pages name none.
WITH_PORTS = {path: found for path in TO_COPY if (found := ports(path))}


def test_examples_pages_snippets_and_new_programs_have_robots() -> None:
    assert len(WITH_PORTS) >= 14
    areas = {path.relative_to(ROOT).parts[0] for path in WITH_PORTS}
    assert areas == {"examples", "README.md", "crates", "editors", "docs"}


@pytest.mark.parametrize(
    "path", WITH_PORTS, ids=lambda path: path.relative_to(ROOT).as_posix()
)
def test_robots_to_copy_are_found_by_coppeliasim(path: Path) -> None:
    first = default_ports()["VRep" if configured(path) == "vrep" else "CoppeliaSim"]
    written = WITH_PORTS[path]
    assert sorted(written) == list(range(first, first + len(written)))


def test_the_script_names_the_same_ports() -> None:
    part = ROOT / "python/pydslrep_runtime/coppeliasim.py"
    named = re.findall(
        r"^(?:DEFAULT|LEGACY)_PORT = (\d+)", part.read_text("utf-8"), re.M
    )
    assert list(map(int, named)) == sorted(set(default_ports().values()), reverse=True)


def test_tests_use_no_ports_that_a_system_gives_away() -> None:
    # Where tests simulate programs. These may be the ports of any connection (FIRST_PORT in support/ports.py).
    given_away = range(32_768, 65_536)
    folders = ("crates/cli/tests", "tests/command", "tests/scripts", "tests/article")
    files = [
        path for folder in folders for path in sorted((ROOT / folder).rglob("*.*"))
    ]
    named = {
        f"{path.relative_to(ROOT)}: {port}"
        for path in files
        if path.suffix in {".rs", ".py", ".pyr"}
        for port in ports(path)
        if port in given_away
    }
    assert not named
    assert sum(bool(ports(path)) for path in files if path.suffix == ".rs") >= 3
