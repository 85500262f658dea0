"""Time in the event loop: clocks advance when all tasks wait, in the order of their next steps."""

import asyncio
import os
import threading
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field
from typing import Any

import pytest
from pydslrep_runtime.errors import SimulatorError
from pydslrep_runtime.event_loop import SimulationLoop


@dataclass(eq=False)
class Clock:
    """A clock that notes its steps."""

    name: str
    time_step: float
    log: list[str]
    time: float = 0.0
    error: Exception | None = field(default=None)

    def advance(self) -> None:
        """Takes a step."""
        if self.error:
            raise self.error
        self.time += self.time_step
        self.log.append(f"{self.name} {self.time:g}")


def run(
    main: Callable[[SimulationLoop], Coroutine[Any, Any, None]], *clocks: Clock
) -> None:
    """Runs a coroutine in a loop that reads the first clock."""
    loop = SimulationLoop()
    with asyncio.Runner(loop_factory=lambda: loop) as runner:
        loop.use_clock(clocks[0] if clocks else None)
        try:
            runner.run(main(loop))
        finally:
            loop.use_clock(None)


def test_waiters_of_one_step_act_in_their_order() -> None:
    log: list[str] = []
    clock = Clock("clock", 0.5, log)

    async def main(loop: SimulationLoop) -> None:
        async def act(order: int) -> None:
            for _ in range(2):
                await loop.next_step(clock, order)
                log.append(f"robot {order}")

        await asyncio.gather(act(2), act(0), act(1))

    run(main, clock)
    robots = ["robot 0", "robot 1", "robot 2"]
    assert log == ["clock 0.5", *robots, "clock 1", *robots]


def test_no_time_passes_while_a_task_can_run() -> None:
    clock = Clock("clock", 0.5, [])

    async def main(loop: SimulationLoop) -> None:
        async def busy() -> None:
            for _ in range(100):
                await asyncio.sleep(0)
            assert clock.time == 0.0

        await asyncio.gather(loop.next_step(clock, 0), busy())

    run(main, clock)
    assert clock.time == 0.5


def test_the_clock_whose_step_is_due_first_advances() -> None:
    log: list[str] = []
    slow, fast = Clock("slow", 0.5, log), Clock("fast", 0.2, log)

    async def main(loop: SimulationLoop) -> None:
        async def steps(clock: Clock, count: int) -> None:
            for _ in range(count):
                await loop.next_step(clock, 0)

        await asyncio.gather(steps(slow, 1), steps(fast, 4))

    run(main, slow, fast)
    assert log == ["fast 0.2", "fast 0.4", "slow 0.5", "fast 0.6", "fast 0.8"]


def test_a_clock_that_nobody_waits_for_stands_still() -> None:
    log: list[str] = []
    idle, busy = Clock("idle", 0.1, log), Clock("busy", 0.5, log)

    async def main(loop: SimulationLoop) -> None:
        await loop.next_step(busy, 0)

    run(main, idle, busy)
    assert log == ["busy 0.5"]


def test_an_error_of_a_clock_reaches_those_who_wait_for_it() -> None:
    clock = Clock("clock", 0.5, [], error=SimulatorError("gone"))

    async def main(loop: SimulationLoop) -> None:
        results = await asyncio.gather(
            loop.next_step(clock, 0), loop.next_step(clock, 1), return_exceptions=True
        )
        assert tuple(results) == (clock.error, clock.error)
        with pytest.raises(SimulatorError):
            await loop.next_step(clock, 0)

    run(main, clock)


def test_an_error_that_nobody_waits_for_ends_the_run() -> None:
    clock = Clock("clock", 0.5, [], error=SimulatorError("gone"))

    async def main(_loop: SimulationLoop) -> None:
        await asyncio.sleep(1.0)

    with pytest.raises(SimulatorError, match="gone"):
        run(main, clock)


def test_other_threads_are_heard() -> None:
    clock = Clock("clock", 0.5, [])

    async def main(loop: SimulationLoop) -> None:
        assert await loop.run_in_executor(None, lambda: 7) == 7

    run(main, clock)


def test_without_a_clock_time_is_real() -> None:
    async def main(loop: SimulationLoop) -> None:
        before = loop.time()
        await asyncio.sleep(0.001)
        assert loop.time() - before >= 0.001

    run(main)


def test_cancelled_waiters_are_forgotten() -> None:
    log: list[str] = []
    first, other = Clock("first", 0.5, log), Clock("other", 0.1, log)

    async def main(loop: SimulationLoop) -> None:
        waiting = asyncio.create_task(loop.next_step(other, 0))
        await asyncio.sleep(0)
        waiting.cancel()
        await loop.next_step(first, 1)

    run(main, first, other)
    assert log == ["first 0.5"]


async def steps_alone(loop: SimulationLoop, clock: Clock, count: int) -> None:
    """Takes steps."""
    for _ in range(count):
        await loop.next_step(clock, 0)


def test_a_task_that_is_alone_steps_at_once_but_now_and_then(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, done = Clock("clock", 0.5, []), []

    async def main(loop: SimulationLoop) -> None:
        step_at_once = loop.step_at_once

        def counted(clock: Any) -> bool:
            done.append(step_at_once(clock))
            return done[-1]

        monkeypatch.setattr(loop, "step_at_once", counted)
        await steps_alone(loop, clock, 80)

    run(main, clock)
    assert (len(done), sum(done)) == (80, 70)
    assert clock.time == 40.0


def test_who_steps_at_once_does_not_overtake_others() -> None:
    log: list[str] = []
    clock = Clock("clock", 0.5, log)

    async def main(loop: SimulationLoop) -> None:
        async def act(name: str) -> None:
            for _ in range(20):
                await steps_alone(loop, clock, 1)
                log.append(name)

        await asyncio.gather(act("a"), act("b"))

    run(main, clock)
    assert log[1::3] == ["a"] * 20
    assert log[2::3] == ["b"] * 20


def test_who_steps_at_once_meets_timers_in_time() -> None:
    clock = Clock("clock", 0.5, [])

    async def main(loop: SimulationLoop) -> None:
        rung: list[float] = []
        loop.call_later(2.25, lambda: rung.append(clock.time))
        await steps_alone(loop, clock, 20)
        assert rung == [2.5]
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(3.0):
                await steps_alone(loop, clock, 20)
        assert clock.time == 13.0

    run(main, clock)


def test_who_steps_at_once_hears_other_threads_and_files() -> None:
    clock = Clock("clock", 0.5, [])

    async def main(loop: SimulationLoop) -> None:
        heard: list[str] = []
        thread = threading.Thread(
            target=loop.call_soon_threadsafe, args=(heard.append, "thread")
        )
        thread.start()
        thread.join()
        await steps_alone(loop, clock, 1)
        assert heard == ["thread"]
        reader, writer = os.pipe()
        loop.add_reader(reader, lambda: heard.append(os.read(reader, 10).decode()))
        os.write(writer, b"file")
        await steps_alone(loop, clock, 2)
        assert heard == ["thread", "file"]
        loop.remove_reader(reader)
        os.close(reader)
        os.close(writer)

    run(main, clock)


def test_an_error_of_a_clock_reaches_who_steps_at_once() -> None:
    clock = Clock("clock", 0.5, [], error=SimulatorError("gone"))

    async def main(loop: SimulationLoop) -> None:
        for _ in range(10):
            with pytest.raises(SimulatorError, match="gone"):
                await steps_alone(loop, clock, 1)

    run(main, clock)


def test_who_steps_at_once_can_be_cancelled() -> None:
    clock = Clock("clock", 0.5, [])

    async def main(loop: SimulationLoop) -> None:
        task = asyncio.current_task()
        assert task is not None
        loop.call_soon(task.cancel)
        with pytest.raises(asyncio.CancelledError):
            await steps_alone(loop, clock, 100)
        assert clock.time <= 1.0

    run(main, clock)
