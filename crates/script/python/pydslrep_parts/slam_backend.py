#: if standalone
"""How a robot that goes by its wheels knows where it is."""

import itertools
import math
from collections.abc import Iterable, Sequence

from .dominant_orientation import Grain, grain_of
from .pose import Pose, wrap_angle
from .pose_graph import Compass, Link, PoseGraph
from .scan import Mark, Sweep
from .scan_matching import KnownMark, KnownMarks, Match, match

#: endif


FURTHEST = 0.3  # m from where a robot believes to be: further off, it is another place
MOST_DRIFT = 0.1  # radians in a sweep: more is a mistake


class Memory:
    """The places where a robot has looked about, and what it saw there.

    Each place is linked to the one before by what the wheels rolled, and to those near it
    by what is seen from both. Walls that run along each other tell the heading besides.
    """

    NEAR = 1.2  # m between places from which the same may be seen
    MOST = 8  # of these are looked at
    ROLL_ERROR = 0.012  # m per root of a metre rolled (standard deviation) ...
    TURN_ERROR = 0.04  # ... and radians
    GRAIN_ERROR = math.radians(0.8)  # of the heading that walls tell
    AGREED = 0.5  # of the marks must have the direction that walls run in

    def __init__(self) -> None:
        self._graph = PoseGraph()
        self._marks: list[list[Mark]] = []
        self._walls: float | None = None  # the direction that they run in
        self._unsure = 0.0  # m rolled since they told the heading

    @property
    def places(self) -> Sequence[Pose]:
        """Where they are, as far as is known by now."""
        return self._graph.poses

    def recognise(self, sweep: Sweep, here: Pose, rolled: float) -> Pose:
        """A new place: where the robot is now, by all it knows.

        `here` is where its wheels have it at the end of the sweep, `rolled` how far they
        rolled since the place before, in metres.
        """
        middle, marks = sweep.middle(), sweep.marks()
        number = self._graph.add(middle)
        self._unsure += rolled
        grain = self._grain(marks, middle)
        self._link_by_wheels(number, middle, rolled)
        drift = 0.0
        if grain:
            drift = grain.drift
            self._orient(number, grain, middle)
        marks = thinned(undistorted(mark, drift) for mark in marks)
        more = self._link_by_marks(number, marks, rolled)
        self._marks.append([undistorted(mark, more) for mark in marks])
        drift += more
        end = here.seen_from(middle).placed_on(self._graph.poses[number])
        return end.turned(drift / 2.0)

    def _link_by_wheels(self, number: int, middle: Pose, rolled: float) -> None:
        if number == 0:
            return
        before = self._graph.poses[number - 1]
        place = 1.0 / (self.ROLL_ERROR**2 * rolled + 1e-6)
        heading = 1.0 / (self.TURN_ERROR**2 * rolled + 1e-6)
        information = [[place, 0.0, 0.0], [0.0, place, 0.0], [0.0, 0.0, heading]]
        relative = middle.seen_from(before)
        self._graph.link(
            Link(number - 1, number, relative, information, is_certain=True)
        )

    def _grain(self, marks: Sequence[Mark], middle: Pose) -> Grain | None:
        """The direction of the walls as seen from a place."""
        within = math.pi / 4.0
        guess = 0.0
        if self._walls is not None:
            within = min(within, 0.03 + 3.0 * self.TURN_ERROR * math.sqrt(self._unsure))
            guess = self._walls - middle.theta
        grain = grain_of(marks, guess, within)
        if grain is None or grain.share < self.AGREED or abs(grain.drift) > MOST_DRIFT:
            return None
        off = math.remainder(grain.angle - guess, math.pi / 2.0)
        return grain if abs(off) <= within else None

    def _orient(self, number: int, grain: Grain, middle: Pose) -> None:
        """Puts the heading right by the walls."""
        self._unsure = 0.0
        if self._walls is None:
            # The first place is where the robot stood before the sweep.
            middle = middle.turned(grain.drift / 2.0)
            self._graph.poses[number] = middle
            self._walls = middle.theta + grain.angle
            return
        off = math.remainder(self._walls - grain.angle - middle.theta, math.pi / 2.0)
        heading = wrap_angle(middle.theta + off)
        self._graph.orient(Compass(number, heading, 1.0 / self.GRAIN_ERROR**2))
        self._graph.poses[number] = Pose(middle.x, middle.y, heading)
        if abs(off) > self.TURN_ERROR:
            self._graph.relax()

    def _link_by_marks(self, number: int, marks: list[Mark], rolled: float) -> float:
        """Links a place to those near it; the rest of the drift."""
        poses = self._graph.poses
        here = poses[number]
        away = {n: math.hypot(p.x - here.x, p.y - here.y) for n, p in enumerate(poses)}
        near = sorted((n for n in away if away[n] < self.NEAR), key=lambda n: away[n])
        groups = self._graph.components(near[: self.MOST])
        drift = 0.0
        # First those that the robot comes from.
        groups.sort(key=lambda group: number not in group)
        for group in groups:
            known = self._known([n for n in group if n != number])
            if number in group:
                found = self._beside(marks, poses[number], known, rolled)
                if found:
                    drift = found.drift
                    poses[number] = found.pose
                    for link in self._links(number, found):
                        self._graph.link(link)
            else:
                found = self._closed_loop(marks, poses[number], known)
                if found and self._graph.closes(self._links(number, found)):
                    drift = found.drift
        if number % 10 == 9:
            self._graph.relax()
        return drift

    def _beside(
        self, marks: Sequence[Mark], here: Pose, known: KnownMarks, rolled: float
    ) -> Match | None:
        """Where the robot is beside the places that it comes from."""
        off = 0.02 + self.ROLL_ERROR * math.sqrt(rolled), 0.03
        found = match(marks, here, off, known)
        if (
            found is None
            or found.count < 10
            or found.rough > 0.03
            or abs(found.drift) > MOST_DRIFT
        ):
            return None
        change = found.pose.seen_from(here)
        is_near = math.hypot(change.x, change.y) < 4.0 * off[0]
        return found if is_near and abs(change.theta) < 4.0 * off[1] else None

    def _closed_loop(
        self, marks: Sequence[Mark], here: Pose, known: KnownMarks
    ) -> Match | None:
        """Where the robot is among places that it comes back to, by another way."""
        if len(marks) < 25:
            return None
        best: Match | None = None
        shifts = sorted(
            itertools.product((0.0, -0.2, 0.2), repeat=2),
            key=lambda s: math.hypot(*s),
        )
        for right, up in shifts:
            start = Pose(here.x + right, here.y + up, here.theta)
            found = match(marks, here, (0.2, 0.05), known, start)
            if (
                not found
                or found.count < 15
                or abs(found.drift) > MOST_DRIFT
                or abs(wrap_angle(found.pose.theta - here.theta)) > 0.15
                or found.share < 0.4
                or found.rough > 0.025
            ):
                continue
            if math.hypot(found.pose.x - here.x, found.pose.y - here.y) > FURTHEST:
                continue
            if best is None or found.share > best.share + 0.05:
                best = found
            if found.share > 0.7:
                break
        return best

    def _links(self, number: int, found: Match) -> list[Link]:
        poses = self._graph.poses
        return [
            Link(place, number, found.pose.seen_from(poses[place]), information)
            for place, information in found.information.items()
        ]

    def _known(self, places: Sequence[int]) -> KnownMarks:
        found = []
        for number in places:
            for mark in self._marks[number]:
                at = Pose(mark.x, mark.y, mark.normal).placed_on(
                    self._graph.poses[number]
                )
                cos, sin = math.cos(at.theta), math.sin(at.theta)
                found.append(KnownMark(at.x, at.y, cos, sin, number))
        return KnownMarks(found)


def undistorted(mark: Mark, drift: float) -> Mark:
    """A mark as it is where the sweep turned that much further than the wheels did."""
    at = Pose(mark.x, mark.y, mark.normal)
    at = at.placed_on(Pose(0.0, 0.0, drift * mark.when))
    return Mark(at.x, at.y, at.theta, mark.when)


THIN = 0.04  # m about which marks that face the same way are one


def thinned(marks: Iterable[Mark]) -> list[Mark]:
    """Fewer marks, each the mean of some that were seen next to each other at about the same time."""
    cells: dict[tuple[int, ...], list[Mark]] = {}
    for mark in marks:
        facing = round(4.0 * mark.normal / math.pi) % 8
        cell = (
            round(mark.x / THIN),
            round(mark.y / THIN),
            facing,
            round(4.0 * mark.when),
        )
        cells.setdefault(cell, []).append(mark)
    return [mean_of(alike) for alike in cells.values()]


def mean_of(marks: Sequence[Mark]) -> Mark:
    """The mean of marks that are alike."""
    count, first = len(marks), marks[0].normal
    return Mark(
        sum(mark.x for mark in marks) / count,
        sum(mark.y for mark in marks) / count,
        first + sum(wrap_angle(mark.normal - first) for mark in marks) / count,
        sum(mark.when for mark in marks) / count,
    )
