"""Commands that are killed at any moment: every file is as before or as it should be, and nothing stays behind."""

from __future__ import annotations

import functools
import os
import pathlib
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable
from dataclasses import dataclass

import pytest
from amount import dice, report, times
from until import until

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
    # How often it is killed in a short run.
    few: int = 6


OUTPUTS = ("--trace", "yard.jsonl", "--picture", "yard.svg", "--figures", "yard.json")

CASES = {
    "build": Case(("build", "main.pyr")),
    "fmt": Case(("fmt", "main.pyr")),
    "check": Case(("check", "--fix", "main.pyr"), MISTAKEN),
    "new": Case(("new", "patrol")),
    "plan": Case(
        ("plan", "main.pyr", "--environment", "yard", "--picture", "yard.png"),
        few=3,
    ),
    "run": Case(
        ("run", "main.pyr", "--environment", "yard", *OUTPUTS),
        varying=("yard.json",),
        trace="yard.jsonl",
        few=3,
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

    def start(
        self, *more: str, prepare: Callable[[], None] | None = None
    ) -> subprocess.Popen[bytes]:
        """Starts the command with more arguments, in a process that `prepare` has changed."""
        return subprocess.Popen(
            [self.command, *self.case.arguments, *more],
            cwd=self.folder,
            preexec_fn=prepare,
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
        until("its processes end", lambda: not self.processes(), self.processes)

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


def results(command: str, folder: pathlib.Path, case: Case) -> tuple[Files, Files]:
    """The files before and after a command that nobody disturbs."""
    undisturbed = Workplace(command, folder, case)
    before = undisturbed.files()
    undisturbed.finish()
    return before, undisturbed.files()


def assert_whole(place: Workplace, before: Files, complete: Files) -> None:
    """Every file is as it was or as it is in the end, but for a trace, which may have only its beginning."""
    place.settle()
    trace = place.case.trace
    for file, content in place.files().items():
        if trace and file.removesuffix(".partial") == trace:
            assert complete[trace].startswith(content)
            assert content.endswith(b"\n") or not content
        elif not is_leftover(file):
            allowed = (before.get(file), complete.get(file))
            assert content in allowed, f"{file} is neither"


def assert_repaired(place: Workplace, complete: Files) -> None:
    """The next run completes everything, and removes what is left of the one before."""
    if place.files() != complete:
        place.finish()
    assert place.files() == complete
    assert not list(place.scratch.iterdir()), "temporary files stay"
    place.settle()


@pytest.mark.parametrize("name", CASES)
def test_kills(command: str, tmp_path: pathlib.Path, name: str) -> None:
    die, case = dice(f"kills {name}"), CASES[name]
    # The first run also does what is done once.
    before, complete = results(command, tmp_path / "undisturbed", case)
    latest = 1.1 * Workplace(command, tmp_path / "timed", case).finish()
    count, killed = times(case.few), 0
    place = Workplace(command, tmp_path / "0", case)
    while killed < count:
        process = place.start()
        try:
            process.wait(timeout=die.uniform(0.0, latest))
            # It was faster than the one that was timed.
            latest *= 0.9
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            killed += process.wait() == -signal.SIGKILL
        assert_whole(place, before, complete)
        if die.random() < 0.5:
            place = Workplace(command, tmp_path / f"{killed} {die.random()}", case)
    assert_repaired(place, complete)
    report(f"kills {name}", killed)


def has_content(path: pathlib.Path) -> bool:
    return path.exists() and path.stat().st_size > 0


def end_at(size: int) -> None:
    """Has the system kill this process when a file grows beyond a size, in bytes."""
    import resource  # not on Windows

    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


@pytest.mark.parametrize("name", [name for name in CASES if name != "run"])
def test_kills_in_the_middle_of_a_write(
    command: str, tmp_path: pathlib.Path, name: str
) -> None:
    die, case = dice(f"writes {name}"), CASES[name]
    before, complete = results(command, tmp_path / "undisturbed", case)
    written = [file for file in complete if before.get(file) != complete[file]]
    largest = max(len(complete[file]) for file in written)
    count = times(case.few // 3)
    for number in range(count):
        place = Workplace(command, tmp_path / str(number), case)
        size = die.randrange(largest)
        process = place.start(prepare=functools.partial(end_at, size))
        assert process.wait(LIMIT) == -signal.SIGXFSZ, size
        assert_whole(place, before, complete)
        assert any(is_leftover(file) for file in place.files()), "nothing was begun"
        assert_repaired(place, complete)
    report(f"writes {name}", count)


def test_kills_of_a_run_that_writes_its_trace(
    command: str, tmp_path: pathlib.Path
) -> None:
    case = CASES["run"]
    assert case.trace
    before, complete = results(command, tmp_path / "undisturbed", case)
    count = times(1)
    for number in range(count):
        place = Workplace(command, tmp_path / str(number), case)
        begun = place.folder / f"{case.trace}.partial"
        # Robots drive for half a minute: it is killed long before the end.
        process = place.start("--speed", "1")
        until("it writes", functools.partial(has_content, begun))
        process.kill()
        assert process.wait(LIMIT) == -signal.SIGKILL, "it ended by itself"
        assert_whole(place, before, complete)
        # The script has noticed, and ended the trace where it was.
        trace = place.files().get(case.trace) or place.files()[begun.name]
        assert 0 < len(trace) < len(complete[case.trace])
        assert_repaired(place, complete)
    report("writes run", count)
