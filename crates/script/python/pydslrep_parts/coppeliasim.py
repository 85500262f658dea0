#: if standalone
"""The interface to CoppeliaSim."""

import math
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import zmq
from coppeliasim_zmqremoteapi_client import RemoteAPIClient  # type: ignore[import-untyped]

from .errors import SetupError, SimulatorError
from .model import Mounting, RobotModel, SensorCone
from .pose import Pose
from .settings import CONNECT_TIMEOUT, REPLY_TIMEOUT, STOP_TIMEOUT

#: endif


SIMULATOR = "CoppeliaSim"
DEFAULT_PORT = 23000  # of its ZeroMQ remote API
LEGACY_PORT = 19999  # of the legacy remote API
PORT_HELP = "port of the ZeroMQ remote API, for all robots or one; repeatable"
REALTIME_HELP = "run no faster than real time"


class TimeoutSocket:
    """Replaces the client's socket, which would wait forever, with a timeout per call.

    A call may take any number of messages, but no longer than the limit.
    """

    def __init__(self, client: Any, address: str, limit: float) -> None:
        """Replaces the client's socket."""
        client.socket.close(linger=0)
        client.socket = self
        self.limit = limit
        self._deadline = 0.0
        self._address = address
        self._socket = client.context.socket(zmq.REQ)
        self._socket.linger = 0
        self._socket.connect(f"tcp://{address}")

    def begin(self) -> None:
        """Starts the timeout of a new call."""
        self._deadline = time.monotonic() + self.limit

    def send(self, request: bytes) -> None:
        """Sends a request."""
        self._socket.send(request, zmq.NOBLOCK)

    def recv(self) -> bytes:
        """Receives a reply; raises SimulatorError."""
        left = max(0.0, self._deadline - time.monotonic())
        if not self._socket.poll(1000.0 * left):
            raise SimulatorError(f"no reply from {self._address} for {self.limit:g} s")
        reply: bytes = self._socket.recv()
        return reply

    def close(self, linger: int = 0) -> None:
        """Disconnects."""
        self._socket.close(linger)


class Body:
    """The interface to a robot's body in CoppeliaSim.

    For a physical robot, write a class with the same public methods and attributes: `pose`
    reads its odometry or a camera, `set_wheel_rates` sets its motors, and `advance` waits
    for `time_step`; `start` and the methods for stepping can do nothing.
    """

    def __init__(self, model: RobotModel, host: str, port: int, realtime: bool) -> None:
        """Connects to the simulator and finds the robot; raises SetupError."""
        self.model = model
        self.time = 0.0  # s of simulation time, after the last step
        self._address = f"{host}:{port}"
        self._realtime = realtime
        self._started = self._is_stepping = self._connection_lost = self._in_call = (
            False
        )
        self._step_due: float | None = None
        try:
            self._client = RemoteAPIClient(host, port)
            self._socket = TimeoutSocket(self._client, self._address, CONNECT_TIMEOUT)
            self._sim = self._call(self._client.require, "sim")
            self._socket.limit = REPLY_TIMEOUT
            self._find_objects()
        except (SimulatorError, zmq.ZMQError) as error:
            if port == LEGACY_PORT and self._in_call:
                raise SetupError(
                    f"robot {model.name}: no reply from port {port}. CoppeliaSim's ZeroMQ "
                    f"remote API listens on {DEFAULT_PORT}: change the port in the program, or "
                    f"use --port {DEFAULT_PORT}."
                ) from error
            raise SetupError(
                f"robot {model.name}: {error}. Is CoppeliaSim running there, with its ZeroMQ "
                "remote API on that port? Use --host and --port to connect elsewhere."
            ) from error

    def pose(self) -> Pose:
        """The pose of the wheels' centre."""
        return self._mounting.pose(self._matrix(self._body))

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets the rates of the wheels in rad/s, forward if positive."""
        for index, rate in enumerate(rates):
            # Skip negligible changes, except to zero.
            if abs(rate - self._rates[index]) > (1e-4 if rate else 0.0):
                velocity = rate * self._mounting.axis_signs[index]
                joint = self._joints[index]
                self._call(self._sim.setJointTargetVelocity, joint, velocity)
                self._rates[index] = rate

    #: if until
    def detects(self, sensor: str) -> bool:
        """Whether a proximity sensor detects an object."""
        handle = self._sensors[sensor]
        state = self._call(self._sim.readProximitySensor, handle)[0]
        if state < 0:
            # The scene requires explicit handling of this sensor.
            state = self._call(self._sim.handleProximitySensor, handle)[0]
        return bool(state > 0)

    #: endif
    #: if slam
    def wheel_angles(self) -> list[float]:
        """The angles of the wheels in radians, forward if positive."""
        angles = [
            self._call(self._sim.getJointPosition, joint) for joint in self._joints
        ]
        return [s * a for s, a in zip(self._mounting.axis_signs, angles, strict=True)]

    def distance(self, sensor: str) -> float | None:
        """The distance that a proximity sensor measures, in metres; None if nothing."""
        handle = self._sensors[sensor]
        state, distance, *_ = self._call(self._sim.readProximitySensor, handle)
        if state < 0:
            # The scene requires explicit handling of this sensor.
            state, distance, *_ = self._call(self._sim.handleProximitySensor, handle)
        return float(distance) if state > 0 else None

    def sensor_cone(self, sensor: str) -> SensorCone:
        """The mount and detection volume of a proximity sensor."""
        handle = self._sensors[sensor]
        mount = self._mounting.mount(self._matrix(self._body), self._matrix(handle))
        reach = self._property("getFloatProperty", handle, "volume_range")
        angles = self._property("getFloatArrayProperty", handle, "volume_angle")
        return SensorCone(mount, reach, angles[0] if angles else None)

    def _property(self, function: str, handle: int, name: str) -> Any:
        """A property of an object; None in versions without properties."""
        try:
            return self._call(getattr(self._sim, function), handle, name)
        except (AttributeError, SimulatorError):
            if self._in_call:
                raise  # the call itself failed
            return None

    #: endif
    def advance(self) -> None:
        """Advances the simulation by one step."""
        self._call(self._sim.step)
        if self._step_due is None:
            self.time = self._call(self._sim.getSimulationTime)
            self._step_due = time.monotonic()
        else:
            self.time += self.time_step
        self._step_due += self.time_step
        if self._realtime:
            time.sleep(max(0.0, self._step_due - time.monotonic()))

    def start(self) -> None:
        """Starts the simulation if it is stopped."""
        if self._is_stopped():
            self._started = True
            self._call(self._sim.startSimulation)
            self._wait_until_stopped(False)

    def enable_stepping(self) -> None:
        """From now on, time passes only when `advance` is called."""
        if not self._is_stepping:
            self._is_stepping = True
            self._call(self._sim.setStepping, True)
            self._step_due = None

    def disable_stepping(self) -> None:
        """From now on, time no longer waits for this robot."""
        if self._is_stepping:
            self._call(self._sim.setStepping, False)
            self._is_stepping = False

    def stall_reason(self) -> str:
        """Why the robot may not move although its wheels should turn."""
        state = self._call(self._sim.getSimulationState)
        if not state & self._sim.simulation_advancing:
            return "the simulation was stopped or paused"
        mode = self._sim.jointintparam_dynctrlmode
        for name, joint in zip(self.model.wheels, self._joints, strict=True):
            found = self._call(self._sim.getObjectInt32Param, joint, mode)
            if found != self._sim.jointdynctrl_velocity:
                return (
                    f"joint {name} ignores velocities: set its control mode to velocity"
                )
        return "an obstacle may be in the way"

    def stop(self) -> None:
        """Stops the wheels, even after an error."""
        if self._connection_lost:
            return
        if self._in_call:
            # An interrupted call leaves its socket unusable. A new socket serves the same
            # client, which may still be in stepping mode.
            self._socket = TimeoutSocket(self._client, self._address, STOP_TIMEOUT)
        try:
            for joint in self._joints:
                self._call(self._sim.setJointTargetVelocity, joint, 0.0)
        except SimulatorError:
            self._connection_lost = self._in_call  # the first error is reported

    def close(self) -> None:
        """Stops the simulation if this robot started it, and disconnects."""
        try:
            if self._started and not self._connection_lost:
                self._call(self._sim.stopSimulation)
                self._wait_until_stopped(True)
            if not self._connection_lost:
                self.disable_stepping()
        except SimulatorError:
            self._connection_lost = True
        self._socket.close()

    def _is_stopped(self) -> bool:
        state = self._call(self._sim.getSimulationState)
        return bool(state == self._sim.simulation_stopped)

    def _wait_until_stopped(self, stopped: bool) -> None:
        """Waits, because starting and stopping take effect after the reply."""
        deadline = time.monotonic() + STOP_TIMEOUT
        while self._is_stopped() != stopped and time.monotonic() < deadline:
            time.sleep(0.02)

    def _find_objects(self) -> None:
        """Finds and measures the robot's parts."""
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
        self.time_step: float = self._call(self._sim.getSimulationTimeStep)
        joints = [self._matrix(joint) for joint in self._joints]
        self._mounting = Mounting(self.model, self._matrix(self._body), joints)
        self.drive = self._mounting.drive
        self._rates = [math.inf] * len(
            joints
        )  # unknown, so the first rates are always set

    def _find_parts(self, what: str, kind: int, names: Iterable[str]) -> list[int]:
        def fits(found: int) -> bool:
            return found == kind

        robot = self.model.name
        return [
            self._find(what, fits, f"/{robot}/{name}", f"/{name}_{robot}")
            for name in names
        ]

    def _find(self, what: str, fits: Callable[[int], bool], *paths: str) -> int:
        """The first object of the right type; a wheel and a sensor may share a name."""
        tried = []
        for path in paths:
            others: set[int] = set()
            handle = self._object(path, 0)
            while handle >= 0 and handle not in others:
                if fits(self._call(self._sim.getObjectType, handle)):
                    return handle
                others.add(handle)
                handle = self._object(path, len(others))
            tried.append(f"{path} (an object of another type)" if others else path)
        self._missing.append(f"{what} {' or '.join(tried)}")
        return -1

    def _object(self, path: str, index: int) -> int:
        """The object at an index among those with a path, or -1."""
        options = {"noError": True, "index": index}
        handle: int = self._call(self._sim.getObject, path, options)
        return handle

    def _matrix(self, handle: int) -> list[float]:
        """An object's matrix: rows of rotation and translation."""
        matrix: list[float] = self._call(self._sim.getObjectMatrix, handle)
        return matrix

    def _call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Calls a function of the simulator; raises SimulatorError."""
        self._socket.begin()
        self._in_call = True
        try:
            result = function(*arguments)
        except SimulatorError:
            raise
        except zmq.ZMQError as error:
            raise SimulatorError(
                f"lost connection to {self._address}: {error}"
            ) from error
        except Exception as error:  # the client has no error class of its own
            self._in_call = False
            raise SimulatorError(f"error from {self._address}: {error}") from error
        self._in_call = False
        return result
