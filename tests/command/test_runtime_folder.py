"""Scripts find the package that they import: next to them on another machine, or installed."""

from __future__ import annotations

import ast
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tokenize
import venv
from collections.abc import Iterator

import pytest
from ports import free_ports

ROOT = pathlib.Path(__file__).parents[2]
TABLE_2 = ROOT / "tests" / "paper" / "table2_two_wheels.pyr"
NAME = "pydslrep_runtime"


@pytest.fixture(scope="module")
def client_only(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A Python that has the simulator's client library and nothing else."""
    home = tmp_path_factory.mktemp("client")
    venv.create(home)
    python = home / "bin" / "python"
    # Its own pip would take twice as long to install as what is needed.
    pip = [sys.executable, "-m", "pip", "--python", str(python)]
    install = ["install", "--quiet", "--disable-pip-version-check"]
    options = ["--no-deps", "--require-hashes", "--only-binary", ":all:"]
    requirements = str(ROOT / "python" / "requirements.txt")
    subprocess.run(
        [*pip, *install, *options, "--requirement", requirements], check=True
    )
    return python


@pytest.fixture
def built(command: str, tmp_path: pathlib.Path) -> pathlib.Path:
    """A folder with a program, its script and the package."""
    program = TABLE_2.read_text(encoding="utf-8")
    [port] = free_ports(1)
    program = re.sub(r"port \d+", f"port {port}", program)
    folder = tmp_path / "built"
    folder.mkdir()
    (folder / "table2.pyr").write_text(program, encoding="utf-8")
    subprocess.run([command, "build", "table2.pyr"], cwd=folder, check=True)
    return folder


@pytest.fixture
def simulator(command: str, built: pathlib.Path) -> Iterator[None]:
    """The simulator of the program."""
    start = [command, "sim", str(built / "table2.pyr")]
    with subprocess.Popen(start, stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout
        while "Ready" not in running.stdout.readline():
            assert running.poll() is None
        yield
        running.terminate()


def run(
    python: pathlib.Path, folder: pathlib.Path, *arguments: str
) -> subprocess.CompletedProcess[str]:
    command: list[str | pathlib.Path] = [python, folder / "area_1.py", *arguments]
    return subprocess.run(command, text=True, capture_output=True, check=False)


@pytest.mark.usefixtures("simulator")
def test_a_folder_is_all_that_another_machine_needs(
    client_only: pathlib.Path, built: pathlib.Path, tmp_path: pathlib.Path
) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    shutil.move(built / "area_1.py", elsewhere)
    shutil.move(built / NAME, elsewhere)
    trace = tmp_path / "trace.jsonl"
    done = run(client_only, elsewhere, "--trace", str(trace))
    assert (done.returncode, done.stderr) == (0, "")
    last = json.loads(trace.read_text(encoding="utf-8").splitlines()[-1])
    assert abs(last["x"]) < 0.005
    assert abs(last["y"] + 4.0) < 0.005


def test_a_missing_folder_is_explained(
    client_only: pathlib.Path, built: pathlib.Path
) -> None:
    shutil.rmtree(built / NAME)
    done = run(client_only, built)
    assert done.returncode == 1
    assert "if missing: pydslrep build" in done.stderr
    assert f"No module named '{NAME}'" in done.stderr


def test_an_installed_package_is_used(command: str, tmp_path: pathlib.Path) -> None:
    """Once the package is installed where scripts run, `build` writes scripts alone."""
    home = tmp_path / "venv"
    venv.create(home)
    library = f"lib/python{sys.version_info.major}.{sys.version_info.minor}"
    packages = home / library / "site-packages"
    environment = os.environ | {"VIRTUAL_ENV": str(home)}

    def build() -> str:
        program = tmp_path / "table2.pyr"
        program.write_bytes(TABLE_2.read_bytes())
        start = [command, "build", str(program)]
        return subprocess.run(
            start, env=environment, text=True, capture_output=True, check=True
        ).stdout

    shutil.copytree(ROOT / "python" / NAME, packages / NAME)
    assert "is installed in your Python" in " ".join(build().split())
    assert not (tmp_path / NAME).exists()
    done = run(home / "bin" / "python", tmp_path, "--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert "--robot" in done.stdout

    shutil.rmtree(packages / NAME)
    assert f"{NAME} written" in " ".join(build().split())
    assert (tmp_path / NAME / "__init__.py").exists()


def lines_of_code(path: pathlib.Path) -> int:
    """Lines that are not blank, comments or docstrings, as Python reads them."""
    text = path.read_text(encoding="utf-8")
    count: set[int] = set()
    with path.open("rb") as file:
        for token in tokenize.tokenize(file.readline):
            if token.type not in {
                tokenize.COMMENT,
                tokenize.NL,
                tokenize.NEWLINE,
                tokenize.INDENT,
                tokenize.DEDENT,
                tokenize.ENCODING,
                tokenize.ENDMARKER,
            }:
                count.update(range(token.start[0], token.end[0] + 1))
    lines = text.splitlines()
    count -= {number for number in count if not lines[number - 1].strip()}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            assert node.end_lineno
            if isinstance(node.value.value, str):
                count -= set(range(node.lineno, node.end_lineno + 1))
    return len(count)


def test_stats_counts_as_python_does(command: str, built: pathlib.Path) -> None:
    printed = subprocess.run(
        [command, "stats", built / "table2.pyr", "--json"],
        text=True,
        capture_output=True,
        check=True,
    )
    stats = json.loads(printed.stdout)
    package = (built / NAME).rglob("*.py")
    assert stats["runtime"] == sum(lines_of_code(path) for path in package)
    assert stats["environments"][0]["python"] == lines_of_code(built / "area_1.py")
