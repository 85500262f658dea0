"""How many seconds an engine simulates in a second of processor time, for one robot and for four.

    python3 tests/bench/engines.py target/release/pydslrep

The processor time is that of the whole run: the command, its simulator, and the script with its start. Other work on the
computer hardly counts. MuJoCo must be installed in the Python that runs this.
"""

from __future__ import annotations

import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).parents[2]
PROGRAMS = {
    "one robot": ROOT / "tests/paper/table2_two_wheels.pyr",
    "four robots": ROOT / "examples/crossing.pyr",
}
ENGINES = ("embedded", "mujoco")


def processor_time() -> float:
    """Seconds of all processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure(command: str, program: pathlib.Path, engine: str) -> tuple[float, float]:
    """Seconds that a run simulates, and of processor time."""
    before = processor_time()
    done = subprocess.run(
        [
            command,
            *("run", program.name, "--engine", engine, "--python", sys.executable),
            *("--no-progress", "--events", "-"),
        ],
        cwd=program.parent,
        capture_output=True,
        check=True,
        encoding="utf-8",
    )
    used = processor_time() - before
    events = map(json.loads, done.stdout.splitlines())
    return max(event.get("t") or 0.0 for event in events), used


def main() -> None:
    """Prints a line for each engine and program."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("command")
    parser.add_argument("--rounds", type=int, default=7)
    options = parser.parse_args()
    command = str(pathlib.Path(options.command).resolve())
    for engine in ENGINES:
        for name, program in PROGRAMS.items():
            runs = [measure(command, program, engine) for _ in range(options.rounds)]
            simulated = runs[0][0]
            used = statistics.median(run[1] for run in runs)
            print(
                f"{engine}, {name}: {simulated:.1f} s in {used:.2f} s, {simulated / used:.0f} s per second",
                flush=True,
            )


if __name__ == "__main__":
    main()
