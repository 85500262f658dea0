"""Movements: coroutines that drive robots, one after the other or in parallel."""

import asyncio
import functools
from collections.abc import Callable, Coroutine
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any, ParamSpec, TypeVar, overload

P = ParamSpec("P")
T = TypeVar("T")
Async = Callable[P, Coroutine[Any, Any, T]]


@dataclass(frozen=True, eq=False)
class Movement:
    """One run of a movement; a second run of the same movement is another one."""

    name: str


current: ContextVar[Movement] = ContextVar("movement")
"""The movement that the current task runs. Its name is in messages and traces."""


@overload
def movement(function: Async[P, T]) -> Async[P, T]: ...


@overload
def movement(*, name: str) -> Callable[[Async[P, T]], Async[P, T]]: ...


def movement(
    function: Async[P, T] | None = None, *, name: str | None = None
) -> Async[P, T] | Callable[[Async[P, T]], Async[P, T]]:
    """Makes a coroutine function a movement: `@movement`, or `@movement(name="...")`.

    Messages and traces have the function's name unless another is given.
    """

    def decorate(function: Async[P, T]) -> Async[P, T]:
        own_name = name or function.__name__

        @functools.wraps(function)
        async def run(*args: P.args, **kwargs: P.kwargs) -> T:
            before = current.get()
            current.set(Movement(own_name))
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
