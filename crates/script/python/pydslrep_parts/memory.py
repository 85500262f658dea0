#: if standalone
"""How a robot knows again where it is."""

import itertools
import math
from collections.abc import Sequence

from .floor import Place
from .pose import Pose, wrap_angle

#: endif


class Memory:
    """What a robot saw from where, to know again where it is when it comes back."""

    REACH = 0.7  # m from a place, so that about the same is seen
    APART = 0.3  # m between places to remember what is seen from

    def __init__(self) -> None:
        self._scans: list[tuple[Pose, list[Place]]] = []

    def recognise(self, here: Pose, seen: Sequence[Place]) -> Pose:
        """The pose, put right by what was seen before; remembers what is new.

        `seen` has places where something stands, as they are from `here`.
        """
        away, known = min(
            (
                (math.hypot(scan.x - here.x, scan.y - here.y), places)
                for scan, places in self._scans
            ),
            key=lambda found: found[0],
            default=(math.inf, []),
        )
        pose = fitted(here, seen, known) if away < self.REACH else here
        if away > self.APART:
            points = (Pose(*place, 0.0).seen_from(here) for place in seen)
            moved = (point.placed_on(pose) for point in points)
            self._scans.append((pose, [(point.x, point.y) for point in moved]))
        return pose


COARSE = 0.15  # m about a place within which what is seen again is looked for
GRAIN = 0.04  # m between cells of what was seen before
WORTH = 0.06  # of what is seen: a pose that fits better by less is no better
TURNS = math.radians(8.0)  # the most that a heading is put right at once ...
SHIFT = 0.12  # m: ... and a place


def fitted(here: Pose, seen: Sequence[Place], known: Sequence[Place]) -> Pose:
    """The pose from which `seen` lies on `known` best, near the one it was thought to be.

    Both are places where something stands, `seen` as it is from `here`. Where little of it
    fits, or nothing fits better, the pose stays.
    """
    field: dict[tuple[int, int], float] = {}
    about: set[tuple[int, int]] = set()
    for x, y in known:
        column, row = round(x / COARSE), round(y / COARSE)
        about |= {(column + a, row + b) for a in (-1, 0, 1) for b in (-1, 0, 1)}
        column, row = round(x / GRAIN), round(y / GRAIN)
        for right in range(-2, 3):
            for up in range(-2, 3):
                cell = column + right, row + up
                fit = 1.0 - math.hypot(right, up) / 3.0
                field[cell] = max(fit, field.get(cell, 0.0))
    # What has no counterpart near is new, and says nothing.
    points = [
        Pose(x, y, 0.0).seen_from(here)
        for x, y in seen
        if (round(x / COARSE), round(y / COARSE)) in about
    ]

    def score(pose: Pose) -> float:
        cos, sin = math.cos(pose.theta), math.sin(pose.theta)
        total = 0.0
        for point in points:
            x = pose.x + cos * point.x - sin * point.y
            y = pose.y + sin * point.x + cos * point.y
            total += field.get((round(x / GRAIN), round(y / GRAIN)), 0.0)
        # Along a bare wall everything fits: then the least change is best.
        off = math.hypot(pose.x - here.x, pose.y - here.y)
        turned = abs(wrap_angle(pose.theta - here.theta))
        return total / len(points) - 0.5 * off - 0.3 * turned

    if len(points) < 15:
        return here
    best, most = here, score(here) + WORTH
    shift, turn = SHIFT / 3.0, TURNS / 4.0
    shifts, turns = range(-3, 4), range(-4, 5)
    while shift > 0.005:
        middle = best
        for a, b, c in itertools.product(shifts, shifts, turns):
            pose = Pose(middle.x + a * shift, middle.y + b * shift, middle.theta)
            pose = pose.turned(c * turn)
            if (value := score(pose)) > most:
                best, most = pose, value
        shift, turn, shifts, turns = shift / 2.0, turn / 2.0, range(-1, 2), range(-1, 2)
    return best if most > 0.4 else here
