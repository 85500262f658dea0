"""Robots in CoppeliaSim, over its ZeroMQ remote API."""

import math
import os
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from typing import Any

from .backend import Backend, RobotSpec, SensorCone
from .errors import SetupError, SimulatorError
from .mounting import MAX_MISALIGNMENT, Mounting, angle_to_left, angle_to_vertical
from .notes import Notes, pause
from .pose import Pose
from .readings import TIME, check, check_time
from .remote_api import (
    EXECUTED,
    RUN_VARIABLE,
    Connection,
    RefusedError,
    Request,
    accepts_connections,
)
from .scene.lookup import objects_at, part_paths, robot_paths
from .settings import (
    CLIENT_TIMEOUT,
    PROBE_PERIOD,
    STANDSTILL_CHECKS,
    STOP_TIMEOUT,
)
from .wait_policy import PAUSED, WaitPolicy

DEFAULT_PORT = 23000  # of the ZeroMQ remote API
LEGACY_PORT = 19999  # of the legacy remote API
TURNING = 0.01  # rad/s above which a wheel turns
STEPS_PER_CHECK = (
    20  # steps after which time and wheels are compared with the simulator's
)
SPEED_OF_FALL = 1.0  # m/s, at which a body sinks that nothing carries
FALLEN = 0.1  # m below its start, from which on it has
SAME_RATE = 0.001  # rad/s by which a wheel's target differs from the one that was set


class CoppeliaSim:
    """The simulator, and its clock: its first connection steps it for all robots."""

    def __init__(self, host: str, *, realtime: bool, restart: bool = False) -> None:
        """With `realtime`, time passes no faster than real time; with `restart`, a simulation that runs is stopped first."""
        self.time = 0.0
        self.time_step = 0.0
        self._host, self._realtime, self._restart = host, realtime, restart
        self._robots: dict[str, CoppeliaSimRobot] = {}
        self._notes = Notes()
        self._connections: dict[int, Connection] = {}
        self._has_started = self._is_stepping = False
        self._step_due: float | None = None
        self._steps = 0
        self._last_step = 0.0  # in the time of `time.monotonic`
        self._checked_time = 0.0  # what the simulator said last
        self._checked_steps = self._standstills = 0
        self.is_doubtful = False  # whether the latest step may have taken no time
        self._wait_policies: dict[Connection, WaitPolicy] = {}

    def connect(self, spec: RobotSpec) -> Backend:
        """Connects a robot; raises SetupError."""
        try:
            if spec.port not in self._connections:
                self._connections[spec.port] = Connection(self._host, spec.port)
                self._stop_running()
            robot = CoppeliaSimRobot(spec, self._connections[spec.port], self)
        except SimulatorError as error:
            if spec.port in self._connections:
                raise SetupError(f"robot {spec.name}: {error}") from error
            if spec.port == LEGACY_PORT:
                raise SetupError(
                    f"robot {spec.name}: no reply from port {spec.port}. CoppeliaSim's ZeroMQ "
                    f"remote API listens on {DEFAULT_PORT}: change the port in the program, or "
                    f"use --port {DEFAULT_PORT}."
                ) from error
            raise SetupError(
                f"robot {spec.name}: {error}. {self._reason_for_silence(spec.port)}"
            ) from error
        self._robots[spec.name] = robot
        return robot

    def _reason_for_silence(self, port: int) -> str:
        """What to do about a simulator that does not reply."""
        address = f"{self._host}:{port}"
        if port not in self._connections and accepts_connections(address):
            from .scene.findings import finding

            why = finding("no-reply", address=address)
            return f"{why.message[0].upper()}{why.message[1:]}: {why.help}."
        return (
            "Is CoppeliaSim running there, with its ZeroMQ remote API on that port? Use --host and --port to connect "
            "elsewhere."
        )

    def _stop_running(self) -> None:
        """Puts everything back, once, if that is wanted: before anything is measured."""
        if self._restart and not self._is_stopped():
            first = self._first()
            first.call(first.sim.stopSimulation)
            self._wait_until(stopped=True)
        self._restart = False

    def start(self) -> None:
        """Starts the simulation if it is stopped; time stands still until `advance`."""
        first = self._first()
        self._is_stepping = True
        first.call(first.sim.setStepping, True)
        self._last_step = time.monotonic()
        self.time_step = first.call(first.sim.getSimulationTimeStep)
        for connection in self._connections.values():
            policy = self._wait_policies[connection] = WaitPolicy(connection.address)
            connection.call_on_silence(policy.wait, PROBE_PERIOD)
        if self._is_stopped():
            self._has_started = True
            first.call(first.sim.startSimulation)
            self._wait_until(stopped=False)
        self._wait_while_paused()
        now = first.call(first.sim.getSimulationTime)
        check(f"error from {first.address}: sim.getSimulationTime", now, TIME)
        self.time = self._checked_time = now
        if not self._has_started:
            poses = {name: robot.pose() for name, robot in self._robots.items()}
            self._notes.say_running(self.time, poses)

    def advance(self) -> None:
        """Takes one step."""
        _first, *others = self._connections.values()
        for connection in others:
            # The step must not overtake commands on other connections.
            connection.finish()
        if self.is_doubtful or self._steps % STEPS_PER_CHECK == 1:
            self._check_time()
        self._take_step()
        for connection in self._connections.values():
            connection.read_ahead()
        if self._step_due is None:
            self.time = self._read_time()
            self._step_due = time.monotonic()
        else:
            self.time += self.time_step
        self._step_due += self.time_step
        if self._realtime:
            time.sleep(max(0.0, self._step_due - time.monotonic()))

    def close(self) -> None:
        """Stops the simulation if it was started here, and disconnects."""
        if self._connections:
            first = self._first()
            if self._has_started:
                first.last_call("sim.stopSimulation")
                with suppress(SimulatorError):  # the first error is reported
                    self._wait_until(stopped=True)
            if self._is_stepping:
                first.last_call("sim.setStepping", False)
        for connection in self._connections.values():
            connection.close()

    def _take_step(self) -> None:
        first, began = self._first(), time.monotonic()
        if began - self._last_step > CLIENT_TIMEOUT / 2.0:
            self._hold_time()
        try:
            first.result(first.post("sim.step"))
        except RefusedError as error:
            # After a long pause, a client that was waiting for its step is unknown.
            if EXECUTED not in str(error):
                raise
        self._steps += 1
        self._last_step = time.monotonic()
        if self._last_step - began > CLIENT_TIMEOUT / 2.0:
            self._hold_time()

    def _hold_time(self) -> None:
        """Enters stepping mode again if the simulator has forgotten this client in the meantime."""
        first = self._first()
        if first.call(first.sim.setStepping, True):
            first.call(first.sim.setStepping, False)
        self.is_doubtful = True

    def _check_time(self) -> None:
        """Corrects the time; while the simulation is paused, newer versions return from steps that they have not taken."""
        self.is_doubtful = False
        now = self._read_time()
        if abs(now - self.time) > self.time_step / 2.0:
            self._wait_while_paused()
            self.time = now

    def _read_time(self) -> float:
        """The simulator's own time in seconds; raises SimulatorError if it stands still although steps were taken."""
        first, before = self._first(), self._checked_time
        now: float = first.call(first.sim.getSimulationTime)
        check_time(f"error from {first.address}: sim.getSimulationTime", before, now)
        if now > before or self._steps == self._checked_steps:
            self._standstills = 0
        else:
            # While the simulation is paused, some steps are not taken.
            self._standstills += 1
            if self._standstills >= STANDSTILL_CHECKS:
                raise SimulatorError(
                    f"error from {first.address}: sim.getSimulationTime stands still at {now:g} s, "
                    "although the simulation runs"
                )
        self._checked_time, self._checked_steps = now, self._steps
        return now

    def _wait_while_paused(self) -> None:
        first = self._first()
        while (state := first.call(first.sim.getSimulationState)) == PAUSED:
            self._wait_policies[first].say_paused()
            pause()
        if state == first.sim.simulation_stopped:
            raise SimulatorError("the simulation was stopped")

    def _first(self) -> Connection:
        return next(iter(self._connections.values()))

    def _is_stopped(self) -> bool:
        first = self._first()
        state = first.call(first.sim.getSimulationState)
        return bool(state == first.sim.simulation_stopped)

    def _wait_until(self, *, stopped: bool) -> None:
        """Waits, because starting and stopping take effect after the reply."""
        deadline = time.monotonic() + STOP_TIMEOUT
        first = self._first()
        while not (first.is_lost or first.is_silent) and time.monotonic() < deadline:
            if self._is_stopped() == stopped:
                break
            time.sleep(0.02)


class CoppeliaSimRobot(Backend):
    """A robot in CoppeliaSim's scene."""

    def __init__(
        self, spec: RobotSpec, connection: Connection, clock: CoppeliaSim
    ) -> None:
        """Finds the robot's parts; raises SetupError."""
        self.clock = clock
        self._spec, self._connection = spec, connection
        self._sim, self._call = connection.sim, connection.call
        self._find_objects()
        joints = [self._matrix(joint) for joint in self._joints]
        body = self._matrix(self._body)
        self._check_frame(body, joints)
        self._mounting = Mounting(body, joints)
        # The rates are unknown, so the first ones are always set.
        self._rates = [math.inf] * len(joints)
        self._commands: list[Request] = []
        self._last_matrix: Sequence[float] = ()
        self._height = body[11]
        self._last_height = (math.inf, body[11])  # s, m
        self._explicit: set[str] = set()  # sensors that the scene does not handle
        self._has_rival = False  # whether another program drives it, too
        self._steps = 0
        self._notes = Notes()

    def wheel_mounts(self) -> Sequence[tuple[float, float]]:
        """The positions of the wheels on the body."""
        return self._mounting.wheels

    def _check_frame(
        self, body: Sequence[float], joints: Sequence[Sequence[float]]
    ) -> None:
        """Raises SetupError if the body cannot move, or its frame does not face forward."""
        name = robot_paths(self._spec)[0]
        if self._is_static():
            raise self._unfit("static-body", object=name, kind="a static shape")
        tilt = angle_to_vertical(body)
        if tilt > MAX_MISALIGNMENT:
            raise self._unfit("tilted-body", object=name, angle=tilt)
        for wheel, joint in zip(self._spec.wheels, joints, strict=True):
            angle = angle_to_left(body, joint)
            if angle > MAX_MISALIGNMENT:
                path = part_paths(self._spec, wheel)[0]
                raise self._unfit("wrong-forward", joint=path, angle=angle, object=name)

    def _is_static(self) -> bool:
        """Whether the body is a shape that neither physics nor a parent moves."""
        parameter = getattr(self._sim, "shapeintparam_static", None)
        if (
            parameter is None
            or self._call(self._sim.getObjectType, self._body)
            != self._sim.object_shape_type
        ):
            return False
        if not self._connection.try_call("getObjectInt32Param", self._body, parameter):
            return False
        return bool(self._call(self._sim.getObjectParent, self._body) == -1)

    def _unfit(self, code: str, **values: Any) -> SetupError:
        from .scene.findings import finding

        why = finding(code, **values)
        return SetupError(f"robot {self._spec.name}: {why.message}; {why.help}")

    def pose(self) -> Pose:
        """The pose of the wheels' centre."""
        self._check_commands()
        matrix = self._connection.read("sim.getObjectMatrix", self._body)
        if matrix == self._last_matrix and any(self._rates):
            self.clock.is_doubtful = True
        self._last_matrix = matrix
        self._check_fall(matrix)
        return self._mounting.pose(matrix)

    def _check_fall(self, body: Sequence[float]) -> None:
        """Raises SimulatorError if nothing carries the robot: off its floor, it would go on driving."""
        now, height = self.clock.time, body[11]
        (before, higher), self._last_height = self._last_height, (now, height)
        if now <= before or self._height - height < FALLEN:
            return
        if higher - height > SPEED_OF_FALL * (now - before):
            path = robot_paths(self._spec)[0]
            raise SimulatorError(
                f"it has fallen off its floor: {path} is {self._height - height:.2f} m lower than at the start. The "
                "floor must be larger than its way; `pydslrep scene push` builds one"
            )

    def set_wheel_rates(self, rates: Sequence[float]) -> None:
        """Sets the rates of the wheels in rad/s, forward if positive."""
        self._check_commands()
        self._steps += 1
        if self._steps % STEPS_PER_CHECK == 2 and not self._has_rival:
            self._check_driver()
        for index, rate in enumerate(rates):
            # Skip negligible changes, except to zero.
            if abs(rate - self._rates[index]) > (1e-4 if rate else 0.0):
                velocity = rate * self._mounting.axis_signs[index]
                command = "sim.setJointTargetVelocity"
                self._commands.append(
                    self._connection.post(command, self._joints[index], velocity)
                )
                self._rates[index] = rate

    def _check_driver(self) -> None:
        """Says if somebody else drives the robot, too."""
        for name, joint, sign, rate in zip(
            self._spec.wheels,
            self._joints,
            self._mounting.axis_signs,
            self._rates,
            strict=True,
        ):
            found = self._connection.try_call("getJointTargetVelocity", joint)
            if found is None or math.isinf(rate):
                continue
            if abs(sign * found - rate) > SAME_RATE:
                self._has_rival = True
                self._notes.say(
                    f"another program drives robot {self._spec.name}, too: it has set its wheel {name} to "
                    f"{sign * found:.2f} rad/s, this script to {rate:.2f} rad/s. End one of them"
                )
                return

    def detects(self, sensor: str) -> bool:
        """Whether a proximity sensor detects an object."""
        return bool(self._read(sensor)[0] > 0)

    def distance(self, sensor: str) -> float | None:
        """The distance that a proximity sensor measures, in metres; None if nothing."""
        state, distance, *_ = self._read(sensor)
        return float(distance) if state > 0 else None

    def sensor_cone(self, sensor: str) -> SensorCone:
        """The mount and detection volume of a proximity sensor."""
        handle, get = self._sensors[sensor], self._connection.try_call
        mount = self._mounting.mount(self._matrix(self._body), self._matrix(handle))
        reach = get("getFloatProperty", handle, "volume_range")
        angles = get("getFloatArrayProperty", handle, "volume_angle")
        return SensorCone(mount, reach, angles[0] if angles else None)

    def wheel_angles(self) -> Sequence[float]:
        """The angles of the wheels in radians, forward if positive."""
        angles = [
            self._connection.read("sim.getJointPosition", joint)
            for joint in self._joints
        ]
        return [s * a for s, a in zip(self._mounting.axis_signs, angles, strict=True)]

    def stall_reason(self) -> str:
        """Why the robot may not move although its wheels should turn."""
        state = self._call(self._sim.getSimulationState)
        if not state & self._sim.simulation_advancing:
            return "the simulation was stopped or paused"
        tilt = angle_to_vertical(self._matrix(self._body))
        if tilt > MAX_MISALIGNMENT:
            return f"it has fallen over: its body is {tilt:.0f}° off the vertical. Stop the simulation, which puts it back"
        from .scene.checks import explain

        if why := explain(self._connection, self._spec):
            return why
        mode = self._sim.jointintparam_dynctrlmode
        for name, joint in zip(self._spec.wheels, self._joints, strict=True):
            found = self._call(self._sim.getObjectInt32Param, joint, mode)
            if found != self._sim.jointdynctrl_velocity:
                return (
                    f"joint {name} ignores velocities: set its control mode to velocity"
                )
        body = self._matrix(self._body)
        joints = [self._matrix(joint) for joint in self._joints]
        path = robot_paths(self._spec)[0]
        if self._mounting.has_lost_wheels(body, joints):
            return (
                f"the wheels drive away from {path}: it is static, or an object above the "
                f"chassis; the chassis itself has to be called {self._spec.name}"
            )
        rates = [self._connection.try_call("getJointVelocity", j) for j in self._joints]
        if None not in rates and all(abs(rate) < TURNING for rate in rates):
            return "its wheels do not turn: their motors may be off or weak"
        # In the simulator of `pydslrep run`, nothing else can be wrong.
        hint = (
            "" if RUN_VARIABLE in os.environ else "; `pydslrep doctor` checks the scene"
        )
        return (
            "its wheels turn, but the body does not move: "
            + super().stall_reason()
            + hint
        )

    def crawl_reason(self) -> str:
        """Why the robot may be slower than planned."""
        from .scene.checks import explain_crawl

        if why := explain_crawl(self._connection, self._spec):
            return why
        return super().crawl_reason() + "; `pydslrep doctor` checks the scene"

    def stop(self) -> None:
        """Stops the wheels, even after an error."""
        self._connection.last_calls(
            "sim.setJointTargetVelocity", [(joint, 0.0) for joint in self._joints]
        )
        self._rates = [0.0] * len(self._joints)

    def _check_commands(self) -> None:
        """Raises SimulatorError if the simulator has refused a command."""
        commands, self._commands = self._commands, []
        for command in commands:
            self._connection.result(command)

    def _read(self, sensor: str) -> Any:
        """State, distance and more of a proximity sensor."""
        handle = self._sensors[sensor]
        if sensor not in self._explicit:
            reading = self._connection.read("sim.readProximitySensor", handle)
            if reading[0] >= 0:
                return reading
        # The scene requires explicit handling of this sensor: what it reads else is what it detected when handled last.
        reading = self._call(self._sim.handleProximitySensor, handle)
        self._explicit.add(sensor)
        return reading

    def _find_objects(self) -> None:
        joint = self._sim.object_joint_type
        sensor = self._sim.object_proximitysensor_type
        self._missing: list[str] = []
        self._body = self._find(
            "robot", lambda kind: kind not in (joint, sensor), *robot_paths(self._spec)
        )
        self._check_found()  # where it is, its parts are
        self._joints = self._find_parts("joint", joint, self._spec.wheels)
        sensors = (*self._spec.sensors, *self._spec.bumpers)
        handles = self._find_parts("proximity sensor", sensor, sensors)
        self._sensors = dict(zip(sensors, handles, strict=True))
        self._check_found()

    def _check_found(self) -> None:
        if self._missing:
            raise SetupError(
                f"robot {self._spec.name}: the scene at {self._connection.address} has no "
                + ", no ".join(self._missing)
                + "; `pydslrep scene push` builds what the program needs"
            )

    def _find_parts(self, what: str, kind: int, names: Iterable[str]) -> list[int]:
        def fits(found: int) -> bool:
            return found == kind

        return [self._find(what, fits, *part_paths(self._spec, name)) for name in names]

    def _find(self, what: str, fits: Callable[[int], bool], *paths: str) -> int:
        """The first object of the right type; a wheel and a sensor may share a name."""
        tried = []
        for path in paths:
            has_others = False
            for handle in objects_at(self._connection, path):
                if fits(self._call(self._sim.getObjectType, handle)):
                    return handle
                has_others = True
            tried.append(f"{path} (an object of another type)" if has_others else path)
        self._missing.append(f"{what} {' or '.join(tried)}")
        return -1

    def _matrix(self, handle: int) -> list[float]:
        """An object's matrix: rows of rotation and translation."""
        matrix: list[float] = self._call(self._sim.getObjectMatrix, handle)
        return matrix
