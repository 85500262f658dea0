"""Runs a script in Pyodide as a process of its own would run it: it finds no module as an earlier script has left it."""

import asyncio
import gc
import io
import runpy
import selectors
import socket
import sys
import time
from collections.abc import Callable
from typing import Any


class Idle(selectors._BaseSelectorImpl):
    """A selector without files: the browser has none that a script could wait for."""

    def select(self, timeout: float | None = None) -> list[Any]:
        """Waits."""
        time.sleep(max(timeout or 0.0, 0.0))
        return []


class Wakeup:
    """An end of the pair of sockets by which threads wake up an event loop: there are no threads."""

    def __init__(self, number: int) -> None:
        self._number = number

    def fileno(self) -> int:
        """A number that no file has."""
        return self._number

    def setblocking(self, flag: bool) -> None:
        """Does nothing."""

    def send(self, data: bytes) -> int:
        """Does nothing: the loop is awake while this is called."""
        return len(data)

    def recv(self, _size: int) -> bytes:
        """Nothing."""
        raise BlockingIOError

    def close(self) -> None:
        """Does nothing."""


class Lines(io.TextIOBase):
    """Passes on what a script prints, line by line."""

    def __init__(self, show: Callable[[str], object]) -> None:
        self._show = show
        self._line = ""

    def writable(self) -> bool:
        """It is."""
        return True

    def write(self, text: str) -> int:
        """Passes on the lines that are complete."""
        *lines, self._line = (self._line + text).split("\n")
        for line in lines:
            self._show(line)
        return len(text)

    def finish(self) -> None:
        """Passes on a last line without an end."""
        if self._line:
            self._show(self._line)
            self._line = ""


def forget_modules() -> None:
    """Unloads the modules of an earlier script: those beside this one, and the simulator, of which each run has its own.

    So does CoppeliaSim's client, which keeps the `zmq` that it has imported. `cbor2` stays: it is compiled, and cannot be
    initialized twice.
    """
    folder = __file__.rpartition("/")[0]
    for name, module in list(sys.modules.items()):
        file = getattr(module, "__file__", None) or ""
        if name != __name__ and file.startswith(f"{folder}/"):
            del sys.modules[name]
    for name in ("coppeliasim_zmqremoteapi_client", "_pydslrep_simulator"):
        sys.modules.pop(name, None)


def start(
    script: str,
    arguments: list[str],
    show: Callable[[str], object],
    show_error: Callable[[str], object],
) -> int:
    """Runs a script; the exit code."""
    forget_modules()
    selectors.DefaultSelector = Idle  # type: ignore[misc,assignment]
    socket.socketpair = lambda *_: (Wakeup(1 << 20), Wakeup(1 + (1 << 20)))  # type: ignore[assignment,return-value]
    # Pyodide runs this in an event loop of its own.
    asyncio._set_running_loop(None)  # type: ignore[attr-defined]
    sys.argv = [script, *arguments]
    out, error = Lines(show), Lines(show_error)
    sys.stdout, sys.stderr = out, error
    try:
        runpy.run_path(script, run_name="__main__")
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    finally:
        out.finish()
        error.finish()
        # While its simulator is there: what is left of the script may still close its connections.
        gc.collect()
    return 0
