"""Robots that are driven through ROS 2: commands to their drivers, and readings from them."""

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

from . import drives
from .backend import Backend, RobotSpec, SensorCone
from .errors import SetupError, SimulatorError
from .facts import (
    ROBOT_TYPES,
    ROS2_BASE_FRAME,
    ROS2_QOS,
    ROS2_SPEED_LIMIT,
    ROS2_STAMPED,
    STEP,
    TRACK,
    WHEELBASE,
)
from .notes import Notes
from .pose import Pose
from .readings import LENGTH, check
from .ros2_link import Link, is_best_effort
from .ros2_topics import (
    CLOCK,
    TYPES,
    Topic,
    Topics,
    heading,
    measured,
    nearest,
    seconds,
)
from .settings import CONNECT_TIMEOUT, MAX_READING_AGE, PROBE_PERIOD, SILENCE_LIMIT

LOOK_PERIOD = 0.1  # s between two looks at who is there, while a robot is awaited
STEPS_PER_CHECK = 20  # after which the script looks for others that drive its robots
ROUNDING = 1e-6  # s


class Heard:
    """The newest message of a topic, and how old it is."""

    def __init__(self, now: Callable[[], float]) -> None:
        """`now` is the time of the script in seconds; the clock of who publishes may differ from it."""
        self.message: Any = None
        self.overtaken = (
            0  # messages that were older than one before them, since the newest
        )
        self._now, self._stamp = now, -math.inf
        self._offset = math.inf  # s from the publisher's clock to the script's, at most
        self._born = -math.inf

    def take(self, message: Any) -> None:
        """Takes a message, unless a newer one has overtaken it."""
        now, stamp = self._now(), seconds(message.header.stamp)
        if stamp < self._stamp:
            self.overtaken += 1
            return
        self.message, self._stamp, self.overtaken = message, stamp, 0
        # None takes less than no time: the fastest one tells how the clocks differ, and others were held up.
        self._offset = min(self._offset, now - stamp)
        self._born = stamp + self._offset if stamp else now

    def age(self) -> float:
        """Seconds since what it says was so; infinite if there is none."""
        return self._now() - self._born

    def taken(self) -> float:
        """When what it says was so, in seconds by the publisher's clock, or the script's if it has no stamp."""
        return self._stamp or self._born

    def reason(self) -> str:
        """Why there may be no newer one."""
        if self.overtaken:
            return f"{self.overtaken} messages have come since, all with older stamps"
        return "its driver may have ended, or the network is down"


class Ros2:
    """A node for all robots of a script, and their clock."""

    def __init__(self, *, sim_time: bool, timeout: float = SILENCE_LIMIT) -> None:
        """With `sim_time`, time is that of the topic /clock, else real time. Raises SetupError.

        The topic may stand still for `timeout` seconds of real time.
        """
        self._timeout = timeout
        self.time, self.time_step = 0.0, STEP
        self.link = Link("pydslrep")
        self._robots: list[Ros2Robot] = []
        self._notes = Notes()
        self.is_simulated = sim_time
        self._clock = -math.inf  # s, what /clock said last
        self._begin = self._due = self._last = 0.0
        if sim_time:
            self.link.subscribe(Topic(CLOCK, "clock"), self._take_clock, reliable=False)

    def now(self) -> float:
        """Seconds, from any beginning."""
        return self._clock if self.is_simulated else time.monotonic()

    def connect(self, spec: RobotSpec) -> "Ros2Robot":
        """Connects a robot; raises SetupError."""
        if self.is_simulated and self._clock == -math.inf:
            self.await_all(f"{CLOCK} is silent", self._missing_clock)
        robot = Ros2Robot(spec, self)
        self._robots.append(robot)
        self.await_all(f"robot {spec.name} is not there", robot.missing)
        return robot

    def start(self) -> None:
        """Time begins."""
        if not self.is_simulated and self.link.publishers(CLOCK):
            self._notes.say(
                f"there is a simulation, whose time is on {CLOCK}; this script keeps real time. With --sim-time it keeps "
                "that of the simulation"
            )
        self._begin = self._due = self._last = self.now()

    def advance(self) -> None:
        """Sends the commands, and takes what arrives until the next step."""
        for robot in self._robots:
            robot.send()
        self._due = max(self._due + self.time_step, self.now())
        if self.is_simulated:
            self._await_clock()
        else:
            while (rest := self._due - time.monotonic()) > 0.0:
                self.link.wait(rest)
        self.link.take_all()
        self._last = self.now()
        self.time = self._last - self._begin

    def close(self) -> None:
        """Waits until the drivers have the last commands, and leaves."""
        self.link.close(*(robot.commands for robot in self._robots))

    def await_all(
        self, what: str, missing: Callable[[], tuple[list[str], bool]]
    ) -> None:
        """Waits until nothing is missing; raises SetupError if that takes too long or cannot be any more."""
        limit = time.monotonic() + CONNECT_TIMEOUT
        while True:
            looked = time.monotonic()
            lacks, is_hopeless = missing()
            if not lacks:
                return
            if is_hopeless or looked > limit:
                raise SetupError(f"{what}: {'; '.join(lacks)}. {self._known()}")
            while time.monotonic() < looked + LOOK_PERIOD:
                self.link.wait(LOOK_PERIOD)

    def _known(self) -> str:
        topics = self.link.topics()
        if not topics:
            return "There are no topics of others: the robot may be off, on another network, or in another ROS_DOMAIN_ID"
        return f"The topics there are: {', '.join(topics)}"

    def _missing_clock(self) -> tuple[list[str], bool]:
        if self._clock > -math.inf:
            return [], False
        return what_is_wrong(self.link, Topic(CLOCK, "clock"), reliable=False)

    def _take_clock(self, message: Any) -> None:
        self._clock = seconds(message.clock)

    def _await_clock(self) -> None:
        """Waits for the next step of the simulation; while its time stands still, it is paused."""
        began = looked = time.monotonic()
        while self._clock < self._due - ROUNDING or self._clock <= self._last:
            if self._clock < self._last - ROUNDING:
                raise SimulatorError(
                    f"{CLOCK} went back from {self._last:g} s to {self._clock:g} s: the simulation was reset"
                )
            before = self._clock
            self.link.wait(LOOK_PERIOD)
            now = time.monotonic()
            if self._clock > before:
                began = now
            if now < looked + PROBE_PERIOD:
                continue
            looked = now
            if not self.link.publishers(CLOCK):
                raise SimulatorError(
                    f"nobody publishes {CLOCK} any more: the simulation has ended"
                )
            if now > began + self._timeout:
                raise SimulatorError(f"{CLOCK} stands still, for {self._timeout:g} s")
            if now > began + PROBE_PERIOD:
                self._notes.say_paused()


class Ros2Robot(Backend):
    """A robot with a driver for ROS 2."""

    def __init__(self, spec: RobotSpec, ros: Ros2) -> None:
        self.clock: Ros2 = ros
        self._spec, self._link, self._notes = spec, ros.link, Notes()
        settings = spec.ros2
        self._track = settings.get("track", TRACK)
        self._wheelbase = settings.get("wheelbase", WHEELBASE)
        self._limit = settings.get("speed_limit", ROS2_SPEED_LIMIT)
        self._frame = settings.get("base_frame", ROS2_BASE_FRAME)
        self._is_stamped = settings.get("stamped", ROS2_STAMPED)
        self._is_reliable = settings.get("qos", ROS2_QOS) == "reliable"
        self._radii = list(spec.wheels.values())
        self._type = ROBOT_TYPES[spec.type]
        self._drive = getattr(drives, self._type.drive)(
            self.wheel_mounts(), self._radii
        )
        self._topics = Topics(spec.name, settings)
        self._sensors = {
            name: self._topics.sensor(name) for name in (*spec.sensors, *spec.bumpers)
        }
        self._twist = (0.0, 0.0, 0.0)  # m/s ahead and to the left, rad/s
        self._steps = 0
        self._heard: dict[str, Heard] = {}  # by topic
        self._message = self._topics.command.type.load()
        try:
            for topic in (self._topics.pose, *self._sensors.values()):
                if topic.name not in self._heard:
                    heard = self._heard[topic.name] = Heard(ros.now)
                    self._link.subscribe(topic, heard.take, reliable=self._is_reliable)
            self.commands = self._link.publisher(self._topics.command)
        except Exception as error:
            raise SetupError(f"robot {spec.name}: {error}") from error

    def missing(self) -> tuple[list[str], bool]:
        """What of the robot is not there yet, and whether waiting is in vain."""
        lacks, is_hopeless = [], False
        for topic in {self._topics.pose, *self._sensors.values()}:
            if self._heard[topic.name].message is None:
                wrong, is_final = what_is_wrong(
                    self._link, topic, reliable=self._is_reliable
                )
                lacks += wrong
                is_hopeless |= is_final
        command = self._topics.command
        types = {each.topic_type for each in self._link.listeners(command.name)}
        if types and str(command.type) not in types:
            lacks.append(other_type(command, types))
            is_hopeless = True
        elif not types or self.commands.get_subscription_count() == 0:
            lacks.append(f"nobody listens to {command.name}")
        return sorted(lacks), is_hopeless

    def wheel_mounts(self) -> Sequence[tuple[float, float]]:
        """The positions of the wheels on the body."""
        half, front = self._track / 2.0, self._wheelbase / 2.0
        if len(self._radii) == 2:
            return [(0.0, half), (0.0, -half)]
        return [(front, half), (-front, half), (front, -half), (-front, -half)]

    def pose(self) -> Pose:
        """The pose of the robot's frame, which is the wheels' centre; raises SimulatorError if it is too old."""
        topic = self._topics.pose
        heard = self._heard[topic.name]
        if heard.age() > MAX_READING_AGE + ROUNDING:
            raise SimulatorError(
                f"the {topic.what} on {topic.name} is {heard.age():.2f} s old, and the robot must not drive blindly: "
                f"{heard.reason()}"
            )
        pose = heard.message.pose.pose
        x, y = float(pose.position.x), float(pose.position.y)
        check(f"{topic.name}: position.x", x, LENGTH)
        check(f"{topic.name}: position.y", y, LENGTH)
        try:
            return Pose(x, y, heading(pose.orientation))
        except SimulatorError as error:
            raise SimulatorError(f"{topic.name}: {error}") from None

    def pose_time(self) -> float:
        """When its pose was so, in seconds by the clock of its stamps; differences do not depend on when messages came."""
        return self._heard[self._topics.pose.name].taken()

    @property
    def turn_rate(self) -> float:
        """How fast it is told to turn, in rad/s."""
        return self._twist[2]

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets what the next commands are: the motion of a body whose wheels turn like that, within the speed limit."""
        rims = [rate * radius for rate, radius in zip(rates, self._radii, strict=True)]
        fastest = max(map(abs, rims))
        share = min(1.0, self._limit / fastest) if fastest > 0.0 else 1.0
        if share < 1.0 - 1e-9:
            self._notes.say(
                f"robot {self._spec.name} drives at {self._limit:g} m/s, its speed-limit, not at {fastest:.2f} m/s"
            )
        sideways = sum(map(math.prod, zip(self._type.pushes, rims, strict=True)))
        count = len(rims)
        self._twist = (
            share * sum(rims) / count,
            share * sideways / count,
            share * self._drive.turn_rate(rates),
        )

    def send(self) -> None:
        """Sends the command once: its driver stops when none has come for a while."""
        self._steps += 1
        if self._steps % STEPS_PER_CHECK == 1:
            self._check_driver()
        message = self._message()
        twist = message
        if self._is_stamped:
            now = self.clock.now() if self.clock.is_simulated else time.time()
            stamp = message.header.stamp
            stamp.sec, stamp.nanosec = int(now), int(now % 1.0 * 1e9)
            message.header.frame_id, twist = self._frame, message.twist
        twist.linear.x, twist.linear.y, twist.angular.z = self._twist
        self.commands.publish(message)

    def detects(self, sensor: str) -> bool:
        """Whether a sensor detects an object."""
        return self.distance(sensor) is not None

    def distance(self, sensor: str) -> float | None:
        """The distance that a sensor measures, in metres; None if it detects nothing."""
        topic = self._sensors[sensor]
        message = self._heard[topic.name].message
        try:
            if topic.what == "range":
                return measured(message)
            _, _, bearing, reach, cone = self._mount(sensor)
            return nearest(message, math.radians(bearing), math.radians(cone), reach)
        except SimulatorError as error:
            raise SimulatorError(f"sensor {sensor}, {topic.name}: {error}") from None

    def reading_age(self, sensor: str) -> float:
        """How old the reading of a sensor is, in seconds."""
        return self._heard[self._sensors[sensor].name].age()

    def sensor_cone(self, sensor: str) -> SensorCone:
        """The mount and detection volume of a sensor."""
        x, y, bearing, reach, cone = self._mount(sensor)
        return SensorCone(Pose(x, y, math.radians(bearing)), reach, math.radians(cone))

    def stall_reason(self) -> str:
        """Why the robot may not move although its wheels should turn."""
        command = self._topics.command.name
        if not self._link.listeners(command):
            return f"nobody listens to {command} any more"
        return f"an obstacle may be in the way, or its driver does not obey {command}"

    def stop(self) -> None:
        """Commands it to stop, twice: one may be lost."""
        self._twist = (0.0, 0.0, 0.0)
        for _ in range(2):
            self.send()

    def _mount(self, sensor: str) -> tuple[float, float, float, float, float]:
        try:
            return self._spec.mounts[sensor]
        except KeyError:
            raise SimulatorError(f"nobody says where sensor {sensor} is") from None

    def _check_driver(self) -> None:
        """Says if somebody else drives the robot, too."""
        command = self._topics.command.name
        if others := self._link.publishers(command):
            names = ", ".join(sorted({full_name(each) for each in others}))
            self._notes.say(
                f"somebody else drives robot {self._spec.name}, too: {names} publishes on {command}. End one of them"
            )


def full_name(endpoint: Any) -> str:
    """The name of a node with its namespace."""
    return f"{endpoint.node_namespace.rstrip('/')}/{endpoint.node_name}"


def what_is_wrong(
    link: Link, topic: Topic, *, reliable: bool
) -> tuple[list[str], bool]:
    """Why nothing is heard of a topic, and whether waiting is in vain."""
    publishers = link.publishers(topic.name)
    types = {each.topic_type for each in publishers}
    if not types:
        return [f"nobody publishes {topic.name}"], False
    if str(topic.type) not in types:
        return [other_type(topic, types)], True
    if reliable and all(map(is_best_effort, publishers)):
        return [f'{topic.name} is not reliable: set qos = "best-effort"'], True
    return [f"nothing has come on {topic.name}"], False


def other_type(topic: Topic, types: set[str]) -> str:
    """Says that a topic has another type than it should."""
    hint = ""
    if types & {str(TYPES["command"]), str(TYPES["stamped command"])}:
        word = "true" if topic.what == "command" else "false"
        hint = f": set stamped = {word} in the scene"
    return f"{topic.name} is {', '.join(sorted(types))}, not {topic.type}{hint}"
