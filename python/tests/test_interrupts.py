"""Whatever ends a run from outside stops the robots first; once more changes nothing."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from queue import Queue

import pytest

PACKAGE = Path(__file__).parents[1]
LIMIT = 60.0  # s

SCRIPT = """
from pydslrep_runtime import Backend, Pose, RealTimeClock, TwoWheelRobot, run

rover = TwoWheelRobot("rover", port=1, left=("l", 0.05), right=("r", 0.05))


class Rover(Backend):
    def __init__(self, spec):
        self.clock, self.x, self.rates = RealTimeClock(0.001), 0.0, [0.0, 0.0]

    def wheel_mounts(self):
        return [(0.0, 0.1), (0.0, -0.1)]

    def pose(self):
        self.x += 0.05 * 0.001 * self.rates[0]
        return Pose(self.x, 0.0, 0.0)

    def set_wheel_rates(self, rates):
        if any(rates) and not any(self.rates):
            print("drives", flush=True)
        self.rates = rates

    def stop(self):
        self.rates = [0.0, 0.0]
        print("stops", flush=True)
        input()
        print("stopped", flush=True)

    def close(self):
        print("closed", self.rates, flush=True)


async def main():
    await rover.move(1000.0)


if __name__ == "__main__":
    run(main, robots=[rover])
"""

SIGNALS = [
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGHUP", "SIGQUIT")
    if hasattr(signal, name)
]
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")


class Script:
    """A running script."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self._lines: Queue[str] = Queue()
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._lines.put(line.strip())

    def wait_for(self, line: str) -> None:
        """Waits for a line of its output."""
        found = self._lines.get(timeout=LIMIT)
        assert found == line

    def go_on(self) -> None:
        """Lets it stop its robot."""
        assert self.process.stdin is not None
        self.process.stdin.write("\n")
        self.process.stdin.flush()


@contextmanager
def started(folder: Path, before: Sequence[str] = (), **env: str) -> Iterator[Script]:
    """Starts the script."""
    script = folder / "script.py"
    script.write_text(SCRIPT, encoding="utf-8")
    with subprocess.Popen(
        [*before, sys.executable, script, "--robot", "script:Rover"],
        env={**os.environ, "PYTHONPATH": str(PACKAGE), **env},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield Script(process)
        finally:
            process.kill()


@pytest.mark.parametrize("number", SIGNALS)
def test_every_way_out_stops_the_robots(number: signal.Signals, tmp_path: Path) -> None:
    with started(tmp_path) as script:
        script.wait_for("drives")
        script.process.send_signal(number)
        script.wait_for("stops")
        # Impatience does not leave the wheels turning.
        for other in SIGNALS * 3:
            script.process.send_signal(other)
        script.go_on()
        script.wait_for("stopped")
        script.go_on()
        # After the action, the run stops everything once more.
        script.wait_for("stops")
        script.wait_for("stopped")
        script.process.send_signal(number)
        script.wait_for("closed [0.0, 0.0]")
        assert script.process.stderr is not None
        assert script.process.stderr.read() == "interrupted\n"
        assert script.process.wait(LIMIT) == 130


def test_a_robot_that_never_stops_does_not_keep_the_process(tmp_path: Path) -> None:
    with started(tmp_path, PYDSLREP_TIME_LIMITS="END_LIMIT=0.2") as script:
        script.wait_for("drives")
        script.process.send_signal(signal.SIGINT)
        script.wait_for("stops")
        assert script.process.wait(LIMIT) == 130


def test_what_was_ignored_stays_so(tmp_path: Path) -> None:
    with started(tmp_path, before=("nohup",)) as script:
        script.wait_for("drives")
        script.process.send_signal(signal.SIGHUP)
        script.process.send_signal(signal.SIGTERM)
        script.wait_for("stops")
        script.go_on()
        script.wait_for("stopped")
        script.go_on()
        assert script.process.wait(LIMIT) == 130


def test_a_closed_terminal_changes_nothing(tmp_path: Path) -> None:
    with started(tmp_path) as script:
        script.wait_for("drives")
        assert script.process.stderr is not None
        script.process.stderr.close()
        script.process.send_signal(signal.SIGHUP)
        script.wait_for("stops")
        script.go_on()
        script.wait_for("stopped")
        script.go_on()
        script.wait_for("stops")
        script.wait_for("stopped")
        script.wait_for("closed [0.0, 0.0]")
        assert script.process.wait(LIMIT) == 130
