"""Benchmarks language servers side by side, over pipes, as an editor would drive them.

    python tests/bench [--sizes 100,1000,10000] [--samples 60] "SERVER --stdio" ["OTHER SERVER --stdio"]

All servers run in parallel and take turns for each figure, so that other load on the machine affects all of them equally.
Times are medians in milliseconds; with two servers, the last column is the first one's time divided by the second one's.
"""

from __future__ import annotations

import argparse
import shlex
import statistics
import time

from client import Client
from figures import FIGURES, Bench, WrongAnswerError
from program import program

SECONDS_PER_FIGURE = 6.0
FEWEST = 3


def main() -> None:
    """Measures and prints all figures."""
    options = arguments()
    commands = [shlex.split(command) for command in options.servers]
    print(row("cold start, 100 lines", "", [cold(command) for command in commands]))
    for size in map(int, options.sizes.split(",")):
        measure(commands, size, options.samples)


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
    return parser.parse_args()


def cold(command: list[str]) -> float:
    """Seconds from the start of a process to the first diagnostics."""
    samples = []
    for _ in range(FEWEST):
        with Client(command) as client:
            client.open(program(100).text)
            _, arrived = client.settled([])
            samples.append(arrived - client.began)
    return statistics.median(samples)


def measure(commands: list[list[str]], size: int, samples: int) -> None:
    """Prints all figures for programs of one size."""
    text = program(size)
    clients = [Client(command) for command in commands]
    benches = [Bench(client, text) for client in clients]
    for name in FIGURES:
        print(row(name, size, [median(bench, name, samples) for bench in benches]))
    if all(client.process.poll() is None for client in clients):
        peaks = [client.peak_memory() for client in clients]
        print(row("peak memory, MiB", size, [peak / 1000 for peak in peaks]))
    for client in clients:
        client.stop()


def median(bench: Bench, name: str, samples: int) -> float | None:
    """The median in seconds; None if a server lacks the capability."""
    step, capability = FIGURES[name]
    if capability and not bench.client.has(capability):
        return None
    taken: list[float] = []
    began = time.perf_counter()
    # Every edit is undone by the next step, so the number of steps is even.
    while len(taken) < max(samples, FEWEST + 1) or len(taken) % 2:
        taken.append(step(bench))
        if (
            time.perf_counter() - began > SECONDS_PER_FIGURE
            and len(taken) > FEWEST
            and not len(taken) % 2
        ):
            break
    return statistics.median(taken)


def row(name: str, size: object, times: list[float | None]) -> str:
    """One row of the table."""
    cells = [
        "     n/a" if seconds is None else f"{seconds * 1000:8.2f}" for seconds in times
    ]
    ratio = ""
    if len(times) == 2 and times[0] is not None and times[1]:
        ratio = f"{times[0] / times[1]:8.1f}"
    return f"{name:24}{size!s:>8} {' '.join(cells)} {ratio}".rstrip()


if __name__ == "__main__":
    try:
        main()
    except WrongAnswerError as error:
        raise SystemExit(f"wrong answer: {error}") from error
