"""How work grows with its input, counted in instructions, so that other load on the machine does not matter.

    python3 tests/bench/growth.py [--sizes 1000,10000,100000] [--only plan] target/release/pydslrep

needs valgrind. An exponent of 1 is linear. The cost of the same command with an input of size 1 is subtracted.
"""

from __future__ import annotations

import argparse
import math
import os
import pathlib
import re
import subprocess
import tempfile
from typing import TYPE_CHECKING

from client import Client
from program import BLOCK

if TYPE_CHECKING:
    from collections.abc import Callable

PARTS = """\
wheel a with radius 4.5
wheel b with radius 4.5
robot r with port 23000 has { a b } wheels
"""
SLOW = 3600.0
"""Seconds: counting takes fifty times as long as running."""

ENVIRONMENT = "environment e has { r } robots with { m } moves\n"
FIRST_LINE = {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 0}}


def environments(size: int) -> str:
    """One movement that many environments run."""
    many = (
        f"environment e{number} has {{ r }} robots with {{ m }} moves\n"
        for number in range(size)
    )
    return PARTS + "movement m of r { move 1 meters }\n" + "".join(many)


def twins(size: int) -> str:
    """The same, with names of which each two differ by case only."""
    return re.sub(
        r"environment e(\d*[13579]) ",
        lambda found: f"environment E{int(found[1]) - 1} ",
        environments(size),
    )


def actions(size: int) -> str:
    """One long movement."""
    two = "  move 1 meters\n  turn left\n"
    return f"{PARTS}movement m of r {{\n{two * (size // 2 + 1)}}}\n{ENVIRONMENT}"


def programs(size: int) -> str:
    """Many programs without problems in one file."""
    blocks = range(1, size // 20 + 2)
    return "".join(
        BLOCK.format(n=f"{block:05}", port=10_000 + block % 50_000) for block in blocks
    )


def repeated(size: int) -> str:
    """The same program again and again: every name is declared often."""
    return (PARTS + "movement m of r { turn left }\n" + ENVIRONMENT) * (size // 5 + 1)


def one_program(text: Callable[[int], str]) -> Callable[[int], dict[str, str]]:
    """A single file."""
    return lambda size: {"0.pyr": text(size)}


def chain(size: int) -> dict[str, str]:
    """Files that import each other, a tenth of the size."""
    files = max(size // 10, 1)
    texts = {
        f"{number}.pyr": f'import "{number + 1}.pyr"\nwheel w{number} with radius 4\n'
        for number in range(files)
    }
    return texts | {f"{files}.pyr": "wheel w with radius 4\n"}


BUILD = ["build", "--no-runtime", "-o", "scripts"]

CASES: dict[str, tuple[Callable[[int], dict[str, str]], list[str]]] = {
    "check: programs in a file": (one_program(programs), ["check"]),
    "check: one program repeated": (one_program(repeated), ["check"]),
    "check: a chain of imports": (chain, ["check"]),
    "check: environments alike but for case": (one_program(twins), ["check"]),
    "plan: actions": (one_program(actions), ["plan"]),
    "plan: environments": (one_program(environments), ["plan"]),
    "build: actions": (one_program(actions), BUILD),
    "build: environments": (one_program(environments), BUILD),
}
"""Of the command: the files, of which the first is named, and the arguments."""

REQUESTS: dict[str, tuple[Callable[[int], str], str, dict[str, object]]] = {
    "code actions: environments": (
        environments,
        "textDocument/codeAction",
        {"range": FIRST_LINE, "context": {"diagnostics": []}},
    ),
    "planned path: actions": (actions, "pydslrep/plannedPath", {"environment": "e"}),
}
"""Of the server: the program, the method and its parameters."""


def main() -> None:
    """Prints a row for each case."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("command", type=pathlib.Path, help="the command `pydslrep`")
    parser.add_argument("--sizes", default="1000,10000,100000")
    parser.add_argument("--only", default="", help="a part of the names of cases")
    options = parser.parse_args()
    sizes = [int(size) for size in options.sizes.split(",")]
    print(f"{'millions of instructions':40} {sizes} exponent")
    for name in [*CASES, *REQUESTS]:
        if options.only in name:
            base, *counts = (count(options.command, name, size) for size in (1, *sizes))
            print(row(name, sizes, [one - base for one in counts]), flush=True)


def row(name: str, sizes: list[int], counts: list[int]) -> str:
    """The counts, and how they grow from the first size to the last."""
    cells = " ".join(f"{one / 1e6:9.1f}" for one in counts)
    exponent = math.log(counts[-1] / counts[0]) / math.log(sizes[-1] / sizes[0])
    return f"{name:40} {cells} {exponent:8.2f}"


def count(command: pathlib.Path, name: str, size: int) -> int:
    """The instructions that a case takes."""
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder, "log")
        valgrind = [
            *("nice", "valgrind", "--tool=callgrind"),
            *("--callgrind-out-file=/dev/null", f"--log-file={log}"),
            str(command.resolve()),
        ]
        if name in CASES:
            files, arguments = CASES[name]
            for path, text in files(size).items():
                pathlib.Path(folder, path).write_text(text)
            subprocess.run(
                [*valgrind, *arguments, "0.pyr"],
                cwd=folder,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                check=False,
            )
        else:
            request([*valgrind, "lsp"], name, size, pathlib.Path(folder, "0.pyr"))
        found = re.search(r"Collected : (\d+)", log.read_text())
    assert found, "valgrind has counted nothing"
    return int(found[1])


def request(server: list[str], name: str, size: int, path: pathlib.Path) -> None:
    """Opens a program and sends one request about it."""
    program, method, params = REQUESTS[name]
    uri = f"file://{path}"
    document = {"uri": uri, "languageId": "pydslrep", "version": 1}
    client = Client(server, SLOW)
    opened = {"textDocument": document | {"text": program(size)}}
    client.tell("textDocument/didOpen", opened)
    client.ask(method, {"uri": uri, "textDocument": {"uri": uri}} | params)
    client.ask("shutdown", None)
    client.tell("exit", None)
    client.process.wait()


if __name__ == "__main__":
    os.environ.setdefault("NO_COLOR", "1")
    main()
