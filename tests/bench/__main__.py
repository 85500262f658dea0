"""Language servers measured side by side, over pipes, as an editor would drive them.

    python tests/bench [--sizes 100,1000,10000] [--samples 60] "SERVER --stdio" ["OTHER SERVER --stdio"]

All servers run at once and take turns figure by figure, so that whatever else the machine does falls on all of them
alike. Times are medians in milliseconds; with two servers the last column says how many times the first one's time is the
second one's.
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
    """Reads the command line, measures and prints."""
    options = arguments()
    commands = [shlex.split(command) for command in options.servers]
    print(row("cold start, 100 lines", "", [cold(command) for command in commands]))
    for size in map(int, options.sizes.split(",")):
        measure(commands, size, options.samples)


def arguments() -> argparse.Namespace:
    """What was asked for."""
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
    """Seconds; `None` where a server cannot do it."""
    step, capability = FIGURES[name]
    if capability and not bench.client.has(capability):
        return None
    taken: list[float] = []
    began = time.perf_counter()
    # Whatever is typed has to be taken back, so the number of steps is even.
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
    """One line of the table."""
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
