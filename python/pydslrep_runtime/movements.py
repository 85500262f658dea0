"""Movements: coroutines that drive robots, one after the other or in parallel."""

import asyncio
import functools
import inspect
import itertools
import sys
import weakref
from collections import Counter
from collections.abc import Callable, Coroutine
from contextvars import ContextVar
from types import CodeType, FrameType
from typing import Any, ParamSpec, Protocol, TypeVar, overload

from .places import Call, Place
from .statements import Statement, Table, statements_of

P = ParamSpec("P")
T = TypeVar("T")
Async = Callable[P, Coroutine[Any, Any, T]]

# The modules whose functions lie between a statement of a movement and an action of this package.
OWN = (__name__.partition(".")[0], "contextlib")


class Loop(Protocol):
    """The rounds of a loop."""

    robot: object
    round: int
    """The current one, from 1; 0 outside of any."""


class Movement:
    """One run of a movement; a second run of the same movement is another one."""

    def __init__(
        self,
        name: str,
        code: CodeType | None = None,
        caller: "Movement | None" = None,
        call: Statement | None = None,
    ) -> None:
        """`code` is that of its function; `caller` does it, by a statement of its own."""
        self.name, self.caller, self.call = name, caller, call
        self._code = code
        self._robot: object = None  # that it drives
        self._counts: Counter[object] = Counter()  # of actions so far, by robot
        # Weak: only the code that runs a loop holds it, so it is gone when that code ends for any reason.
        self._loops: list[weakref.ref[Loop]] = []

    def called_by(self, frame: FrameType | None) -> bool:
        """Whether its function runs in a frame."""
        return frame is not None and frame.f_code is self._code

    def statement(
        self, frame: FrameType | None, robot: object = None, *, counts: bool = True
    ) -> Statement:
        """The statement that a frame is at.

        Where there is no source, or a function of somebody else's in between, it is counted as it happens, if it counts
        then; else it is the one that would come next.
        """
        if counts:
            self._counts[robot] += 1
        if self.called_by(frame) and frame is not None:
            found = self._table().get(frame.f_lineno)
            if found is not None:
                return found
        # A statement that does a movement is none of a robot's own.
        actions = Counter(self._counts)
        calls = actions.pop(None, 0)
        counted = max(actions.values(), default=0) if robot is None else actions[robot]
        return Statement(calls + counted + (0 if counts else 1), None)

    def chain(self, robot: object) -> list["Movement"]:
        """The movements of a robot that lead here, outermost first: one of another robot's does not do this one."""
        chain, movement = [self], self
        while (caller := movement.caller) and caller._robot in (None, robot):
            chain.append(movement := caller)
        for movement in chain:
            movement._robot = movement._robot or robot
        return chain[::-1]

    def add_loop(self, loop: Loop) -> None:
        """A loop has begun."""
        self._loops = [each for each in self._loops if each() is not None]
        self._loops.append(weakref.ref(loop))

    def rounds(self, robot: object) -> list[int]:
        """The rounds of the loops that it is in, outermost first."""
        loops = (each() for each in self._loops)
        return [
            loop.round
            for loop in loops
            if loop is not None and loop.robot is robot and loop.round
        ]

    def _table(self) -> Table:
        table = None if self._code is None else statements_of(self._code)
        return {} if table is None else table


current: ContextVar[Movement] = ContextVar("movement")
"""The movement that the current task runs. Its name is in messages and traces."""


def place_of(robot: object, *, is_action: bool = True) -> Place:
    """Where in the program a robot is that begins an action now, or reads the condition of a statement."""
    movement = current.get()
    frame: FrameType | None = sys._getframe(1)
    while frame is not None and _is_own(frame):
        frame = frame.f_back
    statement = movement.statement(frame, robot, counts=is_action)
    chain = movement.chain(robot)
    calls = [
        Call(caller.name, done.call.number)
        for caller, done in itertools.pairwise(chain)
        if done.call is not None
    ]
    return Place(
        chain[0].name,
        statement.number,
        statement.line,
        tuple(number for each in chain for number in each.rounds(robot)),
        tuple(calls),
        movement.name if calls else "",
    )


def _is_own(frame: FrameType) -> bool:
    return str(frame.f_globals.get("__name__", "")).partition(".")[0] in OWN


@overload
def movement(function: Async[P, T]) -> Async[P, T]: ...


@overload
def movement(*, name: str) -> Callable[[Async[P, T]], Async[P, T]]: ...


def movement(
    function: Async[P, T] | None = None, *, name: str | None = None
) -> Async[P, T] | Callable[[Async[P, T]], Async[P, T]]:
    """Makes a coroutine function a movement: `@movement`, or `@movement(name="...")`.

    Messages and traces have the function's name unless another is given. A movement that awaits another one of the same
    robot does it: messages then have the name of the first one, and the way from there.
    """

    def decorate(function: Async[P, T]) -> Async[P, T]:
        own_name = name or function.__name__
        code = getattr(inspect.unwrap(function), "__code__", None)

        @functools.wraps(function)
        async def run(*args: P.args, **kwargs: P.kwargs) -> T:
            before, frame = current.get(), sys._getframe(1)
            new = Movement(own_name, code)
            if before.called_by(frame):
                new.caller, new.call = before, before.statement(frame)
            current.set(new)
            try:
                return await function(*args, **kwargs)
            finally:
                current.set(before)

        return run

    return decorate if function is None else decorate(function)


async def parallel(*movements: Coroutine[Any, Any, object]) -> None:
    """Runs movements at the same time, until all have ended.

    If one fails, the others stop, and the error of the first that failed is raised.
    """
    try:
        async with asyncio.TaskGroup() as group:
            for each in movements:
                group.create_task(each)
    except BaseExceptionGroup as failures:
        raise failures.exceptions[0] from None
