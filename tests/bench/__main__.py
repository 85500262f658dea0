"""Benchmarks language servers side by side, over pipes, as an editor would drive them.

    python tests/bench [--sizes 100,1000,10000] [--samples 60] "SERVER --stdio" ["OTHER SERVER --stdio"]
    python tests/bench --only open,keystroke --json figures.json --names ours "SERVER --stdio"

All servers run in parallel and take turns for each figure, so that other load on the machine affects all of them equally.
Times are medians in milliseconds; with two servers, the last column is the first one's time divided by the second one's.
On a busy machine, `--processor` gives steadier figures: the processor time of the servers for each step, without that of other processes.
"""

from __future__ import annotations

import argparse
import json
import pathlib
import shlex
import statistics
import time
from typing import TYPE_CHECKING, NamedTuple

from client import Client
from figures import FIGURES, Bench, WrongAnswerError
from program import program

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SECONDS_PER_FIGURE = 6.0
MIN_SAMPLES = 3
COLD = "cold start"
MEMORY = "peak memory, MiB"


class Row(NamedTuple):
    """A figure for programs of a size, in ms or MiB, of each server; None if it lacks the capability."""

    figure: str
    lines: int
    values: list[float | None]

    def text(self) -> str:
        """As a line of the table."""
        cells = [
            "     n/a" if value is None else f"{value:8.2f}" for value in self.values
        ]
        ratio = ""
        if len(self.values) == 2 and self.values[0] is not None and self.values[1]:
            ratio = f"{self.values[0] / self.values[1]:8.1f}"
        return f"{self.figure:24}{self.lines:>8} {' '.join(cells)} {ratio}".rstrip()


def main() -> None:
    """Measures and prints all figures."""
    options = arguments()
    commands = [shlex.split(command) for command in options.servers]
    rows: list[Row] = []
    if COLD.startswith(options.only):
        rows.append(Row(COLD, 100, [cold(command, options) for command in commands]))
        print(rows[-1].text())
    for size in map(int, options.sizes.split(",")):
        for row in measure(commands, size, options):
            print(row.text(), flush=True)
            rows.append(row)
    if options.json:
        names = options.names or options.servers
        cells = [
            {
                "figure": row.figure,
                "lines": row.lines,
                "values": dict(zip(names, row.values, strict=True)),
            }
            for row in rows
        ]
        options.json.write_text(json.dumps(cells, indent=1) + "\n", encoding="utf-8")


def arguments() -> argparse.Namespace:
    """Parses the command line."""
    about, _, more = (__doc__ or "").partition("\n")
    parser = argparse.ArgumentParser(
        prog="python tests/bench", description=about, epilog=more
    )
    parser.add_argument(
        "servers", nargs="+", help="commands that start a server on stdio"
    )
    parser.add_argument(
        "--sizes", default="100,1000,10000", help="lines of the program"
    )
    parser.add_argument(
        "--samples", type=int, default=60, help="steps per figure, at most"
    )
    parser.add_argument(
        "--only",
        type=lambda text: tuple(text.split(",")),
        default=("",),
        help="beginnings of the figures to take",
    )
    parser.add_argument(
        "--processor",
        action="store_true",
        help="take the processor time of the servers, which other load changes less",
    )
    parser.add_argument("--json", type=pathlib.Path, help="also write the figures here")
    parser.add_argument(
        "--names",
        type=lambda text: text.split(","),
        help="the servers' names in that file",
    )
    return parser.parse_args()


def cold(command: list[str], options: argparse.Namespace) -> float:
    """Milliseconds from the start of a process to the first diagnostics."""
    samples = []
    for _ in range(MIN_SAMPLES):
        with Client(command) as client:
            client.open(program(100).text)
            _, arrived = client.settled([])
            took = arrived - client.began
            samples.append(client.processor_time() if options.processor else took)
    return 1000 * statistics.median(samples)


def measure(
    commands: list[list[str]], size: int, options: argparse.Namespace
) -> Iterator[Row]:
    """Takes the figures that are asked for, for programs of one size."""
    text = program(size)
    clients = [Client(command) for command in commands]
    benches = [Bench(client, text) for client in clients]
    for name in FIGURES:
        if name.startswith(options.only):
            yield Row(name, size, [median(bench, name, options) for bench in benches])
    if MEMORY.startswith(options.only) and all(
        client.process.poll() is None for client in clients
    ):
        peaks = [client.peak_memory() for client in clients]
        yield Row(MEMORY, size, [*peaks])
    for client in clients:
        client.stop()


def median(bench: Bench, name: str, options: argparse.Namespace) -> float | None:
    """The median in milliseconds; None if a server lacks the capability."""
    step, capability = FIGURES[name]
    if capability and not bench.client.has(capability):
        return None
    taken: list[float] = []
    began = time.perf_counter()
    # Every edit is undone by the next step, so the number of steps is even.
    while len(taken) < max(options.samples, MIN_SAMPLES + 1) or len(taken) % 2:
        taken.append(processor_time(bench, step) if options.processor else step(bench))
        if (
            time.perf_counter() - began > SECONDS_PER_FIGURE
            and len(taken) > MIN_SAMPLES
            and not len(taken) % 2
        ):
            break
    bench.restore()
    return 1000 * statistics.median(taken)


def processor_time(bench: Bench, step: Callable[[Bench], float]) -> float:
    """Seconds that the server runs for a step."""
    before = bench.client.processor_time()
    step(bench)
    return bench.client.processor_time() - before


if __name__ == "__main__":
    try:
        main()
    except WrongAnswerError as error:
        raise SystemExit(f"wrong answer: {error}") from error
