"""Scripts in a simulator that treats them as CoppeliaSim does: pauses, killed clients, and frames that cannot be driven.

A client of the legacy remote API pauses the simulation, because a paused CoppeliaSim 4.6 answers only that one.
"""

from __future__ import annotations

import pathlib

import pytest
import sim
from coppeliasim_zmqremoteapi_client import (  # type: ignore[import-untyped]
    RemoteAPIClient,
)
from ports import free_ports
from stage import (
    BLOCKING,
    PROGRAM,
    Halt,
    Stage,
    assert_near,
    ends,
    finish,
    handle,
    interrupt,
    note,
    onlooker,
    start,
    wait_for_motion,
    wait_for_rest,
)
from until import LIMIT

SERVERS = ("coppeliasim-4.6", "coppeliasim-4.7")
# Long enough to be paused, interrupted and killed in the middle.
ACTIONS = "move 2 meters turn left move -20 centimeters"
GOAL = (2.0, -0.2, 90.0)

# The limits of scripts, for tests that wait for them; the simulator answers sooner on a busy machine, too.
QUICK = {"PROBE_PERIOD": 1.0, "REPLY_TIMEOUT": 2.0}


def hurry(script: pathlib.Path, **settings: float) -> None:
    """Changes settings of the package next to a script."""
    file = script.parent / "pydslrep_runtime" / "settings.py"
    changed = "".join(f"{name} = {value}\n" for name, value in settings.items())
    file.write_text(file.read_text(encoding="utf-8") + changed, encoding="utf-8")


class Scene:
    """A stage with its ports and a script in a hurry."""

    def __init__(self, command: str, folder: pathlib.Path, scene: str = "") -> None:
        self.ports = free_ports(2)
        self.stage = Stage(
            command, folder / "stage", PROGRAM.format(*self.ports, actions=ACTIONS)
        )
        self.script = self.stage.build("coppeliasim")
        hurry(self.script, **QUICK)
        (self.stage.folder / "world.scene.toml").write_text(scene, encoding="utf-8")


@pytest.fixture(name="scene")
def fixture_scene(command: str, tmp_path: pathlib.Path) -> Scene:
    """A scene without obstacles."""
    return Scene(command, tmp_path)


@pytest.mark.parametrize("server", SERVERS)
def test_a_script_waits_while_the_simulation_is_paused(
    scene: Scene, server: str
) -> None:
    trace, halt = scene.stage.folder / "trace", Halt(scene.script)
    with (
        scene.stage.simulator("--server", server),
        onlooker(scene.ports[1]) as eye,
    ):
        script = start(scene.script, "--trace", str(trace))
        with halt.reached(script):
            assert sim.simxPauseSimulation(eye, BLOCKING) == 0
        note(script, "paused")
        assert sim.simxStartSimulation(eye, BLOCKING) == 0
        _, err = finish(script)
        assert "paused" not in err, "it says so once"
    assert_near(ends(trace)["rover"], GOAL, 0.02, 1.5)


def test_a_pause_may_outlast_the_timeout_of_a_script(scene: Scene) -> None:
    hurry(scene.script, CLIENT_TIMEOUT=0.1)
    trace, halt = scene.stage.folder / "trace", Halt(scene.script)
    with (
        scene.stage.simulator("--server", "coppeliasim-4.6"),
        onlooker(scene.ports[1]) as eye,
    ):
        script = start(scene.script, "--trace", str(trace))
        with halt.reached(script):
            assert sim.simxPauseSimulation(eye, BLOCKING) == 0
        note(script, "paused")
        assert sim.simxStartSimulation(eye, BLOCKING) == 0
        finish(script)
    assert_near(ends(trace)["rover"], GOAL, 0.02, 1.5)


@pytest.mark.parametrize("server", SERVERS)
def test_an_interrupt_during_a_pause_stops_every_wheel(
    scene: Scene, server: str
) -> None:
    halt = Halt(scene.script)
    with (
        scene.stage.simulator("--server", server),
        onlooker(scene.ports[1]) as eye,
    ):
        script = start(scene.script)
        with halt.reached(script):
            left = wait_for_motion(eye, script)
            assert sim.simxPauseSimulation(eye, BLOCKING) == 0
        note(script, "paused")
        interrupt(script)
        finish(script, 130)
        assert sim.simxStartSimulation(eye, BLOCKING) == 0
        wait_for_rest(eye, left)
        wait_for_rest(eye, handle(eye, "/rover/wheelR"))


def test_a_script_waits_until_a_client_that_is_gone_is_forgotten(scene: Scene) -> None:
    hurry(scene.script, HOLD_LIMIT=LIMIT)
    with (
        scene.stage.simulator("--server", "coppeliasim-4.6"),
        onlooker(scene.ports[1]),
    ):
        gone = RemoteAPIClient("127.0.0.1", scene.ports[0])
        gone.setStepping(True)
        script = start(scene.script)
        note(script, "another client holds the simulation's time")
        # The simulator hears from it for the last time, and forgets it as soon as it may: a client states its timeout in
        # what it takes for its first message.
        gone.timeout, gone.sendCnt = 0, 0
        gone.setStepping(True)
        finish(script)


def test_a_client_that_holds_the_time_is_named(scene: Scene) -> None:
    halt = Halt(scene.script)
    with (
        scene.stage.simulator("--server", "coppeliasim-4.6"),
        onlooker(scene.ports[1]),
    ):
        hurry(scene.script, CLIENT_TIMEOUT=600.0, HOLD_LIMIT=1.0)
        killed = start(scene.script)
        with halt.reached(killed):
            killed.kill()
            killed.communicate()
        _, err = finish(start(scene.script), 1)
        assert (
            "move 2 m: another client holds the simulation's time: it is in stepping mode and takes no step, for 1 s. "
            "End that program, or stop the simulation and start this script again"
            in err
        )


@pytest.mark.parametrize(
    ("frame", "code", "words"),
    [
        ("ahead", 0, ""),
        ("x-up", 2, "the z axis of /rover is 90° off the vertical"),
        ("z-ahead", 2, "the z axis of /rover is 90° off the vertical"),
        (
            "x-left",
            2,
            "the axis of /rover/wheelL is 90° off the y axis of /rover",
        ),
        ("static", 1, "the wheels drive away from /rover"),
    ],
)
def test_frames_that_cannot_be_driven_are_refused(
    command: str, tmp_path: pathlib.Path, frame: str, code: int, words: str
) -> None:
    scene = Scene(command, tmp_path, f'[robots.rover]\nframe = "{frame}"\n')
    with scene.stage.simulator("--server", "coppeliasim-4.6"):
        _, err = finish(start(scene.script), code)
        assert words in err
