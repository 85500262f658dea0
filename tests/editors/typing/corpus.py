"""The programs to type: the article's, the contract's, the examples, generated ones, and some with similar names."""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
DEBUG = ROOT / "target" / "debug"
GENERATED = 50
# The approximate number of entities and actions of a generated program, and how many it takes to find those with nested blocks.
SIZE = 12
TRIED = 150
# A line at the third depth: in a block of a block.
NESTED = "\n" + 6 * " "
# The programs of the test command: comments and nested blocks, similar names, one as the article prints it.
FEW = ("comments", "names_few_tab", "table2_two_wheels_printed")
# Its syntax errors leave it without a layout.
WITHOUT_LAYOUT = ("11-recovery",)
# How many programs have similar names, and how many letters these begin with; in the test command, fewer.
SIMILAR = 6
LETTERS = 6
FEW_LETTERS = 2
STEP = 2


@dataclass(frozen=True)
class Program:
    """A program."""

    name: str
    text: str
    # Whether Tab follows each word of a list: it accepts the first item of a menu, or is a blank.
    tabs: bool = False
    # Whether it is typed as written, with its own line breaks and braces, although it is not formatted.
    is_printed: bool = False

    @property
    def is_generated(self) -> bool:
        """Whether it is one of many that differ by chance."""
        return self.name.startswith("nested_")

    def matches(self, typed: str) -> bool:
        """Whether a text is what was typed. The editor formats programs that are not."""
        if self.tabs:
            return _without_blanks(typed) == _without_blanks(self.text)
        if self.is_printed:
            return formatted(typed) == formatted(self.text) and not ragged(typed)
        return typed == self.text


def programs() -> list[Program]:
    """All programs, in a fixed order."""
    folders = (
        "tests/paper",
        "examples",
        "tests/programs/0.3",
        "tests/editors/typing/programs",
    )
    files = [
        file
        for folder in folders
        for file in sorted((ROOT / folder).glob("*.pyr"))
        if file.stem not in WITHOUT_LAYOUT
    ]
    texts = {file.stem: file.read_text() for file in files}
    texts |= {f"names_{seed:02}": similar_names(seed) for seed in range(SIMILAR)}
    texts["names_few"] = similar_names(0, FEW_LETTERS)
    printed = [
        Program(f"{file.stem}_printed", file.read_text(), is_printed=True)
        for file in sorted((ROOT / "tests/paper").glob("*.pyr"))
    ]
    texts |= {f"nested_{seed:03}": text for seed, text in enumerate(_generated())}
    with tempfile.TemporaryDirectory(prefix="pydslrep-") as folder:
        typed = _fewer_generated(_formatted(texts, Path(folder)))
    tabs = [
        Program(f"{program.name}_tab", program.text, tabs=True)
        for program in typed
        if program.name.startswith("names_")
    ]
    return [*typed, *tabs, *printed]


def other_files() -> dict[str, str]:
    """The programs that are in the folder while others are typed."""
    return {
        f"others/{program.name}.pyr": program.text
        for program in programs()
        if not program.tabs and not program.is_printed
    }


def similar_names(seed: int, count: int = LETTERS) -> str:
    """A program with names that begin like others, in lists on one line and over several."""
    letters = [chr(ord("a") + (seed * 4 + place) % 26) for place in range(count)]
    sensors = [name for letter in letters for name in _family(letter, letters[0])]
    names = _family(letters[0], letters[1])
    rotated = [*names[seed % 4 :], *names[: seed % 4]]
    lines = [f"wheel {name} with radius 4.5" for name in names]
    lines += [f"sensor {name}" for name in sensors]
    robot = (
        f"robot {names[1]} type fw with port 23000 has {{ {' '.join(rotated)} }} wheels"
    )
    lines.append(f"{robot} with sensors {{ {', '.join(reversed(sensors))} }}")
    moved = names[:count]
    for name in moved:
        until = "{ " + ", ".join(rotated) + " }"
        action = f"turn left until {until}"
        lines.append(f"movement {name} of {names[1]} {{ {action} move 2 meters }}")
    moves = " ".join(moved[(seed + place) % len(moved)] for place in range(26))
    lines.append(
        f"environment {names[0]} has {{ {names[1]} }} robots with {{ {moves} }} moves"
    )
    return "\n".join(lines) + "\n"


def _family(first: str, second: str) -> list[str]:
    """Four names of which some begin like others: `a`, `ab`, `abc`, `a2`."""
    third = chr(ord("a") + (ord(second) - ord("a") + 1) % 26)
    return [first, first + second, first + second + third, first + "2"]


def ragged(text: str) -> list[str]:
    """The lines that are not indented by their depth, as far as they begin outside comments."""
    found, depth = [], 0
    for line in text.splitlines():
        code = re.sub(r"//.*|/\*.*?\*/", "", line)
        leading = len(line) - len(line.lstrip(" "))
        if code.strip() and leading != STEP * (depth - code.lstrip().startswith("}")):
            found.append(line)
        depth += code.count("{") - code.count("}")
    return found


def formatted(text: str) -> str:
    """A text in canonical layout, as far as it has no errors."""
    done = subprocess.run(
        [_pydslrep(), "fmt", "-"],
        input=text,
        check=False,
        capture_output=True,
        text=True,
    )
    return done.stdout


def _without_blanks(text: str) -> str:
    return "\n".join(" ".join(line.split()) for line in text.strip().splitlines())


def _fewer_generated(found: list[Program]) -> list[Program]:
    """Without generated programs that are flat, or more than enough."""
    nested = [one for one in found if one.is_generated and NESTED in one.text]
    kept = nested[:GENERATED]
    return [one for one in found if not one.is_generated or one in kept]


def _generated() -> list[str]:
    generator = os.environ.get("RANDOM_PROGRAMS", str(DEBUG / "random-programs"))
    command = [generator, str(TRIED), str(SIZE), "tidy"]
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return output.split("\0")[:TRIED]


def _formatted(texts: dict[str, str], folder: Path) -> list[Program]:
    """The programs, formatted."""
    parts = folder / "parts"
    parts.symlink_to(ROOT / "examples" / "parts")
    files = {name: folder / f"{name}.pyr" for name in texts}
    for name, file in files.items():
        file.write_text(texts[name])
    _run("fmt", files.values())
    # The article's programs have errors.
    _run("check", [file for name, file in files.items() if name.startswith("nested_")])
    return [Program(name, file.read_text()) for name, file in files.items()]


def _pydslrep() -> str:
    return os.environ.get("PYDSLREP", str(DEBUG / "pydslrep"))


def _run(action: str, files: Iterable[Path]) -> None:
    command = [_pydslrep(), action, *map(str, files)]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"pydslrep {action}:\n{done.stdout}{done.stderr}")
