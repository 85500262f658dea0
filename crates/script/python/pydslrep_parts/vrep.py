#: if standalone
"""The interface to V-REP, or to CoppeliaSim's legacy remote API."""

import importlib
import math
import socket
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from .errors import SetupError, SimulatorError
from .model import Mounting, RobotModel, SensorCone
from .pose import Pose
from .settings import CONNECT_TIMEOUT, REPLY_TIMEOUT, STOP_TIMEOUT

#: endif


SIMULATOR = "V-REP"
PORT_HELP = "port of the remote API, one per robot; repeatable"
REALTIME_HELP = "run in real time instead of triggering every step"

# Constants of the remote API that its client does not name, or not in all versions.
WORLD = -1
TYPE_JOINT = 1
TYPE_SENSOR = 5
PARAM_TIME_STEP = 1
PARAM_REAL_TIME = 25
PARAM_MOTOR_ENABLED = 2000
PARAM_CONTROL_MODE = 2039  # since 4.3, with this value for velocity control:
CONTROL_VELOCITY = 4
SERVER_STATE = 17
NOT_STOPPED, PAUSED = 1, 2  # bits of the state
NO_VALUE, TIMEOUT, REMOTE_ERROR = 1, 2, 8  # bits of return codes
CYCLE = 1  # ms between messages; the usual 5 would slow down every step


def load_client() -> Any:
    """Imports V-REP's client for Python, which PyPI does not have; raises SetupError."""
    library = {"win32": "remoteApi.dll", "darwin": "remoteApi.dylib"}.get(
        sys.platform, "remoteApi.so"
    )
    for name in ("sim", "vrep"):
        try:
            client = importlib.import_module(name)
        except ModuleNotFoundError as error:
            if error.name == name:
                continue
            raise SetupError(f"{name}.py needs {error.name}.py next to it") from error
        except Exception as error:  # without its library it fails in various ways
            raise SetupError(
                f"{name}.py cannot be loaded: {error}. Is its library {library} next to it?"
            ) from error
        if hasattr(client, "simxStart"):
            return client
    raise SetupError(
        "V-REP's client for Python is missing: neither its sim.py nor its vrep.py is on "
        f"Python's path. Copy sim.py, simConst.py and {library} to "
        f"{Path(__file__).resolve().parent}. CoppeliaSim has them in "
        "programming/legacyRemoteApi/remoteApiBindings (before 4.3: "
        "programming/remoteApiBindings), under python/python and lib/lib. In V-REP 3 the "
        "first two are called vrep.py and vrepConst.py."
    )


def matrix_of(position: Sequence[float], angles: Sequence[float]) -> list[float]:
    """The matrix of a position and Euler angles (about x, then new y, then new z)."""
    (ca, cb, cc), (sa, sb, sc) = map(math.cos, angles), map(math.sin, angles)
    x, y, z = position
    return [
        *(cb * cc, -cb * sc, sb, x),
        *(sa * sb * cc + ca * sc, ca * cc - sa * sb * sc, -sa * cb, y),
        *(sa * sc - ca * sb * cc, ca * sb * sc + sa * cc, ca * cb, z),
    ]


class Body:
    """The interface to a robot's body in V-REP.

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
        self._started = self._is_stepping = self._connection_lost = False
        self._joints: list[int] = []
        self._client = load_client()
        self._id = self._connect(host, port)
        try:
            self._find_objects()
        except (SimulatorError, SetupError) as error:
            self._client.simxFinish(self._id)
            if isinstance(error, SetupError):
                raise
            raise SetupError(
                f"robot {model.name}: {error}. The remote API serves one client per port: is "
                "another client connected? Use --port to choose another port."
            ) from error

    def _connect(self, host: str, port: int) -> int:
        try:
            address = socket.gethostbyname(host)  # the client does not resolve names
        except OSError as error:
            raise SetupError(f"unknown host {host}: {error}") from error
        limit = round(1000.0 * CONNECT_TIMEOUT)
        number: int = self._client.simxStart(address, port, True, True, limit, CYCLE)
        if number < 0:
            raise SetupError(
                f"robot {self.model.name}: no reply from {self._address}. Is V-REP running "
                "there, with its remote API on that port? Use --host and --port to connect "
                "elsewhere."
            )
        return number

    def pose(self) -> Pose:
        """The pose of the wheels' centre."""
        return self._mounting.pose(self._read_body())

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets the rates of the wheels in rad/s, forward if positive."""
        client = self._client
        try:
            # Commands given during a pause are sent together.
            client.simxPauseCommunication(self._id, True)
            for index, rate in enumerate(rates):
                # Skip negligible changes, except to zero.
                if abs(rate - self._rates[index]) > (1e-4 if rate else 0.0):
                    velocity = rate * self._mounting.axis_signs[index]
                    self._set_velocity(index, velocity, client.simx_opmode_oneshot)
                    self._rates[index] = rate
        finally:
            client.simxPauseCommunication(self._id, False)

    #: if until
    def detects(self, sensor: str) -> bool:
        """Whether a proximity sensor detects an object."""
        read = self._client.simxReadProximitySensor
        mode = self._client.simx_opmode_buffer
        return bool(self._call(read, self._sensors[sensor], mode))

    #: endif
    #: if slam
    def wheel_angles(self) -> list[float]:
        """The angles of the wheels in radians, forward if positive."""
        read, mode = self._client.simxGetJointPosition, self._client.simx_opmode_buffer
        angles = [self._call(read, joint, mode) for joint in self._joints]
        return [s * a for s, a in zip(self._mounting.axis_signs, angles, strict=True)]

    def distance(self, sensor: str) -> float | None:
        """The distance that a proximity sensor measures, in metres; None if nothing."""
        client, handle = self._client, self._sensors[sensor]
        code, state, point, _, _ = client.simxReadProximitySensor(
            self._id, handle, client.simx_opmode_buffer
        )
        self._check(code, "simxReadProximitySensor")
        return math.hypot(*point) if state else None

    def sensor_cone(self, sensor: str) -> SensorCone:
        """The mount of a proximity sensor; the remote API does not report its volume."""
        wait = self._client.simx_opmode_blocking
        seen = self._matrix(self._sensors[sensor], wait)
        return SensorCone(self._mounting.mount(self._read_body(), seen))

    #: endif
    def advance(self) -> None:
        """Advances the simulation by one step."""
        before = self._milliseconds
        if self._is_stepping:
            # Refused if the simulation is not running, which the state below shows.
            self._call(self._client.simxSynchronousTrigger, allow=REMOTE_ERROR)
        deadline = time.monotonic() + REPLY_TIMEOUT
        # The reply to a trigger precedes the step, and other clients may have to trigger.
        while self._is_running():
            self._read_body()
            if self._milliseconds > before:
                break
            if time.monotonic() > deadline:
                raise SimulatorError(
                    f"no time passed at {self._address} for {REPLY_TIMEOUT:g} s"
                )
        self.time = self._milliseconds / 1000.0

    def start(self) -> None:
        """Starts the simulation if it is stopped."""
        if self._is_stopped():
            client, wait = self._client, self._client.simx_opmode_blocking
            if self._realtime:
                self._call(client.simxSetBooleanParameter, PARAM_REAL_TIME, True, wait)
            self._started = True
            self._call(client.simxStartSimulation, wait)
            self._wait_until_stopped(False)
        self._read_body()

    def enable_stepping(self) -> None:
        """From now on, time passes only when `advance` is called."""
        if not self._is_stepping and not self._realtime:
            code = self._client.simxSynchronous(self._id, True)
            if code == REMOTE_ERROR:
                raise SetupError(
                    f"robot {self.model.name}: {self._address} does not let clients trigger "
                    "simulation steps. Set portIndex..._syncSimTrigger to true in its "
                    "remoteApiConnections.txt, or use --realtime."
                )
            self._check(code)
            self._is_stepping = True
            self._read_body()

    def disable_stepping(self) -> None:
        """From now on, time no longer waits for this robot."""
        if self._is_stepping:
            self._call(self._client.simxSynchronous, False)
            self._is_stepping = False

    def stall_reason(self) -> str:
        """Why the robot may not move although its wheels should turn."""
        if not self._is_running():
            return "the simulation was stopped or paused"
        for name, joint in zip(self.model.wheels, self._joints, strict=True):
            mode = self._joint_parameter(joint, PARAM_CONTROL_MODE)
            if mode not in (None, CONTROL_VELOCITY):
                return (
                    f"joint {name} ignores velocities: set its control mode to velocity"
                )
            if mode is None and self._joint_parameter(joint, PARAM_MOTOR_ENABLED) == 0:
                return f"the motor of joint {name} is off: enable it"
        return "an obstacle may be in the way"

    def stop(self) -> None:
        """Stops the wheels, even after an error."""
        if self._connection_lost:
            return
        try:
            for index in range(len(self._joints)):
                self._set_velocity(index, 0.0, self._client.simx_opmode_blocking)
        except SimulatorError:
            self._connection_lost = True  # the first error is reported

    def close(self) -> None:
        """Stops the simulation if this robot started it, and disconnects."""
        try:
            if self._started and not self._connection_lost:
                wait = self._client.simx_opmode_blocking
                self._call(self._client.simxStopSimulation, wait)
                self._wait_until_stopped(True)
            if not self._connection_lost:
                self.disable_stepping()
        except SimulatorError:
            self._connection_lost = True
        self._client.simxFinish(self._id)

    def _state(self) -> int:
        """The state of the simulation, after all earlier commands."""
        self._call(self._client.simxGetPingTime)
        # Unlike others, its first result is no return code.
        _, state = self._client.simxGetInMessageInfo(self._id, SERVER_STATE)
        return int(state)

    def _is_stopped(self) -> bool:
        return not self._state() & NOT_STOPPED

    def _is_running(self) -> bool:
        return self._state() & (NOT_STOPPED | PAUSED) == NOT_STOPPED

    def _wait_until_stopped(self, stopped: bool) -> None:
        """Waits, because starting and stopping take effect after the reply."""
        deadline = time.monotonic() + STOP_TIMEOUT
        while self._is_stopped() != stopped and time.monotonic() < deadline:
            time.sleep(0.02)

    def _find_objects(self) -> None:
        """Finds and measures the robot's parts."""
        client, wait = self._client, self._client.simx_opmode_blocking
        joints = self._call(client.simxGetObjects, TYPE_JOINT, wait)
        sensors = self._call(client.simxGetObjects, TYPE_SENSOR, wait)
        name = self.model.name
        self._missing: list[str] = []
        self._body = self._find(
            "robot", lambda found: found not in (*joints, *sensors), name, f"/{name}"
        )
        self._joints = self._find_parts("joint", joints, self.model.wheels)
        #: if until or slam
        found = self._find_parts("proximity sensor", sensors, self.model.sensors)
        self._sensors = dict(zip(self.model.sensors, found, strict=True))
        #: endif
        if self._missing:
            raise SetupError(
                f"robot {name}: the scene at {self._address} has no "
                + ", no ".join(self._missing)
            )
        step = self._call(client.simxGetFloatingParameter, PARAM_TIME_STEP, wait)
        self.time_step = round(step, 6)  # the client has single precision
        self._start_streams()
        mounts = [self._matrix(joint, wait) for joint in self._joints]
        self._mounting = Mounting(self.model, self._read_body(), mounts)
        self.drive = self._mounting.drive
        self._rates = [math.inf] * len(
            mounts
        )  # unknown, so the first rates are always set

    def _start_streams(self) -> None:
        """Subscribes to the values that change in every step."""
        client, stream = self._client, self._client.simx_opmode_streaming
        self._matrix(self._body, stream, allow=NO_VALUE)
        #: if until or slam
        for sensor in self._sensors.values():
            # Sensors have no readings before the first step.
            allow = NO_VALUE | REMOTE_ERROR
            self._call(client.simxReadProximitySensor, sensor, stream, allow=allow)
        #: endif
        #: if slam
        for joint in self._joints:
            self._call(client.simxGetJointPosition, joint, stream, allow=NO_VALUE)
        #: endif
        self._call(client.simxGetPingTime)

    def _find_parts(
        self, what: str, kind: Sequence[int], names: Iterable[str]
    ) -> list[int]:
        def fits(found: int) -> bool:
            return found in kind

        robot = self.model.name
        return [
            self._find(what, fits, f"{name}_{robot}", f"/{robot}/{name}", name)
            for name in names
        ]

    def _find(self, what: str, fits: Callable[[int], bool], *names: str) -> int:
        """The first object of the right type; a wheel and a sensor may share a name."""
        tried = []
        for name in names:
            others: set[int] = set()
            handle = self._object(name)
            while handle is not None and handle not in others:
                if fits(handle):
                    return handle
                others.add(handle)
                handle = self._object(f"{name}[{len(others)}]")
            tried.append(f"{name} (an object of another type)" if others else name)
        self._missing.append(f"{what} {' or '.join(tried)}")
        return -1

    def _object(self, name: str) -> int | None:
        wait = self._client.simx_opmode_blocking
        code, handle = self._client.simxGetObjectHandle(self._id, name, wait)
        self._check(code & ~REMOTE_ERROR)
        return None if code else int(handle)

    def _joint_parameter(self, joint: int, parameter: int) -> int | None:
        """A parameter of a joint; None in versions without it."""
        read, wait = (
            self._client.simxGetObjectIntParameter,
            self._client.simx_opmode_blocking,
        )
        code, value = read(self._id, joint, parameter, wait)
        self._check(code & ~REMOTE_ERROR)
        return None if code else int(value)

    def _set_velocity(self, index: int, velocity: float, mode: int) -> None:
        set_velocity = self._client.simxSetJointTargetVelocity
        self._call(set_velocity, self._joints[index], velocity, mode, allow=NO_VALUE)

    def _read_body(self) -> list[float]:
        """The body's matrix in the simulator's last message; also stores its time."""
        buffer = self._client.simx_opmode_buffer
        while True:
            matrix = self._matrix(self._body, buffer)
            self._milliseconds = self._client.simxGetLastCmdTime(self._id)
            # Another message may arrive between reading the position and the angles.
            if matrix == self._matrix(self._body, buffer):
                return matrix

    def _matrix(self, handle: int, mode: int, allow: int = 0) -> list[float]:
        """An object's matrix: rows of rotation and translation."""
        client = self._client
        position = self._call(
            client.simxGetObjectPosition, handle, WORLD, mode, allow=allow
        )
        angles = self._call(
            client.simxGetObjectOrientation, handle, WORLD, mode, allow=allow
        )
        return matrix_of(position, angles)

    def _call(
        self, function: Callable[..., Any], *arguments: Any, allow: int = 0
    ) -> Any:
        """Calls a function of the client, returns its first value; raises SimulatorError.

        `allow` has the bits of return codes that are no errors.
        """
        result = function(self._id, *arguments)
        code, *values = result if isinstance(result, tuple) else (result,)
        self._check(code & ~allow, function.__name__)
        return values[0] if values else None

    def _check(self, code: int, function: str = "a command") -> None:
        if code == 0:
            return
        if self._client.simxGetConnectionId(self._id) == -1:
            self._connection_lost = True
            raise SimulatorError(f"lost connection to {self._address}")
        if code & TIMEOUT:
            raise SimulatorError(f"no reply from {self._address}")
        if code & REMOTE_ERROR:
            raise SimulatorError(f"{self._address} refused {function}")
        raise SimulatorError(f"{self._address}: {function} returned code {code}")
