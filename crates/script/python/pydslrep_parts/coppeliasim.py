#: if standalone
"""All contact with the simulator CoppeliaSim."""

import math
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import zmq
from coppeliasim_zmqremoteapi_client import RemoteAPIClient  # type: ignore[import-untyped]

from .errors import SetupError, SimulatorError
from .model import Eye, Mounting, RobotModel
from .pose import Pose
from .settings import CONNECT_TIMEOUT, REPLY_TIMEOUT, STOP_TIMEOUT

#: endif


SIMULATOR = "CoppeliaSim"
USUAL_PORT = 23000  # where its remote API listens
LEGACY_PORT = 19999  # where that of the older V-REP does
PORT_HELP = "port of the ZeroMQ remote API, for all robots or for one; may be repeated"
REALTIME_HELP = "run no faster than the robots would"


class LimitedSocket:
    """The client's own socket would wait for ever; this one does not.

    An answer may take any number of rounds, but no longer than the limit.
    """

    def __init__(self, client: Any, address: str, limit: float) -> None:
        """Takes the place of the client's socket."""
        client.socket.close(linger=0)
        client.socket = self
        self.limit = limit
        self._deadline = 0.0
        self._address = address
        self._socket = client.context.socket(zmq.REQ)
        self._socket.linger = 0
        self._socket.connect(f"tcp://{address}")

    def begin(self) -> None:
        """Starts the time for a new call."""
        self._deadline = time.monotonic() + self.limit

    def send(self, request: bytes) -> None:
        """Sends a request."""
        self._socket.send(request, zmq.NOBLOCK)

    def recv(self) -> bytes:
        """The answer; raises SimulatorError."""
        left = max(0.0, self._deadline - time.monotonic())
        if not self._socket.poll(1000.0 * left):
            raise SimulatorError(f"no answer from {self._address} for {self.limit:g} s")
        answer: bytes = self._socket.recv()
        return answer

    def close(self, linger: int = 0) -> None:
        """Hangs up."""
        self._socket.close(linger)


class Body:
    """A robot's body in CoppeliaSim: all contact with it goes through this class.

    For a physical robot write a class with the same public methods and attributes: `pose`
    from its odometry or a camera, `set_wheel_rates` to its motors, and `advance` to wait for
    `time_step`; those that start, hold and release time have nothing to do there.
    """

    def __init__(self, model: RobotModel, host: str, port: int, realtime: bool) -> None:
        """Connects to the simulator and finds the robot; raises SetupError."""
        self.model = model
        self.time = 0.0  # s of simulation time, after the last step
        self._address = f"{host}:{port}"
        self._realtime = realtime
        self._started = self._holds_time = self._is_lost = self._in_call = False
        self._step_due: float | None = None
        try:
            self._client = RemoteAPIClient(host, port)
            self._socket = LimitedSocket(self._client, self._address, CONNECT_TIMEOUT)
            self._sim = self._ask(self._client.require, "sim")
            self._socket.limit = REPLY_TIMEOUT
            self._find_objects()
        except (SimulatorError, zmq.ZMQError) as error:
            if port == LEGACY_PORT and self._in_call:
                raise SetupError(
                    f"robot {model.name}: nothing answers on port {port}; CoppeliaSim's ZeroMQ "
                    f"remote API listens on {USUAL_PORT}: change the port in the program, or "
                    f"start with --port {USUAL_PORT}"
                ) from error
            raise SetupError(
                f"robot {model.name}: {error}. Is CoppeliaSim running there, with its ZeroMQ "
                "remote API on that port? --host and --port choose another place."
            ) from error

    def pose(self) -> Pose:
        """Where the middle of the wheels is, and the robot's heading."""
        return self._mounting.pose(self._matrix(self._body))

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets how fast the wheels turn, in rad/s, forward where positive."""
        for index, rate in enumerate(rates):
            # Changes that nobody could see are not worth a call, but rest is rest.
            if abs(rate - self._rates[index]) > (1e-4 if rate else 0.0):
                velocity = rate * self._mounting.senses[index]
                joint = self._joints[index]
                self._ask(self._sim.setJointTargetVelocity, joint, velocity)
                self._rates[index] = rate

    #: if until
    def detects(self, sensor: str) -> bool:
        """Whether a proximity sensor sees something."""
        handle = self._sensors[sensor]
        state = self._ask(self._sim.readProximitySensor, handle)[0]
        if state < 0:
            # Nobody has handled it yet: its scene leaves that to scripts like this one.
            state = self._ask(self._sim.handleProximitySensor, handle)[0]
        return bool(state > 0)

    #: endif
    #: if slam
    def wheel_angles(self) -> list[float]:
        """How far the wheels have turned, in radians, forward where positive."""
        angles = [
            self._ask(self._sim.getJointPosition, joint) for joint in self._joints
        ]
        return [s * a for s, a in zip(self._mounting.senses, angles, strict=True)]

    def distance(self, sensor: str) -> float | None:
        """How far off what a proximity sensor sees is, in metres; None where it sees nothing."""
        handle = self._sensors[sensor]
        state, distance, *_ = self._ask(self._sim.readProximitySensor, handle)
        if state < 0:
            # Nobody has handled it yet: its scene leaves that to scripts like this one.
            state, distance, *_ = self._ask(self._sim.handleProximitySensor, handle)
        return float(distance) if state > 0 else None

    def eye(self, sensor: str) -> Eye:
        """Where a proximity sensor is mounted, and what is known of how far it sees."""
        handle = self._sensors[sensor]
        mount = self._mounting.mount(self._matrix(self._body), self._matrix(handle))
        reach = self._property("getFloatProperty", handle, "volume_range")
        angles = self._property("getFloatArrayProperty", handle, "volume_angle")
        return Eye(mount, reach, angles[0] if angles else None)

    def _property(self, function: str, handle: int, name: str) -> Any:
        """A property of an object; None in versions that cannot tell."""
        try:
            return self._ask(getattr(self._sim, function), handle, name)
        except (AttributeError, SimulatorError):
            if self._in_call:
                raise  # it is not the property that is missing
            return None

    #: endif
    def advance(self) -> None:
        """Lets one step of simulation time pass."""
        self._ask(self._sim.step)
        if self._step_due is None:
            self.time = self._ask(self._sim.getSimulationTime)
            self._step_due = time.monotonic()
        else:
            self.time += self.time_step
        self._step_due += self.time_step
        if self._realtime:
            time.sleep(max(0.0, self._step_due - time.monotonic()))

    def start(self) -> None:
        """Starts the simulation, unless it runs already."""
        if self._is_stopped():
            self._started = True
            self._ask(self._sim.startSimulation)
            self._wait_until_stopped(False)

    def hold_time(self) -> None:
        """From now on time only passes when `advance` is called."""
        if not self._holds_time:
            self._holds_time = True
            self._ask(self._sim.setStepping, True)
            self._step_due = None

    def release_time(self) -> None:
        """From now on this robot does not hold up time."""
        if self._holds_time:
            self._ask(self._sim.setStepping, False)
            self._holds_time = False

    def why_it_stands(self) -> str:
        """What may keep the robot in place although its wheels should turn."""
        state = self._ask(self._sim.getSimulationState)
        if not state & self._sim.simulation_advancing:
            return "the simulation was stopped or paused"
        mode = self._sim.jointintparam_dynctrlmode
        for name, joint in zip(self.model.wheels, self._joints, strict=True):
            found = self._ask(self._sim.getObjectInt32Param, joint, mode)
            if found != self._sim.jointdynctrl_velocity:
                return (
                    f"joint {name} ignores velocities: set its control mode to velocity"
                )
        return "something may be in its way"

    def stop(self) -> None:
        """Stops the wheels, whatever happened before."""
        if self._is_lost:
            return
        if self._in_call:
            # A call that was cut off leaves its socket unusable. A new one serves the same
            # client, which may still hold the time.
            self._socket = LimitedSocket(self._client, self._address, STOP_TIMEOUT)
        try:
            for joint in self._joints:
                self._ask(self._sim.setJointTargetVelocity, joint, 0.0)
        except SimulatorError:
            self._is_lost = self._in_call  # what led here says why

    def close(self) -> None:
        """Stops the simulation where this robot started it, and hangs up."""
        try:
            if self._started and not self._is_lost:
                self._ask(self._sim.stopSimulation)
                self._wait_until_stopped(True)
            if not self._is_lost:
                self.release_time()
        except SimulatorError:
            self._is_lost = True
        self._socket.close()

    def _is_stopped(self) -> bool:
        state = self._ask(self._sim.getSimulationState)
        return bool(state == self._sim.simulation_stopped)

    def _wait_until_stopped(self, stopped: bool) -> None:
        """Starting and stopping take effect a moment after the simulator has answered."""
        deadline = time.monotonic() + STOP_TIMEOUT
        while self._is_stopped() != stopped and time.monotonic() < deadline:
            time.sleep(0.02)

    def _find_objects(self) -> None:
        """Finds the robot's parts and measures them: nothing about them is assumed."""
        name = self.model.name
        joint = self._sim.object_joint_type
        sensor = self._sim.object_proximitysensor_type
        self._missing: list[str] = []
        self._body = self._find(
            "robot", lambda kind: kind not in (joint, sensor), f"/{name}"
        )
        self._joints = self._find_parts("joint", joint, self.model.wheels)
        #: if until or slam
        sensors = self._find_parts("proximity sensor", sensor, self.model.sensors)
        self._sensors = dict(zip(self.model.sensors, sensors, strict=True))
        #: endif
        if self._missing:
            raise SetupError(
                f"robot {name}: the scene at {self._address} has no "
                + ", no ".join(self._missing)
            )
        self.time_step: float = self._ask(self._sim.getSimulationTimeStep)
        joints = [self._matrix(joint) for joint in self._joints]
        self._mounting = Mounting(self.model, self._matrix(self._body), joints)
        self.drive = self._mounting.drive
        self._rates = [math.inf] * len(joints)  # unknown, so the first is always set

    def _find_parts(self, what: str, kind: int, names: Iterable[str]) -> list[int]:
        def fits(found: int) -> bool:
            return found == kind

        robot = self.model.name
        return [
            self._find(what, fits, f"/{robot}/{name}", f"/{name}_{robot}")
            for name in names
        ]

    def _find(self, what: str, fits: Callable[[int], bool], *paths: str) -> int:
        """The first object of a kind: others may share its name, as a wheel and a sensor may."""
        tried = []
        for path in paths:
            others: set[int] = set()
            handle = self._object(path, 0)
            while handle >= 0 and handle not in others:
                if fits(self._ask(self._sim.getObjectType, handle)):
                    return handle
                others.add(handle)
                handle = self._object(path, len(others))
            tried.append(
                f"{path} (what is there is of another kind)" if others else path
            )
        self._missing.append(f"{what} {' or '.join(tried)}")
        return -1

    def _object(self, path: str, index: int) -> int:
        """One of the objects that a path leads to, or -1 when there are no more."""
        options = {"noError": True, "index": index}
        handle: int = self._ask(self._sim.getObject, path, options)
        return handle

    def _matrix(self, handle: int) -> list[float]:
        """Where an object is: rows of rotation and translation."""
        matrix: list[float] = self._ask(self._sim.getObjectMatrix, handle)
        return matrix

    def _ask(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Calls a function of the simulator; raises SimulatorError."""
        self._socket.begin()
        self._in_call = True
        try:
            result = function(*arguments)
        except SimulatorError:
            raise
        except zmq.ZMQError as error:
            raise SimulatorError(f"lost {self._address}: {error}") from error
        except Exception as error:  # the client has no class of its own for these
            self._in_call = False
            raise SimulatorError(f"{self._address} answered: {error}") from error
        self._in_call = False
        return result
