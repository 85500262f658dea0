"""Scripts that are killed, interrupted or disconnected at any time leave the simulator unaffected.

`PYDSLREP_KILLS=100` tests more than the three times of a normal test run.
"""

from __future__ import annotations

import json
import math
import os
import pathlib
import random
import signal
import socket
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import pytest
from ports import free_ports
from stage import (
    PROGRAM,
    TARGETS,
    Stage,
    finish,
    handle,
    onlooker,
    start,
    wait_for_rest,
)
from until import LIMIT, until

KILLS = int(os.environ.get("PYDSLREP_KILLS", "3"))

# The number of messages before a script ends: from its first message to the middle of its path.
MAX_PARTS = 600


class Relay:
    """A proxy between a script and its simulator that counts messages and can disconnect both."""

    def __init__(self, port: int) -> None:
        self._target = port
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._server.getsockname()[1]
        self._passed = threading.Semaphore(0)
        self._lines: list[socket.socket] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                near, _ = self._server.accept()
                far = socket.create_connection(("127.0.0.1", self._target))
                self._lines += [near, far]
                for ends in ((near, far), (far, near)):
                    threading.Thread(target=self._pass, args=ends, daemon=True).start()

    def _pass(self, source: socket.socket, sink: socket.socket) -> None:
        with suppress(OSError):
            while part := source.recv(65536):
                sink.sendall(part)
                self._passed.release()
        for line in (source, sink):
            with suppress(OSError):
                line.shutdown(socket.SHUT_RDWR)

    def wait_for(self, parts: int) -> None:
        """Waits until so many messages have passed."""
        for _ in range(parts):
            assert self._passed.acquire(timeout=LIMIT)

    def hang_up(self) -> None:
        """Closes all connections and accepts no more."""
        with suppress(OSError):
            self._server.shutdown(socket.SHUT_RDWR)
        self._server.close()
        for line in self._lines:
            with suppress(OSError):
                line.shutdown(socket.SHUT_RDWR)
            line.close()


@contextmanager
def relay(port: int) -> Iterator[Relay]:
    between = Relay(port)
    try:
        yield between
    finally:
        between.hang_up()


def resources(process: int) -> tuple[int, int]:
    """The number of threads and open files of a process."""
    home = pathlib.Path("/proc", str(process))
    return len(list((home / "task").iterdir())), len(list((home / "fd").iterdir()))


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
@pytest.mark.parametrize("target", TARGETS)
def test_scripts_that_end_at_any_moment(
    command: str, tmp_path: pathlib.Path, target: str
) -> None:
    ports = free_ports(2)
    program = PROGRAM.format(*ports, actions="move 500 meters at 50")
    long = Stage(command, tmp_path / "long", program)
    short = Stage(
        command,
        tmp_path / "short",
        PROGRAM.format(*ports, actions="move 5 centimeters turn left 20"),
    )
    script, last = long.build(target), short.build(target)
    dice = random.Random(20)
    with long.simulator() as simulator, onlooker(ports[1]) as eye:
        wheel = handle(eye, "/rover/wheelL")
        before = resources(simulator.pid)
        for turn in range(KILLS):
            how = ("kill", "interrupt", "hang up")[turn % 3]
            with relay(ports[0]) as between:
                process = start(script, "--port", f"rover={between.port}")
                between.wait_for(dice.randint(1, MAX_PARTS))
                assert process.poll() is None, process.communicate()
                if how == "kill":
                    process.kill()
                elif how == "interrupt":
                    process.send_signal(signal.SIGINT)
                    process.wait(LIMIT)
                else:
                    between.hang_up()
                wait_for_rest(eye, wheel)
                process.kill()
                process.communicate()
            until(
                f"after `{how}` the simulator has as many threads and files as before",
                lambda: resources(simulator.pid) == before,
                lambda: resources(simulator.pid),
            )
        finish(start(last, "--trace", str(tmp_path / "trace")))
        rows = (tmp_path / "trace").read_text(encoding="utf-8").splitlines()
        first, last_row = (json.loads(rows[index])["theta"] for index in (0, -1))
        turned = math.degrees(math.remainder(last_row - first, math.tau))
        assert turned == pytest.approx(20.0, abs=0.5)
