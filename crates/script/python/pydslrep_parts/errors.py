#: if standalone
"""Errors while a script runs."""
#: endif


class SetupError(Exception):
    """The simulator cannot be reached, or an object is missing from its scene."""


class SimulatorError(Exception):
    """The simulator did not reply, or replied with an error."""


#: if parallel
class MovementCancelledError(Exception):
    """Another robot's movement failed, so this one stops too."""


#: endif
class MovementError(Exception):
    """A robot could not complete its movement."""
