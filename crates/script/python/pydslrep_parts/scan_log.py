#: if standalone
"""All that a robot saw, to draw the floor anew where places turn out to be elsewhere."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .occupancy_grid import Floor, Place, Reading
from .pose import Pose, wrap_angle

#: endif


@dataclass(frozen=True)
class Look:
    """What was seen at once; eyes and obstacle are as they are from the robot."""

    readings: Sequence[Reading]
    obstacle: Place | None = None  # that came near


@dataclass(frozen=True)
class Entry:
    """A look between two places, and where the robot was, as seen from each."""

    look: Look
    from_start: Pose
    from_end: Pose
    share: float  # of the way from the one to the other


class Diary:
    """Looks on the way from place to place.

    Where the robot was between two places follows from both: what the wheels made wrong on
    the way is spread along it.
    """

    def __init__(self) -> None:
        self._legs: list[list[Entry]] = []
        self._begun: list[
            tuple[Pose, Look]
        ] = []  # since the last place, as seen from it
        self._place = Pose(0.0, 0.0, 0.0)  # the last one

    def note(self, here: Pose, look: Look) -> None:
        """A look from where the robot believes to be."""
        self._begun.append((here.seen_from(self._place), look))

    def arrive(self, middle: Pose, place: Pose) -> None:
        """A place: the wheels have it at `middle`, which was on the way, but it is at `place`."""
        end = middle.seen_from(self._place)
        seen = [(pose, pose.seen_from(end), look) for pose, look in self._begun]
        after = min(
            range(len(seen)), key=lambda n: (far_from_origin(seen[n][1]), -n), default=0
        )
        count = max(1, after)
        leg = [
            Entry(look, from_start, from_end, number / count)
            for number, (from_start, from_end, look) in enumerate(seen[:after])
        ]
        if not self._legs:
            # Before the first place there is none to see it from.
            leg = [Entry(e.look, e.from_end, e.from_end, 1.0) for e in leg]
        self._legs.append(leg)
        self._begun = [(from_end, look) for _, from_end, look in seen[after:]]
        self._place = place

    def draw(self, floor: Floor, places: Sequence[Pose], since: int = 0) -> None:
        """Shows a floor what was seen on the ways to these places, but for the first ones."""
        for here, look in self._looks(places, since):
            for reading in look.readings:
                floor.see(reading.seen_by(here))
            if look.obstacle is not None:
                at = Pose(*look.obstacle, 0.0).placed_on(here)
                floor.block(at.x, at.y)
        for place in places[since:]:
            floor.stand(place.x, place.y)

    def _looks(self, places: Sequence[Pose], since: int) -> Iterator[tuple[Pose, Look]]:
        for number in range(since, len(self._legs)):
            start, end = places[max(0, number - 1)], places[number]
            for entry in self._legs[number]:
                a, b = entry.from_start.placed_on(start), entry.from_end.placed_on(end)
                yield between(a, b, entry.share), entry.look
        for pose, look in self._begun:
            yield pose.placed_on(places[-1]), look


def far_from_origin(pose: Pose) -> float:
    """In metres, or radians."""
    return math.hypot(pose.x, pose.y) + abs(pose.theta)


def between(a: Pose, b: Pose, share: float) -> Pose:
    """The pose that is that share of the way from one to another, which are near."""
    return Pose(
        a.x + share * (b.x - a.x),
        a.y + share * (b.y - a.y),
        wrap_angle(a.theta + share * wrap_angle(b.theta - a.theta)),
    )
