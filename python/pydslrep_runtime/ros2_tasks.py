"""`python -m pydslrep_runtime.ros2_tasks`, which `pydslrep doctor --target ros2` starts."""

import sys
from collections.abc import Mapping
from typing import Any

from .answers import serve_one


def task(request: Mapping[str, Any]) -> Any:
    """Looks at the robots of ROS 2."""
    # It fails where there is no ROS 2, which is an answer, too.
    from .ros2_doctor import doctor

    return doctor(request)


if __name__ == "__main__":
    sys.exit(serve_one(task))
