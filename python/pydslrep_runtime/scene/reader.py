"""What the checks read from a simulator's scene."""

from collections.abc import Iterable, Sequence
from typing import Any

from ..errors import ReadingError, SimulatorError
from ..readings import MAX_DEPTH
from ..remote_api import Connection
from .lookup import objects_at

# The names of CoppeliaSim's types of objects; the last word of its constants.
KINDS = (
    "shape",
    "joint",
    "graph",
    "camera",
    "dummy",
    "proximitysensor",
    "visionsensor",
    "forcesensor",
    "light",
    "script",
)
READABLE = {
    "proximitysensor": "proximity sensor",
    "visionsensor": "vision sensor",
    "forcesensor": "force sensor",
}
SIMILAR = 0.02  # by which the diameters of a round shape differ, at most


class SceneReader:
    """Objects of a scene by their handles; every method raises SimulatorError."""

    def __init__(self, connection: Connection) -> None:
        self.connection = connection
        self._sim = connection.sim
        self._parents: dict[int, int] = {}  # as far as they have been read
        self._objects_below: dict[int, int] = {}  # in the longest branch
        types = {
            getattr(self._sim, f"object_{kind}_type", None): kind for kind in KINDS
        }
        self._kinds = {
            number: READABLE.get(kind, kind) for number, kind in types.items()
        }

    def call(self, function: str, *arguments: Any) -> Any:
        """Calls a function of the simulator."""
        return self.connection.call(self.constant(function), *arguments)

    def constant(self, name: str) -> Any:
        """A constant or function of the simulator."""
        value = getattr(self._sim, name, None)
        if value is None:
            raise SimulatorError(
                f"the simulator at {self.connection.address} has no sim.{name}"
            )
        return value

    def name_of(self, value: int, pattern: str, names: Iterable[str]) -> str:
        """Which of some constants has a value."""
        for name in names:
            if getattr(self._sim, pattern.format(name), None) == value:
                return name
        return "unknown"

    def at(self, path: str) -> list[int]:
        """All objects with a path."""
        return list(objects_at(self.connection, path))

    def path(self, handle: int) -> str:
        """An object's full path."""
        path: str = self.call("getObjectAlias", handle, 2)
        return path

    def kind(self, handle: int) -> str:
        """An object's type, such as "proximity sensor"."""
        return self._kinds.get(
            self.call("getObjectType", handle), "object of another type"
        )

    def parent(self, handle: int) -> int | None:
        """The object above; raises SimulatorError if the objects above are no line."""
        parent: int = self.call("getObjectParent", handle)
        self._parents[handle] = parent
        if parent < 0:
            return None
        below = self._objects_below.get(handle, 0) + 1
        self._objects_below[parent] = max(below, self._objects_below.get(parent, 0))
        above: int | None = parent
        for _ in range(MAX_DEPTH - below):
            if above is None:
                return parent
            if above == handle:
                raise ReadingError(f"object {handle} of the scene is its own ancestor")
            above = self._parents.get(above)
        raise ReadingError(
            f"object {handle} of the scene is in a branch of more than {MAX_DEPTH} objects"
        )

    def below(self, handle: int) -> Sequence[int]:
        """All objects below."""
        # A list without elements is an empty map.
        return list(
            self.call("getObjectsInTree", handle, self.constant("handle_all"), 1)
        )

    def matrix(self, handle: int) -> Sequence[float]:
        """An object's matrix: rows of rotation and translation."""
        matrix: Sequence[float] = self.call("getObjectMatrix", handle)
        return matrix

    def integer(self, handle: int, parameter: str) -> int:
        """An object's parameter."""
        value: int = self.call("getObjectInt32Param", handle, self.constant(parameter))
        return value

    def number(self, handle: int, parameter: str) -> float:
        """An object's parameter."""
        value: float = self.call(
            "getObjectFloatParam", handle, self.constant(parameter)
        )
        return value

    def is_static(self, shape: int) -> bool:
        """Whether physics does not move a shape."""
        return self.integer(shape, "shapeintparam_static") != 0

    def is_respondable(self, shape: int) -> bool:
        """Whether a shape collides with others."""
        return self.integer(shape, "shapeintparam_respondable") != 0

    def mass(self, shape: int) -> float:
        """A shape's mass in kilograms."""
        return self.number(shape, "shapefloatparam_mass")

    def joint_mode(self, joint: int) -> int:
        """A joint's mode; old versions return its options, too."""
        mode = self.call("getJointMode", joint)
        return int(mode if isinstance(mode, int) else mode[0])

    def shapes(self) -> Sequence[int]:
        """All shapes of the scene."""
        scene = self.constant("handle_scene")
        # A list without elements is an empty map.
        return list(
            self.call("getObjectsInTree", scene, self.constant("object_shape_type"), 0)
        )

    def size(self, shape: int) -> Sequence[float]:
        """The lengths of the edges of a shape's bounding box in metres; those of primitives are along its axes."""
        return [
            self.number(shape, f"objfloatparam_objbbox_max_{axis}")
            - self.number(shape, f"objfloatparam_objbbox_min_{axis}")
            for axis in "xyz"
        ]

    def radius(self, shape: int) -> float | None:
        """The radius of a round shape in metres, by its bounding box; None if it is not round."""
        size = sorted(self.size(shape))
        pairs = [(size[0], size[1]), (size[1], size[2])]
        smaller, larger = min(pairs, key=lambda pair: pair[1] - pair[0])
        is_round = larger - smaller <= SIMILAR * larger
        return (smaller + larger) / 4.0 if is_round else None
