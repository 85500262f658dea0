"""Requests of the command to a Python of its own: JSON comes from standard input, an answer as JSON goes to standard output."""

import json
import signal
import sys
from collections.abc import Callable, Mapping
from typing import Any

from . import interrupts
from .errors import SetupError, SimulatorError
from .readings import shortened

Task = Callable[[Mapping[str, Any]], Any]
"""What answers a request."""


class RefusalError(Exception):
    """A request that cannot be fulfilled, in a sentence, and what to do about it.

    Programs tell the reason from others by a word, where they can do something about it.
    """

    def __init__(
        self, message: str, help_text: str | None = None, reason: str | None = None
    ) -> None:
        super().__init__(message)
        self.message, self.help, self.reason = message, help_text, reason


def serve_one(task: Task) -> int:
    """Answers one request; returns the exit code."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        # The command that started this process interrupts it so.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    interrupts.listen()
    try:
        text, code = answer(sys.stdin.read(), task)
        sys.stdout.write(text)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return interrupts.EXIT_CODE
    finally:
        interrupts.ignore()
    return code


def answer(request: str, task: Task) -> tuple[str, int]:
    """The answer to a request as JSON, and the exit code."""
    try:
        # Numbers that are not finite are no JSON.
        return json.dumps(task(json.loads(request)), allow_nan=False), 0
    except RefusalError as error:
        return refusal(error), 2
    except (SetupError, SimulatorError) as error:
        return refusal(RefusalError(str(error))), 2
    except Exception as error:
        what = f"internal error: {type(error).__name__}: {shortened(str(error))}"
        return refusal(RefusalError(what, "please report this")), 2


def refusal(error: RefusalError) -> str:
    """Why there is no result, as JSON."""
    said = {"error": error.message, "help": error.help, "reason": error.reason}
    return json.dumps(said)
