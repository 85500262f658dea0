"""What a script says while it waits."""

import sys
import time


class Notes:
    """Says each thing once."""

    def __init__(self) -> None:
        self._said: set[str] = set()

    def say_paused(self) -> None:
        """Says that the simulation is paused."""
        self.say("the simulation is paused; this script waits until it goes on")

    def say(self, note: str) -> None:
        """Says something, once."""
        if note not in self._said:
            self._said.add(note)
            print(f"note: {note}", file=sys.stderr, flush=True)


def pause(seconds: float = 0.1) -> None:
    """Lets real time pass."""
    time.sleep(seconds)
