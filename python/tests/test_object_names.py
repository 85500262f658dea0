"""Robots whose objects have other names in the scene, such as those of CoppeliaSim's library."""

import pytest
from driving import joints
from fake_scene import FakeConnection, two_wheel_scene
from fake_simulator import FakeRobot, FakeWorld
from pydslrep_runtime import RobotSpec, SetupError, TwoWheelRobot
from pydslrep_runtime.coppeliasim import CoppeliaSim
from pydslrep_runtime.scene.checks import explain

OBJECTS = {
    "r": "/Pioneer",
    "wheelL": "/Pioneer/leftMotor",
    "wheelR": "/Pioneer/rightMotor",
}


def spec(objects: dict[str, str]) -> RobotSpec:
    robot = TwoWheelRobot(
        "r", port=1, left=("wheelL", 0.045), right=("wheelR", 0.045), objects=objects
    )
    return robot.spec("127.0.0.1", 1)


def world(monkeypatch: pytest.MonkeyPatch) -> FakeWorld:
    """A world with a robot of the library."""
    fake = FakeWorld(FakeRobot("r", joints("two-wheel")))
    for part, path in OBJECTS.items():
        own = "/r" if part == "r" else f"/r/{part}"
        fake.paths[path] = fake.paths.pop(own)
    fake.serve(monkeypatch)
    return fake


def test_a_script_finds_objects_by_their_paths(monkeypatch: pytest.MonkeyPatch) -> None:
    fake = world(monkeypatch)
    robot = CoppeliaSim("127.0.0.1", realtime=False).connect(spec(OBJECTS))
    robot.set_wheel_rates([1.0, 2.0])
    robot.pose()
    assert [joint.target for joint in fake.robots["r"].joints] == [1.0, 2.0]


def test_only_the_given_path_is_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    world(monkeypatch)
    wrong = spec({**OBJECTS, "wheelL": "/Pioneer/motor"})
    with pytest.raises(SetupError, match=r"has no joint /Pioneer/motor;"):
        CoppeliaSim("127.0.0.1", realtime=False).connect(wrong)


def test_parts_must_exist() -> None:
    with pytest.raises(ValueError, match="robot r has no part wheel"):
        spec({"wheel": "/Pioneer/leftMotor"})


def test_the_checks_find_the_same_objects() -> None:
    scene = two_wheel_scene("Pioneer")
    scene["/Pioneer/wheelL"].alias = "leftMotor"
    scene["/Pioneer/wheelR"].alias = "rightMotor"
    connection = FakeConnection(scene)
    assert explain(connection, spec(OBJECTS)) == ""  # type: ignore[arg-type]
    assert explain(connection, spec({})).startswith("there is no object /r: ")  # type: ignore[arg-type]
