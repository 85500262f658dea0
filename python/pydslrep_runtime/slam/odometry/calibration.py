"""Calibration: how much further a robot turns and drives than its wheels report.

Tyres touch the floor elsewhere than drawn, and their radii differ. Such errors are systematic, so odometry drifts to one
side all the time, mostly by the track, since every scan is a turn (J. Borenstein and L. Feng, Measurement and correction of
systematic odometry errors in mobile robots, 1996). Scans tell how the robot has really moved from one to the next; against
what the wheels report, both factors can be estimated while it explores (A. Censi et al., Simultaneous calibration of odometry
and sensor parameters for mobile robots, 2013).
"""

import math

MAX_CHI2 = 9.0  # of a measurement; more is a push or a wrong match


class Factor:
    """A factor that is estimated from measurements, with its uncertainty: a Kalman filter."""

    def __init__(self, sigma: float, min_sigma: float) -> None:
        """It is about 1; `sigma` is its standard deviation before the first measurement.

        `min_sigma` is the standard deviation that no number of measurements goes below.
        """
        self.value = 1.0
        self._variance, self._min_variance = sigma**2, min_sigma**2

    @property
    def sigma(self) -> float:
        """The standard deviation of the factor."""
        return math.sqrt(self._variance)

    def observe(self, reported: float, actual: float, sigma: float) -> None:
        """Learns what a reported amount has actually been, with a standard deviation."""
        error = actual - self.value * reported
        spread = self._variance * reported**2 + sigma**2
        if error**2 > MAX_CHI2 * spread:
            return
        gain = self._variance * reported / spread
        self.value += gain * error
        self._variance = max(
            self._variance * (1.0 - gain * reported), self._min_variance
        )


class Calibration:
    """The factors of a robot with two wheels: actual by reported turns and ways."""

    TURN_SIGMA = 0.03
    WAY_SIGMA = 0.02
    MIN_TURN_SIGMA = 0.0005
    MIN_WAY_SIGMA = 0.004  # matches along the way are short by a millimetre or two

    def __init__(self) -> None:
        self.turn = Factor(self.TURN_SIGMA, self.MIN_TURN_SIGMA)
        self.way = Factor(self.WAY_SIGMA, self.MIN_WAY_SIGMA)
