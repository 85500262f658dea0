"""Any name in a program gives a script that passes Python's tools and drives the robots.

The tests use all names that could conflict with a script: Python's keywords and builtins, the script's own identifiers,
those of the runtime, and the keywords of the language.
"""

from __future__ import annotations

import ast
import builtins
import itertools
import keyword
import os
import pathlib
import re
import subprocess
import sys
from collections.abc import Sequence

import mypy_cache

ROOT = pathlib.Path(__file__).parents[2]

# Robots of every type, sensors, an address, movements in sequence and in parallel. Tests rename `W3` and the like; `^`
# lets keywords be names.
PROGRAM = """
wheel ^W0 with radius 4.5   wheel ^W1 with radius 4.5
wheel ^W2 with radius 5     wheel ^W3 with radius 5     wheel ^W4 with radius 5     wheel ^W5 with radius 5
wheelH ^W6 with radius 6    wheelH ^W7 with radius 6    wheelH ^W8 with radius 6    wheelH ^W9 with radius 6
sensor ^S0 : distance
sensor ^S1 : bumper
ip ^I0 127.0.0.1

robot ^R0 type tw with port 23000 has { ^W0 ^W1 } wheels with sensors { ^S0, ^S1 }
robot ^R1 type fw with port 23000 has { ^W2 ^W3 ^W4 ^W5 } wheels
robot ^R2 type fwh with port 23001 has { ^W6 ^W7 ^W8 ^W9 } wheels with sensors { ^S1 }

movement ^M0 of ^R0 {
  move 6 centimeters
  turn left until { ^S0, ^S1 }
  turn right 20
}
movement ^M1 of ^R1 { move -5 centimeters at 12 }
parallel movement ^M2 of ^R2 { turn left 15 move 0.05 meters }
parallel movement ^M3 of ^R0 { move 5 centimeters }

environment ^E0 with ip ^I0 has { ^R0 ^R1 ^R2 } robots with { ^M0 ^M1 ^M2 ^M3 } moves
"""
KINDS = ["robot", "movement", "environment"]
PLACES = sorted(set(re.findall(r"\^([A-Z]\d)", PROGRAM)))

# One name for everything that may share it: each kind of entity has its own namespace. The robot with that name is not
# the first one in the scene, and another robot has a wheel with that name too.
ONE_NAME = """
wheel ^X with radius 4.5
wheel right_one with radius 4.5
sensor ^X
ip ^X 127.0.0.1
robot ^X type tw with port 23000 has { ^X right_one } wheels with sensors { ^X }
robot with_wheel type tw with port 23000 has { ^X right_one } wheels
movement ^X of ^X { move 5 centimeters turn left until { ^X } turn right 20 }
parallel movement second of with_wheel { move 5 centimeters }
parallel movement third of ^X { move 5 centimeters }
environment ^X with ip ^X has { with_wheel ^X } robots with { ^X second third } moves
"""


def renamed(program: str, names: dict[str, str]) -> str:
    return re.sub(r"\^([A-Z]\d?)\b", lambda place: "^" + names[place[1]], program)


def built(command: str, folder: pathlib.Path, program: str) -> pathlib.Path:
    """The script of a program."""
    path = folder / "program.pyr"
    folder.mkdir()
    path.write_text(program, encoding="utf-8")
    done = subprocess.run(
        [command, "build", path], capture_output=True, encoding="utf-8", check=False
    )
    assert done.returncode == 0, done.stderr
    [script] = folder.glob("*.py")
    return script


def identifiers(script: str) -> set[str]:
    """All identifiers in a script."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(script)):
        for field in ("id", "name", "attr", "arg", "asname", "module"):
            value = getattr(node, field, None)
            if isinstance(value, str):
                found.update(value.split("."))
    return found


def keywords() -> set[str]:
    grammar = (ROOT / "grammar" / "pydslrep.ebnf").read_text(encoding="utf-8")
    return set(re.findall(r'"([A-Za-z]+)"', grammar))


def runtime() -> set[str]:
    """The identifiers in the interface of the runtime, and its modules."""
    folder = ROOT / "python" / "pydslrep_runtime"
    modules = {path.stem for path in folder.rglob("*.py")}
    return modules | identifiers((folder / "__init__.py").read_text(encoding="utf-8"))


def all_names(script: str) -> list[str]:
    """Names that could conflict with a script, in an order that gives neighbours different roles."""
    own = {name for name in identifiers(script) if name not in PLACES}
    names = (
        set(keyword.kwlist) | set(keyword.softkwlist) | set(dir(builtins)) | own
    ) | keywords()
    names |= {"__main__", "__init__", "__name__", "__file__", "self", "_", "__"}
    # What a name becomes that is taken, and what ruff and mypy treat specially.
    names |= {f"{name}_{kind}" for name in ["class", "run"] for kind in KINDS}
    names |= {f"{kind}_{number}" for kind in KINDS for number in (1, 2)}
    names |= {*KINDS, "l", "O", "I", "reveal_type", "reveal_locals", "TYPE_CHECKING"}
    names |= runtime()
    return sorted(
        name for name in names if re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name)
    )


def drive(command: str, program: pathlib.Path) -> None:
    done = subprocess.run(
        [command, "run", "--no-progress", program],
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, f"{program.read_text()}\n{done.stderr}"
    assert "driven" in done.stdout


def pass_tools(scripts: Sequence[pathlib.Path], folder: pathlib.Path) -> None:
    """Runs ruff and mypy as a user would, without this repository's settings."""
    folder.mkdir()
    for index, script in enumerate(scripts):
        # Rename scripts to check all at once: they may share names, or have those of modules.
        (folder / f"script_{index}.py").write_bytes(script.read_bytes())
    for arguments in (
        ["ruff", "check", "--isolated", "--no-cache", "."],
        ["ruff", "format", "--isolated", "--no-cache", "--check", "."],
        [
            *("mypy", "--strict", "--python-version", "3.11", "--config-file="),
            *(mypy_cache.option(), "."),
        ],
    ):
        done = subprocess.run(
            [sys.executable, "-m", *arguments],
            cwd=folder,
            # mypy finds the runtime, as it would beside the scripts.
            env=os.environ | {"MYPYPATH": str(ROOT / "python")},
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == 0, done.stdout


def test_any_name_is_only_a_name(
    command: str, tmp_path: pathlib.Path, long: bool
) -> None:
    plain = built(command, tmp_path / "plain", renamed(PROGRAM, {p: p for p in PLACES}))
    names = all_names(plain.read_text(encoding="utf-8"))
    assert {"class", "None", "print", "robot_1", "run", "movement", "l"} <= set(names)
    scripts = []
    for index, start in enumerate(range(0, len(names), len(PLACES))):
        # Fill up the last program with the first names.
        some = itertools.chain(names[start:], names)
        chosen = dict(zip(PLACES, some, strict=False))
        folder = tmp_path / f"names_{index}"
        scripts.append(built(command, folder, renamed(PROGRAM, chosen)))
        if long or index % 4 == 0:
            drive(command, folder / "program.pyr")
    pass_tools(scripts, tmp_path / "scripts")


def test_one_name_for_everything(
    command: str, tmp_path: pathlib.Path, long: bool
) -> None:
    scripts = []
    for name in ("class", "run", "x", "x_robot", "movement", "l", "math"):
        folder = tmp_path / name
        scripts.append(built(command, folder, renamed(ONE_NAME, {"X": name})))
        if long or len(scripts) <= 2:
            drive(command, folder / "program.pyr")
    pass_tools(scripts, tmp_path / "scripts")
