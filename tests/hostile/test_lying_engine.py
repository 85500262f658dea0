"""Commands and scripts whose engine lies: bounded time and memory, one message, and files as they were."""

from __future__ import annotations

import json
import os
import pathlib
import re
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import pytest
from amount import dice, report, times
from lying_engine import KINDS, Lie, LyingEngine
from pydslrep_runtime.readings import RESULTS
from pydslrep_runtime.remote_api import Connection

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="processes' use")

FEW = 5  # lies to each of four
LIMIT = 120.0  # s, on a slow machine
MAX_MEMORY = 700 << 20  # bytes
MAX_OUTPUT = 4000  # characters
# Where an engine falls silent, nobody should wait for minutes.
SHORT = "REPLY_TIMEOUT=2,HOLD_LIMIT=3,SILENCE_LIMIT=3,PROBE_PERIOD=0.5"

PROGRAM = """\
wheel l with radius 4.5
wheel r with radius 4.5
sensor eye
robot one type tw with port 23000 has { l r } wheels with sensors { eye }
movement go of one { move 5 centimeters turn left until { eye } turn left 5 }
environment yard has { one } robots with { go } moves
"""
SCENE = """\
[[box]]
name = "crate"
at = [1.5, 1]
size = [0.6, 0.4]
[[polygon]]
name = "wedge"
corners = [[-3, -2], [-2, -2], [-2.5, -1.8]]
"""
OLD_TRACE = '{"t": 0.05, "robot": "one", "x": 0, "y": 0, "theta": 0}\n'

Files = dict[str, bytes]


@dataclass(frozen=True)
class Done:
    """A process that has ended."""

    code: int
    out: str
    err: str
    seconds: float
    cpu: float  # s
    memory: int  # bytes of the largest process


def measured(
    arguments: list[str], folder: pathlib.Path, scratch: pathlib.Path, limits: str
) -> Done:
    """Runs a process and measures it."""
    out, err = scratch / "out", scratch / "err"
    begin = time.monotonic()
    with out.open("wb") as stdout, err.open("wb") as stderr:
        process = subprocess.Popen(
            arguments,
            cwd=folder,
            env={**os.environ, "PYDSLREP_TIME_LIMITS": limits},
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            stderr=stderr,
        )
        timer = threading.Timer(LIMIT, process.kill)
        timer.start()
        _, status, use = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
    return Done(
        process.returncode,
        out.read_text(encoding="utf-8"),
        err.read_text(encoding="utf-8"),
        time.monotonic() - begin,
        use.ru_utime + use.ru_stime,
        use.ru_maxrss << 10,
    )


class Victim:
    """One that asks a simulator, and the folder where it works."""

    def __init__(
        self, name: str, command: str, port: int, folder: pathlib.Path
    ) -> None:
        self.name, self.command, self.direct = name, command, port
        self.folder, self.scratch = folder / "it", folder / "scratch"
        self.folder.mkdir()
        self.scratch.mkdir()
        program = self.folder / "yard.pyr"
        program.write_text(PROGRAM, encoding="utf-8")
        (self.folder / "yard.scene.toml").write_text(SCENE, encoding="utf-8")
        (self.folder / "driven.jsonl").write_text(OLD_TRACE, encoding="utf-8")
        if name == "script":
            self._run("build", "yard.pyr")
        if name == "push":
            self._make_an_object()
        else:
            self._run("scene", "push", "yard.pyr", "--port", str(port))
        self.engine = LyingEngine(port)
        self.engine.start()
        self.before = self.files()
        self.objects = self.restored()

    def _run(self, *arguments: str) -> None:
        subprocess.run(
            [self.command, *arguments], cwd=self.folder, check=True, capture_output=True
        )

    def _make_an_object(self) -> None:
        connection = Connection("127.0.0.1", self.direct)
        sim = connection.sim
        size = [0.1, 0.1, 0.1]
        made = connection.call(
            sim.createPrimitiveShape, sim.primitiveshape_cuboid, size, 0
        )
        connection.call(sim.setObjectAlias, made, "mine")
        connection.close()

    def arguments(self) -> list[str]:
        """What is started."""
        port = ["--port", str(self.engine.port)]
        if self.name == "script":
            trace = ["--trace", "driven.jsonl"]
            return [sys.executable, "-B", "yard.py", *port, *trace]
        task = {
            "doctor": ["doctor", "yard.pyr"],
            "pull": ["scene", "pull", "hall"],
            "push": ["scene", "push", "yard.pyr", "--replace"],
        }[self.name]
        return [self.command, *task, *port, "--no-progress", "--python", sys.executable]

    def files(self) -> Files:
        """All files of the folder."""
        return {
            str(path.relative_to(self.folder)): path.read_bytes()
            for path in self.folder.rglob("*")
            if path.is_file()
        }

    def restored(self) -> set[int]:
        """Removes what was not there before, and returns what is there."""
        connection = Connection("127.0.0.1", self.direct)
        try:
            sim, call = connection.sim, connection.call
            call(sim.stopSimulation)
            tree = (sim.getObjectsInTree, sim.handle_scene, sim.handle_all, 0)
            found = set(call(*tree))
            if new := found - getattr(self, "objects", found):
                call(sim.removeObjects, sorted(new))
            return found
        finally:
            connection.close()

    def suffer(self, lie: Lie | None) -> Done:
        """Runs it once; afterwards everything is as before."""
        self.engine.begin(lie)
        limits = SHORT if lie and lie.kind == "silence" else ""
        done = measured(self.arguments(), self.folder, self.scratch, limits)
        after = self.files()
        for file, content in self.before.items():
            if file == "driven.jsonl":
                for line in after[file].decode().splitlines():
                    assert json.loads(line)["robot"] == "one", lie
                assert after[file], f"{lie}: an older trace is replaced by nothing"
            else:
                assert after.get(file) == content, f"{lie}: {file} is changed"
        new = after.keys() - self.before.keys()
        written = {"hall/hall.pyr", "hall/hall_area.scene.toml"}
        assert new == (written if self.name == "pull" and done.code == 0 else set())
        for file in new:
            (self.folder / file).unlink()
        if new:
            (self.folder / "hall").rmdir()
        (self.folder / "driven.jsonl").write_text(OLD_TRACE, encoding="utf-8")
        left = self.restored()
        assert left >= self.objects, f"{lie}: objects of others are gone"
        if done.code != 0 and not (lie and lie.kind == "silence"):
            # The handle of one may never have arrived.
            assert len(left - self.objects) <= 1, f"{lie}: made objects stay"
        return done


def lies(answers: Counter[str]) -> list[Lie]:
    """All lies about the answers that one gets: about the first one, and in the middle."""
    return [
        Lie(function, kind, occurrence)
        for function, count in sorted(answers.items())
        for kind in KINDS
        for occurrence in sorted({1, (count + 1) // 2})
    ]


def is_read(function: str) -> bool:
    """Whether anything depends on a function's result."""
    return RESULTS[function.removeprefix("sim.")] != ()


def check(lie: Lie, done: Done) -> None:
    """What must hold for each."""
    text = done.out + done.err
    assert done.code in (0, 1, 2), f"{lie}: {done}"
    assert "Traceback" not in text, f"{lie}: {text}"
    assert "internal error" not in text, f"{lie}: {text}"
    assert len(text) < MAX_OUTPUT, f"{lie}: {len(text)} characters"
    assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f]", text), f"{lie}: {text!r}"
    assert not re.search(r"\d{25}", text), f"{lie}: {text}"
    assert done.memory < MAX_MEMORY, f"{lie}: {done.memory} bytes"
    errors = re.findall(r"^error(?:\[.*\])?: .*", done.err, re.M)
    if done.code == 2:
        assert len(errors) + done.out.count("error[no-") == 1, f"{lie}: {text}"
    if lie.kind in ("nan", "infinity", "1e308") and is_read(lie.function):
        assert done.code != 0, f"{lie}: {text}"
        assert "sim." in text, f"{lie}: {text}"


@pytest.fixture
def victim(
    request: pytest.FixtureRequest, command: str, port: int, tmp_path: pathlib.Path
) -> Iterator[Victim]:
    found = Victim(request.param, command, port, tmp_path)
    yield found
    found.engine.close()


@pytest.mark.parametrize("victim", ["script", "doctor", "pull", "push"], indirect=True)
def test_an_engine_that_lies(victim: Victim, long: bool) -> None:
    honest = victim.suffer(None)
    assert honest.code == 0, honest
    all_lies = lies(victim.engine.answers)
    die = dice(f"engine {victim.name}")
    chosen = all_lies if long else die.sample(all_lies, min(times(FEW), len(all_lies)))
    outcomes: Counter[str] = Counter()
    slowest, largest, cpu = 0.0, 0, honest.cpu
    failures = []
    for lie in chosen:
        try:
            done = victim.suffer(lie)
            assert victim.engine.told == 1, f"{lie}: it was not told; {done}"
            check(lie, done)
        except AssertionError as failure:
            failures.append(str(failure).partition("\n")[0])
            outcomes["failure"] += 1
        else:
            outcomes[f"exit {done.code}"] += 1
            slowest, largest = max(slowest, done.seconds), max(largest, done.memory)
            cpu += done.cpu
    figures = {
        **outcomes,
        "slowest": round(slowest),
        "megabytes": largest >> 20,
        "cpu": round(cpu),
    }
    print(f"{victim.name}: {figures}")
    report(f"engine {victim.name}", len(chosen) - outcomes["failure"], len(chosen))
    assert not failures, "\n".join(failures)


@pytest.mark.parametrize("victim", ["script"], indirect=True)
def test_an_engine_that_answers_everything_but_steps(victim: Victim) -> None:
    # Only who asks for a step waits for ever: the script's question for the state, by another connection, is answered.
    lie = Lie("sim.step", "silence", 3)
    done = victim.suffer(lie)
    assert victim.engine.told == 1
    check(lie, done)
    assert done.code == 1, done
    assert done.err.count("error") == 1, done.err
    assert "another client holds the simulation's time" in done.err
