"""`check --watch`, as used next to an editor."""

from __future__ import annotations

import os
import pathlib
import pty
import queue
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator

import pytest

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals and terminals")

GOOD = """wheel l with radius 4
wheel r with radius 4
robot a type tw with port 23000 has { l r } wheels
movement m of a { move 1 meters }
environment yard has { a } robots with { m } moves
"""
BAD = GOOD.replace("{ l r }", "{ l x }")

# Reached only if something is broken.
LIMIT = 60


class Watcher:
    """A running `check --watch`."""

    def __init__(self, command: str, folder: pathlib.Path, *arguments: str) -> None:
        self._process = subprocess.Popen(
            [command, "check", "--watch", *arguments],
            cwd=folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
        )
        self._lines: queue.Queue[str] = queue.Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._process.stdout
        for line in self._process.stdout:
            self._lines.put(line.rstrip("\n"))

    def look(self) -> tuple[str, str]:
        """The problems and the summary of the next check."""
        problems: list[str] = []
        while True:
            line = self._lines.get(timeout=LIMIT)
            summary = re.fullmatch(
                r"\[\d\d:\d\d:\d\d\] (.*) Watching for changes; press Ctrl\+C to stop\.",
                line,
            )
            if summary:
                return "\n".join(problems), summary[1]
            problems.append(line)

    def until(self, summary: str) -> str:
        """The problems of the next check with such a summary: it may see a partly written file first."""
        while True:
            problems, found = self.look()
            if found.startswith(summary):
                return problems

    def interrupt(self) -> int:
        self._process.send_signal(signal.SIGINT)
        return self._process.wait(LIMIT)

    def kill(self) -> None:
        self._process.kill()
        self._process.wait()
        assert self._process.stdout
        self._process.stdout.close()


class Start:
    """Starts watchers, and terminates them after the test."""

    def __init__(self, command: str, folder: pathlib.Path) -> None:
        self._command = command
        self._folder = folder
        self.watchers: list[Watcher] = []

    def __call__(self, *arguments: str) -> Watcher:
        self.watchers.append(Watcher(self._command, self._folder, *arguments))
        return self.watchers[-1]


@pytest.fixture
def start(command: str, tmp_path: pathlib.Path) -> Iterator[Start]:
    start = Start(command, tmp_path)
    yield start
    for watcher in start.watchers:
        watcher.kill()


def save_by_rename(path: pathlib.Path, text: str) -> None:
    """Saves a file as many editors do."""
    temporary = path.with_name(f".{path.name}.swp")
    temporary.write_text(text)
    temporary.rename(path)


def test_programs_are_checked_again(tmp_path: pathlib.Path, start: Start) -> None:
    program = tmp_path / "x.pyr"
    program.write_text(GOOD)
    watcher = start()
    assert watcher.until("No problems in 1 file.") == ""
    program.write_text(BAD)
    assert "there is no wheel called `x`" in watcher.until("1 error")
    save_by_rename(program, GOOD)
    assert watcher.until("No problems in 1 file.") == ""
    save_by_rename(program, BAD)
    watcher.until("1 error")
    program.unlink()
    assert "there is no program in" in watcher.until("Nothing was checked.")
    program.write_text(GOOD)
    assert watcher.until("No problems in 1 file.") == ""
    assert watcher.interrupt() == 130


def test_folders_that_come_later_are_watched(
    tmp_path: pathlib.Path, start: Start
) -> None:
    (tmp_path / "x.pyr").write_text(GOOD)
    watcher = start()
    watcher.until("No problems in 1 file.")
    # The set of watched folders must not change from here on.
    (tmp_path / "x.pyr").write_text(BAD)
    watcher.until("1 error")
    below = tmp_path / "rooms" / "deep"
    below.mkdir(parents=True)
    (below / "y.pyr").write_text(BAD)
    watcher.until("2 errors")
    (below / "y.pyr").write_text(GOOD)
    watcher.until("1 error")
    (tmp_path / "rooms").rename(tmp_path / "halls")
    (tmp_path / "halls" / "deep" / "y.pyr").write_text(BAD)
    while "halls/deep/y.pyr" not in watcher.until("2 errors"):
        pass


def test_imports_are_watched_wherever_they_are(
    tmp_path: pathlib.Path, start: Start
) -> None:
    (tmp_path / "pydslrep.toml").write_text("")
    (tmp_path / "a").mkdir()
    wheels, rest = GOOD.split("robot", maxsplit=1)
    program = tmp_path / "a" / "x.pyr"
    program.write_text(f'import "../parts/wheels.pyr"\nrobot{rest}')
    watcher = start("a/x.pyr")
    assert "there is no file" in watcher.look()[0]
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "wheels.pyr").write_text(wheels)
    assert watcher.until("No problems in 1 file.") == ""
    save_by_rename(tmp_path / "parts" / "wheels.pyr", wheels.replace("wheel l", ""))
    watcher.until("1 error")
    save_by_rename(tmp_path / "parts" / "wheels.pyr", wheels)
    assert watcher.until("No problems in 1 file.") == ""
    program.write_text(GOOD)
    assert watcher.until("No problems in 1 file.") == ""
    assert watcher.interrupt() == 130


def test_settings_are_watched_also_above(tmp_path: pathlib.Path, start: Start) -> None:
    below = tmp_path / "a" / "b"
    below.mkdir(parents=True)
    (below / "x.pyr").write_text(BAD)
    watcher = start("a/b/x.pyr")
    watcher.until("1 error")
    settings = tmp_path / "pydslrep.toml"
    settings.write_text('[severity]\nunresolved-reference = "hint"\n')
    watcher.until("2 hints")
    save_by_rename(settings, "sevrity = 1\n")
    assert "did you mean `severity`?" in watcher.until("Nothing was checked.")
    settings.unlink()
    watcher.until("1 error")
    assert watcher.interrupt() == 130


def test_a_program_that_is_not_there_yet(tmp_path: pathlib.Path, start: Start) -> None:
    watcher = start("rooms/x.pyr")
    assert "rooms/x.pyr does not exist" in watcher.until("Nothing was checked.")
    (tmp_path / "rooms").mkdir()
    (tmp_path / "rooms" / "x.pyr").write_text(GOOD)
    assert watcher.until("No problems in 1 file.") == ""


def test_a_terminal_is_cleared_before_each_look(
    command: str, tmp_path: pathlib.Path
) -> None:
    program = tmp_path / "x.pyr"
    program.write_text(GOOD)
    ours, theirs = pty.openpty()
    process = subprocess.Popen(
        [command, "check", "--watch"],
        cwd=tmp_path,
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        start_new_session=True,
    )
    os.close(theirs)

    def read_until(end: bytes) -> bytes:
        read = b""
        while not read.endswith(end):
            read += os.read(ours, 4096)
        return read

    try:
        for _ in range(2):
            assert read_until(b"press Ctrl+C to stop.\r\n").startswith(
                b"\x1b[2J\x1b[3J\x1b[H"
            )
            program.write_text(program.read_text() + "\n")
    finally:
        process.send_signal(signal.SIGINT)
        assert process.wait(LIMIT) == 130
        os.close(ours)


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--format", "json"], "--watch is for people"),
        (["-"], "standard input cannot be watched"),
        (["--fix"], "cannot be used with"),
    ],
)
def test_what_does_not_go_together(
    command: str, tmp_path: pathlib.Path, arguments: list[str], problem: str
) -> None:
    done = subprocess.run(
        [command, "check", "--watch", *arguments],
        cwd=tmp_path,
        capture_output=True,
        encoding="utf-8",
        check=False,
        timeout=LIMIT,
    )
    assert done.returncode == 2
    assert problem in done.stderr
