"""`pydslrep scene` against the embedded simulator, with the real client library."""

from __future__ import annotations

import contextlib
import json
import math
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
from pydslrep_runtime.scene.pull import pull
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


def test_an_obstacle_that_moves_stays_at_its_first_point(
    command: str, port: int, small_program: Path
) -> None:
    scene_file = small_program.with_name("yard.scene.toml")
    scene_file.write_text(
        scene_file.read_text()
        + '[[cylinder]]\nname = "person"\nradius = 0.2\n'
        + "path = [[0, 2, 0.5], [5, 2, -2]]\nrepeat = true\n"
    )
    done = scene(command, "push", small_program, port=port)
    assert "obstacle `person` has a path, but does not move here" in done.stderr
    assert "x 2 m, y 0.5 m" in " ".join(done.stderr.split())
    assert "crate" not in done.stderr
    with client(port) as sim:
        person = sim.getObject("/person")
        sim.setStepping(True)
        sim.startSimulation()
        for _ in range(3):
            sim.step()
        assert sim.getObjectPosition(person)[:2] == pytest.approx([2.0, 0.5])
        sim.stopSimulation()
    pulled = small_program.with_name("hall")
    done = scene(command, "pull", pulled, port=port)
    assert "warning" not in done.stderr, done.stderr
    text = (pulled / "hall_area.scene.toml").read_text()
    assert 'name = "person"' in text
    assert "at = [2, 0.5]" in text
    assert "path" not in text


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
        post = sim.getObject("/my_post")
        assert sim.getObjectInt32Param(post, sim.shapeintparam_static) == 1
        for handle in objects(sim):
            mark = json.loads(sim.readCustomDataBlock(handle, "PyDSLRep"))
            assert mark["environment"] == "yard"


def test_mecanum_wheels_are_as_they_were_measured(
    command: str, port: int, program: Path
) -> None:
    """The model that drives in CoppeliaSim's engine: R is 5 cm, and only ratios of masses matter."""
    scene(command, "push", program, port=port)
    with client(port) as sim:
        body, joint = sim.getObject("/two"), sim.getObject("/two/a")
        shapes = sim.getObjectsInTree(body, sim.object_shape_type, 0)
        masses = [sim.getShapeMass(shape) for shape in shapes]
        heavy = sim.getShapeMass(body)
        _, _, size = sim.getShapeGeomInfo(body)
        assert sum(masses) == pytest.approx(40.0 * size[0] * size[1])
        hub, *rollers = sim.getObjectsInTree(joint, sim.object_shape_type, 1)
        assert sim.getObjectInt32Param(hub, sim.shapeintparam_respondable) == 0
        _, kind, size = sim.getShapeGeomInfo(hub)
        assert kind == sim.primitiveshape_cylinder
        assert size[:3] == pytest.approx([0.09, 0.09, 0.025])
        assert sim.getShapeMass(hub) == pytest.approx(heavy / 8.0)
        assert len(rollers) == 8
        lowest = []
        for roller in rollers:
            _, kind, size = sim.getShapeGeomInfo(roller)
            assert kind == sim.primitiveshape_spheroid
            assert size[:3] == pytest.approx([0.08] * 3)
            assert sim.getShapeMass(roller) == pytest.approx(heavy / 20.0)
            mask = sim.shapeintparam_respondable_mask
            assert sim.getObjectInt32Param(roller, mask) == 0xFF00
            friction = sim.getEngineFloatParam(sim.bullet_body_oldfriction, roller)
            assert friction == 1.0
            pin = sim.getObjectParent(roller)
            matrix = sim.getObjectMatrix(pin, joint)
            assert math.hypot(matrix[3], matrix[7]) == pytest.approx(0.01)
            # The axis is along the rim by t = 1.026, and along the axle by 1.
            along = math.hypot(matrix[2], matrix[6])
            assert along / matrix[10] == pytest.approx(1.0262, abs=1e-4)
            lowest.append(sim.getObjectMatrix(roller)[11] - 0.04)
        assert min(lowest) == pytest.approx(0.0, abs=1e-9), "one is on the floor"


def test_the_floor_covers_the_plan(
    command: str, port: int, small_program: Path
) -> None:
    program = small_program.read_text()
    small_program.write_text(program.replace("move 1 meters", "move 25 meters"))
    scene(command, "push", small_program, port=port)
    with client(port) as sim:
        floor = sim.getObject("/floor")
        middle = sim.getObjectMatrix(floor)[3]
        _, _, size = sim.getShapeGeomInfo(floor)
        assert middle + size[0] / 2.0 >= 35.0
        assert middle - size[0] / 2.0 <= -10.0


@pytest.mark.parametrize(
    ("height", "reach", "degrees"),
    [(0.045, 1.0, 20.0), (0.03, 3.0, 30.0), (0.1, 0.5, 60.0), (0.05, 5.0, 10.0)],
)
def test_sensors_look_above_a_floor_that_they_see(
    port: int, height: float, reach: float, degrees: float
) -> None:
    cone = math.radians(degrees)
    eye = {**ROBOT["sensors"][0], "kind": "distance", "range": reach, "cone": cone}  # type: ignore[index]
    wheels = [{**wheel, "radius": height} for wheel in ROBOT["wheels"]]  # type: ignore[attr-defined]
    robot = {**ROBOT, "wheels": wheels, "sensors": [eye]}
    described = read_scene({"environment": "e", "robots": [robot], "obstacles": []})
    connection = Connection("127.0.0.1", port)
    assert push(connection, described, replace=False) == []
    pulled, unclear = pull(connection, "e")
    connection.close()
    (found,) = pulled.robots[0].sensors
    assert unclear == []
    assert found.range == reach
    assert found.cone == pytest.approx(cone)
    assert found.bearing == pytest.approx(0.0)
    with client(port) as sim:
        carpet = sim.createPrimitiveShape(sim.primitiveshape_cuboid, [20, 20, 0.1])
        sim.setObjectPosition(carpet, [0, 0, -0.05])
        sensor = sim.getObject("/robot_1/eye")
        assert sim.checkProximitySensor(sensor, carpet)[0] == 0
        # A level one would see it, unless it is high above the floor for its range.
        if math.sin(cone / 2.0) * reach > height:
            level = [0, 0, 1, 0.15, 0, 1, 0, 0, -1, 0, 0, 0]
            sim.setObjectMatrix(sensor, level, sim.getObject("/robot_1"))
            state, distance, *_ = sim.checkProximitySensor(sensor, carpet)
            assert state == 1
            assert distance == pytest.approx(height / math.sin(cone / 2.0))


def test_a_long_step_of_the_physics_engine_is_noted(
    command: str, port: int, small_program: Path
) -> None:
    with client(port) as sim:
        sim.setFloatParam(sim.floatparam_physicstimestep, 0.05)
    done = scene(command, "push", small_program, port=port)
    assert "takes steps of 50 ms" in done.stderr
    assert "set Dynamics dt to 5 ms in [Simulation > Simulation settings]" in " ".join(
        done.stderr.split()
    )


def run_there(
    command: str, program: Path, port: int, *options: str
) -> subprocess.CompletedProcess[str]:
    """Runs a program in a simulator."""
    return subprocess.run(
        [
            *(command, "run", str(program), "--no-progress", *options),
            *("--host", "127.0.0.1", "--port", str(port)),
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_a_run_that_goes_on_from_the_middle_says_so(
    command: str, port: int, small_program: Path
) -> None:
    scene(command, "push", small_program, port=port)
    with client(port) as sim:
        sim.setStepping(True)
        sim.startSimulation()
        for joint in ("/one/l", "/one/r"):
            sim.setJointTargetVelocity(sim.getObject(joint), 2.0)
        for _ in range(40):
            sim.step()
        sim.setStepping(False)
        for joint in ("/one/l", "/one/r"):
            sim.setJointTargetVelocity(sim.getObject(joint), 0.0)
        sim.setStepping(True)
        # It leaves without stopping the simulation, as after a kill.
    with client(port) as sim:
        assert sim.getSimulationState() != sim.simulation_stopped
    on = run_there(command, small_program, port)
    assert "note: the simulation is running already" in on.stderr
    assert "one at x 0." in on.stderr
    again = run_there(
        command,
        small_program,
        port,
        "--restart",
        "--figures",
        str(small_program.with_suffix(".json")),
    )
    assert again.returncode == 0, again.stderr
    assert "running already" not in again.stderr
    figures = json.loads(small_program.with_suffix(".json").read_text())
    assert figures["robots"][0]["driven"]["x"] == pytest.approx(1.0, abs=0.01)


SLAM = """
wheel l with radius 4.5
wheel r with radius 4.5
sensor f1
sensor f2
sensor l1
sensor r1
sensor b1
robot one type tw with port 23000 has { l r } wheels with sensors { f1 f2 l1 r1 b1 }
movement go of one { slam }
environment yard has { one } robots with { go } moves
"""


def test_a_slam_that_explores_nothing_fails(
    command: str, port: int, small_program: Path, tmp_path: Path
) -> None:
    """All sensors see the floor wherever the robot is."""
    small_program.write_text(SLAM)
    scene(command, "push", small_program, port=port)
    with client(port) as sim:
        sim.setObjectSpecialProperty(
            sim.getObject("/floor"), sim.objectspecialproperty_detectable
        )
        body = sim.getObject("/one")
        for name in ("f1", "f2", "l1", "r1", "b1"):
            sensor = sim.getObject(f"/one/{name}")
            x, y, _ = sim.getObjectMatrix(sensor, body)[2::4]
            flat = math.hypot(x, y)
            cos, sin = x / flat, y / flat
            at = sim.getObjectMatrix(sensor, body)[3::4]
            level = [0, -sin, cos, at[0], 0, cos, sin, at[1], -1, 0, 0, at[2]]
            sim.setObjectMatrix(sensor, level, body)
    done = run_there(command, small_program, port, "--map", str(tmp_path / "map.json"))
    assert done.returncode == 1, done.stdout + done.stderr
    said = " ".join(done.stderr.split())
    assert "it has explored nothing" in said
    assert "Its sensors see something 0.2" in said


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
        made = ("setObjectMatrix", "setJointTargetForce", "createForceSensor")
        for name in (*made, "getScript"):
            fail_at(name)
            with pytest.raises(SimulatorError):
                push(connection, described, replace=False)
            assert objects(other) == []
        monkeypatch.undo()
        push(connection, described, replace=False)
        earlier = objects(other)
        other.removeScript(other.getScript(other.scripttype_mainscript))
        for name in ("createProximitySensor", "setScriptStringParam", "removeObjects"):
            fail_at(name)
            with pytest.raises(SimulatorError):
                push(connection, described, replace=True)
            assert objects(other) == earlier
            assert other.getScript(other.scripttype_mainscript) == -1
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
