"""`pydslrep scene pull`: what was pushed comes back, and others' models are read."""

from __future__ import annotations

import json
import math
import subprocess
from pathlib import Path

import pytest
from pydslrep_runtime.remote_api import Connection
from pydslrep_runtime.scene.description import read_scene
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
