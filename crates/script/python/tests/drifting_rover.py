"""A ghost that does not know where it is: its wheels slip, and it goes by how they turned."""

import math
import random
from collections.abc import Callable

from ghost_rover import MOUNTS, RADIUS, GhostRover, on
from pydslrep_parts.floor import Floor, Place, Reading
from pydslrep_parts.memory import Memory
from pydslrep_parts.pose import Pose, wrap_angle
from rooms import Rooms


class DriftingRover(GhostRover):
    """`here` is where it is, `believed` where it thinks that it is."""

    def __init__(self, rooms: Rooms, floor: Floor, slip: float, seed: int = 1) -> None:
        self.dice, self.slip = random.Random(seed), slip
        self.believed = Pose(*rooms.start, 0.0)
        self.memory = Memory()
        self.scan: Floor | None = None
        super().__init__(rooms, floor)

    def pose(self) -> Pose:
        return self.believed

    def off(self) -> float:
        """How far it is from where it believes to be, in metres."""
        return math.hypot(self.here.x - self.believed.x, self.here.y - self.believed.y)

    def wobble(self, share: float) -> float:
        return 1.0 + self.dice.gauss(0.0, self.slip) * share

    def turn_by(self, angle: float) -> None:
        count = max(1, math.ceil(abs(angle) / self.TURN))
        # Slip is alike over a second, in which a robot turns by more than that.
        for index in range(count):
            if index % 5 == 0:
                wobble = self.wobble(0.7)
            self.here = self.here.turned(angle / count * wobble)
            self.believed = self.believed.turned(angle / count)
            self.look()
        self.turned += abs(angle)

    def drive_to(self, goal: Place, is_enough: Callable[[], bool]) -> bool:
        dx, dy = goal[0] - self.believed.x, goal[1] - self.believed.y
        self.turn_by(wrap_angle(math.atan2(dy, dx) - self.believed.theta))
        count = max(1, math.ceil(math.hypot(dx, dy) / self.STEP))
        step = math.hypot(dx, dy) / count
        for index in range(count):
            if index % 3 == 0:
                bend = self.dice.gauss(0.0, self.slip) * 1.4 / 0.3
                wobble = self.wobble(0.7)
            if self.distance(on(self.here, MOUNTS[2])) < RADIUS - 0.15 + 0.05:
                return False
            self.here = self.here.turned(step * bend).ahead(step * wobble)
            self.believed = self.believed.ahead(step)
            self.driven += step
            self.look()
            if is_enough():
                break
        return True

    def retreat_to(self, goal: Place) -> None:
        away = math.dist(goal, (self.believed.x, self.believed.y))
        self.here, self.believed = self.here.ahead(-away), self.believed.ahead(-away)

    def localise(self) -> None:
        self.scan = Floor(RADIUS)
        self.turn_by(math.pi)
        self.believed = self.memory.recognise(self.believed, self.scan.edges())
        self.scan = None

    def look(self) -> None:
        if not self.rooms.holds(self.here.x, self.here.y, self.here.theta, 0.15):
            self.touched.append(self.here)
        for mount in MOUNTS:
            away = self.distance(on(self.here, mount))
            eye = on(self.believed, mount)
            reading = Reading(eye, self.cone, min(away, self.reach), away < self.reach)
            self.floor.see(reading)
            if self.scan is not None:
                self.scan.see(reading)
