"""How much less a robot turns than its wheels roll, as observed while it drives along circles."""

MAX_SCRUB = 4.0  # how many times less a robot turns than its wheels roll
DOUBT = 1e-4  # rad² of observed steps at which half of what is observed is believed
MEMORY = 0.99  # the share of a step's weight that remains after another one


class Scrub:
    """Makes up for wheels that slide sideways: on a circle, a robot with four wheels turns less than they roll.

    Steering alone would leave it on a larger circle: it acts on an error, and here the cause of the error goes on.
    """

    def __init__(self, expected: float) -> None:
        """`expected` is how much less a robot with its wheels should turn than they roll."""
        self.min_factor = 1.0 / expected
        """The minimum of `factor`: that of wheels that do not slide."""
        self._max_factor = MAX_SCRUB / expected
        self._asked = self._turned = DOUBT

    @property
    def factor(self) -> float:
        """How much wider its track seems than is expected; 1 before there is evidence."""
        return min(max(self._asked / self._turned, self.min_factor), self._max_factor)

    def observe(self, asked: float, turned: float) -> None:
        """Adds a step in which the wheels' rates should have turned the robot by radians, and by how much it has turned."""
        # A least-squares fit in which old steps fade.
        self._asked = DOUBT + MEMORY * (self._asked - DOUBT) + asked**2
        self._turned = DOUBT + MEMORY * (self._turned - DOUBT) + asked * turned
        # A robot that is pushed around has not scrubbed.
        self._turned = max(self._turned, self._asked / self._max_factor)
