"""Every rule about a scene: a scene that breaks it, and one that does not."""

import re
from collections.abc import Callable
from typing import Any

import fake_scene
import pytest
from fake_scene import (
    DUMMY,
    FORCE_SENSOR,
    JOINT,
    PAUSED,
    RUNNING,
    SHAPE,
    VISION_SENSOR,
    FakeConnection,
    FakeScene,
    mecanum_scene,
    two_wheel_scene,
)
from pydslrep_runtime import RobotSpec, SimulatorError
from pydslrep_runtime.scene import checks, doctor
from pydslrep_runtime.scene.checks import (
    check_robot,
    check_simulator,
    explain,
    explain_crawl,
)
from pydslrep_runtime.scene.findings import RULES, Finding, Severity, finding
from pydslrep_runtime.scene.reader import SceneReader

SPEC = RobotSpec(
    "robot_1", "127.0.0.1", 23000, {"wheelL": 0.045, "wheelR": 0.045}, ["fSensor"]
)
UPRIGHT = ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))  # x up
SIDEWAYS = ((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0))  # x to the right
BACKWARD = ((-1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0))


TICKS = [1.0 + 0.05 * step for step in range(1, 60)]  # s


def reader(scene: FakeScene) -> SceneReader:
    connection: Any = FakeConnection(scene)
    return SceneReader(connection)


def findings(scene: FakeScene, spec: RobotSpec = SPEC) -> list[Finding]:
    """Everything that is wrong."""
    scenes = reader(scene)
    return [*check_simulator(scenes), *check_robot(scenes, spec)]


def codes(scene: FakeScene, spec: RobotSpec = SPEC) -> list[str]:
    return [each.rule.code for each in findings(scene, spec)]


class FakeTime:
    """Time that passes only while somebody sleeps."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 0.0
        monkeypatch.setattr("time.monotonic", lambda: self.now)
        monkeypatch.setattr("time.sleep", self.sleep)

    def sleep(self, seconds: float) -> None:
        self.now += seconds


@pytest.fixture(autouse=True)
def fake_time(monkeypatch: pytest.MonkeyPatch) -> FakeTime:
    return FakeTime(monkeypatch)


def change(path: str, **values: Any) -> Callable[[FakeScene], None]:
    """Changes an object."""

    def apply(scene: FakeScene) -> None:
        for name, value in values.items():
            setattr(scene[path], name, value)

    return apply


def change_scene(**values: Any) -> Callable[[FakeScene], None]:
    """Changes the simulator."""

    def apply(scene: FakeScene) -> None:
        for name, value in values.items():
            setattr(scene, name, value)

    return apply


def nest(scene: FakeScene) -> None:
    """A static object above the chassis has the robot's name."""
    chassis = scene["/robot_1"]
    base = scene.add(alias="robot_1", kind=SHAPE, static=True)
    chassis.alias, chassis.parent = "chassis", base


def duplicate(scene: FakeScene) -> None:
    scene.objects += two_wheel_scene().objects


def remove_tyre(scene: FakeScene) -> None:
    scene.objects.remove(scene["/robot_1/wheelL/tyre"])


def spin(scene: FakeScene) -> None:
    scene.state, scene.times = RUNNING, iter([1.0, *TICKS])
    scene["/robot_1/wheelL"].rate = scene["/robot_1/wheelR"].rate = 2.0
    scene["/robot_1"].speed = 0.001


def fall(scene: FakeScene) -> None:
    scene.state, scene.times = RUNNING, iter([1.0, 1.05])
    scene["/robot_1"].position = (12.0, 0.0, -3.0)


def see_the_floor(scene: FakeScene) -> None:
    size, low = (9.0, 9.0, 0.1), (0.0, 0.0, -0.05)
    scene.add(
        **{"alias": "carpet", "kind": SHAPE, "static": True, "special": 0x1F1},
        **{"size": size, "position": low},
    )
    scene["/robot_1/fSensor"].sees["carpet"] = 0.27


TYRE = "/robot_1/wheelL/tyre"

# What breaks each rule, and only it.
BROKEN: dict[str, Callable[[FakeScene], None]] = {
    "old-version": change_scene(version=40501),
    "no-main-script": change_scene(main_script=-1),
    "paused": change_scene(state=PAUSED),
    "time-held": change_scene(state=RUNNING),
    "time-step": change_scene(time_step=0.1),
    "physics-step": change_scene(physics_step=0.05),
    "fallen": fall,
    "robot-missing": change("/robot_1", alias="Pioneer"),
    "robot-kind": change("/robot_1", kind=JOINT),
    "duplicate-name": duplicate,
    "static-body": change("/robot_1", kind=DUMMY),
    "nested-chassis": nest,
    "tilted-body": change("/robot_1", rotation=UPRIGHT),
    "wrong-forward": change("/robot_1", rotation=SIDEWAYS),
    "swapped-wheels": change("/robot_1", rotation=BACKWARD),
    "wheel-missing": change("/robot_1/wheelL", alias="motor"),
    "wheel-kind": change("/robot_1/wheelL", kind=SHAPE),
    "joint-type": change("/robot_1/wheelL", joint_type=fake_scene.PRISMATIC),
    "joint-mode": change("/robot_1/wheelL", mode=fake_scene.KINEMATIC),
    "motor-off": change("/robot_1/wheelL", control=fake_scene.FREE),
    "control-mode": change("/robot_1/wheelL", control=fake_scene.POSITION),
    "no-torque": change("/robot_1/wheelL", torque=0.0),
    "weak-motor": change("/robot_1/wheelL", torque=0.01),
    "no-wheel-shape": remove_tyre,
    "static-wheel": change(TYRE, static=True),
    "ghost-wheel": change(TYRE, respondable=False),
    "wheel-radius": change(TYRE, size=(0.1, 0.02, 0.1)),
    "sensor-missing": change("/robot_1/fSensor", alias="eye"),
    "sensor-kind": change("/robot_1/fSensor", kind=VISION_SENSOR),
    "sensor-sees-floor": see_the_floor,
    "wheels-spin": spin,
}
MECANUM = RobotSpec(
    "robot_1", "127.0.0.1", 23000, dict.fromkeys(["a", "b", "c", "d"], 0.05)
)

# What leads to others.
CONSEQUENCES = {
    "duplicate-name": ["duplicate-name"] * 3,
}

UNREACHABLE = {"no-connection", "legacy-port", "no-reply"}


def test_a_scene_without_faults_has_no_findings() -> None:
    assert codes(two_wheel_scene()) == []


def test_every_rule_has_a_scene() -> None:
    assert len({rule.code for rule in RULES}) == len(RULES)
    assert BROKEN.keys() | UNREACHABLE | {"rollers-collide"} == {
        rule.code for rule in RULES
    }


@pytest.mark.parametrize("code", BROKEN)
def test_what_breaks_a_rule_is_found(code: str) -> None:
    scene = two_wheel_scene()
    BROKEN[code](scene)
    found = findings(scene)
    assert [each.rule.code for each in found] == [code, *CONSEQUENCES.get(code, [])]
    for each in found:
        for text in (each.message, each.help):
            assert re.search(r"[{}]|None|unknown|0\.0{4}", text) is None, text


@pytest.mark.parametrize("step", [0.05, 0.01])
def test_shorter_steps_are_fine(step: float) -> None:
    scene = two_wheel_scene()
    scene.time_step = step
    assert codes(scene) == []


def test_time_that_passes_is_not_held(fake_time: FakeTime) -> None:
    scene = two_wheel_scene()
    scene.state, scene.times = RUNNING, iter([3.0, 3.0, 3.0, 3.05])
    assert codes(scene) == []
    assert 0.0 < fake_time.now < checks.HOLD_TIME


def test_frames_are_not_judged_by_rounding_errors() -> None:
    scene = two_wheel_scene()
    tiny = ((1e-9, 1.0, 0.0), (-1.0, 1e-9, 0.0), (0.0, 0.0, 1.0))
    scene["/robot_1"].rotation = tiny
    assert codes(scene) == ["wrong-forward"]


def test_axes_may_point_to_the_right() -> None:
    scene = two_wheel_scene()
    for side in "LR":
        flipped = ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
        scene[f"/robot_1/wheel{side}"].rotation = flipped
    assert codes(scene) == []


def test_a_dummy_on_the_chassis_moves_with_it() -> None:
    scene = two_wheel_scene()
    chassis = scene["/robot_1"]
    chassis.alias = "chassis"
    scene.add(alias="robot_1", kind=DUMMY, parent=chassis)
    for part in ("wheelL", "wheelR", "fSensor"):
        scene[f"/chassis/{part}"].alias = f"{part}_robot_1"
    assert codes(scene) == []


def test_a_chassis_may_hang_on_a_force_sensor() -> None:
    scene = two_wheel_scene()
    chassis = scene["/robot_1"]
    hull = scene.add(alias="robot_1", kind=SHAPE)
    bolt = scene.add(alias="bolt", kind=FORCE_SENSOR, parent=hull)
    chassis.alias, chassis.parent = "chassis", bolt
    assert codes(scene) == []
    chassis.parent = hull
    assert codes(scene) == ["nested-chassis"]


def test_a_wheel_and_a_sensor_may_share_a_name() -> None:
    scene = two_wheel_scene()
    scene["/robot_1/fSensor"].alias = "wheelL"
    spec = RobotSpec("robot_1", "localhost", 23000, SPEC.wheels, ["wheelL"])
    assert codes(scene, spec) == []


def test_rollers_have_radii_of_their_own() -> None:
    scene = two_wheel_scene()
    tyre = scene[TYRE]
    axle = scene.add(alias="axle", kind=JOINT, parent=tyre)
    scene.add(alias="roller", kind=SHAPE, parent=axle, size=(0.01, 0.01, 0.03))
    tyre.size = (0.05, 0.05, 0.02)
    assert codes(scene) == []


def test_what_cannot_be_measured_is_not_judged() -> None:
    scene = two_wheel_scene()
    scene[TYRE].size = (0.07, 0.08, 0.09)
    assert codes(scene) == []


def test_rollers_that_overlap_must_not_collide() -> None:
    assert codes(mecanum_scene(mask=0xFF00), MECANUM) == []
    (found,) = findings(mecanum_scene(mask=0xFF02), MECANUM)
    assert found.rule.code == "rollers-collide"
    assert found.message.startswith("/robot_1/a/hub/axle0/roller0 and /robot_1/a/hub/")
    scene = mecanum_scene(mask=0xFF02)
    scene["/robot_1/a/hub/axle1/roller1"].position = (0.2, 0.1, 0.05)
    assert codes(scene, MECANUM) == [], "they are apart"


def test_a_floor_is_seen_only_if_it_is_detectable_and_low() -> None:
    for change_it in (
        change("/carpet", special=1),
        change("/carpet", position=(0.0, 0.0, 0.05)),
        change("/carpet", static=False),
    ):
        scene = two_wheel_scene()
        see_the_floor(scene)
        change_it(scene)
        assert codes(scene) == []


def test_a_robot_that_has_tipped_over_is_no_matter_of_its_frame() -> None:
    scene = two_wheel_scene()
    scene["/robot_1"].rotation = UPRIGHT
    scene.state, scene.times = RUNNING, iter([1.0, 1.05])
    assert codes(scene) == ["fallen"]


def test_a_robot_that_moves_does_not_spin_its_wheels() -> None:
    scene = two_wheel_scene()
    spin(scene)
    scene["/robot_1"].speed = 0.08
    assert codes(scene) == []


def test_a_robot_is_observed_for_a_second() -> None:
    """A blocked body trembles: at any moment, it may be as fast as one that drives."""
    scene = two_wheel_scene()
    spin(scene)
    scene["/robot_1"].speed = 0.0
    connection: Any = FakeConnection(scene)
    matrix, trembles = connection.sim.getObjectMatrix, iter([0.001, -0.001] * 99)

    def trembling(handle: int) -> list[float]:
        found: list[float] = matrix(handle)
        found[3] += next(trembles)
        return found

    connection.sim.getObjectMatrix = trembling
    found = list(check_robot(SceneReader(connection), SPEC))
    assert [each.rule.code for each in found] == ["wheels-spin"]


def test_time_that_stands_still_tells_nothing_of_the_wheels(
    fake_time: FakeTime,
) -> None:
    scene = two_wheel_scene()
    spin(scene)
    scene.times = iter([1.0])
    assert list(check_robot(reader(scene), SPEC)) == []
    assert fake_time.now > checks.OBSERVE_LIMIT


def test_a_script_says_the_first_error_and_what_to_do() -> None:
    scene = two_wheel_scene()
    connection: Any = FakeConnection(scene)
    scene[TYRE].size = (0.1, 0.1, 0.02)
    assert explain(connection, SPEC) == ""
    spin(scene)
    assert explain(connection, SPEC) == "", "the script knows itself that they turn"
    scene["/robot_1/wheelR"].control = fake_scene.FREE
    assert explain(connection, SPEC) == (
        "/robot_1/wheelR has no motor, as its control mode is Free: double-click the icon of /robot_1/wheelR in the "
        "scene hierarchy, click [Dynamic properties dialog] of the joint, and set Control mode to Velocity"
    )


def test_a_script_that_crawls_says_why() -> None:
    connection: Any = FakeConnection(mecanum_scene(mask=0xFF02))
    assert "collide with each other" in explain_crawl(connection, MECANUM)
    connection = FakeConnection(change_scene_of(physics_step=0.05))
    assert "set Dynamics dt to 5 ms" in explain_crawl(connection, SPEC)
    assert explain_crawl(FakeConnection(two_wheel_scene()), SPEC) == ""  # type: ignore[arg-type]


def change_scene_of(**values: Any) -> FakeScene:
    scene = two_wheel_scene()
    change_scene(**values)(scene)
    return scene


def test_a_simulator_that_cannot_be_asked_keeps_the_scripts_own_error() -> None:
    scene = two_wheel_scene()
    connection: Any = FakeConnection(scene)
    connection.sim.getObjectsInTree = None
    assert explain(connection, SPEC) == ""
    with pytest.raises(SimulatorError, match=r"has no sim\.getObjectsInTree"):
        list(check_robot(SceneReader(connection), SPEC))


def test_json() -> None:
    assert finding("old-version", version="4.5.1").as_json() == {
        "code": "old-version",
        "severity": "error",
        "robot": None,
        "message": "this is CoppeliaSim 4.5.1; scripts need 4.6 or later",
        "help": "install a newer CoppeliaSim, or generate the script for the legacy remote API with --target vrep",
    }
    assert [each.rule.severity for each in findings_of_step()] == [Severity.HINT]


def findings_of_step() -> list[Finding]:
    scene = two_wheel_scene()
    scene.time_step = 0.1
    return findings(scene)


@pytest.mark.parametrize(
    ("port", "listens", "code"),
    [
        (19999, False, "legacy-port"),
        (19999, True, "legacy-port"),
        (23000, False, "no-connection"),
        (23000, True, "no-reply"),
    ],
)
def test_who_does_not_reply(
    port: int, listens: bool, code: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(_host: str, _port: int) -> None:
        raise SimulatorError("no reply")

    monkeypatch.setattr(doctor, "Connection", refuse)
    monkeypatch.setattr(doctor, "accepts_connections", lambda _address: listens)
    spec = RobotSpec("robot_1", "127.0.0.1", port, SPEC.wheels)
    with pytest.raises(doctor.UnreachableError) as caught:
        list(doctor.examine([spec]))
    assert caught.value.finding.rule.code == code
