"""The names of a robot's objects, where its scene file gives them paths of their own."""

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace

from ..answers import RefusalError
from .description import RobotDescription, SensorDescription, WheelDescription


def alias_of(name: str) -> str:
    """What CoppeliaSim makes of a name."""
    return re.sub(r"[^0-9A-Za-z_]", "_", name)


def named_as_objects(robot: RobotDescription) -> RobotDescription:
    """The same robot, but the names are those of its objects: scripts look for parts below their robot's body.

    Raises RefusalError if an object cannot have such a path.
    """
    body = robot.object or f"/{robot.name}"
    alias = _alias(body, above="")
    wheels = tuple(
        replace(wheel, name=_part_alias(wheel, body)) for wheel in robot.wheels
    )
    sensors = tuple(
        replace(sensor, name=_part_alias(sensor, body)) for sensor in robot.sensors
    )
    for parts in (wheels, sensors):
        _check_distinct(f"{body}/{part.name}" for part in parts)
    return replace(robot, name=alias, wheels=wheels, sensors=sensors)


def _part_alias(part: WheelDescription | SensorDescription, body: str) -> str:
    return _alias(part.object or f"{body}/{part.name}", above=body)


def _alias(path: str, *, above: str) -> str:
    """The alias of an object with a path, right below another one."""
    parent, _, alias = path.rpartition("/")
    if parent != above:
        where = f"right below `{above}`" if above else "at the top of the scene"
        raise RefusalError(
            f"the object `{path}` would not be {where}, where `scene push` builds it",
            "correct `object` in the scene file, or build the robot yourself",
        )
    if alias_of(alias) != alias:
        raise RefusalError(
            f"`{alias}` cannot be the alias of an object in CoppeliaSim",
            "use letters from a to z, digits and _ in the names of robots, wheels and sensors, and in `object`",
        )
    return alias


def _check_distinct(paths: Iterable[str]) -> None:
    twice = [path for path, count in Counter(paths).items() if count > 1]
    if twice:
        raise RefusalError(
            f"two parts of a robot are the object `{twice[0]}`",
            "correct `object` in the scene file",
        )
