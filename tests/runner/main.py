"""Runs every check: `tests/run.sh [--editors] [--long] [NAME...]`."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import time

import jobs
import report
from schedule import LIMIT, Commands, Schedule, runner

# How much the tests with an amount of their own do at full length.
AMOUNTS = {
    "PYDSLREP_EDITS": "1000000",
    "PYDSLREP_COMPARE_EVERY": "25",
    "PYDSLREP_COMPLETED": "1000",
    "PYDSLREP_PROGRAMS": "100000",
    "PYDSLREP_MUTATIONS": "2000",
    "PYDSLREP_HOSTILE": "50",
    "PYDSLREP_KEYSTROKES": "144000",
    "PYDSLREP_REFACTORED": "500",
}


def main() -> None:
    """Runs what the arguments choose; exits with 1 if something failed."""
    options = arguments()
    # In the background of a shell, SIGINT is ignored; and SIGTERM has to end the commands, too. An exception from a handler
    # could come where a lock of the pool is taken, and nothing would end any more.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: Commands.interrupt())
    begin = time.monotonic()
    jobs.LOGS.mkdir(parents=True, exist_ok=True)
    limit = 24 * LIMIT if options.long else LIMIT
    run = runner(jobs.LOGS, jobs.ROOT, variables(options.long), limit)
    schedule = Schedule(
        jobs.chosen(options.names, options.editors, options.long),
        run,
        lambda outcome: print(report.line(outcome), flush=True),
    )
    try:
        outcomes = schedule.finish()
    except KeyboardInterrupt:
        sys.exit(f"interrupted; the output so far is in {jobs.LOGS}")
    print(report.end(outcomes, time.monotonic() - begin, jobs.ROOT))
    sys.exit(0 if all(outcome.succeeded for outcome in outcomes) else 1)


def arguments() -> argparse.Namespace:
    names = [job.name for job in jobs.every()]
    parser = argparse.ArgumentParser(prog="tests/run.sh", description=__doc__)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"only this: {', '.join(names)}"
    )
    parser.add_argument(
        "--editors",
        action="store_true",
        help="also in real editors and browsers, which it installs on Debian-based systems",
    )
    parser.add_argument(
        "--long",
        action="store_true",
        help="everything at full length, which takes hours",
    )
    options = parser.parse_args()
    if unknown := [name for name in options.names if name not in names]:
        parser.error(f"there is no {unknown[0]}; choose from {', '.join(names)}")
    return options


def variables(long: bool) -> dict[str, str]:
    """The environment of all jobs."""
    found = os.environ | {
        # Some images forbid it; then every one of hundreds of scripts compiles again what it imports.
        "PYTHONDONTWRITEBYTECODE": "",
        "PYDSLREP": str(jobs.BUILT / "pydslrep"),
        "PYDSLREP_LSP": str(jobs.BUILT / "pydslrep-lsp"),
        "RANDOM_PROGRAMS": str(jobs.BUILT / "random-programs"),
        "PYDSLREP_WEB": str(jobs.ROOT / "editors/web/dist"),
        "PYDSLREP_PLAYGROUND": str(jobs.ROOT / "editors/playground/dist"),
    }
    if long:
        found |= {"LONG": "1", **AMOUNTS}
    if "CI" in found:
        # Only the next build would save what incremental compilation costs, and nobody is there to read debug information.
        found |= {"CARGO_INCREMENTAL": "0", "CARGO_PROFILE_DEV_DEBUG": "false"}
        # Clippy looks at crates while they are compiled, and not at all of them and their dependencies a second time.
        # Elsewhere, people build without it, and would compile all crates again.
        found |= {"RUSTC_WORKSPACE_WRAPPER": "clippy-driver"}
    return found


if __name__ == "__main__":
    main()
