"""What can be wrong with a robot in ROS 2: each finding with what to do about it.

`RULES` is the list: the checks refer to it, docs/ros2.md shows it, and the tests have a robot for most of them.
"""

from typing import Any

from .scene.findings import Finding, Rule, Severity

ERROR, WARNING, HINT = Severity.ERROR, Severity.WARNING, Severity.HINT

# In the order in which they are looked for.
RULES = (
    Rule(
        "no-topics",
        ERROR,
        "There are no topics of others",
        "there are no topics of others",
        "switch the robot on and start its driver; it must be in the same network, have the same ROS_DOMAIN_ID, and "
        "ROS_AUTOMATIC_DISCOVERY_RANGE must not keep its topics on another machine",
    ),
    Rule(
        "no-listener",
        ERROR,
        "Nobody listens to the robot's commands",
        "nobody listens to {topic}",
        "start the robot's driver, or name the topic that it listens to: `cmd-vel` or `namespace` in "
        "[robots.{robot}.ros2] of the scene; {known}",
    ),
    Rule(
        "missing-topic",
        ERROR,
        "Nobody publishes a topic",
        "nobody publishes {topic}",
        "start the robot's driver, or name the topic that it publishes: `{key}` or `namespace` in [robots.{robot}.ros2] "
        "of the scene; {known}",
    ),
    Rule(
        "wrong-type",
        ERROR,
        "A topic has another type",
        "{topic} is {found}, not {expected}",
        "name a topic of the right type with `{key}` in [robots.{robot}.ros2] of the scene; {known}",
    ),
    Rule(
        "other-command",
        ERROR,
        "Commands need a stamp, or must have none",
        "{topic} is {found}, not {expected}",
        "set `stamped = {word}` in [robots.{robot}.ros2] of the scene",
    ),
    Rule(
        "incompatible-qos",
        ERROR,
        "The quality of service of a topic does not fit",
        "the quality of service of {node} does not fit on {topic}: {reason}",
        "set `qos` in [robots.{robot}.ros2] of the scene to what it has, or change it in the settings of {node}",
    ),
    Rule(
        "silent-topic",
        ERROR,
        "Nothing comes on a topic",
        "nothing has come on {topic}, which {node} publishes",
        "look at what {node} says: a sensor may be off; between machines, a firewall may let the names through, but no "
        "messages",
    ),
    Rule(
        "bad-reading",
        ERROR,
        "A message makes no sense",
        "{topic}: {reason}",
        "look at it with `ros2 topic echo {topic}`, and at the settings of {node}",
    ),
    Rule(
        "stands-still",
        ERROR,
        "The stamps of a topic stand still",
        "the stamps on {topic} stand still, so that its messages get older and older",
        "look at what {node} says: it repeats what it has once measured",
    ),
    Rule(
        "rare-messages",
        ERROR,
        "Messages come too rarely",
        "up to {gap:.2f} s pass between two messages on {topic}; after {limit:g} s, scripts stop the robot",
        "let {node} publish at least 10 messages per second, better 20",
    ),
    Rule(
        "slow-topic",
        WARNING,
        "Messages come slowly",
        "{rate:.1f} messages per second come on {topic}: the robot arrives beside its goals",
        "let {node} publish at least 10 messages per second, better 20",
    ),
    Rule(
        "second-source",
        WARNING,
        "A topic has several publishers",
        "{topic} has {count} publishers, of {nodes}: what they say may contradict each other",
        "end all but one: a driver may have been started twice; several robots need a namespace each",
    ),
    Rule(
        "second-driver",
        WARNING,
        "Somebody else drives the robot",
        "{nodes} can drive the robot, too, by {topic}",
        "end it before a script drives, or let a multiplexer such as twist_mux decide",
    ),
    Rule(
        "other-frame",
        HINT,
        "The odometry has other frames",
        "{topic} has the frame {found}, not {expected}",
        'set `{key} = "{found}"` in [robots.{robot}.ros2] of the scene, if this is the frame of the wheels\' centre or of '
        "the odometry",
    ),
    Rule(
        "simulation",
        HINT,
        "There is a simulation",
        "there is a simulation, whose time is on /clock",
        "use `pydslrep run --target ros2 --sim-time`, so that the script keeps its time",
    ),
    Rule(
        "does-not-turn",
        ERROR,
        "The robot does not turn (`--drive`)",
        "told to turn by {told:.0f} deg/s, it turns by {found:.1f} deg/s",
        "look whether it obeys {topic}: an emergency stop, a motor that is off, or a limit of its driver may hold it",
    ),
    Rule(
        "turns-back",
        ERROR,
        "The robot turns the other way (`--drive`)",
        "told to turn to the left, it turns to the right by {found:.1f} deg/s",
        "exchange the left and the right wheels in the settings of its driver; the odometry counts to the left, too",
    ),
    Rule(
        "track",
        WARNING,
        "The robot turns by another angle than it is told (`--drive`)",
        "told to turn by {told:.1f} deg/s, it turns by {found:.1f} deg/s, as if its wheels were {fits:.3f} m apart, not "
        "{track:.3f} m",
        "measure how far the wheels are apart, and set that as `track` in the scene and in its driver (wheel_separation); "
        "of wheels that slide, the driver has to count on {fits:.3f} m",
    ),
    Rule(
        "not-driven",
        HINT,
        "It was not driven, as something is wrong",
        "--drive has not driven it, because of the findings above",
        "correct them first",
    ),
)

_BY_CODE = {rule.code: rule for rule in RULES}


def finding(code: str, robot: str | None = None, **values: Any) -> Finding:
    """A finding of the rule with a code."""
    return Finding(_BY_CODE[code], robot, {"robot": robot, **values})
