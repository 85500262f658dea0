"""A scene as data: what `pydslrep` passes to this package as JSON, and what it gets back.

Metres, radians and seconds; x ahead, y to the left, headings counter-clockwise from x.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

from ..facts import TypeName
from ..pose import Pose

Point = tuple[float, float]


@dataclass(frozen=True)
class WheelDescription:
    """A driven wheel and its joint."""

    name: str
    radius: float
    x: float  # of its joint, on the robot's body
    y: float
    mirrored: bool = False  # whether the joint's axis points to the right
    object: str | None = None  # the path of its joint; None: by its name


@dataclass(frozen=True)
class SensorDescription:
    """A proximity sensor."""

    name: str
    kind: Literal["distance", "bumper"]
    x: float  # on the robot's body
    y: float
    bearing: float  # where it faces
    range: float
    cone: float  # opening angle
    object: str | None = None  # its path; None: by its name


@dataclass(frozen=True)
class RobotDescription:
    """A robot: a rectangular body, whose centre is that of the wheels."""

    name: str
    type: TypeName
    x: float  # of its start
    y: float
    heading: float
    length: float
    width: float
    grip: float  # friction of wheels across their rolling direction, as a share of that along it
    rim_speed: float | None  # the greatest; None: no limit
    rim_acceleration: float  # the greatest
    wheels: tuple[WheelDescription, ...]  # in the order of the drive
    sensors: tuple[SensorDescription, ...] = ()
    object: str | None = None  # the path of its body; None: by its name

    @property
    def start(self) -> Pose:
        """The pose of the body's centre at the start."""
        return Pose(self.x, self.y, self.heading)


@dataclass(frozen=True)
class ObstacleDescription:
    """An obstacle: a box, a cylinder or a polygon, where it is at the start."""

    name: str
    x: float
    y: float
    heading: float
    size: Point | None = None  # of a box: length and width
    radius: float | None = None  # of a cylinder
    corners: tuple[Point, ...] = ()  # of a polygon, in its own frame
    triangles: tuple[tuple[Point, ...], ...] = ()  # which the polygon consists of
    moves: bool = False  # in the embedded simulator


@dataclass(frozen=True)
class SceneDescription:
    """Everything that an environment and its scene file say about the world."""

    environment: str
    robots: tuple[RobotDescription, ...]
    obstacles: tuple[ObstacleDescription, ...] = ()
    # The least and the greatest coordinates that robots may get to; none if that is unknown.
    reach: tuple[Point, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """The opposite of `read_scene`."""
        return asdict(self)


def read_scene(json: Mapping[str, Any]) -> SceneDescription:
    """A scene from decoded JSON; raises KeyError and TypeError if it is another one."""
    return SceneDescription(
        json["environment"],
        tuple(_robot(robot) for robot in json["robots"]),
        tuple(_obstacle(obstacle) for obstacle in json["obstacles"]),
        _points(json.get("reach", ())),
    )


def _robot(json: Mapping[str, Any]) -> RobotDescription:
    wheels = tuple(WheelDescription(**wheel) for wheel in json["wheels"])
    sensors = tuple(SensorDescription(**sensor) for sensor in json["sensors"])
    return RobotDescription(**{**json, "wheels": wheels, "sensors": sensors})


def _obstacle(json: Mapping[str, Any]) -> ObstacleDescription:
    size = json.get("size")
    triangles = tuple(_points(corners) for corners in json.get("triangles", ()))
    return ObstacleDescription(
        **{
            **json,
            "size": _points([size])[0] if size else None,
            "corners": _points(json.get("corners", ())),
            "triangles": triangles,
        }
    )


def _points(json: Sequence[Sequence[float]]) -> tuple[Point, ...]:
    return tuple((x, y) for x, y in json)
