"""Commands that are killed at any moment: every file is as before or as it should be, and nothing stays behind."""

from __future__ import annotations

import os
import pathlib
import signal
import subprocess
import sys
import time
import uuid
from dataclasses import dataclass

import pytest
from amount import dice, report, times

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")

LIMIT = 120.0

PROGRAM = """\
wheel l   with radius 4.5
wheel r with radius 4.5
robot rover type tw with port 23000 has { l r } wheels
movement lap of rover { move 0.5 meters turn   left }
environment yard has { rover } robots with { lap lap } moves
environment hall has { rover } robots with { lap } moves
"""
# One problem that `check --fix` mends.
MISTAKEN = PROGRAM.replace("meters", "meterss")

Files = dict[str, bytes]


@dataclass(frozen=True)
class Case:
    """A command that writes files."""

    arguments: tuple[str, ...]
    program: str = PROGRAM
    # Files that are not the same in every run.
    varying: tuple[str, ...] = ()
    # A trace, of which a run that ends early leaves the beginning.
    trace: str | None = None


OUTPUTS = ("--trace", "yard.jsonl", "--picture", "yard.svg", "--figures", "yard.json")

CASES = {
    "build": Case(("build", "main.pyr")),
    "fmt": Case(("fmt", "main.pyr")),
    "check": Case(("check", "--fix", "main.pyr"), MISTAKEN),
    "new": Case(("new", "patrol")),
    "plan": Case(
        ("plan", "main.pyr", "--environment", "yard", "--picture", "yard.png")
    ),
    "run": Case(
        ("run", "main.pyr", "--environment", "yard", *OUTPUTS),
        varying=("yard.json",),
        trace="yard.jsonl",
    ),
}


class Workplace:
    """A folder with a program, and a temporary folder that nobody else uses."""

    def __init__(self, command: str, folder: pathlib.Path, case: Case) -> None:
        self.command, self.case = command, case
        self.folder, self.scratch = folder / "it", folder / "scratch"
        self.scratch.mkdir(parents=True)
        self.folder.mkdir()
        (self.folder / "main.pyr").write_text(case.program, encoding="utf-8")
        self.mark = uuid.uuid4().hex

    def start(self) -> subprocess.Popen[bytes]:
        """Starts the command in a process group of its own."""
        return subprocess.Popen(
            [self.command, *self.case.arguments],
            cwd=self.folder,
            env={**os.environ, "TMPDIR": str(self.scratch), "PYDSLREP_MARK": self.mark},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def finish(self) -> float:
        """Runs the command undisturbed; returns how long it took, in seconds."""
        begin = time.monotonic()
        process = self.start()
        assert process.wait(timeout=LIMIT) in (0, 1), "1: what was mended was a problem"
        return time.monotonic() - begin

    def files(self) -> Files:
        """All files of the folder."""
        return {
            str(path.relative_to(self.folder)): path.read_bytes()
            for path in sorted(self.folder.rglob("*"))
            if path.is_file() and path.name not in self.case.varying
        }

    def settle(self) -> None:
        """Waits until the processes that come from a killed command have noticed, and ended."""
        deadline = time.monotonic() + LIMIT
        while left := self.processes():
            assert time.monotonic() < deadline, left
            time.sleep(0.01)

    def processes(self) -> list[str]:
        """The processes that come from the command; none where the system does not list them in files."""
        found = []
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if self.mark.encode() in (process / "environ").read_bytes():
                    found.append((process / "cmdline").read_text().replace("\0", " "))
            except OSError:
                continue  # it has ended, or belongs to somebody else
        return found


def is_leftover(name: str) -> bool:
    """Whether a file is, or is in, something that the next start removes."""
    return any(part.startswith(".pydslrep-") for part in pathlib.PurePath(name).parts)


@pytest.mark.parametrize("name", CASES)
def test_kills(command: str, tmp_path: pathlib.Path, name: str) -> None:
    die, case = dice(f"kills {name}"), CASES[name]
    undisturbed = Workplace(command, tmp_path / "undisturbed", case)
    before = undisturbed.files()
    # The first run also does what is done once.
    undisturbed.finish()
    complete = undisturbed.files()
    duration = Workplace(command, tmp_path / "timed", case).finish()
    count, killed = times(6), 0
    place = Workplace(command, tmp_path / "0", case)
    for number in range(count):
        process = place.start()
        try:
            process.wait(timeout=die.uniform(0.0, 1.1 * duration))
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.wait()
            killed += 1
        place.settle()
        for file, content in place.files().items():
            if file.removesuffix(".partial") == case.trace:
                assert complete[case.trace].startswith(content)
                assert content.endswith(b"\n") or not content
            elif not is_leftover(file):
                allowed = (before.get(file), complete.get(file))
                assert content in allowed, f"{file} is neither"
        if die.random() < 0.5:
            place = Workplace(command, tmp_path / str(number + 1), case)
    if place.files() != complete:
        place.finish()
    assert place.files() == complete
    assert not list(place.scratch.iterdir()), "temporary files stay"
    place.settle()
    report(f"kills {name}", runs=count, killed=killed)
