"""Robots of a person's own: their classes, and the clock of real robots."""

import sys
from pathlib import Path

import pytest
from pydslrep_runtime import Backend, Pose, RealTimeClock, RobotSpec, SimulatorError
from pydslrep_runtime.backend import METHODS, load_backend

SPEC = RobotSpec("rover", "127.0.0.1", 23000, {"left": 0.05, "right": 0.05})


class Rover(Backend):
    """Only what a class has to define."""

    def __init__(self, spec: RobotSpec) -> None:
        self.spec = spec
        self.clock = RealTimeClock(0.05)
        self.rates: list[float] = []

    def wheel_mounts(self) -> list[tuple[float, float]]:
        """Two wheels."""
        return [(0.0, 0.1), (0.0, -0.1)]

    def pose(self) -> Pose:
        """Stays where it is."""
        return Pose(0.0, 0.0, 0.0)

    def set_wheel_rates(self, rates: object) -> None:
        """Notes the rates."""
        assert isinstance(rates, list)
        self.rates = rates


def test_a_class_inherits_what_it_does_not_define() -> None:
    rover = load_backend(f"{__name__}:Rover")(SPEC)
    assert isinstance(rover, Rover)
    assert rover.spec is SPEC
    rover.rates = [1.0, 1.0]
    rover.stop()
    assert rover.rates == [0.0, 0.0]
    with pytest.raises(
        SimulatorError, match="Rover does not read sensors, such as eye"
    ):
        rover.detects("eye")
    rover.close()


def test_every_method_of_the_protocol_is_asked_for() -> None:
    assert set(METHODS) == {
        "wheel_mounts",
        "pose",
        "set_wheel_rates",
        "detects",
        "distance",
        "sensor_cone",
        "wheel_angles",
        "stall_reason",
        "crawl_reason",
        "stop",
        "close",
    }


def test_what_a_module_itself_lacks_is_shown_as_it_is(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    module = tmp_path / "rover_without_driver.py"
    module.write_text("import no_such_driver\n", encoding="utf-8")
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    with pytest.raises(ModuleNotFoundError, match="no_such_driver"):
        load_backend("rover_without_driver:Rover")


class FakeTime:
    """Time that passes only when somebody sleeps, and some more."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 1000.0
        monkeypatch.setattr("time.monotonic", lambda: self.now)
        monkeypatch.setattr("time.sleep", self.sleep)

    def sleep(self, seconds: float) -> None:
        """Sleeps."""
        assert seconds >= 0.0
        self.now += seconds


def test_real_time_keeps_its_step(monkeypatch: pytest.MonkeyPatch) -> None:
    time = FakeTime(monkeypatch)
    clock = RealTimeClock(0.05)
    times = []
    for _ in range(5):
        clock.advance()
        time.now += 0.01  # the control takes a while
        times.append(clock.time)
    assert times == pytest.approx([0.0, 0.05, 0.1, 0.15, 0.2])


def test_real_time_does_not_catch_up(monkeypatch: pytest.MonkeyPatch) -> None:
    time = FakeTime(monkeypatch)
    clock = RealTimeClock(0.05)
    clock.advance()
    time.now += 3.0
    before = time.now
    clock.advance()
    clock.advance()
    assert time.now == pytest.approx(before + 0.05)
