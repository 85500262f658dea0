"""Hostile bytes at the simulator's ports: it goes on, and drives the next script."""

from __future__ import annotations

import pathlib
import random
import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest
from amount import dice, report, times
from mutation import mangled
from ports import free_ports
from stage import PROGRAM, TARGETS, Stage, finish, start
from until import until
from use import Use

# What the simulator may need more than at first: bytes for a few hundred connections.
MORE_MEMORY = 64 << 20


class Recorder:
    """A relay between scripts and the simulator that keeps what the scripts send."""

    def __init__(self, port: int) -> None:
        self._target = port
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._server.getsockname()[1]
        self.sent: list[bytes] = []
        self._lines: list[socket.socket] = []
        self._threads: list[threading.Thread] = []
        self._start(self._accept)

    def close(self) -> None:
        """Disconnects everybody."""
        for line in (self._server, *self._lines):
            with suppress(OSError):
                line.shutdown(socket.SHUT_RDWR)
        for thread in self._threads:
            thread.join()
        for line in (self._server, *self._lines):
            line.close()

    def _start(self, work: Callable[..., None], *arguments: Any) -> None:
        thread = threading.Thread(target=work, args=arguments)
        self._threads.append(thread)
        thread.start()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                near, _ = self._server.accept()
                far = socket.create_connection(("127.0.0.1", self._target))
                self._lines += [near, far]
                self._start(self._pass, near, far, self.sent)
                self._start(self._pass, far, near, [])

    @staticmethod
    def _pass(source: socket.socket, sink: socket.socket, kept: list[bytes]) -> None:
        with suppress(OSError):
            while part := source.recv(65536):
                kept.append(part)
                sink.sendall(part)


def attack(port: int, recorded: list[bytes], die: random.Random) -> bool:
    """Sends a part of a session, changed or not, and leaves in some way; returns whether any of it could be sent."""
    begin = 0 if die.random() < 0.8 else die.randrange(len(recorded))
    parts = recorded[begin : begin + die.randint(1, 60)]
    if die.random() < 0.9:
        at = die.randrange(len(parts))
        parts[at] = mangled(parts[at], die)
    if die.random() < 0.1:
        parts = [die.randbytes(die.randint(1, 4000))]
    line = socket.create_connection(("127.0.0.1", port))
    line.settimeout(0.02)
    sent = False
    with line, suppress(OSError):
        for part in parts:
            line.sendall(part)
            sent = True
            if die.random() < 0.5:
                with suppress(TimeoutError):
                    line.recv(65536)
        if die.random() < 0.3:
            line.shutdown(socket.SHUT_WR)
    return sent


@pytest.mark.skipif(not pathlib.Path("/proc").exists(), reason="looks into /proc")
@pytest.mark.parametrize("target", TARGETS)
def test_hostile_bytes(command: str, tmp_path: pathlib.Path, target: str) -> None:
    port, other = free_ports(2)
    program = PROGRAM.format(port, other, actions="turn left 90 move 0.3 meters")
    stage = Stage(command, tmp_path / "stage", program)
    script = stage.build(target)
    die, count = dice(f"ports {target}"), times(60)
    with stage.simulator() as simulator:
        recorder = Recorder(port)
        finish(start(script, "--port", str(recorder.port)))
        recorder.close()
        before = Use.of(simulator.pid)
        sent = sum(attack(port, recorder.sent, die) for _ in range(count))
        finish(start(script))
        assert Use.of(simulator.pid).memory < before.memory + MORE_MEMORY
        until(
            "the simulator has closed what was left",
            lambda: Use.of(simulator.pid).files <= before.files,
            lambda: (before, Use.of(simulator.pid)),
        )
    report(f"ports {target}", sent, count)
