#: if standalone
"""What ties actions to a movement of a robot."""

from collections.abc import Callable
from dataclasses import dataclass

from .robot import Robot

#: endif


@dataclass(frozen=True)
class Movement:
    """Actions of one robot."""

    name: str
    robot: str
    actions: Callable[[Robot], None]


def movement(name: str, of: str) -> Callable[[Callable[[Robot], None]], Movement]:
    """Makes a function a movement of a robot."""
    return lambda actions: Movement(name, of, actions)
