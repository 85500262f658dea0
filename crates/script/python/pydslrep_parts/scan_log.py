#: if standalone
"""A log of all observations, to rebuild the occupancy grid when keyframes move."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .occupancy_grid import OccupancyGrid, Position, Reading
from .pose import Pose, wrap_angle

#: endif


@dataclass(frozen=True)
class Observation:
    """The readings taken at one moment, in the robot's frame."""

    readings: Sequence[Reading]
    obstacle: Position | None = None  # that stopped the robot


@dataclass(frozen=True)
class LogEntry:
    """An observation between two keyframes, with the robot's pose relative to each."""

    observation: Observation
    from_start: Pose
    from_end: Pose
    fraction: float  # of the leg that was complete


class ScanLog:
    """The observations between keyframes, by leg.

    Poses between two keyframes are interpolated from both, which spreads the odometry's
    error over the leg.
    """

    def __init__(self) -> None:
        self._legs: list[list[LogEntry]] = []
        # Since the last keyframe, relative to it.
        self._open_leg: list[tuple[Pose, Observation]] = []
        self._keyframe = Pose(0.0, 0.0, 0.0)  # the last one

    def add(self, here: Pose, observation: Observation) -> None:
        """Adds an observation at the estimated pose."""
        self._open_leg.append((here.relative_to(self._keyframe), observation))

    def add_keyframe(self, estimate: Pose, keyframe: Pose) -> None:
        """Ends a leg at a keyframe; `estimate` is its pose by odometry alone."""
        end = estimate.relative_to(self._keyframe)
        seen = [
            (pose, pose.relative_to(end), observation)
            for pose, observation in self._open_leg
        ]
        after = min(
            range(len(seen)), key=lambda n: (pose_magnitude(seen[n][1]), -n), default=0
        )
        count = max(1, after)
        leg = [
            LogEntry(observation, from_start, from_end, number / count)
            for number, (from_start, from_end, observation) in enumerate(seen[:after])
        ]
        if not self._legs:
            # The first leg has no keyframe at its start.
            leg = [LogEntry(e.observation, e.from_end, e.from_end, 1.0) for e in leg]
        self._legs.append(leg)
        self._open_leg = [
            (from_end, observation) for _, from_end, observation in seen[after:]
        ]
        self._keyframe = keyframe

    def replay(
        self, grid: OccupancyGrid, keyframes: Sequence[Pose], since: int = 0
    ) -> None:
        """Adds the observations of all legs after the first `since` to a grid."""
        for here, observation in self._observations(keyframes, since):
            for reading in observation.readings:
                grid.add_reading(reading.transformed_by(here))
            if observation.obstacle is not None:
                at = Pose(*observation.obstacle, 0.0).transformed_by(here)
                grid.mark_obstacle(at.x, at.y)
        for keyframe in keyframes[since:]:
            grid.mark_footprint(keyframe.x, keyframe.y)

    def _observations(
        self, keyframes: Sequence[Pose], since: int
    ) -> Iterator[tuple[Pose, Observation]]:
        for number in range(since, len(self._legs)):
            start, end = keyframes[max(0, number - 1)], keyframes[number]
            for entry in self._legs[number]:
                a, b = (
                    entry.from_start.transformed_by(start),
                    entry.from_end.transformed_by(end),
                )
                yield interpolate(a, b, entry.fraction), entry.observation
        for pose, observation in self._open_leg:
            yield pose.transformed_by(keyframes[-1]), observation


def pose_magnitude(pose: Pose) -> float:
    """The size of a relative pose: metres plus radians."""
    return math.hypot(pose.x, pose.y) + abs(pose.theta)


def interpolate(a: Pose, b: Pose, fraction: float) -> Pose:
    """Interpolates linearly between two poses."""
    return Pose(
        a.x + fraction * (b.x - a.x),
        a.y + fraction * (b.y - a.y),
        wrap_angle(a.theta + fraction * wrap_angle(b.theta - a.theta)),
    )
