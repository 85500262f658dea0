"""Where the parts of a robot are in a scene: the paths that are tried, and the objects there."""

from collections.abc import Iterator, Sequence

from ..backend import RobotSpec
from ..errors import ReadingError
from ..readings import MAX_NAMESAKES
from ..remote_api import Connection


def robot_paths(spec: RobotSpec) -> Sequence[str]:
    """The paths of a robot's body, the most likely first."""
    return spec.objects.get(spec.name) or (f"/{spec.name}",)


def part_paths(spec: RobotSpec, part: str) -> Sequence[str]:
    """The paths of a robot's wheel or sensor, the most likely first."""
    body = robot_paths(spec)[0]
    return spec.objects.get(part) or (f"{body}/{part}", f"/{part}_{spec.name}")


def objects_at(connection: Connection, path: str) -> Iterator[int]:
    """All objects with a path: a wheel and a sensor may share one. Raises SimulatorError."""
    found: set[int] = set()
    while len(found) < MAX_NAMESAKES:
        options = {"noError": True, "index": len(found)}
        handle: int = connection.call(connection.sim.getObject, path, options)
        if handle < 0 or handle in found:
            return
        found.add(handle)
        yield handle
    raise ReadingError(f"the scene has more than {MAX_NAMESAKES} objects {path}")
