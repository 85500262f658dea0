"""Measures how accurately robots drive in MuJoCo, by the friction of the floor, errors of wheels and steps: a table.

    .venv/bin/python tests/scripts/mujoco_table.py                                   # everything, which takes hours
    .venv/bin/python tests/scripts/mujoco_table.py table2 crossing --frictions 0.3   # some of it
    .venv/bin/python tests/scripts/mujoco_table.py --one-by-one                      # one condition differs at a time

Each run drives a program of the article or an example under a condition: the friction of the floor, by how many percent each
wheel turns faster or slower than it is told (a standard deviation), and the step in which a script controls its robots. The
end of every action is compared with the plan. Results are added to --results, so that a table can be completed later.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

ROOT = pathlib.Path(__file__).parents[2]
sys.path += [
    str(ROOT / part) for part in ("python/tests", "tests/article", "tests/support")
]

from driven import TABLES  # noqa: E402
from program_runs import command_line, lines, offsets  # noqa: E402

DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"
COMMAND = os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))

FRICTIONS, WHEELS, STEPS = (0.8, 0.3, 0.1), (0.0, 2.0, 5.0), (0.05, 0.02, 0.1)
POSITION, HEADING, LATE = 0.02, 1.5, 0.05  # m, degrees, share of the time: targets
LIMIT = 1200  # s of a run


class Condition(NamedTuple):
    """What robots drive on, and with."""

    friction: float = FRICTIONS[0]
    wheels: float = WHEELS[0]
    """How much wheels are off, in percent."""
    step: float = STEPS[0]

    def __str__(self) -> str:
        parts = [f"friction {self.friction:g}"]
        parts += [f"wheels {self.wheels:g} %"] * (self.wheels != WHEELS[0])
        parts += [f"step {1000 * self.step:g} ms"] * (self.step != STEPS[0])
        return ", ".join(parts)

    def apply(self, world: pathlib.Path) -> None:
        """Changes a world."""
        tree = ET.parse(world)
        [floor] = tree.iterfind(".//geom[@name='floor']")
        floor.set("friction", f"{self.friction} 0.005 0.0001")
        for tyres in tree.iterfind("default/pair"):
            sliding = f"{self.friction} {self.friction}"
            tyres.set("friction", f"{sliding} 0.005 0.0001 0.0001")
        [step] = tree.iterfind(".//numeric[@name='step']")
        step.set("data", str(self.step))
        dice = random.Random(1)
        for motor in tree.iter("velocity"):
            # A motor with this gear turns its wheel so much slower than it is told.
            motor.set("gear", str(1.0 + dice.gauss(0.0, self.wheels / 100.0)))
        tree.write(world)


class Program(NamedTuple):
    """A program, and where it is."""

    name: str
    folder: pathlib.Path
    file: str


def programs(folder: pathlib.Path) -> Iterator[Program]:
    """All programs that are judged, in copies."""
    for table in TABLES:
        if table.number == 7:  # slam, which has no plan
            continue
        place = folder / f"table{table.number}"
        place.mkdir()
        (place / "program.pyr").write_text(table.program, encoding="utf-8")
        if table.scene:
            shutil.copy(table.scene, place / "area_1.scene.toml")
        yield Program(place.name, place, "program.pyr")
    examples = folder / "examples"
    shutil.copytree(ROOT / "examples", examples)
    for file in sorted(examples.glob("*.pyr")):
        if "slam" not in file.read_text(encoding="utf-8"):
            yield Program(file.stem, examples, file.name)


def judge(program: Program, condition: Condition) -> dict[str, Any]:
    """Drives a program under a condition."""
    with tempfile.TemporaryDirectory() as place:
        out = pathlib.Path(place)
        world = out / "world.xml"
        planned = command_line(
            COMMAND,
            program.folder,
            "plan",
            program.file,
            "--json",
            "--mjcf",
            str(world),
        )
        built = command_line(
            COMMAND, program.folder, "build", program.file, "-o", str(out)
        )
        if planned.returncode or built.returncode:
            raise SystemExit(planned.stderr + built.stderr)
        [plan] = json.loads(planned.stdout)
        condition.apply(world)
        [script] = out.glob("*.py")
        done = subprocess.run(
            [sys.executable, script.name, "--mujoco", world.name, "--events", "-"],
            cwd=out,
            capture_output=True,
            encoding="utf-8",
            check=False,
            timeout=LIMIT,
        )
    events = lines(done.stdout)
    found = offsets(plan, events)
    failures = [event["message"] for event in events if event["event"] == "failed"]
    return {
        "program": program.name,
        "condition": condition._asdict(),
        "failure": " ".join(failures) or None,
        "actions": len(found),
        "metres": max((away for away, _ in found), default=0.0),
        "degrees": max((turned for _, turned in found), default=0.0),
        "simulated": max((event.get("t") or 0.0 for event in events), default=0.0),
        "planned": plan["duration"],
    }


def cell(result: dict[str, Any] | None) -> str:
    """How far from its plan a run gets at most, and by how much it takes longer than planned."""
    if result is None:
        return ""
    if result["failure"]:
        return "**fails**"
    if not result["actions"]:
        return "arrives"
    off = f"{1000 * result['metres']:.1f} mm, {result['degrees']:.2f}°"
    if result["metres"] > POSITION or result["degrees"] > HEADING:
        off = f"**{off}**"
    if not result["planned"]:
        return off
    share = late(result)
    time = f"{100 * share:+.0f} %"
    return f"{off}, **{time}**" if abs(share) > LATE else f"{off}, {time}"


def table(results: Sequence[dict[str, Any]]) -> str:
    """A row for each program and a column for each condition."""
    cells = {(it["program"], Condition(**it["condition"])): it for it in results}
    rows = list(dict.fromkeys(program for program, _ in cells))
    columns = list(dict.fromkeys(condition for _, condition in cells))
    lines = [
        ["program", *map(str, columns)],
        ["---"] * (len(columns) + 1),
        *([name, *(cell(cells.get((name, it))) for it in columns)] for name in rows),
    ]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def late(result: dict[str, Any]) -> float:
    """By what share of its plan a run takes longer; 0 where sensors decide when it ends."""
    planned = result["planned"] if result["actions"] else None
    return float(result["simulated"] / planned - 1.0) if planned else 0.0


def worst(results: Sequence[dict[str, Any]]) -> str:
    """A row for each condition: the programs that are the furthest off, and those that miss the target."""
    groups: dict[Condition, list[dict[str, Any]]] = {}
    for each in results:
        groups.setdefault(Condition(**each["condition"]), []).append(each)
    lines = [
        ["condition", "position", "heading", "time", "misses the target"],
        ["---"] * 5,
    ]
    for condition, runs in groups.items():
        far = max(runs, key=lambda it: it["metres"])
        turned = max(runs, key=lambda it: it["degrees"])
        slow = max(runs, key=late)
        outside = [it["program"] for it in runs if "**" in cell(it)]
        lines.append(
            [
                str(condition),
                f"{1000 * far['metres']:.1f} mm ({far['program']})",
                f"{turned['degrees']:.2f}° ({turned['program']})",
                f"{100 * late(slow):+.0f} % ({slow['program']})",
                ", ".join(outside) or "none",
            ]
        )
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def conditions(options: argparse.Namespace) -> list[Condition]:
    """Those that are asked for."""
    if not options.one_by_one:
        every = itertools.product(options.frictions, options.wheels, options.steps)
        return [Condition(*each) for each in every]
    return list(
        dict.fromkeys(
            [Condition(friction=each) for each in options.frictions]
            + [Condition(wheels=each) for each in options.wheels]
            + [Condition(step=each) for each in options.steps]
        )
    )


def main() -> None:
    """Drives what has no result yet, and prints the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("programs", nargs="*", help="by their names; all by default")
    parser.add_argument("--frictions", nargs="*", type=float, default=FRICTIONS)
    parser.add_argument("--wheels", nargs="*", type=float, default=WHEELS)
    parser.add_argument("--steps", nargs="*", type=float, default=STEPS)
    parser.add_argument("--one-by-one", action="store_true")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time")
    parser.add_argument(
        "--results", type=pathlib.Path, default=ROOT / "target" / "mujoco.jsonl"
    )
    options = parser.parse_args()
    known: dict[str, dict[str, Any]] = {}
    if options.results.exists():
        for each in lines(options.results.read_text(encoding="utf-8")):
            known[f"{each['program']} {Condition(**each['condition'])}"] = each
    with tempfile.TemporaryDirectory() as folder:
        found = list(programs(pathlib.Path(folder)))
        names = options.programs or [program.name for program in found]
        wanted = [
            (program, condition)
            for condition in conditions(options)
            for program in found
            if program.name in names
        ]

        def result(job: tuple[Program, Condition]) -> dict[str, Any]:
            key = f"{job[0].name} {job[1]}"
            if key not in known:
                known[key] = judge(*job)
                with options.results.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(known[key]) + "\n")
                print(key, cell(known[key]), file=sys.stderr, flush=True)
            return known[key]

        with ThreadPoolExecutor(options.jobs) as pool:
            results = list(pool.map(result, wanted))
    order = [program.name for program in found]
    results.sort(key=lambda each: order.index(each["program"]))
    print(worst(results), table(results), sep="\n\n")


if __name__ == "__main__":
    main()
