#: if standalone
"""Movements: the actions of one robot."""

from collections.abc import Callable
from dataclasses import dataclass

from .robot import Robot

#: endif


@dataclass(frozen=True)
class Movement:
    """The actions of one robot."""

    name: str
    robot: str
    actions: Callable[[Robot], None]


def movement(name: str, of: str) -> Callable[[Callable[[Robot], None]], Movement]:
    """Turns a function into a movement of a robot."""
    return lambda actions: Movement(name, of, actions)
