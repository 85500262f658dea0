"""`python -m pydslrep_runtime.scene`, which `pydslrep scene` starts: a request as JSON in, its answer as JSON out."""

import json
import signal
import sys
from collections.abc import Mapping
from typing import Any

from .. import interrupts
from ..errors import SetupError, SimulatorError
from ..readings import shortened
from .refusal import RefusalError
from .tasks import TASKS


def main() -> int:
    """Reads one request from standard input; returns the exit code."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        # The command that started this one interrupts it so.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    interrupts.listen()
    try:
        text, code = answer(sys.stdin.read())
        sys.stdout.write(text)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return interrupts.EXIT_CODE
    finally:
        interrupts.ignore()
    return code


def answer(request_text: str) -> tuple[str, int]:
    """The answer to a request as JSON, and the exit code."""
    try:
        request: Mapping[str, Any] = json.loads(request_text)
        # Numbers that are not finite are no JSON.
        return json.dumps(TASKS[request["task"]](request), allow_nan=False), 0
    except RefusalError as error:
        return refusal(error.message, error.help, error.reason), 2
    except (SetupError, SimulatorError) as error:
        return refusal(str(error)), 2
    except Exception as error:
        what = f"{type(error).__name__}: {shortened(str(error))}"
        return refusal(f"internal error: {what}", "please report this"), 2


def refusal(message: str, help_text: str | None = None, why: str | None = None) -> str:
    """Why there is no result, as JSON."""
    return json.dumps({"error": message, "help": help_text, "reason": why})


if __name__ == "__main__":
    sys.exit(main())
