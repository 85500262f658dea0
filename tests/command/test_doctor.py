"""`pydslrep doctor` and its checks, in scenes of the embedded simulator that `pydslrep scene push` builds and one call spoils."""

from __future__ import annotations

import contextlib
import json
import re
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from coppeliasim_zmqremoteapi_client import (  # type: ignore[import-untyped]
    RemoteAPIClient,
)
from pydslrep_runtime import RobotSpec
from pydslrep_runtime.scene.doctor import examine
from pydslrep_runtime.scene.findings import RULES

PROGRAM = """
wheel l with radius 4.5
wheel r with radius 4.5
sensor eye
robot one type tw with port {} has {{ l r }} wheels with sensors {{ eye }}
movement go of one {{ turn left until {{ eye }} move 1 meters }}
environment lab has {{ one }} robots with {{ go }} moves
"""
UP = [0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0.1]  # x up
LEVEL = [0, 0, 1, 0.15, 0, 1, 0, 0, -1, 0, 0, 0]  # z ahead
AHEAD = [0, 0, 1, 0, 0, 1, 0, 0.15, -1, 0, 0, 0.045]  # z along the body's x

Spoil = Callable[[Any], object]


def handle(sim: Any, path: str) -> int:
    found: int = sim.getObject(path)
    return found


def tyre(sim: Any) -> int:
    found: int = sim.getObjectsInTree(handle(sim, "/one/l"), sim.object_shape_type, 1)[
        0
    ]
    return found


def alias(path: str, name: str) -> Spoil:
    return lambda sim: sim.setObjectAlias(handle(sim, path), name)


def integer(path: str, parameter: str, value: Any) -> Spoil:
    """Sets a parameter; a value can be the name of a constant."""

    def apply(sim: Any) -> None:
        number = getattr(sim, value) if isinstance(value, str) else value
        each = tyre(sim) if path == "tyre" else handle(sim, path)
        sim.setObjectInt32Param(each, getattr(sim, parameter), number)

    return apply


def shape(sim: Any, name: str) -> int:
    made: int = sim.createPrimitiveShape(sim.primitiveshape_cuboid, [0.1, 0.1, 0.1])
    sim.setObjectAlias(made, name)
    return made


def instead(path: str, name: str) -> Spoil:
    """A shape has the place of a part."""

    def apply(sim: Any) -> None:
        sim.setObjectAlias(handle(sim, path), "other")
        sim.setObjectParent(shape(sim, name), handle(sim, "/one"), True)

    return apply


def nest(sim: Any) -> None:
    body = handle(sim, "/one")
    sim.setObjectAlias(body, "chassis")
    base = shape(sim, "one")
    sim.setObjectInt32Param(base, sim.shapeintparam_static, 1)
    sim.setObjectParent(body, base, True)


def swap(sim: Any) -> None:
    left, right = handle(sim, "/one/l"), handle(sim, "/one/r")
    sim.setObjectAlias(left, "r")
    sim.setObjectAlias(right, "l")


def slide(sim: Any) -> None:
    sim.setObjectAlias(handle(sim, "/one/l"), "other")
    joint = sim.createJoint(sim.joint_prismatic_subtype, sim.jointmode_dynamic, 0)
    sim.setObjectAlias(joint, "l")
    sim.setObjectParent(joint, handle(sim, "/one"), True)


def pause(sim: Any) -> None:
    sim.startSimulation()
    sim.pauseSimulation()


def hold(sim: Any) -> None:
    sim.setStepping(True)
    sim.startSimulation()


def be_a_joint(sim: Any) -> None:
    sim.setObjectAlias(handle(sim, "/one"), "other")
    joint = sim.createJoint(sim.joint_revolute_subtype, sim.jointmode_dynamic, 0)
    sim.setObjectAlias(joint, "one")


def slow_down(sim: Any) -> None:
    sim.setFloatParam(sim.floatparam_simulation_time_step, 0.1)


def lay_a_carpet(sim: Any) -> None:
    """A floor that sensors see, and a sensor that is level."""
    carpet = sim.createPrimitiveShape(sim.primitiveshape_cuboid, [9.0, 9.0, 0.01])
    sim.setObjectMatrix(handle(sim, "/one/eye"), LEVEL, handle(sim, "/one"))
    sim.setObjectAlias(carpet, "carpet")


def push_against_a_box(sim: Any) -> None:
    box = sim.createPrimitiveShape(sim.primitiveshape_cuboid, [0.1, 1.0, 0.2])
    sim.setObjectInt32Param(box, sim.shapeintparam_static, 1)
    sim.setObjectInt32Param(box, sim.shapeintparam_respondable, 1)
    sim.setObjectPosition(box, [0.25, 0.0, 0.1])
    sim.setStepping(True)
    sim.startSimulation()
    for wheel in ("/one/l", "/one/r"):
        # Which way is ahead depends on the axis of the joint; the box stops both.
        sim.setJointTargetVelocity(handle(sim, wheel), 2.0)
    for _ in range(40):
        sim.step()
    sim.setStepping(False)


STATIC, SOLID = "shapeintparam_static", "shapeintparam_respondable"
CONTROL = "jointintparam_dynctrlmode"

BROKEN: dict[str, Spoil] = {
    "no-main-script": lambda sim: sim.removeScript(
        sim.getScript(sim.scripttype_mainscript)
    ),
    "paused": pause,
    "time-held": hold,
    "time-step": slow_down,
    "physics-step": lambda sim: sim.setFloatParam(sim.floatparam_physicstimestep, 0.05),
    "sensor-sees-floor": lay_a_carpet,
    "wheels-spin": push_against_a_box,
    "robot-missing": alias("/one", "Pioneer"),
    "robot-kind": be_a_joint,
    "duplicate-name": lambda sim: shape(sim, "one"),
    "static-body": integer("/one", STATIC, 1),
    "nested-chassis": nest,
    "tilted-body": lambda sim: sim.setObjectMatrix(handle(sim, "/one"), UP),
    "wrong-forward": lambda sim: sim.setObjectMatrix(
        handle(sim, "/one/l"), AHEAD, handle(sim, "/one")
    ),
    "swapped-wheels": swap,
    "wheel-missing": alias("/one/l", "motor"),
    "wheel-kind": instead("/one/l", "l"),
    "joint-type": slide,
    "joint-mode": lambda sim: sim.setJointMode(
        handle(sim, "/one/l"), sim.jointmode_kinematic, 0
    ),
    "motor-off": integer("/one/l", CONTROL, "jointdynctrl_free"),
    "control-mode": integer("/one/l", CONTROL, "jointdynctrl_position"),
    "no-torque": lambda sim: sim.setJointTargetForce(handle(sim, "/one/l"), 0.0),
    "weak-motor": lambda sim: sim.setJointTargetForce(handle(sim, "/one/l"), 1e-4),
    "no-wheel-shape": lambda sim: sim.removeObjects([tyre(sim)]),
    "static-wheel": integer("tyre", STATIC, 1),
    "ghost-wheel": integer("tyre", SOLID, 0),
    "sensor-missing": alias("/one/eye", "lamp"),
    "sensor-kind": instead("/one/eye", "eye"),
}

# What is no matter of calls, or what this simulator cannot be made to be: old; robots do not fall in it. See
# python/tests/test_scene_checks.py and test_scene_pull.py.
ELSEWHERE = {
    "no-connection",
    "legacy-port",
    "no-reply",
    "old-version",
    "wheel-radius",
    "fallen",
    "rollers-collide",
}


@pytest.fixture
def port(command: str, tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[int]:
    """The port of a simulator in which the program's scene is built; tests may parametrise it by the server to imitate."""
    server = getattr(request, "param", "embedded")
    simulator = subprocess.Popen(
        [command, "sim", "--empty", "--port", "0", "--server", server],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert simulator.stdout is not None
    ready = re.search(r":(\d+)", simulator.stdout.readline())
    assert ready is not None
    program(tmp_path).write_text(PROGRAM.format(ready[1]))
    push = [command, "scene", "push", program(tmp_path), "--port", ready[1]]
    subprocess.run(push, check=True, capture_output=True, timeout=60)
    yield int(ready[1])
    simulator.send_signal(signal.SIGINT)
    simulator.communicate(timeout=60)


def program(folder: Path) -> Path:
    return folder / "lab.pyr"


@contextlib.contextmanager
def client(port: int) -> Iterator[Any]:
    """The functions of the simulator."""
    remote = RemoteAPIClient("127.0.0.1", port)
    yield remote.require("sim")
    remote.socket.close(linger=0)
    remote.context.term()


def doctor(command: str, folder: Path, *options: str) -> tuple[int, str]:
    """The exit code and the output of `pydslrep doctor`."""
    done = subprocess.run(
        [command, "doctor", program(folder), *options],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert not done.stderr
    return done.returncode, done.stdout


def codes(port: int, radius: float = 0.045) -> list[str]:
    spec = RobotSpec("one", "127.0.0.1", port, {"l": radius, "r": radius}, ["eye"])
    return [each.rule.code for each in examine([spec])]


def test_every_rule_is_provoked_somewhere() -> None:
    assert BROKEN.keys() | ELSEWHERE == {rule.code for rule in RULES}


@pytest.mark.parametrize("code", BROKEN)
def test_a_pushed_scene_is_sound_until_it_is_spoilt(code: str, port: int) -> None:
    assert codes(port) == []
    with client(port) as sim:
        BROKEN[code](sim)
        assert code in codes(port)


def test_radii_are_compared(port: int) -> None:
    assert codes(port, radius=0.0455) == []
    assert codes(port, radius=0.05) == ["wheel-radius"] * 2


def test_the_command_says_what_to_do(command: str, port: int, tmp_path: Path) -> None:
    assert doctor(command, tmp_path) == (0, "the scene fits the program\n")
    with client(port) as sim:
        BROKEN["motor-off"](sim)
    code, text = doctor(command, tmp_path)
    assert code == 1
    assert "error[motor-off]: robot one: /one/l has no motor" in text
    assert "set Control mode to Velocity" in text
    assert text.endswith("\n1 error\n")
    code, text = doctor(command, tmp_path, "--json")
    (found,) = json.loads(text)
    assert (code, found["code"], found["robot"]) == (1, "motor-off", "one")


def test_nobody_listens(command: str, port: int, tmp_path: Path) -> None:
    code, text = doctor(command, tmp_path, "--port", "one=1")
    assert code == 2
    assert "error[no-connection]: nothing listens at 127.0.0.1:1" in text


@pytest.mark.parametrize("port", ["coppeliasim-4.6"], indirect=True)
def test_a_simulator_that_is_paused_may_not_reply(
    command: str, port: int, tmp_path: Path
) -> None:
    with client(port) as sim:
        pause(sim)
        code, text = doctor(command, tmp_path)
        assert code == 2
        assert f"error[no-reply]: 127.0.0.1:{port} accepts connections" in text
        assert "[Simulation > Start simulation]" in text


def test_the_port_of_the_legacy_remote_api_is_known(
    command: str, port: int, tmp_path: Path
) -> None:
    assert codes(port) == []
    code, text = doctor(command, tmp_path, "--port", "19999")
    assert code == 2
    assert "error[legacy-port]: " in text
    assert "23000" in text
