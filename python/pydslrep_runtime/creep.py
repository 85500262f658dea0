"""How much less a robot moves than its wheels roll, as observed while it drives."""

MOST = 1.25  # times the planned speed that wheels roll, at most
LEAST = 1.0 / MOST
IGNORED = 0.05  # a difference that is not made up for: it is how floor and tyres vary
STEPS = 10  # of a steady speed before it is
MEMORY = 0.98  # the share of a step's weight that remains after another one


class Creep:
    """Makes up for wheels that slip: in physics engines, bodies move some percent less than their wheels roll."""

    def __init__(self) -> None:
        self.gain = 1.0
        """How much faster than planned wheels have to roll; exactly 1 where bodies move as their wheels roll."""
        self._rolled = self._moved = 0.0
        self._steps = 0
        self._speed = 0.0

    def observe(self, speed: float, moved: float, elapsed: float) -> None:
        """Adds a step of seconds in which a robot, or its rims in a turn, should have moved at a speed in m/s, and has so many metres."""
        if speed != self._speed:  # while a robot speeds up or brakes, it may lag behind
            self._speed = speed
            return
        rolled = speed * self.gain * elapsed
        square, product = rolled * rolled, moved * rolled
        # A robot that does something else is not slipping: it may be held by an obstacle.
        if LEAST * square < product < MOST * square:
            self._rolled = MEMORY * self._rolled + square
            self._moved = MEMORY * self._moved + product
            self._steps += 1
            if self._steps >= STEPS:
                self._update()

    def _update(self) -> None:
        gain = self._rolled / self._moved
        self.gain = 1.0 if abs(gain - 1.0) < IGNORED else min(max(gain, LEAST), MOST)
