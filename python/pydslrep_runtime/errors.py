"""Errors while robots are driven."""


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
    ) -> None:
        """`number` is that of the action in its movement, from 1."""
        super().__init__(message)
        self.robot, self.movement, self.number = robot, movement, number
