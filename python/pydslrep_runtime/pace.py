"""How long the steps of a clock take, as measured: those of a busy computer or a physical robot are late."""

# The share of a step's weight in the usual one that remains after another step.
MEMORY = 0.9
MAX_STEP = 2.0  # usual steps; a step that takes longer contains a pause


class Pace:
    """The steps of one robot."""

    def __init__(self, time_step: float) -> None:
        """`time_step` is how long they should take, in seconds."""
        self.last = time_step
        """Seconds of the latest one, without a pause; 0 if no time has passed."""
        self.usual = time_step
        """Seconds of one as far as is known."""

    def observe(self, elapsed: float) -> None:
        """Adds a step, in seconds."""
        if elapsed == self.last == self.usual:
            return
        self.last = min(max(elapsed, 0.0), MAX_STEP * self.usual)
        if self.last > 0.0:
            self.usual += (1.0 - MEMORY) * (self.last - self.usual)
