"""Relocalisation: where a robot is that has lost its way, if only one place fits."""

import math

import numpy as np

from ...pose import Pose, wrap_angle
from .scan_matching import MapPoints, ScanMatch, match_scan
from .surface import SurfacePoints

# Radians that are tried: in rooms with right angles, a quarter turn more may look the same.
TURNS = np.radians(np.arange(-60.0, 61.0, 6.0))
# To where a match may go from there: farther away, others have not been looked for.
MAX_FOUND_TURN = math.radians(72.0)
GRAIN = 0.1  # m between positions that are tried
SAMPLES = 60  # points that are compared before a match
CANDIDATES = 8
MIN_POINTS = 30
MIN_RATIO = 0.75  # of points that have a counterpart
MIN_LEAD = 0.15  # of that ratio over the next best place, after ...
FAR = 0.3  # ... its decrease by each metre, and by each radian, from the estimate
SAME_PLACE = 0.15  # m, and ...
SAME_HEADING = 0.2  # ... radians
SEE_THROUGH = 0.12  # m between a known surface and what is seen behind it


def relocalise(
    points: SurfacePoints, guess: Pose, within: float, known: MapPoints
) -> ScanMatch | None:
    """The only place within metres of a guess, and 60 degrees, that a scan matches."""
    if min(len(points), len(known.points)) < MIN_POINTS:
        return None

    def score(found: ScanMatch) -> float:
        away = found.pose.relative_to(guess)
        far = math.hypot(away.x, away.y) + abs(away.theta)
        return found.inlier_ratio - FAR * far

    best: list[ScanMatch] = []
    for start in candidates(points, guess, within, known):
        # Along a bare wall, odometry is kept.
        here = Pose(guess.x, guess.y, start.theta)
        found = match_scan(points, here, (within / 2.0, 0.3), known, start)
        if (
            found is None
            or abs(wrap_angle(found.pose.theta - guess.theta)) > MAX_FOUND_TURN
        ):
            continue
        # Of the matches of one place the best, as a worse one could make another place seem
        # the only one.
        same = [other for other in best if is_same(found.pose, other.pose)]
        if all(found.inlier_ratio > other.inlier_ratio for other in same):
            best = [*(other for other in best if other not in same), found]
    best.sort(key=score, reverse=True)
    if not best or not is_sure(best[0]):
        return None
    is_only = len(best) == 1 or score(best[0]) >= score(best[1]) + MIN_LEAD
    return best[0] if is_only else None


def is_sure(found: ScanMatch) -> bool:
    """Whether nearly all of the scan matches."""
    return (
        found.inlier_count >= MIN_POINTS
        and found.inlier_ratio >= MIN_RATIO
        and found.rms_error <= 0.02
        and abs(found.drift) <= 0.1
    )


def is_same(a: Pose, b: Pose) -> bool:
    """Whether two matches are of the same place."""
    return (
        math.hypot(a.x - b.x, a.y - b.y) < SAME_PLACE
        and abs(wrap_angle(a.theta - b.theta)) < SAME_HEADING
    )


def candidates(
    points: SurfacePoints, guess: Pose, within: float, known: MapPoints
) -> list[Pose]:
    """The poses at which most points are near a known surface, each a different place."""
    count = math.floor(within / GRAIN)
    offsets = GRAIN * np.arange(-count, count + 1)
    shifts = (guess.x + offsets[:, None]) + 1j * (guess.y + offsets)
    sample = points.position[:: max(1, len(points) // SAMPLES)]
    turned = np.exp(1j * (guess.theta + TURNS))[:, None] * sample
    scores = known.score(turned[:, None] + shifts.reshape(1, -1, 1))
    found: list[Pose] = []
    for number in np.argsort(-scores, axis=None)[:400].tolist():
        turn, place = divmod(number, shifts.size)
        at = shifts.flat[place]
        pose = Pose(at.real, at.imag, wrap_angle(guess.theta + float(TURNS[turn])))
        if not any(is_same(pose, other) for other in found):
            found.append(pose)
    return found[:CANDIDATES]


def seen_through(points: SurfacePoints, here: Pose, known: MapPoints) -> int:
    """How many known surface points a scan at a pose contradicts: it looks through them."""
    away = known.points.position - complex(here.x, here.y)
    is_facing = (away.conj() * known.points.normal).real < -0.5 * np.abs(away)
    away = (away * np.exp(-1j * here.theta))[is_facing & (np.abs(away) < 0.9)]
    between = np.abs(np.angle(away[:, None] / points.position)) < math.radians(2.0)
    depth = np.where(between, np.abs(points.position), np.inf).min(
        axis=1, initial=np.inf
    )
    return int((np.isfinite(depth) & (depth > np.abs(away) + SEE_THROUGH)).sum())
