"""`pydslrep scene` against the embedded simulator, with the real client library."""

from __future__ import annotations

import contextlib
import json
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from coppeliasim_zmqremoteapi_client import (  # type: ignore[import-untyped]
    RemoteAPIClient,
)
from pydslrep_runtime.api_calls import CALLS
from pydslrep_runtime.errors import SimulatorError
from pydslrep_runtime.remote_api import Connection
from pydslrep_runtime.scene.description import read_scene
from pydslrep_runtime.scene.push import push
from test_scene_description import ROBOT

PROGRAM = """
wheel l with radius 4.5
wheel r with radius 4.5
wheelH a with radius 5
wheelH b with radius 5
wheelH c with radius 5
wheelH d with radius 5
sensor eye
robot one type tw with port 23000 has { l r } wheels with sensors { eye }
robot two type fwh with port 23000 has { a b c d } wheels
movement go of one { move 1 meters turn left move 30 centimeters }
movement side of two { move 50 centimeters turn right }
environment yard has { one two } robots with { go side } moves
"""
SCENE = """
[world]
size = [8, 6]
[[box]]
name = "crate"
at = [-2, 1]
size = [0.6, 0.4]
heading = 30
[[cylinder]]
name = "my post"
at = [2, 2]
radius = 0.25
[[polygon]]
name = "wedge"
corners = [[-3, -2], [-2, -2], [-2.5, -1.8], [-3, -1]]
[robots.one]
start = [-1, 0, 0]
[robots.two]
start = [1, -1, 90]
"""


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "yard.pyr"
    path.write_text(PROGRAM)
    (tmp_path / "yard.scene.toml").write_text(SCENE)
    return path


@pytest.fixture
def small_program(tmp_path: Path) -> Path:
    """One robot without rollers, which are many objects."""
    path = tmp_path / "small.pyr"
    path.write_text(
        "wheel l with radius 4.5\nwheel r with radius 4.5\n"
        "robot one type tw with port 23000 has { l r } wheels\n"
        "movement go of one { move 1 meters }\n"
        "environment yard has { one } robots with { go } moves\n"
    )
    (tmp_path / "yard.scene.toml").write_text(
        '[[box]]\nname = "crate"\nat = [1, 1]\nsize = [0.6, 0.4]\n'
    )
    return path


def scene(
    command: str, *arguments: str | Path, port: int, code: int = 0
) -> subprocess.CompletedProcess[str]:
    """Runs `pydslrep scene`."""
    done = subprocess.run(
        [command, "scene", *map(str, arguments), "--port", str(port)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done


@contextlib.contextmanager
def client(port: int) -> Iterator[Any]:
    """The functions of the simulator."""
    remote = RemoteAPIClient("127.0.0.1", port)
    yield remote.require("sim")
    remote.socket.close(linger=0)
    remote.context.term()


def objects(sim: Any) -> list[int]:
    return list(sim.getObjectsInTree(sim.handle_scene, sim.handle_all, 0))


def test_what_is_pushed_drives(command: str, port: int, program: Path) -> None:
    done = scene(command, "push", program, port=port)
    assert "2 robots and 7 obstacles" in done.stdout
    run = subprocess.run(
        [
            *(command, "run", program, "--no-progress"),
            *("--host", "127.0.0.1", "--port", str(port)),
            *("--figures", program.with_suffix(".json")),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    figures = json.loads(program.with_suffix(".json").read_text())
    assert figures["complete"]
    with client(port) as sim:
        # It is back at its start after the run.
        assert sim.getObjectPosition(sim.getObject("/one"))[0] == pytest.approx(-1.0)


def test_objects_are_as_scripts_expect_them(
    command: str, port: int, program: Path
) -> None:
    scene(command, "push", program, port=port)
    with client(port) as sim:
        body, joint = sim.getObject("/one"), sim.getObject("/one/l")
        wheel, sensor = sim.getObjectsInTree(joint, sim.handle_all, 1)[0], "/one/eye"
        assert sim.getObjectParent(body) == -1
        assert sim.getObjectInt32Param(body, sim.shapeintparam_static) == 0
        mode = sim.getObjectInt32Param(joint, sim.jointintparam_dynctrlmode)
        assert mode == sim.jointdynctrl_velocity
        assert sim.getJointTargetForce(joint) > 0.5
        matrix = sim.getObjectMatrix(joint, body)
        assert [round(matrix[index], 9) for index in (2, 6, 10)] == [0.0, 1.0, 0.0]
        assert (round(matrix[3], 9), round(matrix[7], 9)) == (0.0, 0.15)
        _, _, size = sim.getShapeGeomInfo(wheel)
        assert size[0] == pytest.approx(0.09)
        assert sim.getObjectInt32Param(wheel, sim.shapeintparam_respondable) == 1
        kind = sim.getObjectType(sim.getObject(sensor))
        assert kind == sim.object_proximitysensor_type
        # A mecanum wheel has rollers at 45° to its axis.
        rollers = sim.getObjectsInTree(
            sim.getObject("/two/a"), sim.object_joint_type, 1
        )
        across = [
            sim.getObjectMatrix(roller, sim.getObject("/two/a"))[10]
            for roller in rollers
        ]
        assert len(rollers) >= 8
        assert across == pytest.approx([0.5**0.5] * len(rollers))
        post = sim.getObject("/my_post")
        assert sim.getObjectInt32Param(post, sim.shapeintparam_static) == 1
        for handle in objects(sim):
            mark = json.loads(sim.readCustomDataBlock(handle, "PyDSLRep"))
            assert mark["environment"] == "yard"


def test_nothing_is_changed_that_others_made(
    command: str, port: int, small_program: Path
) -> None:
    program = small_program
    with client(port) as sim:
        foreign = sim.createPrimitiveShape(sim.primitiveshape_cuboid, [1, 1, 1])
        sim.setObjectAlias(foreign, "crate")
        before = objects(sim)
    refused = scene(command, "push", program, port=port, code=2)
    assert "/crate" in refused.stderr
    with client(port) as sim:
        assert objects(sim) == before
        sim.setObjectAlias(foreign, "mine")
    scene(command, "push", program, port=port)
    again = scene(command, "push", program, port=port, code=2)
    assert "--replace" in again.stderr
    with client(port) as sim:
        first = objects(sim)
    scene(command, "push", program, "--replace", port=port)
    with client(port) as sim:
        second = objects(sim)
        assert len(second) == len(first)
        assert set(first) & set(second) == {foreign}
    removed = scene(command, "remove", "--environment", "other", port=port)
    assert "0 objects" in removed.stdout
    scene(command, "remove", port=port)
    with client(port) as sim:
        assert objects(sim) == [foreign]


def test_a_push_that_fails_leaves_nothing(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    described = read_scene({"environment": "e", "robots": [ROBOT], "obstacles": []})
    connection = Connection("127.0.0.1", port)
    call, sim = connection.call, connection.sim

    def fail_at(name: str) -> None:
        def fail(function: Any, *arguments: Any) -> Any:
            if function is getattr(sim, name):
                raise SimulatorError("it fails")
            return call(function, *arguments)

        monkeypatch.setattr(connection, "call", fail)

    with client(port) as other:
        for name in ("setObjectMatrix", "setJointTargetForce", "createForceSensor"):
            fail_at(name)
            with pytest.raises(SimulatorError):
                push(connection, described, replace=False)
            assert objects(other) == []
        monkeypatch.undo()
        push(connection, described, replace=False)
        earlier = objects(other)
        fail_at("createProximitySensor")
        with pytest.raises(SimulatorError):
            push(connection, described, replace=True)
        assert objects(other) == earlier
    connection.close()


def test_a_missing_main_script_is_added(command: str, port: int, program: Path) -> None:
    with client(port) as sim:
        sim.removeScript(sim.getScript(sim.scripttype_mainscript))
        assert sim.getScript(sim.scripttype_mainscript) == -1
    assert "main script" in scene(command, "push", program, port=port).stderr
    with client(port) as sim:
        assert sim.getScript(sim.scripttype_mainscript) >= 0
    other = scene(command, "remove", "--environment", "other", port=port)
    assert "Removed 0 objects from" in other.stdout, "the script is still needed"
    assert "objects and the main script" in scene(command, "remove", port=port).stdout
    with client(port) as sim:
        assert sim.getScript(sim.scripttype_mainscript) == -1


@pytest.mark.parametrize("is_own", [True, False])
def test_a_main_script_of_somebody_else_stays(
    command: str, port: int, small_program: Path, *, is_own: bool
) -> None:
    """The scene's own one, or one that was added and then changed."""
    with client(port) as sim:
        if not is_own:
            sim.removeScript(sim.getScript(sim.scripttype_mainscript))
    scene(command, "push", small_program, port=port)
    with client(port) as sim:
        if not is_own:
            script = sim.getScript(sim.scripttype_mainscript)
            text = sim.scriptstringparam_text
            changed = sim.getScriptStringParam(script, text) + "-- mine\n"
            sim.setScriptStringParam(script, text, changed)
    answer = json.loads(scene(command, "remove", "--json", port=port).stdout)
    assert answer["removed"] > 0
    assert not answer["main_script"]
    with client(port) as sim:
        assert sim.getScript(sim.scripttype_mainscript) >= 0


OBJECTS = """
[robots.one]
object = "/Pioneer"
[robots.one.wheels]
l.object = "/Pioneer/leftMotor"
"""


def test_objects_have_the_paths_that_the_scene_file_gives_them(
    command: str, port: int, small_program: Path
) -> None:
    file = small_program.with_name("yard.scene.toml")
    file.write_text(file.read_text() + OBJECTS)
    scene(command, "push", small_program, port=port)
    with client(port) as sim:
        for path in ("/Pioneer", "/Pioneer/leftMotor", "/Pioneer/r"):
            assert sim.getObject(path) >= 0
        assert sim.getObject("/one", {"noError": True}) == -1
    address = ("--host", "127.0.0.1", "--port", str(port))
    for task in ("doctor", "run"):
        done = subprocess.run(
            [command, task, small_program, "--no-progress", *address],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"/Pioneer"', '"/Lab/Pioneer"'),
        ("/Pioneer/leftMotor", "/Pioneer/base/leftMotor"),
        ("/Pioneer/leftMotor", "/Pioneer/motor[0]"),
        ("/Pioneer/leftMotor", "/Pioneer/r"),
    ],
)
def test_paths_that_push_does_not_build_are_refused(
    command: str, port: int, small_program: Path, old: str, new: str
) -> None:
    file = small_program.with_name("yard.scene.toml")
    file.write_text(file.read_text() + OBJECTS.replace(old, new))
    refused = scene(command, "push", "--json", small_program, port=port, code=2)
    answer = json.loads(refused.stdout)
    assert answer["error"]
    assert "`object`" in answer["help"]
    with client(port) as sim:
        assert sim.getObject("/Pioneer", {"noError": True}) == -1


def test_settings_say_where_the_simulator_is(
    command: str, port: int, small_program: Path
) -> None:
    settings = small_program.with_name("pydslrep.toml")
    settings.write_text(f"[coppeliasim]\nport = {port}\n")
    folder = small_program.parent
    for task in (["push", small_program], ["remove"]):
        done = subprocess.run(
            [command, "scene", *task],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert f"CoppeliaSim at 127.0.0.1:{port}" in done.stdout, done.stderr


def test_nothing_is_built_while_the_simulation_runs(
    command: str, port: int, program: Path
) -> None:
    with client(port) as sim:
        sim.startSimulation()
        refused = scene(command, "push", program, port=port, code=2)
        assert "Stop simulation" in refused.stderr
        sim.stopSimulation()


def test_there_is_no_simulator(command: str, program: Path) -> None:
    refused = scene(command, "remove", port=1, code=2)
    assert "nothing listens" in refused.stderr


def test_the_simulator_knows_every_call_of_the_package(port: int) -> None:
    with client(port) as sim:
        # Its own version is 4.6; the properties are of later ones.
        strings = {"readCustomStringData", "writeCustomStringData"}
        assert {name for name in CALLS if not hasattr(sim, name)} == strings
