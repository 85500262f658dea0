"""The programs to type: the article's, the examples, generated ones, and one with comments."""

from __future__ import annotations

import os
import subprocess
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
DEBUG = ROOT / "target" / "debug"
GENERATED = 50
# The approximate number of entities and actions of a generated program.
SIZE = 8
# The programs for continuous integration: table 2, an example, generated ones.
FEW = ("table2_two_wheels", "mecanum", "comments", "generated_05", "generated_12")


@dataclass(frozen=True)
class Program:
    """A formatted program."""

    name: str
    text: str


def programs() -> list[Program]:
    """All programs, in a fixed order."""
    folders = ("tests/paper", "examples", "tests/editors/typing/programs")
    files = [
        file for folder in folders for file in sorted((ROOT / folder).glob("*.pyr"))
    ]
    texts = {file.stem: file.read_text() for file in files}
    for number, text in enumerate(_generated()):
        texts[f"generated_{number:02}"] = text
    with tempfile.TemporaryDirectory(prefix="pydslrep-") as folder:
        return _formatted(texts, Path(folder))


def few() -> list[Program]:
    """The programs that find most defects in little time."""
    return [program for program in programs() if program.name in FEW]


def _generated() -> list[str]:
    generator = os.environ.get("RANDOM_PROGRAMS", str(DEBUG / "random-programs"))
    command = [generator, str(GENERATED), str(SIZE), "tidy"]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return output.split("\0")[:GENERATED]


def _formatted(texts: dict[str, str], folder: Path) -> list[Program]:
    """The programs, formatted."""
    parts = folder / "parts"
    parts.symlink_to(ROOT / "examples" / "parts")
    files = {name: folder / f"{name}.pyr" for name in texts}
    for name, file in files.items():
        file.write_text(texts[name])
    _run("fmt", files.values())
    # The article's programs have errors.
    _run("check", [file for name, file in files.items() if "generated" in name])
    return [Program(name, file.read_text()) for name, file in files.items()]


def _run(action: str, files: Iterable[Path]) -> None:
    pydslrep = os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))
    command = [pydslrep, action, *map(str, files)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"pydslrep {action}:\n{done.stdout}{done.stderr}")
