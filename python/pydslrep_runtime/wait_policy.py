"""Waiting for a simulator that does not answer: it may be paused, or another client may hold the time."""

from .errors import SimulatorError
from .notes import Notes
from .remote_api import ask
from .settings import HOLD_LIMIT, PROBE_PERIOD, REPLY_TIMEOUT, SILENCE_LIMIT

STOPPED, PAUSED = 0, 8  # states of a simulation

HELD = "another client holds the simulation's time: it is in stepping mode and takes no step"


class WaitPolicy(Notes):
    """Decides whether to go on waiting, and says once why."""

    def __init__(self, address: str) -> None:
        """`address` is that of the simulator: host and port."""
        super().__init__()
        self._address = address
        self._excused = 0.0  # s of the call in which nobody held the time

    def wait(self, waited: float) -> None:
        """Returns to go on waiting after `waited` seconds without a reply; raises SimulatorError."""
        if waited < self._excused:  # it is another call
            self._excused = 0.0
        try:
            state = ask(self._address, "sim.getSimulationState", PROBE_PERIOD)
        except SimulatorError:
            state = None
        if state in (None, PAUSED):
            self._excused = waited
        if state is None:
            # CoppeliaSim 4.6 answers nobody while it is paused.
            self._limit(waited, SILENCE_LIMIT, f"no reply from {self._address}")
            self.say(
                f"{self._address} does not answer: the simulation may be paused; this script waits"
            )
        elif state == STOPPED:
            raise SimulatorError("the simulation was stopped")
        elif state == PAUSED:
            self.say_paused()
        else:
            held = waited - self._excused
            self._limit(
                held,
                HOLD_LIMIT,
                HELD,
                ". End that program, or stop the simulation and start this script again",
            )
            if held > REPLY_TIMEOUT / 2.0:
                self.say(f"{HELD}; this script waits up to {HOLD_LIMIT:g} s for it")

    @staticmethod
    def _limit(waited: float, limit: float, reason: str, advice: str = "") -> None:
        if waited > limit:
            raise SimulatorError(f"{reason}, for {limit:g} s{advice}")
