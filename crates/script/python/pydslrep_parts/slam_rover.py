#: if standalone
"""How a robot explores: what it sees on its way, and what it heeds."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from .explorer import Explorer, NoEndError
from .occupancy_grid import Floor, Place, Reading
from .pose import Pose, wrap_angle
from .scan import Sweep
from .scan_log import Diary, Look
from .settings import RIM_SPEED
from .slam_backend import Memory
from .slam_session import Survey

if TYPE_CHECKING:
    from .robot import Robot

#: endif


STEP_LENGTH = 0.5  # m between the places of a map
LOOK_DISTANCE = 0.03  # m to drive from one look to the next ...
LOOK_ANGLE = math.radians(5.0)  # ... or to turn
NEAR = 0.02  # m about a robot that nothing may enter
DRAWN_APART = 0.04  # m that places may be beside where they were drawn ...
DRAWN_TURNED = math.radians(2.0)  # ... and turned
UNSURE = 0.05  # m that a robot may be beside where its wheels have it


class Surveyor:
    """The rover of an explorer: a robot that looks about while it moves."""

    def __init__(self, robot: "Robot", survey: Survey) -> None:
        self._robot, body = robot, robot.body
        name = body.model.name
        eyes = {sensor: body.eye(sensor) for sensor in body.model.eyes}
        self._eyes = {sensor: eye.mount for sensor, eye in eyes.items()}
        self._ranges = {s: survey.range(name, s, eye.range) for s, eye in eyes.items()}
        self._cones = {s: survey.cone(name, s, eye.cone) for s, eye in eyes.items()}
        # The corners of a square body are that much further out than its wheels.
        span = body.drive.turning_radius * math.sqrt(2.0)
        mounts = (math.hypot(eye.x, eye.y) for eye in self._eyes.values())
        self._extent = survey.extent
        self.radius = survey.radius(name, max(span, *mounts))
        self._is_unsure = survey.by_odometry
        # Wheels slip less where they turn slowly.
        self._turning_speed = RIM_SPEED * (0.5 if self._is_unsure else 1.0)
        self.floor = Floor(self.radius + (UNSURE if self._is_unsure else 0.0))
        self._sweep: Sweep | None = None
        self._rolled = 0.0
        self._memory = Memory()
        self._diary = Diary()
        self._drawn: list[Pose] = []  # places that the floor was drawn by
        self._places: list[Place] = []
        self._looked: Pose | None = None
        self._near: Place | None = None

    def explore(self) -> Explorer:
        """An explorer for this robot; raises MovementError."""
        reach = min(
            self._ranges[sensor] + math.hypot(eye.x, eye.y)
            for sensor, eye in self._eyes.items()
        )
        step = min(STEP_LENGTH, reach - self.radius - Floor.LEEWAY - 0.1)
        if step < 0.1:
            least = min(self._ranges.values())
            raise self._robot.failure(
                f"its sensors see no more than {least:g} m, which is too little to explore by"
            )
        return Explorer(
            self,
            self.floor,
            step,
            self._blind_angle(),
            self._extent,
            keeps_to_walls=self._is_unsure,
        )

    def pose(self) -> Pose:
        """Where the robot is."""
        return self._robot.pose()

    def turn_by(self, angle: float) -> None:
        """Turns in place."""
        self._robot.rotate(angle, self._look, self._turning_speed)

    def localise(self) -> int:
        """By odometry, looks all about and finds out by that where the robot is."""
        if not self._is_unsure:
            here = self.pose()
            self._places.append((here.x, here.y))
            return len(self._places) - 1
        self._sweep, self._looked = Sweep(), None
        # All else is seen from the first place.
        speed = self._turning_speed if self._places else 0.5 * self._turning_speed
        self._robot.rotate(self._blind_angle(), self._look, speed)
        sweep, self._sweep = self._sweep, None
        rolled = self._robot.rolled()
        there = self._memory.recognise(sweep, self.pose(), rolled - self._rolled)
        self._rolled = rolled
        self._robot.correct(there)
        self._draw(sweep.middle())
        return len(self._places) - 1

    def place(self, number: int) -> Place:
        """Where a place is, as far as is known by now."""
        return self._places[number]

    def _draw(self, middle: Pose) -> None:
        """Draws what was seen on the way here, or all of it where places have moved."""
        places = self._memory.places
        self._diary.arrive(middle, places[-1])
        self._places = [(place.x, place.y) for place in places]
        if any(map(are_apart, self._drawn, places)):
            self.floor.clear()
            self._drawn = []
        self._diary.draw(self.floor, places, since=len(self._drawn))
        self._drawn += places[len(self._drawn) :]

    def drive_to(self, goal: Place, is_enough: Callable[[], bool]) -> bool:
        """Turns to a place and drives there until something comes near."""
        here = self.pose()
        bearing = math.atan2(goal[1] - here.y, goal[0] - here.x)
        self.turn_by(wrap_angle(bearing - here.theta))
        self._near = None

        def heeds(here: Pose) -> bool:
            return self._look(here) and (self._near is not None or is_enough())

        self._robot.drive_to(Pose(*goal, bearing), heeds)
        if self._near is None:
            return True
        self.floor.block(*self._near)
        if self._is_unsure:
            here = self.pose()
            near = Pose(*self._near, 0.0).seen_from(here)
            self._diary.note(here, Look((), (near.x, near.y)))
        return False

    def retreat_to(self, goal: Place) -> None:
        """Drives back the way it came."""
        heading = self.pose().theta
        self._robot.drive_to(Pose(*goal, heading), self._look_back)

    def _look_back(self, here: Pose) -> bool:
        self._look(here)
        return False

    def _look(self, here: Pose) -> bool:
        """Reads all sensors where that shows something new; whether it did."""
        is_new = self._looked is None or is_moved(here, self._looked)
        if is_new:
            self._looked = here
        elif self._sweep is None:
            return False
        seen = []
        for sensor, mount in self._eyes.items():
            distance = self._robot.body.distance(sensor)
            sees = distance is not None
            if distance is None:
                distance = self._ranges[sensor]
            elif is_new:
                self._heed(mount.placed_on(here).ahead(distance), here)
            reading = Reading(mount, self._cones[sensor], distance, sees)
            seen.append(reading)
            if self._sweep is not None:
                self._sweep.add(here, sensor, reading)
            else:
                self.floor.see(reading.seen_by(here))
        if self._is_unsure and is_new:
            self._diary.note(here, Look(seen))
        return is_new

    def _heed(self, point: Pose, here: Pose) -> None:
        """Notices what is so near ahead that the robot could not turn there."""
        seen = point.seen_from(here)
        reach = self.radius + NEAR
        if 0.0 < seen.x < reach and abs(seen.y) < 0.8 * self.radius:
            self._near = point.x, point.y

    def _blind_angle(self) -> float:
        """The widest angle between two sensors that are next to each other."""
        bearings = sorted(wrap_angle(eye.theta) for eye in self._eyes.values())
        following = [*bearings[1:], bearings[0] + math.tau]
        return max(b - a for a, b in zip(bearings, following, strict=True))


def is_moved(here: Pose, before: Pose) -> bool:
    """Whether there may be something new to see."""
    off = here.seen_from(before)
    return math.hypot(off.x, off.y) >= LOOK_DISTANCE or abs(off.theta) >= LOOK_ANGLE


def are_apart(a: Pose, b: Pose) -> bool:
    """Whether what was seen from a place has to be drawn anew."""
    turned = abs(wrap_angle(a.theta - b.theta))
    return math.hypot(a.x - b.x, a.y - b.y) > DRAWN_APART or turned > DRAWN_TURNED


def survey_with(robot: "Robot", survey: Survey) -> None:
    """Explores with a robot and adds the map to the survey; raises MovementError."""
    explorer = Surveyor(robot, survey).explore()
    try:
        explorer.explore()
    except NoEndError as error:
        raise robot.failure(error) from error
    finally:
        survey.add(robot.body.model.name, explorer.map)
