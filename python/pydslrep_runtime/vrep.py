"""Robots in V-REP, or in CoppeliaSim over its legacy remote API."""

import importlib
import math
import socket
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from .backend import Backend, RobotSpec, SensorCone
from .errors import SetupError, SimulatorError
from .mounting import Mounting
from .notes import Notes, pause
from .pose import Pose
from .readings import LEGACY_POINT, LEGACY_RESULTS, Form, read_result
from .settings import CONNECT_TIMEOUT, REPLY_TIMEOUT, STOP_TIMEOUT

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
        f"{Path(sys.argv[0]).resolve().parent}. CoppeliaSim has them in "
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


class Connection:
    """A connection to one port, for all robots that use it."""

    def __init__(self, client: Any, host: str, port: int) -> None:
        """Connects; raises SimulatorError."""
        self.client = client
        self.address = f"{host}:{port}"
        self.is_lost = False
        limit = round(1000.0 * CONNECT_TIMEOUT)
        self.id: int = client.simxStart(host, port, True, True, limit, CYCLE)
        if self.id < 0:
            raise SimulatorError(f"no reply from {self.address}")

    def call(
        self, function: Callable[..., Any], *arguments: Any, allow: int = 0
    ) -> Any:
        """Calls a function of the client, returns its first value; raises SimulatorError.

        `allow` has the bits of return codes that are no errors.
        """
        result = function(self.id, *arguments)
        code, *values = result if isinstance(result, tuple | list) else (result,)
        self.check(code & ~allow, function.__name__)
        if code:  # it has no value
            return values[0] if values else None
        return self.read(function, values)

    def read(
        self,
        function: Callable[..., Any],
        values: Sequence[Any],
        forms: Sequence[Form] | None = None,
    ) -> Any:
        """The result of a function: those values that are read; raises SimulatorError."""
        name = function.__name__
        forms = LEGACY_RESULTS.get(name, ()) if forms is None else forms
        return read_result(f"error from {self.address}: {name}", values, forms)

    def find(self, function: Callable[..., Any], *arguments: Any) -> int | None:
        """The number that a function returns; None if the simulator refuses it."""
        wait = self.client.simx_opmode_blocking
        code, value = function(self.id, *arguments, wait)
        self.check(code & ~REMOTE_ERROR)
        return None if code else int(self.read(function, [value]))

    def check(self, code: int, function: str = "a command") -> None:
        """Raises SimulatorError unless a return code is 0."""
        if code == 0:
            return
        if self.client.simxGetConnectionId(self.id) == -1:
            self.is_lost = True
            raise SimulatorError(f"lost connection to {self.address}")
        if code & TIMEOUT:
            raise SimulatorError(f"no reply from {self.address}")
        if code & REMOTE_ERROR:
            raise SimulatorError(f"{self.address} refused {function}")
        raise SimulatorError(f"{self.address}: {function} returned code {code}")

    def milliseconds(self) -> int:
        """The simulation time of the latest message."""
        read = self.client.simxGetLastCmdTime
        return int(self.read(read, [read(self.id)]))

    def is_running(self) -> bool:
        """Whether the simulation runs and is not paused, after all earlier commands."""
        return self._state() & (NOT_STOPPED | PAUSED) == NOT_STOPPED

    def is_paused(self) -> bool:
        """Whether the simulation is paused, after all earlier commands."""
        return self._state() & (NOT_STOPPED | PAUSED) == NOT_STOPPED | PAUSED

    def is_stopped(self) -> bool:
        """Whether the simulation is stopped, after all earlier commands."""
        return not self._state() & NOT_STOPPED

    def wait_until(self, *, stopped: bool) -> None:
        """Waits, because starting and stopping take effect after the reply."""
        deadline = time.monotonic() + STOP_TIMEOUT
        while self.is_stopped() != stopped and time.monotonic() < deadline:
            time.sleep(0.02)

    def wait_for(self, milliseconds: int) -> None:
        """Waits for a message from that simulation time or later; raises SimulatorError."""
        deadline = time.monotonic() + REPLY_TIMEOUT
        # The reply to a trigger precedes the step, and other clients may have to trigger.
        while self.milliseconds() < milliseconds and self.is_running():
            if time.monotonic() > deadline:
                raise SimulatorError(
                    f"no time passed at {self.address} for {REPLY_TIMEOUT:g} s"
                )

    def _state(self) -> int:
        self.call(self.client.simxGetPingTime)
        # Unlike others, its first result is no return code.
        read = self.client.simxGetInMessageInfo
        _, state = read(self.id, SERVER_STATE)
        return int(self.read(read, [state]))


class VRep:
    """The simulator, and its clock: its first connection steps it for all robots."""

    def __init__(self, host: str, *, realtime: bool) -> None:
        """With `realtime`, the simulator runs in real time; raises SetupError."""
        self.time = 0.0
        self.time_step = 0.0
        self.milliseconds = 0  # of simulation time
        self._realtime = realtime
        self._client, self._notes = load_client(), Notes()
        self._connections: dict[int, Connection] = {}
        self._has_started = self._is_stepping = False
        try:
            self._host = socket.gethostbyname(host)  # the client does not resolve names
        except OSError as error:
            raise SetupError(f"unknown host {host}: {error}") from error

    def connect(self, spec: RobotSpec) -> Backend:
        """Connects a robot; raises SetupError."""
        try:
            if spec.port not in self._connections:
                connection = Connection(self._client, self._host, spec.port)
                self._connections[spec.port] = connection
        except SimulatorError as error:
            raise SetupError(
                f"robot {spec.name}: {error}. Is V-REP running there, with its remote API on "
                "that port? Use --host and --port to connect elsewhere."
            ) from error
        try:
            return VRepRobot(spec, self._connections[spec.port], self)
        except SimulatorError as error:
            raise SetupError(
                f"robot {spec.name}: {error}. The remote API serves one client per port: is "
                "another client connected? Use --port to choose another port."
            ) from error

    def start(self) -> None:
        """Starts the simulation if it is stopped; time stands still until `advance`."""
        first, wait = self._first(), self._client.simx_opmode_blocking
        if not self._realtime:
            self._enable_stepping(first)
        step = first.call(self._client.simxGetFloatingParameter, PARAM_TIME_STEP, wait)
        self.time_step = round(step, 6)  # the client has single precision
        if first.is_stopped():
            if self._realtime:
                real_time = self._client.simxSetBooleanParameter
                first.call(real_time, PARAM_REAL_TIME, True, wait)
            self._has_started = True
            first.call(self._client.simxStartSimulation, wait)
            first.wait_until(stopped=False)
        first.call(self._client.simxGetPingTime)
        self._read_time()

    def advance(self) -> None:
        """Takes one step, or waits for one in real time."""
        first = self._first()
        while True:
            if self._is_stepping:
                # Refused if the simulation is not running, which the state shows.
                first.call(self._client.simxSynchronousTrigger, allow=REMOTE_ERROR)
            first.wait_for(self.milliseconds + 1)
            if first.milliseconds() > self.milliseconds:
                break
            self._wait_while_paused()
        self._read_time()

    def close(self) -> None:
        """Stops the simulation if it was started here, and disconnects."""
        if self._connections:
            first, wait = self._first(), self._client.simx_opmode_blocking
            with suppress(SimulatorError):  # the first error is reported
                if self._has_started and not first.is_lost:
                    first.call(self._client.simxStopSimulation, wait)
                    first.wait_until(stopped=True)
                if self._is_stepping and not first.is_lost:
                    first.call(self._client.simxSynchronous, False)
        for connection in self._connections.values():
            self._client.simxFinish(connection.id)

    def is_stepped_by(self, connection: Connection) -> bool:
        """Whether a connection triggers the steps."""
        return connection is self._first()

    def _first(self) -> Connection:
        return next(iter(self._connections.values()))

    def _wait_while_paused(self) -> None:
        first = self._first()
        while first.is_paused():
            self._notes.say_paused()
            pause()
        if first.is_stopped():
            raise SimulatorError("the simulation was stopped")

    def _enable_stepping(self, first: Connection) -> None:
        code = self._client.simxSynchronous(first.id, True)
        if code == REMOTE_ERROR:
            raise SetupError(
                f"{first.address} does not let clients trigger simulation steps. Set "
                "portIndex..._syncSimTrigger to true in its remoteApiConnections.txt, or use "
                "--realtime."
            )
        first.check(code)
        self._is_stepping = True

    def _read_time(self) -> None:
        self.milliseconds = self._first().milliseconds()
        self.time = self.milliseconds / 1000.0


class VRepRobot(Backend):
    """A robot in V-REP's scene."""

    def __init__(self, spec: RobotSpec, connection: Connection, clock: VRep) -> None:
        """Finds the robot's parts; raises SetupError."""
        self.clock: VRep = clock
        self._spec, self._connection = spec, connection
        self._client, self._call = connection.client, connection.call
        self._joints: list[int] = []
        self._find_objects()
        self._start_streams()
        wait = self._client.simx_opmode_blocking
        mounts = [self._matrix(joint, wait) for joint in self._joints]
        self._mounting = Mounting(self._read_body(), mounts)
        # The rates are unknown, so the first ones are always set.
        self._rates = [math.inf] * len(mounts)

    def wheel_mounts(self) -> Sequence[tuple[float, float]]:
        """The positions of the wheels on the body."""
        return self._mounting.wheels

    def pose(self) -> Pose:
        """The pose of the wheels' centre."""
        return self._mounting.pose(self._read_body())

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets the rates of the wheels in rad/s, forward if positive."""
        client, number = self._client, self._connection.id
        # Skip negligible changes, except to zero.
        changed = {
            index: rate
            for index, rate in enumerate(rates)
            if abs(rate - self._rates[index]) > (1e-4 if rate else 0.0)
        }
        if not changed:
            return
        try:
            # Commands given during a pause are sent together.
            client.simxPauseCommunication(number, True)
            for index, rate in changed.items():
                velocity = rate * self._mounting.axis_signs[index]
                self._set_velocity(index, velocity, client.simx_opmode_oneshot)
                self._rates[index] = rate
        finally:
            client.simxPauseCommunication(number, False)
        if not self.clock.is_stepped_by(self._connection):
            # The next step is triggered on another connection: wait for these commands.
            self._call(client.simxGetPingTime)

    def detects(self, sensor: str) -> bool:
        """Whether a proximity sensor detects an object."""
        return self.distance(sensor) is not None

    def distance(self, sensor: str) -> float | None:
        """The distance that a proximity sensor measures, in metres; None if nothing."""
        values, read = self._read(sensor), self._client.simxReadProximitySensor
        if self._connection.read(read, values) <= 0:
            return None
        point = self._connection.read(read, values[1:], (LEGACY_POINT,))
        return math.hypot(*point)

    def reading_age(self, sensor: str) -> float:
        """How old the reading of a proximity sensor is: the last one that has arrived stays readable for ever."""
        self._read(sensor)
        return max(0.0, self.clock.milliseconds - self._connection.milliseconds()) / 1e3

    def _read(self, sensor: str) -> list[Any]:
        """The latest reading of a proximity sensor: its state, the point, and more."""
        client, handle = self._client, self._sensors[sensor]
        self._connection.wait_for(self.clock.milliseconds)
        read = client.simxReadProximitySensor
        code, *values = read(self._connection.id, handle, client.simx_opmode_buffer)
        self._connection.check(code, "simxReadProximitySensor")
        return [*values]

    def sensor_cone(self, sensor: str) -> SensorCone:
        """The mount of a proximity sensor; the remote API does not report its volume."""
        seen = self._matrix(self._sensors[sensor], self._client.simx_opmode_blocking)
        return SensorCone(self._mounting.mount(self._read_body(), seen))

    def wheel_angles(self) -> Sequence[float]:
        """The angles of the wheels in radians, forward if positive."""
        read, mode = self._client.simxGetJointPosition, self._client.simx_opmode_buffer
        self._connection.wait_for(self.clock.milliseconds)
        angles = [self._call(read, joint, mode) for joint in self._joints]
        return [s * a for s, a in zip(self._mounting.axis_signs, angles, strict=True)]

    def stall_reason(self) -> str:
        """Why the robot may not move although its wheels should turn."""
        if not self._connection.is_running():
            return "the simulation was stopped or paused"
        for name, joint in zip(self._spec.wheels, self._joints, strict=True):
            mode = self._joint_parameter(joint, PARAM_CONTROL_MODE)
            if mode not in (None, CONTROL_VELOCITY):
                return (
                    f"joint {name} ignores velocities: set its control mode to velocity"
                )
            if mode is None and self._joint_parameter(joint, PARAM_MOTOR_ENABLED) == 0:
                return f"the motor of joint {name} is off: enable it"
        return super().stall_reason()

    def stop(self) -> None:
        """Stops the wheels, even after an error."""
        mode = self._client.simx_opmode_blocking
        with suppress(SimulatorError):  # the first error is reported
            for index in range(len(self._joints)):
                if not self._connection.is_lost:
                    self._set_velocity(index, 0.0, mode)
        self._rates = [0.0] * len(self._joints)

    def _find_objects(self) -> None:
        client, wait = self._client, self._client.simx_opmode_blocking
        joints = self._call(client.simxGetObjects, TYPE_JOINT, wait)
        sensors = self._call(client.simxGetObjects, TYPE_SENSOR, wait)
        name = self._spec.name
        self._missing: list[str] = []
        self._body = self._find(
            "robot",
            lambda found: found not in (*joints, *sensors),
            *(self._spec.objects.get(name) or (name, f"/{name}")),
        )
        self._joints = self._find_parts("joint", joints, self._spec.wheels)
        names = (*self._spec.sensors, *self._spec.bumpers)
        found = self._find_parts("proximity sensor", sensors, names)
        self._sensors = dict(zip(names, found, strict=True))
        if self._missing:
            raise SetupError(
                f"robot {name}: the scene at {self._connection.address} has no "
                + ", no ".join(self._missing)
            )

    def _start_streams(self) -> None:
        """Subscribes to the values that change in every step."""
        client, stream = self._client, self._client.simx_opmode_streaming
        self._matrix(self._body, stream, allow=NO_VALUE)
        for sensor in self._sensors.values():
            # Sensors have no readings before the first step.
            allow = NO_VALUE | REMOTE_ERROR
            self._call(client.simxReadProximitySensor, sensor, stream, allow=allow)
        if self._spec.sensors:
            # Robots that explore need them for odometry.
            for joint in self._joints:
                self._call(client.simxGetJointPosition, joint, stream, allow=NO_VALUE)
        self._call(client.simxGetPingTime)

    def _find_parts(
        self, what: str, kind: Sequence[int], names: Iterable[str]
    ) -> list[int]:
        def fits(found: int) -> bool:
            return found in kind

        robot, objects = self._spec.name, self._spec.objects
        return [
            self._find(
                what,
                fits,
                *(objects.get(name) or (f"{name}_{robot}", f"/{robot}/{name}", name)),
            )
            for name in names
        ]

    def _find(self, what: str, fits: Callable[[int], bool], *names: str) -> int:
        """The first object of the right type; a wheel and a sensor may share a name."""
        tried = []
        get = self._client.simxGetObjectHandle
        for name in names:
            others: set[int] = set()
            handle = self._connection.find(get, name)
            while handle is not None and handle not in others:
                if fits(handle):
                    return handle
                others.add(handle)
                handle = self._connection.find(get, f"{name}[{len(others)}]")
            tried.append(f"{name} (an object of another type)" if others else name)
        self._missing.append(f"{what} {' or '.join(tried)}")
        return -1

    def _joint_parameter(self, joint: int, parameter: int) -> int | None:
        """A parameter of a joint; None in versions without it."""
        read = self._client.simxGetObjectIntParameter
        return self._connection.find(read, joint, parameter)

    def _set_velocity(self, index: int, velocity: float, mode: int) -> None:
        set_velocity = self._client.simxSetJointTargetVelocity
        self._call(set_velocity, self._joints[index], velocity, mode, allow=NO_VALUE)

    def _read_body(self) -> list[float]:
        """The body's matrix after the latest step."""
        buffer = self._client.simx_opmode_buffer
        self._connection.wait_for(self.clock.milliseconds)
        while True:
            matrix = self._matrix(self._body, buffer)
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
