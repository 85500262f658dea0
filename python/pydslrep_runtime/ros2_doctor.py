"""What is there of the robots of a program in ROS 2, and what is wrong with it. Only `--drive` moves a robot."""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

from .backend import RobotSpec
from .errors import SimulatorError
from .facts import ROS2_BASE_FRAME, ROS2_ODOM_FRAME, ROS2_QOS
from .ros2 import full_name
from .ros2_findings import finding
from .ros2_link import Link, misfit, profile
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
from .ros2_turn import measure_turn
from .scene.findings import Finding, Severity
from .settings import CONNECT_TIMEOUT, MAX_READING_AGE

OBSERVATION = 2.0  # s in which messages are counted
GRACE = 4.0  # s after which no more topics are awaited if none has come; nodes announce themselves every 3 s
LOOK_PERIOD = 0.1  # s between two looks at who is there
SLOW = (
    8.0  # messages per second, below which control suffers; drivers of 10 vary a little
)
# The keys of a scene that name the topics.
KEYS = {
    "odometry": "odom",
    "pose": "pose",
    "range": "ranges",
    "scan": "scan",
    "command": "cmd-vel",
    "stamped command": "cmd-vel",
}

FINAL = {
    "wrong-type",
    "other-command",
    "incompatible-qos",
}  # what does not change while one waits

Row = dict[str, str | None]


class Watch:
    """What comes on a topic."""

    def __init__(self, topic: Topic, key: str) -> None:
        self.topic, self.key = topic, key
        self.latest: Any = None
        self._stamps: list[float] = []
        self._arrivals: list[float] = []

    def take(self, message: Any) -> None:
        """Counts a message."""
        self.latest = message
        self._stamps.append(seconds(message.header.stamp))
        self._arrivals.append(time.monotonic())

    def begin(self) -> None:
        """Forgets how many there were while all got to know each other."""
        self._stamps, self._arrivals = self._stamps[-1:], self._arrivals[-1:]

    def stands_still(self) -> bool:
        """Whether several messages have the same stamp."""
        return len(self._stamps) > 2 and len(set(self._stamps)) == 1

    def has_stamps(self) -> bool:
        """Whether its messages say when they were made."""
        return any(self._stamps)

    def rate(self) -> float | None:
        """Messages per second, by their stamps if they have any; None if that is unknown."""
        times = self._times()
        spent = times[-1] - times[0] if times else 0.0
        return (len(times) - 1) / spent if spent > 0.0 else None

    def gap(self) -> float:
        """Seconds between two messages, at most; the time that the latest one is waited for counts."""
        times = self._times()
        steps = [after - before for before, after in pairwise(times)]
        if self._arrivals:
            waited = time.monotonic() - self._arrivals[-1]
            steps.append(waited)
        return max(steps, default=math.inf)

    def frames(self) -> str:
        """Its frames, as far as its messages say them."""
        if self.latest is None:
            return ""
        frames = [
            self.latest.header.frame_id,
            getattr(self.latest, "child_frame_id", ""),
        ]
        return " to ".join(filter(None, frames))

    def _times(self) -> list[float]:
        return sorted(self._stamps) if self.has_stamps() else self._arrivals


class Examined:
    """One robot that is looked at."""

    def __init__(self, spec: RobotSpec, link: Link) -> None:
        self.spec, self._link = spec, link
        self._topics = Topics(spec.name, spec.ros2)
        self._is_reliable = spec.ros2.get("qos", ROS2_QOS) == "reliable"
        self.watches: dict[str, Watch] = {}
        self._sensors = {
            name: self._topics.sensor(name) for name in (*spec.sensors, *spec.bumpers)
        }
        for topic in (self._topics.pose, *self._sensors.values()):
            if topic.name not in self.watches:
                watch = self.watches[topic.name] = Watch(topic, KEYS[topic.what])
                link.subscribe(topic, watch.take, reliable=self._is_reliable)

    def is_settled(self) -> bool:
        """Whether all that has to be there is there, or waiting for it is in vain."""
        return bool(self._link.listeners(self._topics.command.name)) and all(
            watch.latest is not None or self._is_hopeless(watch)
            for watch in self.watches.values()
        )

    def rows(self) -> Iterator[Row]:
        """What is there, one line for each topic."""
        command = self._topics.command
        yield self._row(command, self._link.listeners(command.name))
        for watch in self.watches.values():
            rate = watch.rate()
            shown = None if rate is None else f"{rate:.1f} Hz"
            publishers = self._link.publishers(watch.topic.name)
            row = self._row(watch.topic, publishers)
            yield row | {"rate": shown, "frames": watch.frames() or None}

    def findings(self, *, is_simulated: bool) -> Iterator[Finding]:
        """What is wrong."""
        yield from self._check_command()
        for watch in self.watches.values():
            found = list(self._check_source(watch))
            yield from found or self._check_messages(watch, is_simulated=is_simulated)

    def _is_hopeless(self, watch: Watch) -> bool:
        codes = {each.rule.code for each in self._check_source(watch)}
        return not codes.isdisjoint(FINAL)

    def _row(self, topic: Topic, endpoints: Sequence[Any]) -> Row:
        types = sorted({each.topic_type for each in endpoints})
        return {
            "robot": self.spec.name,
            "topic": topic.name,
            "type": ", ".join(types) or None,
            "nodes": named(endpoints) or None,
            "rate": None,
            "frames": None,
        }

    def _finding(self, code: str, topic: Topic, **values: Any) -> Finding:
        return finding(code, self.spec.name, topic=topic.name, **values)

    def _check_command(self) -> Iterator[Finding]:
        command = self._topics.command
        listeners = self._link.listeners(command.name)
        if not listeners:
            known = self._known(command, self._link.listened(str(command.type)))
            yield self._finding("no-listener", command, known=known)
        elif all(each.topic_type != str(command.type) for each in listeners):
            yield self._wrong_type(command, listeners)
        else:
            ours = profile(10, reliable=True)
            misfits = [(each, misfit(ours, each.qos_profile)) for each in listeners]
            if all(reason for _, reason in misfits):
                yield self._misfit(command, *misfits[0])
        if others := self._link.publishers(command.name):
            yield self._finding("second-driver", command, nodes=named(others))

    def _check_source(self, watch: Watch) -> Iterator[Finding]:
        """Why nothing comes."""
        topic, publishers = watch.topic, self._link.publishers(watch.topic.name)
        if not publishers:
            known = self._known(topic, self._link.published(str(topic.type)))
            yield self._finding("missing-topic", topic, key=watch.key, known=known)
        elif all(each.topic_type != str(topic.type) for each in publishers):
            yield self._wrong_type(topic, publishers)
        elif watch.latest is None:
            ours = profile(10, reliable=self._is_reliable)
            misfits = [(each, misfit(each.qos_profile, ours)) for each in publishers]
            if all(reason for _, reason in misfits):
                yield self._misfit(topic, *misfits[0])
            else:
                yield self._finding("silent-topic", topic, node=named(publishers))

    def _check_messages(self, watch: Watch, *, is_simulated: bool) -> Iterator[Finding]:
        """What is wrong with what comes."""
        topic, publishers = watch.topic, self._link.publishers(watch.topic.name)
        node = named(publishers)
        for reason in self._nonsense(watch):
            yield self._finding("bad-reading", topic, reason=reason, node=node)
        if watch.stands_still() and (is_simulated or watch.has_stamps()):
            # A simulation may be paused, or wait for its script.
            if not is_simulated:
                yield self._finding("stands-still", topic, node=node)
        elif (gap := watch.gap()) > MAX_READING_AGE and not is_simulated:
            limit = MAX_READING_AGE
            yield self._finding("rare-messages", topic, gap=gap, limit=limit, node=node)
        elif (rate := watch.rate()) is not None and rate < SLOW:
            yield self._finding("slow-topic", topic, rate=rate, node=node)
        if len(publishers) > 1:
            count = len(publishers)
            yield self._finding("second-source", topic, count=count, nodes=node)
        if topic.what == "odometry":
            yield from self._check_frames(watch)

    def _check_frames(self, watch: Watch) -> Iterator[Finding]:
        settings, message = self.spec.ros2, watch.latest
        for key, found, expected in (
            (
                "odom-frame",
                message.header.frame_id,
                settings.get("odom_frame", ROS2_ODOM_FRAME),
            ),
            (
                "base-frame",
                message.child_frame_id,
                settings.get("base_frame", ROS2_BASE_FRAME),
            ),
        ):
            # Many a driver leaves them out.
            if found and found != expected:
                yield self._finding(
                    "other-frame", watch.topic, key=key, found=found, expected=expected
                )

    def _nonsense(self, watch: Watch) -> Iterator[str]:
        """What scripts would refuse."""
        message, topic = watch.latest, watch.topic
        checks: list[Callable[[], object]] = []
        if topic.what in ("odometry", "pose"):
            checks.append(lambda: heading(message.pose.pose.orientation))
        elif topic.what == "range":
            checks.append(lambda: measured(message))
        else:
            for sensor in self._sensors:
                _, _, bearing, reach, cone = self.spec.mounts[sensor]
                around, opening = math.radians(bearing), math.radians(cone)
                checks.append(
                    lambda around=around, opening=opening, reach=reach: nearest(  # type: ignore[misc]
                        message, around, opening, reach
                    )
                )
        for check in checks:
            try:
                check()
            except SimulatorError as error:
                yield str(error)

    def _wrong_type(self, topic: Topic, endpoints: Sequence[Any]) -> Finding:
        found = ", ".join(sorted({each.topic_type for each in endpoints}))
        types = {"found": found, "expected": str(topic.type)}
        if found in (str(TYPES["command"]), str(TYPES["stamped command"])):
            word = "true" if topic.what == "command" else "false"
            return self._finding("other-command", topic, word=word, **types)
        known = self._known(topic, self._link.published(str(topic.type)))
        key = KEYS[topic.what]
        return self._finding("wrong-type", topic, key=key, known=known, **types)

    def _misfit(self, topic: Topic, endpoint: Any, reason: str) -> Finding:
        node = full_name(endpoint)
        return self._finding("incompatible-qos", topic, node=node, reason=reason)

    def _known(self, topic: Topic, names: Sequence[str]) -> str:
        if names:
            return f"of its type are {', '.join(names)}"
        return f"no topic has its type, {topic.type}"


def named(endpoints: Sequence[Any]) -> str:
    """The names of nodes."""
    return ", ".join(sorted({full_name(each) for each in endpoints}))


def doctor(request: Mapping[str, Any]) -> dict[str, Any]:
    """The answer to a request: all topics, or those of robots with what is wrong; and what a turn has shown."""
    robots = [as_spec(each) for each in request["robots"]]
    link = Link("pydslrep_doctor")
    try:
        answer = look(link, robots)
    finally:
        link.close()
    notes: list[str] = []
    if request["drive"] and answer["reached"]:
        findings: list[Finding] = answer["findings"]
        is_simulated = any(each.rule.code == "simulation" for each in findings)
        for spec in robots:
            of_robot = [each for each in findings if each.robot == spec.name]
            if any(each.rule.severity != Severity.HINT for each in of_robot):
                findings.append(finding("not-driven", spec.name))
                continue
            note, found = measure_turn(spec, is_simulated=is_simulated)
            notes.append(note)
            findings += found
    shown = [each.as_json() for each in answer["findings"]]
    return answer | {"findings": shown, "notes": notes}


def look(link: Link, specs: Sequence[RobotSpec]) -> dict[str, Any]:
    """Waits for robots, counts their messages, and says what is there and wrong."""
    robots = [Examined(spec, link) for spec in specs]
    await_robots(link, robots)
    if not link.topics():
        return {"reached": False, "topics": [], "findings": [finding("no-topics")]}
    if not robots:
        return {"reached": True, "topics": list(all_topics(link)), "findings": []}
    for robot in robots:
        for watch in robot.watches.values():
            watch.begin()
    listen(link, OBSERVATION)
    is_simulated = bool(link.publishers(CLOCK))
    findings = [
        each for robot in robots for each in robot.findings(is_simulated=is_simulated)
    ]
    if is_simulated:
        findings.append(finding("simulation"))
    rows = [row for robot in robots for row in robot.rows()]
    return {"reached": True, "topics": rows, "findings": findings}


def await_robots(link: Link, robots: Sequence[Examined]) -> None:
    """Waits until all is there, or as long as something new may come."""
    known, changed = 0, time.monotonic()
    limit = changed + CONNECT_TIMEOUT
    while not robots or not all(robot.is_settled() for robot in robots):
        listen(link, LOOK_PERIOD)
        now = time.monotonic()
        heard = [
            each for robot in robots for each in robot.watches.values() if each.latest
        ]
        there = len(link.topics()) + len(heard)
        if there != known:
            known, changed = there, now
        if now > limit or (known > 0 and now > changed + GRACE):
            return


def listen(link: Link, duration: float) -> None:
    """Takes messages for some seconds of real time."""
    limit = time.monotonic() + duration
    while (rest := limit - time.monotonic()) > 0.0:
        link.wait(rest)


def all_topics(link: Link) -> Iterator[Row]:
    """Everything that somebody publishes or listens to."""
    for name in link.topics():
        endpoints = [*link.publishers(name), *link.listeners(name)]
        types = ", ".join(sorted({each.topic_type for each in endpoints}))
        yield {"robot": None, "topic": name, "type": types, "nodes": named(endpoints)}


def as_spec(robot: Mapping[str, Any]) -> RobotSpec:
    """A robot as its script would declare it."""
    sensors = robot["sensors"]
    names = {
        kind: tuple(each["name"] for each in sensors if each["kind"] == kind)
        for kind in ("distance", "bumper")
    }
    mounts = {
        each["name"]: (
            each["x"],
            each["y"],
            math.degrees(each["bearing"]),
            each["range"],
            math.degrees(each["cone"]),
        )
        for each in sensors
    }
    return RobotSpec(
        robot["name"],
        "",
        0,
        {wheel["name"]: wheel["radius"] for wheel in robot["wheels"]},
        names["distance"],
        names["bumper"],
        type=robot["type"],
        ros2=robot["ros2"],
        mounts=mounts,
    )
