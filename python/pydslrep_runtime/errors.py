"""Errors while robots are driven."""


class SetupError(Exception):
    """A robot cannot be reached, or its simulator's scene lacks an object."""


class SimulatorError(Exception):
    """A simulator or a robot did not reply, or replied with an error."""


class MovementError(Exception):
    """A robot could not complete an action."""
