"""An event loop in which simulation time passes while all tasks wait.

Python's own selector loop, with one difference: when no task can run, its selector advances the simulation by one step
instead of waiting in real time. So `loop.time()`, `asyncio.sleep` and `asyncio.timeout` are in seconds of simulation
time, robots in parallel tasks take each step together, and nothing depends on the speed of the machine.
"""

import asyncio
import selectors
import time
from collections.abc import Callable
from operator import attrgetter
from typing import NamedTuple

from .backend import Clock
from .errors import SimulatorError
from .readings import check_time
from .settings import STANDSTILL_LIMIT

MAX_CORRECTION = 100  # steps by which a clock may be put back
USUAL_GAP = 1.0  # s of a step that needs no further look
STEPS_PER_TURN = 8  # of a task that is alone, after which the loop has its turn
OWN_FILES = 1  # that the loop listens to: it wakes itself up by a pipe


class Waiter(NamedTuple):
    """A robot that waits for its clock's next step."""

    order: int  # robots that wait for the same step act in this order
    wake_up: asyncio.Future[None]


class Ticker:
    """A clock, and what is known of it."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.time = self.latest = clock.time  # the last ones that were times
        self.waiting: list[Waiter] = []
        self.passed: float | None = None  # when time passed last, in real time
        self._name = f"{type(clock).__name__}.time"

    def advance(self) -> None:
        """Takes a step; raises SimulatorError if its time is none."""
        clock, latest = self.clock, self.latest
        clock.advance()
        now = clock.time
        if type(now) is not float or not latest <= now <= latest + USUAL_GAP:
            # A simulator's clock may find that it has counted steps which were not taken.
            check_time(self._name, latest, now, MAX_CORRECTION * clock.time_step)
        self.time = now
        real = time.monotonic()
        if now > latest:
            self.latest, self.passed = now, real
        elif self.passed is None:
            self.passed = real
        # A step may take no time now and then.
        elif real - self.passed > STANDSTILL_LIMIT:
            raise SimulatorError(
                f"{self._name} stands still at {latest:g} s, although steps were taken for {STANDSTILL_LIMIT:g} s"
            )

    def next_step_due(self) -> float:
        """When its next step ends, in its own time."""
        return self.time + self.clock.time_step


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
        self._ticker: Ticker | None = None  # whose time it is
        self._tickers: dict[int, Ticker] = {}
        self._turn = 0  # steps since the loop has looked for wake-ups
        selector = StepSelector(self._advance)
        super().__init__(selector)
        self._files = selector.get_map()

    def time(self) -> float:
        """Seconds of simulation time, or of real time while there is no clock."""
        ticker = self._ticker
        return super().time() if ticker is None else ticker.time

    def use_clock(self, clock: Clock | None) -> None:
        """Sets the clock that `time` reads; without one, no clock advances any more."""
        self._ticker = None if clock is None else self._ticker_of(clock)

    def has_advanced(self, clock: Clock) -> bool:
        """Whether a clock has taken a step in this run; before that, sensors have no readings."""
        return self._ticker_of(clock).passed is not None

    def step_at_once(self, clock: Clock) -> bool:
        """Takes a clock's next step if nobody else could act before it; raises what its `advance` raises.

        It spares a task that is alone the way through the loop, which takes as long as the control of a robot.
        """
        ticker = self._ticker
        self._turn = (self._turn + 1) % STEPS_PER_TURN
        if (
            self._turn == 0
            or ticker is None
            or ticker.clock is not clock
            or ticker.waiting
            or len(self._tickers) > 1
            # What can run and which timers there are, only asyncio knows; if it calls them otherwise, all steps go through it.
            or getattr(self, "_ready", True)
            or getattr(self, "_scheduled", True)
            or len(self._files) > OWN_FILES
        ):
            return False
        ticker.advance()
        return True

    async def next_step(self, clock: Clock, order: int) -> None:
        """Returns after the clock's next step; raises what its `advance` raises."""
        if self.step_at_once(clock):
            return
        wake_up: asyncio.Future[None] = asyncio.Future(loop=self)
        self._ticker_of(clock).waiting.append(Waiter(order, wake_up))
        await wake_up

    def _ticker_of(self, clock: Clock) -> Ticker:
        ticker = self._tickers.get(id(clock))
        if ticker is None:
            ticker = self._tickers[id(clock)] = Ticker(clock)
        return ticker

    def _advance(self, until_timer: float | None) -> bool:
        """Advances the clock whose next step comes first; False if there is none."""
        ticker = self._ticker
        if ticker is None:
            return False
        if len(self._tickers) > 1:
            ticker = self._first(until_timer, ticker)
        due, ticker.waiting = in_order(ticker.waiting), []
        try:
            ticker.advance()
        except Exception as error:
            if not due:
                raise
            for waiter in due:
                waiter.wake_up.set_exception(error)
        else:
            for waiter in due:
                waiter.wake_up.set_result(None)
        return True

    def _first(self, until_timer: float | None, own: Ticker) -> Ticker:
        """The clock whose next step comes first, of those that somebody waits for."""
        tickers = [
            ticker for ticker in self._tickers.values() if in_order(ticker.waiting)
        ]
        if until_timer is not None or not tickers:
            tickers.append(own)
        return min(tickers, key=Ticker.next_step_due)


def in_order(waiters: list[Waiter]) -> list[Waiter]:
    """The waiters that have not been cancelled, in the order in which they act."""
    left = [waiter for waiter in waiters if not waiter.wake_up.done()]
    if len(left) > 1:
        left.sort(key=order_of)
    return left


order_of = attrgetter("order")
