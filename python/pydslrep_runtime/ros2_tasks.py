"""`pydslrep doctor --target ros2` starts it: a request as JSON comes from standard input, its answer goes to standard output."""

import json
import signal
import sys

from . import interrupts
from .errors import SetupError, SimulatorError
from .readings import shortened


def main() -> int:
    """Answers one request; returns the exit code."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        # The command that started this one interrupts it so.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    interrupts.listen()
    try:
        text, code = answer_to(sys.stdin.read())
        sys.stdout.write(text)
        sys.stdout.flush()
    except KeyboardInterrupt:
        return interrupts.EXIT_CODE
    finally:
        interrupts.ignore()
    return code


def answer_to(request: str) -> tuple[str, int]:
    """The answer to a request as JSON, and the exit code."""
    try:
        # It fails where there is no ROS 2.
        from .ros2_doctor import doctor

        return json.dumps(doctor(json.loads(request)), allow_nan=False), 0
    except (SetupError, SimulatorError) as error:
        return refusal(str(error), None), 2
    except Exception as error:
        what = f"internal error: {type(error).__name__}: {shortened(str(error))}"
        return refusal(what, "please report this"), 2


def refusal(message: str, help_text: str | None) -> str:
    """Why there is no result, as JSON."""
    return json.dumps({"error": message, "help": help_text, "reason": None})


if __name__ == "__main__":
    sys.exit(main())
