"""Errors while robots are driven."""

from .places import Call


class SetupError(Exception):
    """A robot cannot be reached, or its simulator's scene lacks an object."""


class SimulatorError(Exception):
    """A simulator or a robot did not reply, or replied with an error."""


class ReadingError(SimulatorError):
    """A simulator or a robot replied with what cannot be."""


class MovementError(Exception):
    """A robot could not complete an action."""

    def __init__(
        self,
        message: str,
        robot: str | None = None,
        movement: str | None = None,
        number: int | None = None,
        *,
        line: int | None = None,
        rounds: tuple[int, ...] = (),
        calls: tuple[Call, ...] = (),
    ) -> None:
        """`number` is that of the action in its movement, from 1; `line`, `rounds` and `calls` are as in `Place`."""
        super().__init__(message)
        self.robot, self.movement, self.number = robot, movement, number
        self.line, self.rounds, self.calls = line, rounds, calls
