"""Where an obstacle that moves is at which time, as `crates/scene/src/trajectory.rs` says."""

from bisect import bisect_right
from collections.abc import Sequence


class ObstaclePath:
    """A way along straight lines, once, or there and back again and again."""

    def __init__(
        self, points: Sequence[tuple[float, float, float]], repeats: bool
    ) -> None:
        """`points` are times in seconds, which grow, and places in metres."""
        self._points, self._repeats = points, repeats
        self._times = [time for time, _, _ in points]

    def at(self, time: float) -> tuple[float, float]:
        """The place at a time, in seconds."""
        moment = self._moment(time)
        following = bisect_right(self._times, moment)
        _, x, y = self._points[max(0, following - 1)]
        if following in (0, len(self._points)):
            return x, y
        begin, end = self._times[following - 1], self._times[following]
        _, next_x, next_y = self._points[following]
        part = (moment - begin) / (end - begin)
        return x + part * (next_x - x), y + part * (next_y - y)

    def _moment(self, time: float) -> float:
        """The time of the way there at which it is where it is at a time."""
        first, last = self._times[0], self._times[-1]
        length = last - first
        if time < last or not self._repeats or length <= 0.0:
            return time
        since = (time - first) % (2.0 * length)
        return first + since if since < length else last - (since - length)
