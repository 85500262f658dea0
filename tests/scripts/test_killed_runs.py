"""A run that is killed takes its script along, and the next one drives as if nothing had happened."""

from __future__ import annotations

import os
import pathlib
import select
import subprocess
import sys

import pytest
from until import LIMIT, until

PROGRAM = """\
wheel a with radius 4
wheel b with radius 4
robot r with port 18371 has { a b } wheels
movement m of r { move 1 meters turn left move 1 meters turn left move 1 meters }
environment yard has { r } robots with { m } moves
"""

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="needs Linux's list of a process's children"
)


def children_of(pid: int) -> list[int]:
    children: list[int] = []
    for task in pathlib.Path(f"/proc/{pid}/task").iterdir():
        listed = (task / "children").read_text(encoding="utf-8").split()
        children += map(int, listed)
    return children


def has_ended(process: int) -> bool:
    """Waits for the end of a process that is not a child of this one."""
    ready, _, _ = select.select([process], [], [], LIMIT)
    os.close(process)
    return bool(ready)


@pytest.fixture
def folder(tmp_path: pathlib.Path) -> pathlib.Path:
    (tmp_path / "p.pyr").write_text(PROGRAM, encoding="utf-8")
    return tmp_path


def kill_a_run(command: str, folder: pathlib.Path) -> int:
    """Kills a run whose robot is driving; returns a descriptor of its script."""
    partial = folder / "killed.jsonl.partial"
    partial.unlink(missing_ok=True)
    # In real time it takes a quarter of a minute: it is killed in the middle of its first action on a busy machine, too.
    start = [command, "run", "p.pyr", "--speed", "1", "--trace", "killed.jsonl"]
    with subprocess.Popen(start, cwd=folder, stderr=subprocess.DEVNULL) as running:

        def drives() -> bool:
            assert running.poll() is None, "it ended by itself"
            return partial.exists() and partial.stat().st_size > 0

        until("its robot drives", drives)
        (script,) = children_of(running.pid)
        descriptor = os.pidfd_open(script)
        running.kill()
        return descriptor


def trace_of_a_run(command: str, folder: pathlib.Path) -> bytes:
    arguments = ["run", "p.pyr", "--trace", "trace.jsonl", "--no-progress"]
    done = subprocess.run(
        [command, *arguments], cwd=folder, check=False, capture_output=True, text=True
    )
    assert (done.returncode, done.stderr) == (0, "trace: trace.jsonl\n")
    return (folder / "trace.jsonl").read_bytes()


def test_the_next_run_is_not_disturbed(
    command: str, folder: pathlib.Path, *, long: bool
) -> None:
    undisturbed = trace_of_a_run(command, folder)
    for _ in range(4 if long else 1):
        script = kill_a_run(command, folder)
        assert trace_of_a_run(command, folder) == undisturbed
        assert has_ended(script), "the script lives on"
