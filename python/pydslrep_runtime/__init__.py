"""Drives mobile robots in CoppeliaSim, in V-REP, or in the real world.

Scripts that PyDSLRep generates import this package, and it can be used by hand:

    from pydslrep_runtime import TwoWheelRobot, run

    rover = TwoWheelRobot("rover", port=23000, left=("wheelL", 0.045), right=("wheelR", 0.045))

    async def square() -> None:
        for _ in range(4):
            await rover.move(0.5)  # metres
            await rover.turn(90)  # degrees to the left

    run(square, robots=[rover])

A `Robot` has further actions; `detects` and `clear` make conditions that end them, and that loops and `if` ask.

Lengths are in metres and times in seconds. Angles are in radians, counter-clockwise seen from above, except in `turn`,
which has degrees as programs have them. Wheel rates are in rad/s, forward if positive.
"""

import sys

if sys.version_info < (3, 11):  # noqa: UP036 (the check is for those who have an older one)
    print("error: pydslrep_runtime needs Python 3.11 or later", file=sys.stderr)
    raise SystemExit(2)

from .backend import Backend, Clock, RealTimeClock, RobotSpec, SensorCone
from .conditions import Condition, clear, detects
from .errors import MovementError, SetupError, SimulatorError
from .movements import movement, parallel
from .pose import Pose
from .robots import FourWheelRobot, MecanumRobot, Robot, TwoWheelRobot
from .runner import run
from .version import __version__

__all__ = [
    "Backend",
    "Clock",
    "Condition",
    "FourWheelRobot",
    "MecanumRobot",
    "MovementError",
    "Pose",
    "RealTimeClock",
    "Robot",
    "RobotSpec",
    "SensorCone",
    "SetupError",
    "SimulatorError",
    "TwoWheelRobot",
    "__version__",
    "clear",
    "detects",
    "movement",
    "parallel",
    "run",
]
