"""Keys for a terminal at a steady pace: by one lasting connection to tmux, since a process for each would be late."""

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
        """Ends the connection, not the terminal."""
        assert self.tmux.stdin
        self.tmux.stdin.close()
        self.tmux.wait()

    def press(self, key: str) -> None:
        """Presses a key, at once."""
        assert self.tmux.stdin
        if len(key) == 1:
            quoted = '"\'"' if key == "'" else f"'{key}'"
            command = f"send-keys -l -- {quoted}"
        else:
            command = f"send-keys {key}"
        self.tmux.stdin.write(command + "\n")
        self.tmux.stdin.flush()

    def type(self, keys: Iterable[str], pace: float) -> float:
        """Presses keys, one each `pace` seconds, and returns how long it took."""
        start = time.monotonic()
        for number, key in enumerate(keys):
            # The pace is what is tested. Who is late goes on at once, as a person's keys wait in the editor.
            time.sleep(max(0.0, start + number * pace - time.monotonic()))
            self.press(key)
        return time.monotonic() - start
