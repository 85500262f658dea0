"""Pipes and devices in the place of files: nobody waits for them, and nobody takes what they hold."""

from __future__ import annotations

import os
import pathlib
import subprocess

import pytest
from test_outputs import PROGRAM

Run = subprocess.CompletedProcess[str]


@pytest.fixture
def folder(tmp_path: pathlib.Path) -> pathlib.Path:
    (tmp_path / "p.pyr").write_text(PROGRAM, encoding="utf-8")
    return tmp_path


def run(command: str, folder: pathlib.Path, *arguments: str) -> Run:
    """Runs it with an input that never ends."""
    reader, writer = os.pipe()
    try:
        return subprocess.run(
            [command, *arguments],
            cwd=folder,
            check=False,
            capture_output=True,
            text=True,
            stdin=reader,
            timeout=60,
        )
    finally:
        os.close(reader)
        os.close(writer)


def put(kind: str, path: pathlib.Path) -> None:
    if kind == "pipe":
        os.mkfifo(path)
    else:
        path.symlink_to({"device": "/dev/zero", "input": "/dev/stdin"}[kind])


@pytest.mark.parametrize("kind", ["pipe", "device", "input"])
@pytest.mark.parametrize("verb", ["check", "plan", "build", "fmt", "stats", "run"])
def test_programs(command: str, folder: pathlib.Path, verb: str, kind: str) -> None:
    put(kind, folder / "x.pyr")
    done = run(command, folder, verb, "x.pyr")
    assert done.returncode == 2
    assert "cannot read x.pyr: not a regular file" in done.stderr
    if verb in ("check", "build", "fmt"):
        done = run(command, folder, verb, ".")
        assert done.returncode == 2
        assert "cannot read x.pyr: not a regular file" in done.stderr


@pytest.mark.parametrize("kind", ["pipe", "device", "input"])
@pytest.mark.parametrize(
    "name", ["yard.scene.toml", "pydslrep.toml", "part.pyr", ".gitignore"]
)
def test_what_belongs_to_a_program(
    command: str, folder: pathlib.Path, name: str, kind: str
) -> None:
    put(kind, folder / name)
    with_import = f'import "part.pyr"\n{PROGRAM}'
    (folder / "p.pyr").write_text(with_import, encoding="utf-8")
    for arguments in (("plan", "p.pyr"), ("check", "p.pyr"), ("check", ".")):
        done = run(command, folder, *arguments)
        assert done.returncode in (0, 1, 2)


@pytest.mark.parametrize("kind", ["pipe", "device", "input"])
def test_scripts(command: str, folder: pathlib.Path, kind: str) -> None:
    put(kind, folder / "yard.py")
    done = run(command, folder, "build", "--no-runtime", "p.pyr")
    assert done.returncode == 2
    assert "yard.py" in done.stderr


def test_the_limit_is_named(command: str, folder: pathlib.Path) -> None:
    with (folder / "x.pyr").open("wb") as large:
        large.truncate((16 << 20) + 1)
    done = run(command, folder, "check", "x.pyr")
    assert done.returncode == 2
    assert "cannot read x.pyr: larger than 16 MiB" in done.stderr
