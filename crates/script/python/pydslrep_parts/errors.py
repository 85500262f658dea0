#: if standalone
"""What can go wrong while a script runs."""
#: endif


class SetupError(Exception):
    """The simulator cannot be reached, or its scene lacks something."""


class SimulatorError(Exception):
    """The simulator did not answer, or answered with an error."""


#: if parallel
class MovementCancelledError(Exception):
    """Another robot's movement failed, so this one stops as well."""


#: endif
class MovementError(Exception):
    """A robot could not do what its movement asks for."""
