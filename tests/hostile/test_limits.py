"""Disks that are full after any number of bytes: an error, and every file is as before or complete."""

from __future__ import annotations

import pathlib
import signal
import subprocess
import sys

import pytest
from amount import dice, report, times
from test_kills import CASES, Workplace, is_leftover

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="limits of files")

# What a full disk cannot stop is of no interest here; `run` needs whole caches.
NAMES = [name for name in CASES if name not in ("run", "new")]


def run_with_limit(place: Workplace, size: int) -> subprocess.CompletedProcess[str]:
    """Runs the command while no file may grow beyond a size, in bytes."""
    import resource  # not on Windows

    def limit() -> None:
        # The system refuses to write more, as on a full disk, instead of ending the process.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return subprocess.run(
        [place.command, *place.case.arguments],
        cwd=place.folder,
        preexec_fn=limit,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("name", NAMES)
def test_a_full_disk(command: str, tmp_path: pathlib.Path, name: str) -> None:
    die, case = dice(f"limits {name}"), CASES[name]
    undisturbed = Workplace(command, tmp_path / "undisturbed", case)
    before = undisturbed.files()
    undisturbed.finish()
    complete = undisturbed.files()
    written = [file for file in complete if before.get(file) != complete[file]]
    largest = max(len(complete[file]) for file in written)
    refused = 0
    for number in range(times(case.few // 2)):
        place = Workplace(command, tmp_path / str(number), case)
        done = run_with_limit(place, die.randrange(largest))
        assert done.returncode == 2, done.stderr
        assert "cannot write" in done.stderr
        refused += 1
        for file, content in place.files().items():
            assert content in (before.get(file), complete.get(file)), (
                f"{file} is neither"
            )
            assert not is_leftover(file)
    report(f"limits {name}", refused)
