"""Presses keys in a terminal at a steady pace, through one tmux connection: a process per key would be too slow."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Iterable

from terminal import Terminal


class Keyboard:
    """A connection that presses keys in a terminal."""

    def __init__(self, terminal: Terminal) -> None:
        attach = ["attach-session", "-f", "no-output,ignore-size"]
        self.tmux = subprocess.Popen(
            ["tmux", "-L", terminal.name, "-C", *attach],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
        )

    def close(self) -> None:
        """Closes the connection, not the terminal."""
        assert self.tmux.stdin
        self.tmux.stdin.close()
        self.tmux.wait()

    def press(self, key: str) -> None:
        """Presses a key immediately."""
        assert self.tmux.stdin
        if len(key) == 1:
            quoted = '"\'"' if key == "'" else f"'{key}'"
            command = f"send-keys -l -- {quoted}"
        else:
            command = f"send-keys {key}"
        self.tmux.stdin.write(command + "\n")
        self.tmux.stdin.flush()

    def type(self, keys: Iterable[str], pace: float) -> float:
        """Presses keys, one each `pace` seconds; returns the seconds it took."""
        start = time.monotonic()
        for number, key in enumerate(keys):
            # Late keys follow at once: the pace is under test, and the editor queues keys.
            time.sleep(max(0.0, start + number * pace - time.monotonic()))
            self.press(key)
        return time.monotonic() - start
