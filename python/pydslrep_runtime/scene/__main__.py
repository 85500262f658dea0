"""`python -m pydslrep_runtime.scene`, which `pydslrep scene` starts: a request as JSON in, its answer as JSON out."""

import json
import sys
from collections.abc import Mapping
from typing import Any

from ..errors import SetupError, SimulatorError
from .refusal import RefusalError
from .tasks import TASKS


def main() -> int:
    """Reads one request from standard input; returns the exit code."""
    request: Mapping[str, Any] = json.load(sys.stdin)
    try:
        answer = TASKS[request["task"]](request)
    except RefusalError as refusal:
        answer = {
            "error": refusal.message,
            "help": refusal.help,
            "reason": refusal.reason,
        }
    except (SetupError, SimulatorError) as error:
        answer = {"error": str(error), "help": None, "reason": None}
    except KeyboardInterrupt:
        return 130
    json.dump(answer, sys.stdout)
    return 2 if "error" in answer else 0


if __name__ == "__main__":
    sys.exit(main())
