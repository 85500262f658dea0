"""Failures: blocked robots, missing objects, simulators that do not reply."""

import math
import re
import socket
import threading
import time
from collections.abc import Iterator

import cbor2
import pytest
import zmq
from driving import declared, drive_alone, joints
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import MovementError, Robot, SetupError, coppeliasim, remote_api
from pydslrep_runtime.coppeliasim import CoppeliaSim
from pydslrep_runtime.settings import STOP_TIMEOUT


async def move_a_metre(robot: Robot) -> None:
    """The second action of its movement."""
    await robot.turn(0.0)
    await robot.move(1.0)


def test_a_blocked_robot_fails_its_action(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"), wall=0.4)
    world = FakeWorld(fake)
    with pytest.raises(MovementError) as error:
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    assert str(error.value) == (
        "robot r, movement m, action 2: move 1 m: no progress for 5 s, 0.600 m from the goal; "
        "its wheels turn, but the body does not move: an obstacle may be in the way; "
        "`pydslrep doctor` checks the scene"
    )
    assert all(joint.target == 0.0 for joint in fake.joints)
    assert not world.running
    assert 5.0 < world.steps * world.dt < 12.0


def test_a_deflected_robot_fails_its_action(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake = FakeRobot("r", joints("two-wheel"), theta=math.radians(-20.0), kerb=-0.1)
    with pytest.raises(MovementError) as error:
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", move_a_metre)
    assert re.fullmatch(
        r"robot r, movement m, action 2: move 1 m: ended 0\.2\d\d m to the left of the goal; "
        "an obstacle may have deflected it",
        str(error.value),
    )
    assert all(joint.target == 0.0 for joint in fake.joints)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_deflection_of_up_to_five_centimetres_is_accepted(
    side: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The robot is pushed where it has no way left to return to its line."""

    def drive(push: float) -> None:
        fake = FakeRobot("r", joints("two-wheel"))
        world = FakeWorld(fake)

        def deflect() -> None:
            if fake.x > 0.999 and fake.y == 0.0:
                fake.y = side * push

        world.before_step = deflect
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
        assert abs(fake.y) == pytest.approx(push, abs=0.001)

    drive(0.048)
    words = f"ended 0.052 m to the {'left' if side > 0.0 else 'right'} of the goal"
    with pytest.raises(MovementError, match=re.escape(words)):
        drive(0.052)


def test_a_joint_in_another_mode_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    for joint in fake.joints:
        joint.mode = 8
    with pytest.raises(
        MovementError,
        match="wheelL ignores velocities: set its control mode to velocity",
    ):
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", move_a_metre)


def test_a_static_body_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"), is_static=True)
    with pytest.raises(SetupError, match="/r does not move, as it is a static shape"):
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", move_a_metre)


@pytest.mark.parametrize("late", ["step", "script"])
def test_holds_the_time_again_when_the_simulator_may_have_forgotten_it(
    late: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After 30 s of silence it does; from half of that on, nothing is certain."""
    world = FakeWorld(FakeRobot("r", joints("two-wheel")))
    clock, passed = time.monotonic, 0.0
    monkeypatch.setattr(time, "monotonic", lambda: clock() + passed)

    def forget() -> None:
        nonlocal passed
        passed += 16.0
        world.holders.clear()

    def forget_in_a_step() -> None:
        if late == "step" and world.steps == 40:
            forget()

    async def actions(robot: Robot) -> None:
        await robot.move(0.5)
        if late == "script":
            forget()
        await robot.move(0.5)
        assert sum(world.holders.values()) == 1

    world.before_step = forget_in_a_step
    drive_alone(world, monkeypatch, "two-wheel", actions)
    assert passed == 16.0
    assert not any(world.holders.values())


def test_a_stopped_simulation_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    world = FakeWorld(FakeRobot("r", joints("two-wheel")))

    def stop() -> None:
        world.running = world.steps < 20

    world.before_step = stop
    with pytest.raises(MovementError, match="move 1 m: the simulation was stopped"):
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)


def test_all_missing_objects_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"), sensors={"eye": lambda _: False})
    world = FakeWorld(fake)
    del world.paths["/r/wheelR"], world.paths["/r/eye"]
    with pytest.raises(SetupError) as error:
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    assert str(error.value) == (
        "robot r: the scene at 127.0.0.1:19999 has no joint /r/wheelR or /wheelR_r, "
        "no proximity sensor /r/eye or /eye_r; `pydslrep scene push` builds what the program needs"
    )


def test_objects_of_another_type_are_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"), sensors={"eye": lambda _: False})
    world = FakeWorld(fake)
    world.paths["/r/wheelR"] = world.paths["/r/eye"]
    world.paths["/eye_r"] = world.paths.pop("/r/wheelL") * 3
    del world.paths["/r/eye"]
    with pytest.raises(SetupError) as error:
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    assert str(error.value) == (
        "robot r: the scene at 127.0.0.1:19999 has no joint /r/wheelL or /wheelL_r, "
        "no joint /r/wheelR (an object of another type) or /wheelR_r, "
        "no proximity sensor /r/eye or /eye_r (an object of another type); "
        "`pydslrep scene push` builds what the program needs"
    )
    world.paths["/r"] = world.paths["/r/wheelR"]
    with pytest.raises(
        SetupError, match=r"no robot /r \(an object of another type\); "
    ):
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)


def test_robot_wheel_and_sensor_may_share_a_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    wheels = joints("two-wheel")
    wheels[0].name = "r"
    fake = FakeRobot("r", wheels, sensors={"r": lambda robot: robot.theta < 0.5})
    world = FakeWorld(fake)
    world.paths["/r/r"].reverse()
    world.paths["/r"] = world.paths["/r/r"] + world.paths["/r"]
    drive_alone(
        world,
        monkeypatch,
        "two-wheel",
        lambda robot: robot.turn_until_free("left", "r"),
    )
    assert 0.5 < fake.theta < 0.6


def test_parts_are_found_by_their_flat_names(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    world = FakeWorld(fake)
    world.paths["/wheelR_r"] = world.paths.pop("/r/wheelR")
    drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    assert fake.x == pytest.approx(1.0, abs=0.001)


def test_swapped_wheels_are_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    wheels = joints("two-wheel")
    fake = FakeRobot("r", wheels[::-1])
    with pytest.raises(SetupError, match="robot r: the left wheel is not to the left"):
        drive_alone(FakeWorld(fake), monkeypatch, "two-wheel", move_a_metre)


def test_a_running_simulation_is_left_running(monkeypatch: pytest.MonkeyPatch) -> None:
    world = FakeWorld(FakeRobot("r", joints("two-wheel")))
    world.running = True
    drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    assert world.running
    assert set(world.holders.values()) == {0}


def test_ctrl_c_stops_the_wheels(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = FakeRobot("r", joints("two-wheel"))
    world = FakeWorld(fake)
    world.running = True

    def interrupt() -> None:
        if world.steps == 30:
            raise KeyboardInterrupt

    world.before_step = interrupt
    with pytest.raises(KeyboardInterrupt):
        drive_alone(world, monkeypatch, "two-wheel", move_a_metre)
    assert fake.joints[0].rate > 0.0
    (client,) = world.clients()
    assert client.socket.limit == STOP_TIMEOUT, (
        "the socket was left in the middle of a call"
    )
    assert all(joint.target == 0.0 for joint in fake.joints)
    assert set(world.holders.values()) == {0}


class Replies(threading.Thread):
    """A server that gives every request the same reply."""

    def __init__(self, reply: object) -> None:
        super().__init__()
        self.context = zmq.Context()
        self.socket = self.context.socket(zmq.REP)
        self.port = self.socket.bind_to_random_port("tcp://127.0.0.1")
        self.reply = reply if isinstance(reply, bytes) else cbor2.dumps(reply)
        self.done = threading.Event()

    def run(self) -> None:
        """Replies until `done` is set."""
        while not self.done.is_set():
            if self.socket.poll(20):
                self.socket.recv()
                self.socket.send(self.reply)
        self.socket.close(linger=0)
        self.context.term()


@pytest.fixture(name="short_wait")
def fixture_short_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shortens the script's timeout."""
    monkeypatch.setattr(remote_api, "CONNECT_TIMEOUT", 0.2)


@pytest.fixture(name="server")
def fixture_server(request: pytest.FixtureRequest) -> Iterator[Replies]:
    """A running server with the reply of the test's parameter."""
    server = Replies(request.param)
    server.start()
    yield server
    server.done.set()
    server.join()


def connect(port: int) -> None:
    """Tries to connect with the client's real class."""
    robot = declared(FakeRobot("r", joints("two-wheel")), "two-wheel", port)
    CoppeliaSim("127.0.0.1", realtime=False).connect(robot.spec("127.0.0.1", port))


@pytest.mark.usefixtures("short_wait")
def test_no_server() -> None:
    with pytest.raises(SetupError, match=r"no reply from 127\.0\.0\.1:9 for 0\.2 s"):
        connect(9)


@pytest.mark.usefixtures("short_wait")
def test_no_server_on_the_port_of_vrep(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        port = silent.getsockname()[1]
        monkeypatch.setattr(coppeliasim, "LEGACY_PORT", port)
        with pytest.raises(SetupError) as error:
            connect(port)
    assert str(error.value) == (
        f"robot r: no reply from port {port}. CoppeliaSim's ZeroMQ remote API listens on 23000: "
        "change the port in the program, or use --port 23000."
    )


@pytest.mark.usefixtures("short_wait")
@pytest.mark.parametrize("server", [{"func": "_*wait*_", "args": []}], indirect=True)
def test_endless_wait_rounds_have_a_limit(server: Replies) -> None:
    with pytest.raises(SetupError, match="no reply from"):
        connect(server.port)


@pytest.mark.parametrize(
    "server",
    [b"HTTP/1.1 400 Bad Request\r\n", {"err": "no such module"}, [1, 2]],
    indirect=True,
)
def test_nonsense_is_reported(server: Replies) -> None:
    with pytest.raises(
        SetupError, match=f"robot r: error from 127.0.0.1:{server.port}: "
    ):
        connect(server.port)
