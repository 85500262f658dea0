"""How well robots explore by odometry whose tracks and wheels are others than they know: a table.

    .venv/bin/python tests/scripts/odometry_table.py                      # everything, which takes hours
    .venv/bin/python tests/scripts/odometry_table.py --worlds 14 3 --errors 2 --seeds 1

Each run explores a generated world in the embedded simulator with its default noise, a track that is wider by an error in
percent, and wheels that are smaller by half of it: turns by the wheels are off by one and a half times as much. What the map says is compared with the simulator's own trace.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
from bisect import bisect_left
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

ROOT = pathlib.Path(__file__).parents[2]
sys.path.append(str(ROOT / "python" / "tests"))

from rooms import Position, Rooms, generate  # noqa: E402

PROGRAM = ROOT / "tests" / "paper" / "table7_slam.pyr"
REACH = 1.5  # m: a step and the range of a sensor
OUTPUTS = ["--map", "map.json", "--events", "events"]
NEAR = 0.25  # m of error that a node may have
LIMIT = 3600  # s for a run

WORLDS = range(1, 21)
FEW_WORLDS = (1, 5, 9, 14, 17)


@dataclass(frozen=True)
class Run:
    """A world, an error in percent, and the seed of the noise."""

    world: int
    error: float
    seed: int

    def __str__(self) -> str:
        return f"{self.world}-{self.error:g}-{self.seed}"

    @property
    def noise(self) -> str:
        """The table of the scene."""
        return f"[noise]\ntrack-error = {self.error:g}\nradius-error = {-self.error / 2.0:g}\n"


# 20 worlds at 0 and 2 %, and five at 1, 2 and 3 % with three seeds.
RUNS = list(
    dict.fromkeys(
        [Run(world, error, 1) for error in (0, 2) for world in WORLDS]
        + [
            Run(world, error, seed)
            for error in (1, 2, 3)
            for seed in (1, 2, 3)
            for world in FEW_WORLDS
        ]
    )
)


@dataclass(frozen=True)
class Result:
    """What a robot has found, and how far its nodes are from where it really was, in metres."""

    area: float
    covered: float
    errors: Sequence[float]
    uncertain: int
    seconds: float  # of simulation

    @property
    def is_good(self) -> bool:
        """Whether all has been seen, and each node is where it should be."""
        return self.covered >= 1.0 and max(self.errors) <= NEAR


def explore(command: str, run: Run, folder: pathlib.Path) -> Result:
    """Runs a program in the embedded simulator, which records where the robot really is."""
    rooms = generate(run.world)
    (folder / "area_1.scene.toml").write_text(
        rooms.scene("robot_1", run.noise), encoding="utf-8"
    )
    program = folder / "program.pyr"
    port = free_port()
    program.write_text(
        PROGRAM.read_text(encoding="utf-8").replace("19999", str(port)),
        encoding="utf-8",
    )
    built = subprocess.run(
        [command, "build", "--stdout", str(program)], check=True, capture_output=True
    )
    (folder / "area_1.py").write_bytes(built.stdout)
    with simulator(command, program, run.seed, folder / "truth"):
        done = subprocess.run(
            [sys.executable, "area_1.py", "--odometry", *OUTPUTS],
            cwd=folder,
            # The runtime of this checkout, not what the command was built with.
            env=os.environ | {"PYTHONPATH": str(ROOT / "python")},
            capture_output=True,
            encoding="utf-8",
            check=False,
            timeout=LIMIT,
        )
    assert done.returncode == 0, done.stderr
    found = json.loads((folder / "map.json").read_text(encoding="utf-8"))
    return judged(rooms, found, folder)


def judged(
    rooms: Rooms,
    found: dict[str, list[dict[str, float]]],
    folder: pathlib.Path,
) -> Result:
    """Compares a map with the simulator's trace."""
    times, places = trace(folder / "truth")
    errors = []
    for node, at in zip(found["nodes"], node_times(folder / "events"), strict=True):
        true = places[min(bisect_left(times, at - 1e-6), len(places) - 1)]
        errors.append(math.dist((node["x"], node["y"]), true))
    nodes = [(node["x"], node["y"]) for node in found["nodes"]]
    return Result(
        area=rooms.width * rooms.height,
        covered=rooms.coverage(nodes, REACH),
        errors=sorted(errors),
        uncertain=sum("uncertain" in node for node in found["nodes"]),
        seconds=times[-1],
    )


def trace(path: pathlib.Path) -> tuple[list[float], list[Position]]:
    """The times and the positions of the only robot."""
    times: list[float] = []
    places: list[Position] = []
    with path.open(encoding="utf-8") as rows:
        for line in rows:
            row = json.loads(line)
            if times and row["t"] < times[-1]:
                times.clear()  # the script has started the simulation anew
                places.clear()
            times.append(row["t"])
            places.append((row["x"], row["y"]))
    return times, places


def node_times(path: pathlib.Path) -> Iterator[float]:
    """When the robot has added each node of its map."""
    count = 0
    for line in path.read_text(encoding="utf-8").splitlines():
        row = json.loads(line)
        if row["event"] == "progress":
            grown = re.match(r"slam: (\d+) nodes", row["text"])
            if grown and int(grown[1]) > count:
                count = int(grown[1])
                yield row["t"]


@contextmanager
def simulator(
    command: str, program: pathlib.Path, seed: int, trace: pathlib.Path
) -> Iterator[None]:
    """The embedded simulator, which writes a trace that is complete afterwards."""
    options = ["--seed", str(seed), "--trace", str(trace)]
    with subprocess.Popen(
        [command, "sim", str(program), *options], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if line.startswith("Ready"):
                break
        try:
            yield
        finally:
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)


def free_port() -> int:
    """A port that nothing listens on."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        port: int = listener.getsockname()[1]
        return port


def row_of(run: Run, result: Result) -> str:
    """A row of the table, in Markdown."""
    median = result.errors[len(result.errors) // 2]
    cells = [
        f"{run.world} ({result.area:.0f} m²)",
        f"{run.error:g} %",
        f"{run.seed}",
        f"{100.0 * result.covered:.2f} %".replace("100.00", "100"),
        f"{len(result.errors)}",
        f"{100.0 * median:.1f} cm",
        f"{100.0 * result.errors[-1]:.1f} cm",
        f"{result.uncertain}",
        f"{result.seconds / 60.0:.0f} min",
        "yes" if result.is_good else "**no**",
    ]
    return f"| {' | '.join(cells)} |"


HEAD = """\
| world | error | seed | floor seen | nodes | off: median | largest | uncertain | simulated | as it should be |
|---|---|---|---|---|---|---|---|---|---|"""


def main() -> None:
    """Prints the table, a row after each run."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--worlds", type=int, nargs="+", help="of 1 to 20")
    parser.add_argument("--errors", type=float, nargs="+", help="in percent")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument(
        "--command", default=str(ROOT / "target" / "debug" / "pydslrep")
    )
    options = parser.parse_args()
    runs = RUNS
    if options.worlds or options.errors:
        runs = [
            Run(world, error, seed)
            for error in options.errors or (0, 1, 2, 3)
            for seed in options.seeds
            for world in options.worlds or WORLDS
        ]
    print(HEAD, flush=True)
    for run in runs:
        with tempfile.TemporaryDirectory() as folder:
            try:
                row = row_of(run, explore(options.command, run, pathlib.Path(folder)))
            except (AssertionError, subprocess.TimeoutExpired) as error:
                row = f"| {run.world} | {run.error:g} % | {run.seed} | {error} |"
        print(row, flush=True)


if __name__ == "__main__":
    main()
