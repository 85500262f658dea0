"""Wheel slip: how much less a robot moves than its wheels roll, as observed while it drives."""

MAX_GAIN = 1.25
MIN_GAIN = 1.0 / MAX_GAIN
IGNORED = 0.05  # a slip that is not compensated: floors and tyres vary that much
STEPS = 10  # at a steady speed before a slip is compensated
MEMORY = 0.98  # the share of a step's weight that remains after another one


class SlipCompensation:
    """Compensates for wheel slip: in physics engines, bodies move some percent less than their wheels roll."""

    def __init__(self) -> None:
        self.gain = 1.0
        """How much faster than planned wheels have to roll; exactly 1 where bodies move as their wheels roll."""
        self._rolled = self._moved = 0.0
        self._steps = 0
        self._speed = 0.0

    def observe(self, speed: float, moved: float, elapsed: float) -> None:
        """Adds a step: the planned speed of the robot, or of its rims in a turn, in m/s, and the metres that it moved in `elapsed` seconds."""
        if speed != self._speed:  # while a robot speeds up or brakes, it may lag behind
            self._speed = speed
            return
        rolled = speed * self.gain * elapsed
        square, product = rolled * rolled, moved * rolled
        # A robot that does something else is not slipping: it may be held by an obstacle.
        if MIN_GAIN * square < product < MAX_GAIN * square:
            self._rolled = MEMORY * self._rolled + square
            self._moved = MEMORY * self._moved + product
            self._steps += 1
            if self._steps >= STEPS:
                self._update()

    def _update(self) -> None:
        gain = self._rolled / self._moved
        is_ignored = abs(gain - 1.0) < IGNORED
        self.gain = 1.0 if is_ignored else min(max(gain, MIN_GAIN), MAX_GAIN)
