"""An event loop in which simulation time passes while all tasks wait.

Python's own selector loop, with one difference: when no task can run, its selector advances the simulation by one step
instead of waiting in real time. So `loop.time()`, `asyncio.sleep` and `asyncio.timeout` are in seconds of simulation
time, robots in parallel tasks take each step together, and nothing depends on the speed of the machine.
"""

import asyncio
import selectors
import time
from collections.abc import Callable, Iterable
from typing import NamedTuple

from .backend import Clock
from .errors import SimulatorError
from .readings import check_time
from .settings import STANDSTILL_LIMIT

MAX_CORRECTION = 100  # steps by which a clock may be put back


class Waiter(NamedTuple):
    """A robot that waits for its clock's next step."""

    clock: Clock
    order: int  # robots that wait for the same step act in this order
    wake_up: asyncio.Future[None]


class StepSelector(selectors.DefaultSelector):
    """Advances time when the event loop has nothing else to do."""

    def __init__(self, advance: Callable[[float | None], bool]) -> None:
        """`advance` gets the time until the next timer, and says whether time has passed."""
        super().__init__()
        self._advance = advance

    def select(
        self, timeout: float | None = None
    ) -> list[tuple[selectors.SelectorKey, int]]:
        """The events since the last call; only waits if there is no clock."""
        is_idle = timeout is None or timeout > 0.0
        return super().select(0.0 if is_idle and self._advance(timeout) else timeout)


class SimulationLoop(asyncio.SelectorEventLoop):
    """The event loop of a run."""

    def __init__(self) -> None:
        self._clock: Clock | None = None
        self._waiting: list[Waiter] = []
        self._times: dict[Clock, float] = {}  # the last one of each that was a time
        self._latest: dict[Clock, float] = {}
        self._passed: dict[Clock, float] = {}  # when time passed last, in real time
        super().__init__(StepSelector(self._advance))

    def time(self) -> float:
        """Seconds of simulation time, or of real time while there is no clock."""
        return super().time() if self._clock is None else self._time_of(self._clock)

    def use_clock(self, clock: Clock | None) -> None:
        """Sets the clock that `time` reads; without one, no clock advances any more."""
        self._clock = clock

    def has_advanced(self, clock: Clock) -> bool:
        """Whether a clock has taken a step in this run; before that, sensors have no readings."""
        return clock in self._passed

    async def next_step(self, clock: Clock, order: int) -> None:
        """Returns after the clock's next step; raises what its `advance` raises."""
        wake_up = self.create_future()
        self._waiting.append(Waiter(clock, order, wake_up))
        await wake_up

    def _advance(self, until_timer: float | None) -> bool:
        """Advances the clock whose next step comes first; False if there is none."""
        if self._clock is None:
            return False
        waiting = [waiter for waiter in self._waiting if not waiter.wake_up.done()]
        clocks = [waiter.clock for waiter in waiting]
        if until_timer is not None or not clocks:
            clocks.append(self._clock)
        clock = min(clocks, key=self._next_step_due)
        due = [waiter for waiter in waiting if waiter.clock is clock]
        self._waiting = [waiter for waiter in waiting if waiter.clock is not clock]
        try:
            self._take_step(clock)
        except Exception as error:
            if not due:
                raise
            fail(due, error)
        else:
            for waiter in in_order(due):
                waiter.wake_up.set_result(None)
        return True

    def _take_step(self, clock: Clock) -> None:
        """Advances a clock; raises SimulatorError if its time is none."""
        before, name = self._time_of(clock), type(clock).__name__
        self._times[clock] = before
        latest = self._latest.setdefault(clock, before)
        clock.advance()
        # A simulator's clock may find that it has counted steps which were not taken.
        check_time(f"{name}.time", latest, clock.time, MAX_CORRECTION * clock.time_step)
        self._times[clock] = clock.time
        self._latest[clock] = max(latest, clock.time)
        now = time.monotonic()
        if clock.time > latest:
            self._passed[clock] = now
        # A step may take no time now and then.
        elif now - self._passed.setdefault(clock, now) > STANDSTILL_LIMIT:
            raise SimulatorError(
                f"{name}.time stands still at {latest:g} s, although steps were taken for {STANDSTILL_LIMIT:g} s"
            )

    def _time_of(self, clock: Clock) -> float:
        return self._times.get(clock, clock.time)

    def _next_step_due(self, clock: Clock) -> float:
        """When a clock's next step ends, in its own time."""
        return self._time_of(clock) + clock.time_step


def in_order(waiters: Iterable[Waiter]) -> list[Waiter]:
    """The waiters in the order in which they act."""
    return sorted(waiters, key=lambda waiter: waiter.order)


def fail(waiters: Iterable[Waiter], error: Exception) -> None:
    """Wakes up waiters with an error."""
    for waiter in in_order(waiters):
        waiter.wake_up.set_exception(error)
