"""Loops whose rounds messages, events and traces tell."""

from collections.abc import Awaitable, Callable, Iterator

from . import movements


class Repeat(Iterator[int]):
    """A number of rounds, from 1."""

    def __init__(
        self, robot: object, count: int, on_round: Callable[[], object]
    ) -> None:
        """`on_round` is called before each round."""
        self.robot, self.round = robot, 0
        self._count, self._done, self._on_round = count, 0, on_round

    def __next__(self) -> int:
        """The next round."""
        if self._done == 0:
            movements.current.get().add_loop(self)
        self.round = 0  # it is between two of them
        if self._done >= self._count:
            raise StopIteration
        self._on_round()
        self._done += 1
        self.round = self._done
        return self.round


class RepeatUntil:
    """Rounds from 1 until a function, which gets the number of those that are done, says that it is enough."""

    def __init__(
        self, robot: object, is_enough: Callable[[int], Awaitable[bool]]
    ) -> None:
        self.robot, self.round = robot, 0
        self._is_enough, self._done = is_enough, 0

    def __aiter__(self) -> "RepeatUntil":
        """Itself."""
        return self

    async def __anext__(self) -> int:
        """The next round."""
        if self._done == 0:
            movements.current.get().add_loop(self)
        self.round = 0  # it is between two of them
        if await self._is_enough(self._done):
            raise StopAsyncIteration
        self._done += 1
        self.round = self._done
        return self.round
