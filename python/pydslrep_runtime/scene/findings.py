"""What can be wrong with a scene: each finding with what to do about it in CoppeliaSim.

`RULES` is the list: the checks refer to it, docs/coppeliasim.md shows it, and the tests have scenes for every rule. Menus
and dialogs have the names of CoppeliaSim's manual.
"""

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any


class Severity(StrEnum):
    """How much a finding matters."""

    ERROR = "error"
    """The robot does not drive, or not where it should."""
    WARNING = "warning"
    """The robot drives, but arrives late or beside its goal."""
    HINT = "hint"
    """It can be better."""


@dataclass(frozen=True)
class Rule:
    """One thing that can be wrong."""

    code: str
    severity: Severity
    title: str  # for the documentation
    message: str  # a template
    help: str  # a template; what to do


@dataclass(frozen=True)
class Finding:
    """A rule that a scene breaks."""

    rule: Rule
    robot: str | None = None
    """The robot of the program that cannot drive because of it; None if none can."""
    values: dict[str, Any] = field(default_factory=dict)
    """What the templates name."""

    @property
    def message(self) -> str:
        """What is wrong."""
        return self.rule.message.format(**self.values)

    @property
    def help(self) -> str:
        """What to do."""
        return self.rule.help.format(**self.values)

    def as_json(self) -> dict[str, str | None]:
        """For `pydslrep doctor`."""
        return {
            "code": self.rule.code,
            "severity": str(self.rule.severity),
            "robot": self.robot,
            "message": self.message,
            "help": self.help,
        }


ERROR, WARNING, HINT = Severity.ERROR, Severity.WARNING, Severity.HINT

JOINT_DYNAMICS = "double-click the icon of {object} in the scene hierarchy, click [Dynamic properties dialog] of the joint, "
SHAPE_DYNAMICS = "double-click the icon of {object} in the scene hierarchy, click [Dynamic properties dialog] of the shape, "

FRAME = (
    "a mesh: stand the robot upright and let it face along x of the world, select {object}, and choose [Edit > Shape "
    "reference frame > Relocate to world origin], then [Relocate to mesh center] there; a primitive shape keeps its axes: "
    "add another cuboid with [Add > Primitive shape], whose x points forward, y to the left and z up, give it the alias "
    "{robot}, drag joints and sensors onto it in the scene hierarchy, and remove {object}"
)

# In the order in which they are looked for: the first one of a robot is the most likely cause of others.
RULES = (
    Rule(
        "no-connection",
        ERROR,
        "Nothing listens at the address",
        "nothing listens at {address}",
        "start CoppeliaSim there; the ZMQ remote API server under [Modules > Connectivity] listens on port 23000",
    ),
    Rule(
        "legacy-port",
        ERROR,
        "The port is that of the legacy remote API",
        "no reply from {address}: 19999 is the port of the legacy remote API, not of ZeroMQ",
        "use port 23000: in the program, or with --port 23000",
    ),
    Rule(
        "no-reply",
        ERROR,
        "Something listens at the address, but does not reply",
        "{address} accepts connections, but does not reply",
        "if the simulation is paused, choose [Simulation > Start simulation]: CoppeliaSim 4.6 does not reply while it is "
        "paused; otherwise another program may use the port",
    ),
    Rule(
        "old-version",
        ERROR,
        "CoppeliaSim is older than 4.6",
        "this is CoppeliaSim {version}; scripts need 4.6 or later",
        "install a newer CoppeliaSim, or generate the script for the legacy remote API with --target vrep",
    ),
    Rule(
        "no-main-script",
        ERROR,
        "The scene has no main script",
        "the scene has no main script, without which a simulation does nothing",
        "`pydslrep scene push` adds one; [File > New scene] has one, too: copy your objects into it",
    ),
    Rule(
        "paused",
        ERROR,
        "The simulation is paused",
        "the simulation is paused at {time:.2f} s",
        "choose [Simulation > Start simulation] to resume it, or [Simulation > Stop simulation]",
    ),
    Rule(
        "time-held",
        ERROR,
        "Another client holds the time",
        "another client holds the time: the simulation runs, but stands still at {time:.2f} s",
        "end the other program, then choose [Simulation > Stop simulation]; a client that was killed holds the time for "
        "up to 10 minutes otherwise",
    ),
    Rule(
        "time-step",
        HINT,
        "The time step is longer than 50 ms",
        "a step of the simulation takes {milliseconds:g} ms",
        "set Simulation dt to 50 ms in [Simulation > Simulation settings]; with 10 ms, robots arrive ten times nearer",
    ),
    Rule(
        "physics-step",
        WARNING,
        "The step of the physics engine is longer than 5 ms",
        "the physics engine takes steps of {milliseconds:g} ms, in which wheels stick and slip: robots arrive centimetres "
        "beside their goals, and late",
        "stop the simulation, and set Dynamics dt to 5 ms in [Simulation > Simulation settings]",
    ),
    Rule(
        "robot-missing",
        ERROR,
        "There is no object with the robot's name",
        "there is no object {paths}",
        "double-click the alias of the robot's body in the scene hierarchy and change it to {robot}; or build the scene "
        "with `pydslrep scene push`",
    ),
    Rule(
        "robot-kind",
        ERROR,
        "The object with the robot's name is a joint or a sensor",
        "{object} is a {kind}, not the robot's body",
        "give the alias {robot} to the shape that carries the wheels",
    ),
    Rule(
        "duplicate-name",
        ERROR,
        "Two objects have the same name",
        "two objects are called {object}: {first} and {second}; the script uses the first",
        "double-click one of the two aliases in the scene hierarchy and change it",
    ),
    Rule(
        "static-body",
        ERROR,
        "The robot's body is static",
        "{object} does not move, as it is {kind}",
        SHAPE_DYNAMICS
        + "and check Body is dynamic; only a shape can be dynamic: the alias {robot} belongs to it",
    ),
    Rule(
        "nested-chassis",
        ERROR,
        "The robot's name is that of an object above its chassis",
        "{object} stays where it is while its chassis {chassis} drives away",
        "give the alias {robot} to {chassis}, and detach that with [Edit > Set parent-less]",
    ),
    Rule(
        "fallen",
        ERROR,
        "The robot has fallen over, or off its floor",
        "{object} has fallen: it is {depth:.2f} m below the height of the floor, and {angle:.0f}° off the vertical",
        "choose [Simulation > Stop simulation], which puts it back; its floor must be larger than its way: `pydslrep scene "
        "push` builds one",
    ),
    Rule(
        "tilted-body",
        ERROR,
        "The z axis of the robot's body does not point up",
        "the z axis of {object} is {angle:.0f}° off the vertical",
        FRAME,
    ),
    Rule(
        "wrong-forward",
        ERROR,
        "The x axis of the robot's body does not point forward",
        "the axis of {joint} is {angle:.0f}° off the y axis of {object}",
        FRAME,
    ),
    Rule(
        "swapped-wheels",
        ERROR,
        "The left wheel is on the right",
        "{left} is not to the left of {right}, as {object} faces",
        "double-click the aliases of the two wheels in the scene hierarchy and swap them; or, if x of {object} points "
        "backward: " + FRAME,
    ),
    Rule(
        "wheel-missing",
        ERROR,
        "There is no joint with a wheel's name",
        "there is no joint {paths}",
        "change the alias of the wheel's joint in the scene hierarchy to {part}, below {robot}",
    ),
    Rule(
        "wheel-kind",
        ERROR,
        "The object with a wheel's name is not a joint",
        "{object} is a {kind}, not a joint",
        "the alias {part} belongs to the joint of the wheel, between the body and the wheel's shape",
    ),
    Rule(
        "joint-type",
        ERROR,
        "A wheel's joint does not rotate",
        "{object} is a {kind} joint, not a revolute one",
        "replace it with [Add > Joint > Revolute]",
    ),
    Rule(
        "joint-mode",
        ERROR,
        "A wheel's joint is not dynamic",
        "{object} is in {mode} mode, in which its motor drives nothing",
        "double-click the icon of {object} in the scene hierarchy and set Mode to Dynamic mode",
    ),
    Rule(
        "motor-off",
        ERROR,
        "A wheel's motor is off",
        "{object} has no motor, as its control mode is Free",
        JOINT_DYNAMICS + "and set Control mode to Velocity",
    ),
    Rule(
        "control-mode",
        ERROR,
        "A wheel's joint is not controlled by velocity",
        "{object} ignores velocities, as its control mode is {mode}",
        JOINT_DYNAMICS + "and set Control mode to Velocity",
    ),
    Rule(
        "no-torque",
        ERROR,
        "A wheel's motor has no torque",
        "the motor of {object} has a torque of 0 N·m",
        JOINT_DYNAMICS + "and set Max. torque to {enough:.2g} N·m or more",
    ),
    Rule(
        "weak-motor",
        WARNING,
        "A wheel's motor is weak",
        "the motor of {object} has a torque of {torque:.2g} N·m, too little to accelerate {mass:.2g} kg as planned",
        JOINT_DYNAMICS + "and set Max. torque to {enough:.2g} N·m or more",
    ),
    Rule(
        "no-wheel-shape",
        ERROR,
        "There is no wheel below a joint",
        "{object} turns nothing, as there is no shape below it",
        "drag the wheel's shape onto {object} in the scene hierarchy",
    ),
    Rule(
        "static-wheel",
        ERROR,
        "A wheel is static",
        "{object} does not turn, as it is static",
        SHAPE_DYNAMICS + "and check Body is dynamic",
    ),
    Rule(
        "ghost-wheel",
        ERROR,
        "A wheel does not touch anything",
        "{object} sinks into the floor, as it is not respondable",
        SHAPE_DYNAMICS + "and check Body is respondable",
    ),
    Rule(
        "rollers-collide",
        ERROR,
        "Rollers of a mecanum wheel collide with each other",
        "{first} and {second} overlap and collide with each other: they push the robot around, and brake it",
        "stop the simulation, and build the robot again with `pydslrep scene push --replace`; for a robot of your own, "
        "double-click the icon of each roller in the scene hierarchy, click [Dynamic properties dialog] of the shape, and "
        "uncheck all local boxes of Respondable mask",
    ),
    Rule(
        "wheel-radius",
        WARNING,
        "A wheel has another radius than in the program",
        "{object} has a radius of {found:.4g} m, the program says {expected:.4g} m",
        "correct the radius in the program; distances are right in any case, speeds are not",
    ),
    Rule(
        "sensor-missing",
        ERROR,
        "There is no proximity sensor with a sensor's name",
        "there is no proximity sensor {paths}",
        "change the alias of the sensor in the scene hierarchy to {part}, below {robot}",
    ),
    Rule(
        "sensor-kind",
        ERROR,
        "The object with a sensor's name is not a proximity sensor",
        "{object} is a {kind}, not a proximity sensor",
        "replace it with [Add > Proximity sensor]",
    ),
    Rule(
        "sensor-sees-floor",
        ERROR,
        "A sensor sees the floor",
        "{object} sees the floor, {floor}, {distance:.2f} m ahead: to the robot, that is an obstacle",
        "double-click the icon of {floor} in the scene hierarchy, click Common, and uncheck Detectable; or raise {object}, "
        "or let it look up",
    ),
    Rule(
        "wheels-spin",
        ERROR,
        "The wheels turn, but the body does not move",
        "the wheels of {object} turn, but the body does not move",
        "look for an obstacle in its way; otherwise the wheels do not touch the floor, or carry too little of its mass",
    ),
)

_BY_CODE = {rule.code: rule for rule in RULES}


def finding(code: str, robot: str | None = None, **values: Any) -> Finding:
    """A finding of the rule with a code."""
    return Finding(_BY_CODE[code], robot, {"robot": robot, **values})
