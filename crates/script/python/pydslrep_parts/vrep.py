#: if standalone
"""All contact with the simulator V-REP, or CoppeliaSim by its legacy remote API."""

import importlib
import math
import socket
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from .errors import SetupError, SimulatorError
from .model import Eye, Mounting, RobotModel
from .pose import Pose
from .settings import CONNECT_TIMEOUT, REPLY_TIMEOUT, STOP_TIMEOUT

#: endif


SIMULATOR = "V-REP"
PORT_HELP = "port of the remote API, one for each robot; may be repeated"
REALTIME_HELP = "let time pass by itself instead of triggering every step"

# Numbers of the remote API that its client has no names for, or other names from version
# to version.
WORLD = -1
TYPE_JOINT = 1
TYPE_SENSOR = 5
PARAM_TIME_STEP = 1
PARAM_REAL_TIME = 25
PARAM_MOTOR_ENABLED = 2000
PARAM_CONTROL_MODE = 2039  # since 4.3, and then with this value for velocities:
CONTROL_VELOCITY = 4
SERVER_STATE = 17
NOT_STOPPED, PAUSED = 1, 2  # bits of the state
NO_VALUE, TIMEOUT, REMOTE_ERROR = 1, 2, 8  # bits of return codes
CYCLE = 1  # ms between messages; 5 is usual, but every step waits for some of them


def load_client() -> Any:
    """V-REP's client for Python, which no package registry has; raises SetupError."""
    library = {"win32": "remoteApi.dll", "darwin": "remoteApi.dylib"}.get(
        sys.platform, "remoteApi.so"
    )
    for name in ("sim", "vrep"):
        try:
            client = importlib.import_module(name)
        except ModuleNotFoundError as error:
            if error.name == name:
                continue
            raise SetupError(f"{name}.py needs {error.name}.py beside it") from error
        except Exception as error:  # whatever it stumbles over without its library
            raise SetupError(
                f"{name}.py cannot be loaded: {error}. Its library {library} must be beside it"
            ) from error
        if hasattr(client, "simxStart"):
            return client
    raise SetupError(
        "V-REP's client for Python is missing: there is neither a sim.py nor a vrep.py of it "
        f"on Python's path. Copy sim.py, simConst.py and {library} to "
        f"{Path(__file__).resolve().parent}. CoppeliaSim has them in its folder "
        "programming/legacyRemoteApi/remoteApiBindings (before 4.3: "
        "programming/remoteApiBindings), in python/python and, by system, in lib/lib. In "
        "V-REP 3 the first two are called vrep.py and vrepConst.py."
    )


def matrix_of(position: Sequence[float], angles: Sequence[float]) -> list[float]:
    """Rows of rotation (about x, then the new y, then the new z) and translation."""
    (ca, cb, cc), (sa, sb, sc) = map(math.cos, angles), map(math.sin, angles)
    x, y, z = position
    return [
        *(cb * cc, -cb * sc, sb, x),
        *(sa * sb * cc + ca * sc, ca * cc - sa * sb * sc, -sa * cb, y),
        *(sa * sc - ca * sb * cc, ca * sb * sc + sa * cc, ca * cb, z),
    ]


class Body:
    """A robot's body in V-REP: all contact with it goes through this class.

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
        self._started = self._holds_time = self._is_lost = False
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
                "another one connected to this one? --port chooses another port."
            ) from error

    def _connect(self, host: str, port: int) -> int:
        try:
            address = socket.gethostbyname(host)  # the client knows no names
        except OSError as error:
            raise SetupError(f"host {host} is not known: {error}") from error
        limit = round(1000.0 * CONNECT_TIMEOUT)
        number: int = self._client.simxStart(address, port, True, True, limit, CYCLE)
        if number < 0:
            raise SetupError(
                f"robot {self.model.name}: nobody answers at {self._address}. Is V-REP running "
                "there, with a server of the remote API on that port? --host and --port choose "
                "another place."
            )
        return number

    def pose(self) -> Pose:
        """Where the middle of the wheels is, and the robot's heading."""
        return self._mounting.pose(self._look())

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets how fast the wheels turn, in rad/s, forward where positive."""
        client = self._client
        try:
            # What is asked for in a pause goes out together when it ends.
            client.simxPauseCommunication(self._id, True)
            for index, rate in enumerate(rates):
                # Changes that nobody could see are not worth a message, but rest is rest.
                if abs(rate - self._rates[index]) > (1e-4 if rate else 0.0):
                    velocity = rate * self._mounting.senses[index]
                    self._set_velocity(index, velocity, client.simx_opmode_oneshot)
                    self._rates[index] = rate
        finally:
            client.simxPauseCommunication(self._id, False)

    #: if until
    def detects(self, sensor: str) -> bool:
        """Whether a proximity sensor sees something."""
        read = self._client.simxReadProximitySensor
        mode = self._client.simx_opmode_buffer
        return bool(self._ask(read, self._sensors[sensor], mode))

    #: endif
    #: if slam
    def wheel_angles(self) -> list[float]:
        """How far the wheels have turned, in radians, forward where positive."""
        read, mode = self._client.simxGetJointPosition, self._client.simx_opmode_buffer
        angles = [self._ask(read, joint, mode) for joint in self._joints]
        return [s * a for s, a in zip(self._mounting.senses, angles, strict=True)]

    def distance(self, sensor: str) -> float | None:
        """How far off what a proximity sensor sees is, in metres; None where it sees nothing."""
        client, handle = self._client, self._sensors[sensor]
        code, state, point, _, _ = client.simxReadProximitySensor(
            self._id, handle, client.simx_opmode_buffer
        )
        self._check(code, "simxReadProximitySensor")
        return math.hypot(*point) if state else None

    def eye(self, sensor: str) -> Eye:
        """Where a proximity sensor is mounted; the remote API cannot tell how far it sees."""
        wait = self._client.simx_opmode_blocking
        seen = self._matrix(self._sensors[sensor], wait)
        return Eye(self._mounting.mount(self._look(), seen))

    #: endif
    def advance(self) -> None:
        """Lets one step of simulation time pass."""
        before = self._milliseconds
        if self._holds_time:
            # Refused where the simulation does not run, as the state will show.
            self._ask(self._client.simxSynchronousTrigger, may=REMOTE_ERROR)
        deadline = time.monotonic() + REPLY_TIMEOUT
        # A trigger is answered before its step was taken, and others may have to trigger, too.
        while self._is_running():
            self._look()
            if self._milliseconds > before:
                break
            if time.monotonic() > deadline:
                raise SimulatorError(
                    f"no time passed at {self._address} for {REPLY_TIMEOUT:g} s"
                )
        self.time = self._milliseconds / 1000.0

    def start(self) -> None:
        """Starts the simulation, unless it runs already."""
        if self._is_stopped():
            client, wait = self._client, self._client.simx_opmode_blocking
            if self._realtime:
                self._ask(client.simxSetBooleanParameter, PARAM_REAL_TIME, True, wait)
            self._started = True
            self._ask(client.simxStartSimulation, wait)
            self._wait_until_stopped(False)
        self._look()

    def hold_time(self) -> None:
        """From now on time only passes when `advance` is called."""
        if not self._holds_time and not self._realtime:
            code = self._client.simxSynchronous(self._id, True)
            if code == REMOTE_ERROR:
                raise SetupError(
                    f"robot {self.model.name}: {self._address} does not let clients trigger "
                    "the steps of time. Set portIndex..._syncSimTrigger to true there in "
                    "remoteApiConnections.txt, or use --realtime."
                )
            self._check(code)
            self._holds_time = True
            self._look()

    def release_time(self) -> None:
        """From now on this robot does not hold up time."""
        if self._holds_time:
            self._ask(self._client.simxSynchronous, False)
            self._holds_time = False

    def why_it_stands(self) -> str:
        """What may keep the robot in place although its wheels should turn."""
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
        return "something may be in its way"

    def stop(self) -> None:
        """Stops the wheels, whatever happened before."""
        if self._is_lost:
            return
        try:
            for index in range(len(self._joints)):
                self._set_velocity(index, 0.0, self._client.simx_opmode_blocking)
        except SimulatorError:
            self._is_lost = True  # what led here says why

    def close(self) -> None:
        """Stops the simulation where this robot started it, and hangs up."""
        try:
            if self._started and not self._is_lost:
                wait = self._client.simx_opmode_blocking
                self._ask(self._client.simxStopSimulation, wait)
                self._wait_until_stopped(True)
            if not self._is_lost:
                self.release_time()
        except SimulatorError:
            self._is_lost = True
        self._client.simxFinish(self._id)

    def _state(self) -> int:
        """How the simulation is, after everything that was sent before was done."""
        self._ask(self._client.simxGetPingTime)
        # What it returns first is no code like others'.
        _, state = self._client.simxGetInMessageInfo(self._id, SERVER_STATE)
        return int(state)

    def _is_stopped(self) -> bool:
        return not self._state() & NOT_STOPPED

    def _is_running(self) -> bool:
        return self._state() & (NOT_STOPPED | PAUSED) == NOT_STOPPED

    def _wait_until_stopped(self, stopped: bool) -> None:
        """Starting and stopping take effect a moment after the simulator has answered."""
        deadline = time.monotonic() + STOP_TIMEOUT
        while self._is_stopped() != stopped and time.monotonic() < deadline:
            time.sleep(0.02)

    def _find_objects(self) -> None:
        """Finds the robot's parts and measures them: nothing about them is assumed."""
        client, wait = self._client, self._client.simx_opmode_blocking
        joints = self._ask(client.simxGetObjects, TYPE_JOINT, wait)
        sensors = self._ask(client.simxGetObjects, TYPE_SENSOR, wait)
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
        step = self._ask(client.simxGetFloatingParameter, PARAM_TIME_STEP, wait)
        self.time_step = round(step, 6)  # the client has single precision
        self._start_streams()
        mounts = [self._matrix(joint, wait) for joint in self._joints]
        self._mounting = Mounting(self.model, self._look(), mounts)
        self.drive = self._mounting.drive
        self._rates = [math.inf] * len(mounts)  # unknown, so the first is always set

    def _start_streams(self) -> None:
        """From now on every message brings what changes all the time."""
        client, stream = self._client, self._client.simx_opmode_streaming
        self._matrix(self._body, stream, may=NO_VALUE)
        #: if until or slam
        for sensor in self._sensors.values():
            # Before the first step, sensors are blind.
            may = NO_VALUE | REMOTE_ERROR
            self._ask(client.simxReadProximitySensor, sensor, stream, may=may)
        #: endif
        #: if slam
        for joint in self._joints:
            self._ask(client.simxGetJointPosition, joint, stream, may=NO_VALUE)
        #: endif
        self._ask(client.simxGetPingTime)

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
        """The first object of a kind: others may share its name, as a wheel and a sensor may."""
        tried = []
        for name in names:
            others: set[int] = set()
            handle = self._object(name)
            while handle is not None and handle not in others:
                if fits(handle):
                    return handle
                others.add(handle)
                handle = self._object(f"{name}[{len(others)}]")
            tried.append(
                f"{name} (what is there is of another kind)" if others else name
            )
        self._missing.append(f"{what} {' or '.join(tried)}")
        return -1

    def _object(self, name: str) -> int | None:
        wait = self._client.simx_opmode_blocking
        code, handle = self._client.simxGetObjectHandle(self._id, name, wait)
        self._check(code & ~REMOTE_ERROR)
        return None if code else int(handle)

    def _joint_parameter(self, joint: int, parameter: int) -> int | None:
        """A parameter of a joint; None in versions that do not have it."""
        read, wait = (
            self._client.simxGetObjectIntParameter,
            self._client.simx_opmode_blocking,
        )
        code, value = read(self._id, joint, parameter, wait)
        self._check(code & ~REMOTE_ERROR)
        return None if code else int(value)

    def _set_velocity(self, index: int, velocity: float, mode: int) -> None:
        set_velocity = self._client.simxSetJointTargetVelocity
        self._ask(set_velocity, self._joints[index], velocity, mode, may=NO_VALUE)

    def _look(self) -> list[float]:
        """Where the body is by the simulator's last message, and when that was."""
        buffer = self._client.simx_opmode_buffer
        while True:
            matrix = self._matrix(self._body, buffer)
            self._milliseconds = self._client.simxGetLastCmdTime(self._id)
            # Between its position and its angles another message may have come.
            if matrix == self._matrix(self._body, buffer):
                return matrix

    def _matrix(self, handle: int, mode: int, may: int = 0) -> list[float]:
        """Where an object is: rows of rotation and translation."""
        client = self._client
        position = self._ask(client.simxGetObjectPosition, handle, WORLD, mode, may=may)
        angles = self._ask(
            client.simxGetObjectOrientation, handle, WORLD, mode, may=may
        )
        return matrix_of(position, angles)

    def _ask(self, function: Callable[..., Any], *arguments: Any, may: int = 0) -> Any:
        """The first value that a function of the client gives; raises SimulatorError.

        `may` has the bits of return codes that are fine.
        """
        answer = function(self._id, *arguments)
        code, *values = answer if isinstance(answer, tuple) else (answer,)
        self._check(code & ~may, function.__name__)
        return values[0] if values else None

    def _check(self, code: int, function: str = "a command") -> None:
        if code == 0:
            return
        if self._client.simxGetConnectionId(self._id) == -1:
            self._is_lost = True
            raise SimulatorError(f"lost {self._address}")
        if code & TIMEOUT:
            raise SimulatorError(f"no answer from {self._address}")
        if code & REMOTE_ERROR:
            raise SimulatorError(f"{self._address} refused {function}")
        raise SimulatorError(f"{self._address}: {function} returned code {code}")
