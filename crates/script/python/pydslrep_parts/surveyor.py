#: if standalone
"""How a robot explores: what it sees on its way, and what it heeds."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from .explorer import Explorer, NoEndError
from .floor import Floor, Place, Reading
from .memory import Memory
from .pose import Pose, wrap_angle
from .survey import Survey

if TYPE_CHECKING:
    from .robot import Robot

#: endif


STEP_LENGTH = 0.5  # m between the places of a map
LOOK_DISTANCE = 0.03  # m to drive from one look to the next ...
LOOK_ANGLE = math.radians(5.0)  # ... or to turn
NEAR = 0.02  # m about a robot that nothing may enter
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
        self.radius = survey.radius(name, max(span, *mounts))
        self._is_unsure = survey.by_odometry
        self.floor = Floor(self.radius + (UNSURE if self._is_unsure else 0.0))
        self._scan: Floor | None = None
        self._memory = Memory()
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
        return Explorer(self, self.floor, step, self._blind_angle())

    def pose(self) -> Pose:
        """Where the robot is."""
        return self._robot.pose()

    def turn_by(self, angle: float) -> None:
        """Turns in place."""
        self._robot.rotate(angle, self._look)

    def localise(self) -> None:
        """Looks all about and puts the pose right by what was seen before, by odometry."""
        if not self._is_unsure:
            return
        self._scan = Floor(self.radius)
        self._looked = None
        self.turn_by(self._blind_angle())
        here, seen = self.pose(), self._scan.edges()
        self._scan = None
        self._robot.correct(self._memory.recognise(here, seen))

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
        if self._looked is not None:
            off = here.seen_from(self._looked)
            if math.hypot(off.x, off.y) < LOOK_DISTANCE and abs(off.theta) < LOOK_ANGLE:
                return False
        self._looked = here
        for sensor, mount in self._eyes.items():
            eye = mount.placed_on(here)
            distance = self._robot.body.distance(sensor)
            sees = distance is not None
            if distance is None:
                distance = self._ranges[sensor]
            else:
                self._heed(eye.ahead(distance), here)
            reading = Reading(eye, self._cones[sensor], distance, sees)
            self.floor.see(reading)
            if self._scan is not None:
                self._scan.see(reading)
        return True

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


def survey_with(robot: "Robot", survey: Survey) -> None:
    """Explores with a robot and adds the map to the survey; raises MovementError."""
    explorer = Surveyor(robot, survey).explore()
    try:
        explorer.explore()
    except NoEndError as error:
        raise robot.failure(
            f"found {len(explorer.map.nodes)} places and no end: is the area closed?"
        ) from error
    finally:
        survey.add(robot.body.model.name, explorer.map)
