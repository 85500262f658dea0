"""Failures between a script for V-REP and its simulator are reported, and nothing hangs."""

from __future__ import annotations

import json
import pathlib
import socket

import pytest
import sim
from ports import free_ports
from stage import (
    BLOCKING,
    CLIENT,
    PROGRAM,
    Halt,
    Stage,
    assert_near,
    ends,
    finish,
    interrupt,
    note,
    onlooker,
    start,
    wait_for_motion,
    wait_for_rest,
)

# Whatever is done to a script on this path is done in the middle of it.
LONG = "move 200 meters"


@pytest.fixture(name="ports")
def fixture_ports() -> list[int]:
    return free_ports(2)


@pytest.fixture(name="stage")
def fixture_stage(command: str, tmp_path: pathlib.Path, ports: list[int]) -> Stage:
    program = PROGRAM.format(*ports, actions=LONG)
    return Stage(command, tmp_path / "stage", program)


def test_no_simulator(stage: Stage, ports: list[int]) -> None:
    _, err = finish(start(stage.build("vrep")), 2)
    assert f"robot rover: no reply from 127.0.0.1:{ports[0]}" in err
    _, err = finish(start(stage.build("vrep"), "--host", "no.such.host.invalid"), 2)
    assert "unknown host no.such.host.invalid" in err


def test_a_port_that_another_client_has(stage: Stage, ports: list[int]) -> None:
    script = stage.build("vrep")
    with stage.simulator(), onlooker(ports[0]):
        _, err = finish(start(script), 2)
    assert f"robot rover: no reply from 127.0.0.1:{ports[0]}. The remote API" in err


def test_missing_objects_are_listed_with_all_names(
    command: str, stage: Stage, tmp_path: pathlib.Path, ports: list[int]
) -> None:
    text = stage.program.read_text(encoding="utf-8")
    renamed = text.replace("rover", "rovers").replace("wheelL", "wheel_x")
    script = Stage(command, tmp_path / "other", renamed).build("vrep")
    with stage.simulator():
        _, err = finish(start(script), 2)
    assert err == (
        f"error: robot rovers: the scene at 127.0.0.1:{ports[0]} has no robot rovers or "
        "/rovers, no joint wheel_x_rovers or /rovers/wheel_x or wheel_x\n"
    )


def test_objects_with_other_names_are_found_by_their_paths(
    command: str, stage: Stage, tmp_path: pathlib.Path
) -> None:
    text = stage.program.read_text(encoding="utf-8")
    renamed = text.replace("rover", "rovers").replace("wheelL", "wheel_x")
    renamed = renamed.replace(LONG, "move 2 centimeters")
    script = Stage(command, tmp_path / "other", renamed).build("vrep")
    objects = {"rovers": "rover", "wheel_x": "/rover/wheelL", "wheelR": "/rover/wheelR"}
    page = script.read_text(encoding="utf-8")
    page = page.replace('"rovers",', f'"rovers", objects={objects},', 1)
    script.write_text(page, encoding="utf-8")
    with stage.simulator():
        out, _ = finish(start(script), 0)
    assert "move 0.02 m" in out


def test_ctrl_c_stops_everything(stage: Stage, ports: list[int]) -> None:
    script = stage.build("vrep")
    with stage.simulator(), onlooker(ports[1]) as eye:
        process = start(script)
        left = wait_for_motion(eye, process)
        interrupt(process)
        _, err = finish(process, 130)
        assert err == "interrupted\n"
        wait_for_rest(eye, left)
        _, state = sim.simxGetInMessageInfo(eye, sim.simx_headeroffset_server_state)
        assert state & 1, "a simulation started by another client continues"


def test_a_simulator_that_dies(stage: Stage, ports: list[int]) -> None:
    script = stage.build("vrep")
    with stage.simulator() as simulator, onlooker(ports[1]) as eye:
        process = start(script)
        wait_for_motion(eye, process)
        simulator.kill()
        _, err = finish(process, 1)
    assert err == (
        "error: robot rover, movement trip, action 1: move 200 m: "
        f"lost connection to 127.0.0.1:{ports[0]}\n"
    )


def test_a_simulation_stopped_by_another_client(stage: Stage, ports: list[int]) -> None:
    script = stage.build("vrep")
    with stage.simulator(), onlooker(ports[1]) as eye:
        process = start(script)
        wait_for_motion(eye, process)
        sim.simxStopSimulation(eye, BLOCKING)
        _, err = finish(process, 1)
    assert err.endswith("the simulation was stopped\n"), err


def test_a_script_waits_while_the_simulation_is_paused(
    stage: Stage, ports: list[int]
) -> None:
    trace = run_with_a_pause(stage, ports, "move 4 centimeters turn left 10", step=20)
    assert_near(ends(trace)["rover"], (0.04, 0.0, 10.0))


def test_a_script_in_real_time_waits_while_the_simulation_is_paused(
    stage: Stage, ports: list[int]
) -> None:
    # How many steps it takes, and how near to a goal it stops, depends on how busy the machine is.
    trace = run_with_a_pause(stage, ports, "wait 3 seconds", 1, "--realtime")
    first, *_, last = map(json.loads, trace.read_text(encoding="utf-8").splitlines())
    assert last["t"] - first["t"] >= 2.9


def run_with_a_pause(
    stage: Stage, ports: list[int], actions: str, step: int, *options: str
) -> pathlib.Path:
    """Pauses the simulation at a step of a script, and lets it go on; returns the trace."""
    short = PROGRAM.format(*ports, actions=actions)
    stage.program.write_text(short, encoding="utf-8")
    script, trace = stage.build("vrep"), stage.folder / "trace"
    halt = Halt(script, step)
    with stage.simulator(), onlooker(ports[1]) as eye:
        process = start(script, "--trace", str(trace), *options)
        with halt.reached(process):
            assert sim.simxPauseSimulation(eye, BLOCKING) == 0
        note(process, "paused")
        assert sim.simxStartSimulation(eye, BLOCKING) == 0
        _, err = finish(process)
        assert "paused" not in err, "it says so once"
    return trace


def test_a_simulation_that_is_stopped_during_a_pause(
    stage: Stage, ports: list[int]
) -> None:
    script = stage.build("vrep")
    with stage.simulator(), onlooker(ports[1]) as eye:
        process = start(script)
        wait_for_motion(eye, process)
        assert sim.simxPauseSimulation(eye, BLOCKING) == 0
        note(process, "paused")
        assert sim.simxStopSimulation(eye, BLOCKING) == 0
        _, err = finish(process, 1)
    assert err.endswith("the simulation was stopped\n"), err


def test_ctrl_c_during_a_pause_stops_everything(stage: Stage, ports: list[int]) -> None:
    script = stage.build("vrep")
    with stage.simulator(), onlooker(ports[1]) as eye:
        process = start(script)
        left = wait_for_motion(eye, process)
        assert sim.simxPauseSimulation(eye, BLOCKING) == 0
        note(process, "paused")
        interrupt(process)
        finish(process, 130)
        assert sim.simxStartSimulation(eye, BLOCKING) == 0
        wait_for_rest(eye, left)


def test_a_server_that_never_replies(stage: Stage, ports: list[int]) -> None:
    script = stage.build("vrep")
    with socket.create_server(("127.0.0.1", ports[0])) as server:
        process = start(script)
        line, _ = server.accept()
        _, err = finish(process, 2)
        line.close()
    assert f"no reply from 127.0.0.1:{ports[0]}" in err


def test_the_client_explains_itself(stage: Stage) -> None:
    script = stage.build("vrep")
    client = script.with_name(CLIENT.name)
    client.unlink()
    _, err = finish(start(script), 2)
    assert "neither its sim.py nor its vrep.py is on Python's path" in err
    assert f"to {script.parent}." in err
    # Another module of that name is not the client.
    client.write_text("answer = 42\n", encoding="utf-8")
    _, err = finish(start(script), 2)
    assert "client for Python is missing" in err
    client.write_text("import simConst\n", encoding="utf-8")
    _, err = finish(start(script), 2)
    assert err == "error: sim.py needs simConst.py next to it\n"
    client.write_text("raise OSError('remoteApi.so: no such file')", encoding="utf-8")
    _, err = finish(start(script), 2)
    assert "error: sim.py cannot be loaded: remoteApi.so: no such file." in err
