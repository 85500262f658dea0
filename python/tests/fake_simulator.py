"""A small kinematic simulator with the interface of CoppeliaSim's client.

It shares no code with the parts under test. Wheels follow their targets with limited acceleration; bodies move by the
least-squares fit to all wheels.
"""

import math
import random
from collections import Counter, deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import cbor2
import pytest
from pydslrep_runtime import remote_api

SUBSTEPS = 8


@dataclass
class FakeJoint:
    """A wheel's joint: its mount, its target and its current rate."""

    name: str
    x: float
    y: float
    radius: float = 0.045
    roller: float = 0.0  # 0 for standard wheels, +1 or -1 for the two orientations of mecanum rollers
    axis_sign: float = 1.0  # -1: the joint's axis points to the body's right
    mode: int = 4  # velocity
    target: float = 0.0
    rate: float = 0.0
    angle: float = 0.0


@dataclass
class FakeRobot:
    """A body with wheels; its pose is that of the body's origin."""

    name: str
    joints: list[FakeJoint]
    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0
    motor_acceleration: float = 40.0  # rad/s²
    slip: float = 0.0  # standard deviation of each wheel's traction
    mean_slip: float = 0.0  # how much less it moves than its wheels roll
    # How much less it turns than its wheels roll; None for as much as four plain wheels with full friction.
    scrub: float | None = None
    drift: float = 0.0  # m that it slides to its left per radian that it turns
    is_static: bool = False
    tremor: float = 0.0  # m and radians that contacts move it in every step
    wall: float = math.inf  # the body's x cannot exceed this
    edge: float = math.inf  # where its floor ends in x
    height: float = 0.1  # m
    sinking: float = 0.0  # m/s
    tilt: float = 0.0  # radians about its x axis
    kerb: float = -math.inf  # it slides along this where y would fall below it
    # Whether each detects something, or how far away that is.
    sensors: dict[str, Callable[["FakeRobot"], Any]] = field(default_factory=dict)
    rate_history: list[list[float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.start = self.x, self.y, self.theta
        if self.scrub is None:
            self.scrub = usual_scrub(self.joints)

    def advance(self, dt: float, noise: random.Random) -> None:
        """Moves for dt seconds."""
        traction = [
            1.0 - self.mean_slip + (noise.gauss(0.0, self.slip) if self.slip else 0.0)
            for _ in self.joints
        ]
        if self.x > self.edge:
            self.sinking += 9.81 * dt
            self.height -= self.sinking * dt
        before = self.theta
        contacts = Contacts.of(self.joints, traction)
        for _ in range(SUBSTEPS):
            self._substep(dt / SUBSTEPS, contacts)
        slid = self.drift * (self.theta - before)
        self.x -= slid * math.sin(self.theta)
        self.y += slid * math.cos(self.theta)
        if self.tremor:
            self.x += noise.uniform(-self.tremor, self.tremor)
            self.theta += noise.uniform(-self.tremor, self.tremor)
        self.rate_history.append(
            [joint.axis_sign * joint.rate for joint in self.joints]
        )

    def _substep(self, dt: float, contacts: "Contacts") -> None:
        limit = self.motor_acceleration * dt
        for joint in self.joints:
            change = joint.target - joint.rate if joint.mode == 4 else -joint.rate
            joint.rate += max(-limit, min(limit, change)) if change else 0.0
            joint.angle += joint.rate * dt
        vx, vy, omega = self.twist(contacts)
        middle = self.theta + omega * dt / 2.0
        cos, sin = math.cos(middle), math.sin(middle)
        x = self.x + (vx * cos - vy * sin) * dt
        if x > self.wall:
            return
        self.x = x
        self.y = max(self.y + (vx * sin + vy * cos) * dt, self.kerb)
        self.theta += omega * dt

    def twist(self, contacts: "Contacts") -> tuple[float, float, float]:
        """The twist of the body's origin; the wheels are symmetric about their centre."""
        vx = vy = omega = 0.0
        for joint, (grip, ahead, left, turn) in zip(
            self.joints, contacts.wheels, strict=True
        ):
            rim = joint.rate * grip
            vx += rim * ahead
            vy += rim * left
            omega += rim * turn
        omega *= 1.0 - (self.scrub or 0.0)
        # from the wheels' centre to the body's origin
        return vx + omega * contacts.cy, vy - omega * contacts.cx, omega


@dataclass(frozen=True)
class Contacts:
    """What does not change during a step: where the wheels are, and how well they grip.

    The speed of a wheel's rim is vx + roller vy - arm omega.
    """

    cx: float  # m: the centre of all wheels
    cy: float
    # Of each: its rim's speed per radian, and what that adds to vx, vy and omega.
    wheels: Sequence[tuple[float, float, float, float]]

    @classmethod
    def of(cls, joints: Sequence[FakeJoint], traction: Sequence[float]) -> "Contacts":
        """Those of joints with their tractions."""
        cx = sum(joint.x for joint in joints) / len(joints)
        cy = sum(joint.y for joint in joints) / len(joints)
        arms = [(joint.y - cy) - joint.roller * (joint.x - cx) for joint in joints]
        rollers = sum(joint.roller**2 for joint in joints) or 1.0
        squares = sum(arm * arm for arm in arms)
        wheels = [
            (
                joint.axis_sign * joint.radius * factor,
                1.0 / len(joints),
                joint.roller / rollers,
                -arm / squares,
            )
            for joint, factor, arm in zip(joints, traction, arms, strict=True)
        ]
        return cls(cx, cy, wheels)


def usual_scrub(joints: Sequence[FakeJoint]) -> float:
    """How much less plain wheels turn a robot than they roll: docs/kinematics.md."""
    if any(joint.roller for joint in joints):
        return 0.0
    long = max(joint.x for joint in joints) - min(joint.x for joint in joints)
    wide = max(joint.y for joint in joints) - min(joint.y for joint in joints)
    return 1.0 - 1.0 / (1.0 + (long / wide) ** 2) if wide else 0.0


def two_wheel_joints(track: float = 0.3, **options: Any) -> list[FakeJoint]:
    """Joints with the names of the article."""
    return [
        FakeJoint("wheelL", 0.0, track / 2.0, **options),
        FakeJoint("wheelR", 0.0, -track / 2.0, **options),
    ]


def four_wheel_joints(
    track: float = 0.3,
    wheelbase: float = 0.25,
    *,
    mecanum: bool = False,
    **options: Any,
) -> list[FakeJoint]:
    """Joints with the names and the order of the article."""
    x, y = wheelbase / 2.0, track / 2.0
    places = {
        "wheelL0": (x, y),
        "wheelL1": (-x, y),
        "wheelR0": (x, -y),
        "wheelR1": (-x, -y),
    }
    return [
        FakeJoint(
            name,
            px,
            py,
            roller=-math.copysign(1.0, px * py) if mecanum else 0.0,
            **options,
        )
        for name, (px, py) in places.items()
    ]


class FakeWorld:
    """The simulator: robots, time, and the clients in stepping mode."""

    def __init__(self, *robots: FakeRobot, dt: float = 0.05, seed: int = 1) -> None:
        self.robots = {robot.name: robot for robot in robots}
        self.dt = dt
        self.steps = 0
        self.running = self.puts_back = False
        self.calls: Counter[str] = Counter()
        self.aliases: dict[str, str] = {}
        self.before_step: Callable[[], None] = lambda: None
        self.holders: dict[str, int] = {}
        self.noise = random.Random(seed)
        self.objects: list[Any] = []
        self.paths: dict[str, list[int]] = {}
        for robot in robots:
            self._add(f"/{robot.name}", robot)
            for joint in robot.joints:
                self._add(f"/{robot.name}/{joint.name}", (robot, joint))
            for sensor in robot.sensors:
                self._add(f"/{robot.name}/{sensor}", (robot, sensor))

    def _add(self, path: str, thing: Any) -> None:
        self.paths.setdefault(path, []).append(len(self.objects) + 10)
        self.objects.append(thing)

    def object(self, handle: int) -> Any:
        """The object of a handle."""
        return self.objects[handle - 10]

    def step(self) -> None:
        """Moves all robots."""
        self.before_step()
        for robot in self.robots.values():
            robot.advance(self.dt, self.noise)
        self.steps += 1

    def serve(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Takes the place of all simulators."""

        def client(host: str, port: int) -> FakeClient:
            return FakeClient(self, f"{host}:{port}/{len(self.clients())}")

        monkeypatch.setattr(remote_api, "RemoteAPIClient", client)
        line = lambda _address, _limit: FakeLine(FakeSocket(self))  # noqa: E731
        monkeypatch.setattr(remote_api, "connect", line)

    def clients(self) -> list["FakeClient"]:
        """All clients so far."""
        return FakeClient.made.setdefault(id(self), [])


class FakeSocket:
    """Answers requests at once, one after the other."""

    rcvtimeo = -1

    def __init__(self, world: FakeWorld) -> None:
        self._world = world
        self._frames: deque[bytes] = deque()

    def send(self, frame: bytes, _flags: int) -> None:
        """Takes a frame of a request; the first one is empty."""
        if frame:
            self._frames.append(cbor2.dumps(self._answer(cbor2.loads(frame))))
        else:
            self._frames.append(b"")

    def recv(self) -> bytes:
        """The next frame of the oldest reply."""
        return self._frames.popleft()

    def close(self, linger: int | None = None) -> None:
        """Closes nothing."""

    def _answer(self, request: dict[str, Any]) -> dict[str, Any]:
        assert request["argsL"] == len(request["args"])
        namespace, _, function = request["func"].partition(".")
        assert namespace == "sim"
        sim = FakeSim(self._world, request["uuid"])
        try:
            value = getattr(sim, function)(*request["args"])
        except AssertionError:
            raise
        except Exception as error:
            return {"err": str(error)}
        if value is None:
            return {"ret": []}
        return {"ret": list(value) if isinstance(value, tuple) else [value]}


class FakeLine:
    """A connection that is never lost."""

    def __init__(self, socket: FakeSocket) -> None:
        self.socket = socket

    def is_lost(self) -> bool:
        """Never."""
        return False

    def close(self, linger: int | None = None) -> None:
        """Closes nothing."""


class FakeClient:
    """The parts of the client's class that scripts use."""

    made: dict[int, list["FakeClient"]] = {}  # noqa: RUF012

    def __init__(self, world: FakeWorld, uuid: str) -> None:
        world.clients().append(self)
        self.socket: Any = FakeSocket(world)
        self.world, self.uuid = world, uuid

    def require(self, name: str) -> "FakeSim":
        """The simulator's functions."""
        assert name == "sim"
        return FakeSim(self.world, self.uuid)


class FakeSim:
    """The functions and constants that scripts use, as specified by the remote API."""

    simulation_stopped = 0
    simulation_advancing = 16
    jointintparam_dynctrlmode = 2039
    jointdynctrl_velocity = 4
    object_shape_type = 0
    object_joint_type = 1
    shapeintparam_static = 3003
    object_proximitysensor_type = 5

    def __init__(self, world: FakeWorld, uuid: str) -> None:
        self._world, self._uuid = world, uuid

    def __getattribute__(self, name: str) -> Any:
        """Counts calls."""
        value = object.__getattribute__(self, name)
        if not name.startswith("_") and callable(value):
            self._world.calls[name] += 1
        return value

    def getObject(self, path: str, options: dict[str, Any]) -> int:
        """A handle, or -1."""
        assert options.keys() == {"noError", "index"}
        assert options["noError"] is True
        return dict(enumerate(self._world.paths.get(path, []))).get(
            options["index"], -1
        )

    def getObjectType(self, handle: int) -> int:
        """A shape, a joint or a proximity sensor."""
        thing = self._world.object(handle)
        if isinstance(thing, FakeRobot):
            return 0
        return 1 if isinstance(thing[1], FakeJoint) else 5

    def getObjectMatrix(self, handle: int) -> list[float]:
        """Rows of rotation and translation."""
        thing = self._world.object(handle)
        robot, joint = thing if isinstance(thing, tuple) else (thing, None)
        c, s = math.cos(robot.theta), math.sin(robot.theta)
        if joint is None:
            up, side = math.cos(robot.tilt), math.sin(robot.tilt)
            return [
                *(c, -s * up, s * side, robot.x),
                *(s, c * up, -c * side, robot.y),
                *(0.0, side, up, robot.height),
            ]
        # the joint's z axis points to the left, or right; its x axis ahead
        x, y = robot.x + c * joint.x - s * joint.y, robot.y + s * joint.x + c * joint.y
        k = joint.axis_sign
        return [c, 0.0, -s * k, x, s, 0.0, c * k, y, 0.0, -k, 0.0, 0.045]

    def getObjectParent(self, handle: int) -> int:
        """None: robots are at the top."""
        assert isinstance(self._world.object(handle), FakeRobot)
        return -1

    def setJointTargetVelocity(self, handle: int, velocity: float) -> int:
        """Sets a motor's target."""
        assert math.isfinite(velocity)
        self._world.object(handle)[1].target = velocity
        return 1

    def getJointPosition(self, handle: int) -> float:
        """A joint's angle about its own axis."""
        angle: float = self._world.object(handle)[1].angle
        return angle

    def getJointTargetVelocity(self, handle: int) -> float:
        """A motor's target."""
        target: float = self._world.object(handle)[1].target
        return target

    def readProximitySensor(self, handle: int) -> tuple[Any, ...]:
        """State and more; no reading before the first step."""
        robot, sensor = self._world.object(handle)
        found = None if self._world.steps == 0 else robot.sensors[sensor](robot)
        state = -1 if self._world.steps == 0 else int(found not in (None, False))
        distance = found if isinstance(found, float) else 0.0
        return (state, distance, [0.0, 0.0, 0.0], -1, [0.0, 0.0, 0.0])

    def handleProximitySensor(self, handle: int) -> tuple[Any, ...]:
        """Only for sensors with explicit handling."""
        raise Exception(
            "316: in sim.handleProximitySensor: object not tagged for explicit handling."
        )

    def getObjectInt32Param(self, handle: int, parameter: int) -> int:
        """A joint's control mode, or whether a shape is static."""
        if parameter == self.shapeintparam_static:
            return int(self._world.object(handle).is_static)
        assert parameter == self.jointintparam_dynctrlmode
        mode: int = self._world.object(handle)[1].mode
        return mode

    def getSimulationTimeStep(self) -> float:
        """Seconds."""
        return self._world.dt

    def getSimulationTime(self) -> float:
        """Seconds."""
        return self._world.steps * self._world.dt

    def getSimulationState(self) -> int:
        """Stopped or running."""
        return 17 if self._world.running else 0

    def startSimulation(self) -> None:
        """Starts."""
        self._world.running = True

    def stopSimulation(self) -> None:
        """Stops, and puts everything back if tests do not look at the end."""
        self._world.running = False
        for robot in self._world.robots.values() if self._world.puts_back else ():
            robot.x, robot.y, robot.theta = robot.start

    def setStepping(self, enable: bool) -> int:
        """Counts levels per client."""
        holders = self._world.holders
        level = holders.get(self._uuid, 0)
        holders[self._uuid] = max(0, level + (1 if enable else -1))
        return level

    def step(self) -> None:
        """Takes a step; with a second client in stepping mode it would wait for that one."""
        world = self._world
        assert world.holders.get(self._uuid, 0) > 0, "step without stepping mode"
        assert sum(world.holders.values()) == 1, "two clients in stepping mode"
        if world.running:
            world.step()
