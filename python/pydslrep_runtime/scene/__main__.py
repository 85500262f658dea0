"""`python -m pydslrep_runtime.scene`, which `pydslrep scene` starts."""

import sys
from collections.abc import Mapping
from typing import Any

from ..answers import serve_one
from .tasks import TASKS


def task(request: Mapping[str, Any]) -> Any:
    """Does what the request names."""
    return TASKS[request["task"]](request)


if __name__ == "__main__":
    sys.exit(serve_one(task))
