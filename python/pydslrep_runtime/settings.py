"""Tolerances and timeouts; speeds are in `facts`, which the command shares."""

import math
import os
from contextlib import suppress

# Shorter limits for tests: `REPLY_TIMEOUT=0.5,HOLD_LIMIT=2`.
TIME_LIMITS = os.environ.get("PYDSLREP_TIME_LIMITS", "")


def limit(name: str, seconds: float) -> float:
    """A limit on waiting, which the environment may change."""
    for each in TIME_LIMITS.split(","):
        key, _, value = each.partition("=")
        if key == name:
            with suppress(ValueError):
                return float(value)
    return seconds


ARRIVAL_TOLERANCE = 0.0001  # m at the rim within which an action is complete
CLOSE_TOLERANCE = (
    0.001  # m at the rim within which it is complete if the robot comes no nearer
)
# An action that comes no nearer is complete within these, and fails outside of them.
END_DISTANCE = 0.005  # m
END_ANGLE = math.radians(0.5)
STALL_TIME = 5.0  # s of simulation time without progress before an action fails
MAX_DEFLECTION = (
    0.05  # m to the side of its line, or off its spot, above which a move or turn fails
)
CONNECT_TIMEOUT = limit(
    "CONNECT_TIMEOUT", 5.0
)  # s to wait for the simulator's first reply
REPLY_TIMEOUT = limit("REPLY_TIMEOUT", 10.0)  # s to wait for any later reply
STOP_TIMEOUT = limit(
    "STOP_TIMEOUT", 1.0
)  # s to wait for a reply while stopping after an error
CLIENT_TIMEOUT = 30.0  # s of silence after which the simulator forgets this client
PROBE_PERIOD = limit(
    "PROBE_PERIOD", 2.0
)  # s without a reply after which the simulator is asked why
HOLD_LIMIT = limit(
    "HOLD_LIMIT", 40.0
)  # s to wait for another client that holds the time; longer than the timeout of a killed script
SILENCE_LIMIT = limit(
    "SILENCE_LIMIT", 600.0
)  # s to wait for a simulator that answers nothing, perhaps because it is paused
STANDSTILL_LIMIT = limit("STANDSTILL_LIMIT", 10.0)  # s during which steps take no time
STANDSTILL_CHECKS = 10  # comparisons with the simulator's time that find it unchanged
MAX_DISTANCE = 100.0  # m after which a move fails that ends by a condition only
MAX_TURN = 360.0  # degrees after which such a turn or arc fails
MAX_WAIT = 600.0  # s of simulation time after which such a wait fails
MAX_ROUNDS = 10_000  # after which a loop fails whose condition has never held
MAX_IDLE_ACTIONS = (
    10_000  # and conditions at one time, after which the next one takes a step
)
MAX_IDLE_ROUNDS = 1_000_000  # at one time, after which a loop fails
MAX_READING_AGE = 0.5  # s of simulation time that the reading of a condition may be old
END_LIMIT = limit("END_LIMIT", 15.0)  # s for the end of a run that was interrupted
