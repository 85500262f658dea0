"""`pydslrep scene pull`: what was pushed comes back, and others' models are read."""

from __future__ import annotations

import json
import math
import subprocess
import tomllib
from pathlib import Path

import pytest
from pydslrep_runtime import RobotSpec
from pydslrep_runtime.remote_api import Connection
from pydslrep_runtime.scene import robot_parts
from pydslrep_runtime.scene.description import read_scene
from pydslrep_runtime.scene.doctor import examine
from pydslrep_runtime.scene.pull import pull
from pydslrep_runtime.scene.push import push
from test_scene_description import OBSTACLES, ROBOT
from test_scene_push import client, program, scene

__all__ = ["program"]  # a fixture


def rounded(value: object) -> object:
    if isinstance(value, float):
        return round(value, 6) + 0.0
    if isinstance(value, dict):
        return {k: rounded(v) for k, v in value.items() if k != "triangles"}
    if isinstance(value, list | tuple):
        return [rounded(each) for each in value]
    return value


def test_what_is_pushed_comes_back(port: int) -> None:
    described = read_scene(
        {"environment": "e", "robots": [ROBOT], "obstacles": OBSTACLES}
    )
    connection = Connection("127.0.0.1", port)
    push(connection, described, replace=False)
    found, unclear = pull(connection, "e")
    connection.close()
    assert unclear == []
    assert rounded(found.as_json()) == rounded(described.as_json())


@pytest.mark.parametrize("model", ["of today", "of version 0.2"])
def test_mecanum_robots_of_both_models_are_known(
    port: int, model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Those of version 0.2 drive badly: their rollers collide."""
    is_old = model != "of today"
    if is_old:
        monkeypatch.setattr(robot_parts, "ROLLERS", 12)
        monkeypatch.setattr(robot_parts, "ROLLER_SIZE", 0.25)
        monkeypatch.setattr(robot_parts, "ROLLER_MASK", 0xFF02)
    places = {"a": (0.1, 0.2), "b": (-0.1, 0.2), "c": (0.1, -0.2), "d": (-0.1, -0.2)}
    wheels = [
        {"name": name, "radius": 0.05, "x": x, "y": y, "mirrored": False}
        for name, (x, y) in places.items()
    ]
    robot = {**ROBOT, "type": "fwh", "grip": 0.05, "wheels": wheels, "heading": 0.0}
    described = read_scene({"environment": "e", "robots": [robot], "obstacles": []})
    connection = Connection("127.0.0.1", port)
    push(connection, described, replace=False)
    found, unclear = pull(connection, "e")
    connection.close()
    assert unclear == []
    assert rounded(found.as_json()) == rounded(described.as_json())
    spec = RobotSpec("robot_1", "127.0.0.1", port, dict.fromkeys(places, 0.05), ["eye"])
    codes = {each.rule.code for each in examine([spec])}
    assert codes == ({"rollers-collide"} if is_old else set())
    with client(port) as sim:
        sim.setStepping(True)
        sim.startSimulation()
        for name, rate in zip("abcd", (2.0, -2.0, -2.0, 2.0), strict=True):
            joint = sim.getObject(f"/robot_1/{name}")
            sim.setJointTargetVelocity(joint, rate)
        for _ in range(40):
            sim.step()
        # It drives sideways, which no other robot does.
        x, y, _ = sim.getObjectPosition(sim.getObject("/robot_1"))
        sim.stopSimulation()
    assert abs(x - 1.0) < 0.01
    assert abs(y + 2.0) > 0.1


def test_a_pulled_program_is_clean_and_drives(
    command: str, port: int, program: Path, tmp_path: Path
) -> None:
    scene(command, "push", program, port=port)
    done = scene(command, "pull", tmp_path / "hall", port=port)
    assert "2 robots and 7 obstacles" in done.stdout
    assert done.stderr == ""
    pulled = tmp_path / "hall" / "hall.pyr"
    check = subprocess.run(
        [command, "check", str(pulled)], capture_output=True, text=True, check=False
    )
    assert check.returncode == 0, check.stdout + check.stderr
    # The world is the same: a path meets the same obstacles from the same start.
    plan = subprocess.run(
        [command, "plan", str(pulled), "--json"],
        capture_output=True,
        text=True,
        check=True,
    )
    starts = [robot["poses"][0] for robot in json.loads(plan.stdout)[0]["robots"]]
    assert starts[0]["x"] == pytest.approx(-0.9)
    assert starts[1]["theta"] == pytest.approx(math.pi / 2)
    # Nothing is overwritten.
    scene(command, "pull", tmp_path / "hall", port=port, code=2)


def test_what_is_not_understood_is_listed(
    command: str, port: int, tmp_path: Path
) -> None:
    with client(port) as sim:
        body = sim.createPrimitiveShape(sim.primitiveshape_cuboid, [0.3, 0.3, 0.1])
        sim.setObjectAlias(body, "tricycle")
        sim.setObjectInt32Param(body, sim.shapeintparam_static, 0)
        joint = sim.createJoint(sim.joint_revolute_subtype, sim.jointmode_dynamic, 0)
        sim.setObjectParent(joint, body, True)
    refused = scene(command, "pull", tmp_path / "hall", port=port, code=2)
    assert "/tricycle has 0 wheels" in refused.stderr
    assert "no robot" in refused.stderr
    assert not (tmp_path / "hall").exists()


def test_meshes_are_pulled_as_they_stand(
    command: str, port: int, program: Path, tmp_path: Path
) -> None:
    """The bounding box of a mesh has axes of its own: only its vertices tell where it is."""
    scene(command, "push", program, port=port)
    corners = [(3.5, -2.1), (4.2, -2.0), (4.1, -1.2), (3.7, -1.1), (3.5, -1.5)]
    low, high = ([[x, y, z] for x, y in corners] for z in (0.0, 0.3))
    top = [0, 1, 2, 0, 2, 3, 0, 3, 4]
    sides: list[int] = []
    for start in range(5):
        end = (start + 1) % 5
        sides += [start, end, end + 5, start, end + 5, start + 5]
    faces = [i + 5 for i in top] + [*reversed(top), *sides]
    with client(port) as sim:
        rock = sim.createShape(
            0, 0.0, [number for each in low + high for number in each], faces
        )
        sim.setObjectAlias(rock, "rock")
        sim.setObjectInt32Param(rock, sim.shapeintparam_respondable, 1)
    done = scene(command, "pull", tmp_path / "hall", port=port)
    assert "2 robots and 8 obstacles" in done.stdout
    assert done.stderr == ""
    (file,) = (tmp_path / "hall").glob("*.scene.toml")
    text = file.read_text()
    (found,) = [
        each["corners"]
        for each in tomllib.loads(text)["polygon"]
        if each["name"] == "rock"
    ]
    points = {(round(x, 3), round(y, 3)) for x, y in found}
    assert points == set(corners)
