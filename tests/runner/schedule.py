"""Runs jobs, some at a time, each as soon as what it needs is there."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

from jobs import Job
from results import Failure, Results

LIMIT = 60 * 60.0
"""After how many seconds a command counts as hung, however busy the machine is: alone, none needs a quarter of that."""

NOTICED = 1.0
"""Within how many seconds an interrupt is noticed."""


@dataclass
class Outcome:
    """What came of a job."""

    job: Job
    log: Path
    succeeded: bool
    seconds: float
    processor_seconds: float = 0.0
    """The processor time of its processes, as far as it waited for them."""
    results: Results = field(default_factory=Results)
    retried: list[Failure] = field(default_factory=list)
    """What failed at first and then passed."""
    missing: str = ""
    """The job without which this one could not run."""


class Schedule:
    """Jobs and the processors that they share."""

    def __init__(
        self,
        jobs: list[Job],
        run: Callable[[Job], Outcome],
        told: Callable[[Outcome], None],
    ):
        self.left = list(jobs)
        self.names = {job.name for job in jobs}
        self.run = run
        self.told = told
        self.outcomes: dict[str, Outcome] = {}
        self.running: dict[Future[Outcome], Job] = {}
        # One more than there are: tests wait for processes, and the compiler for the end of the crate that all others need.
        self.processors = (os.cpu_count() or 1) + 1

    def finish(self) -> list[Outcome]:
        """Runs everything, and returns what came of it in the order in which it ended; raises KeyboardInterrupt after
        `Commands.interrupt`.
        """
        with ThreadPoolExecutor(max_workers=len(self.left) or 1) as pool:
            try:
                self.run_all(pool)
            except BaseException:
                # Before the pool is left, which waits for what runs.
                Commands.interrupt()
                raise
        if Commands.interrupted:
            raise KeyboardInterrupt
        return list(self.outcomes.values())

    def run_all(self, pool: ThreadPoolExecutor) -> None:
        """Runs what is left, until an interrupt."""
        while (self.left or self.running) and not Commands.interrupted:
            self.skip()
            while job := self.next():
                self.left.remove(job)
                self.running[pool.submit(self.run, job)] = job
            if self.running:
                # Not without a limit: a signal that comes right before the main thread begins to wait does not wake it.
                done, _ = wait(self.running, NOTICED, return_when=FIRST_COMPLETED)
                for future in done:
                    del self.running[future]
                    if not Commands.interrupted:
                        self.end(future.result())

    def next(self) -> Job | None:
        """The job that begins now: the first of which everything is there, as soon as there is a place for it.

        No later one takes that place: one that needs several processors would wait for the end of all others.
        """
        busy = sum(other.processors for other in self.running.values())
        for job in self.left:
            if self.is_ready(job):
                has_place = not busy or busy + job.processors <= self.processors
                return job if has_place else None
        return None

    def is_ready(self, job: Job) -> bool:
        """Whether what a job needs has ended, and no other one builds if it does."""
        waits = job.cargo and any(other.cargo for other in self.running.values())
        return not waits and all(name in self.outcomes for name in self.before(job))

    def before(self, job: Job) -> list[str]:
        """The jobs of this run that must have ended first."""
        return [name for name in job.after if name in self.names]

    def skip(self) -> None:
        """Ends jobs that cannot run because something that they need has failed."""
        for job in list(self.left):
            ended = [self.outcomes[name] for name in job.after if name in self.outcomes]
            if lost := [
                one.job.name for one in ended if one.job.prepares and not one.succeeded
            ]:
                self.left.remove(job)
                self.end(Outcome(job, Path(), False, 0.0, missing=lost[0]))

    def end(self, outcome: Outcome) -> None:
        """Notes what came of a job."""
        self.outcomes[outcome.job.name] = outcome
        self.told(outcome)


@dataclass
class Commands:
    """Runs the commands of a job, with their output in a file."""

    root: Path
    variables: dict[str, str]
    log: Path
    limit: float
    processor_seconds: float = 0.0
    groups: ClassVar[set[int]] = set()
    """The process groups of all commands that run. An interrupt in the terminal does not reach them by itself."""
    interrupted: ClassVar[bool] = False
    """Whether nothing more may begin."""

    def run(self, line: str) -> bool:
        """Runs a command; returns whether it succeeded. One that hangs is ended, with all its processes."""
        if self.interrupted:
            return False
        with self.log.open("a", encoding="utf-8") as file:
            print(f"$ {line}", file=file, flush=True)
            process = subprocess.Popen(
                ["bash", "-c", line],
                cwd=self.root,
                env=self.variables,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            self.groups.add(process.pid)
            if self.interrupted:
                # It came too late for `interrupt` to know of it.
                self.terminate(process.pid)
            watch = threading.Timer(self.limit, self.end, (process.pid,))
            watch.start()
            # Unlike `wait`, it says how much processor time was spent.
            _, status, usage = os.wait4(process.pid, 0)
            watch.cancel()
            self.groups.remove(process.pid)
            process.returncode = os.waitstatus_to_exitcode(status)
        self.processor_seconds += usage.ru_utime + usage.ru_stime
        return process.returncode == 0

    def end(self, group: int) -> None:
        """Ends a command that hangs."""
        with self.log.open("a", encoding="utf-8") as file:
            print(f"ended after {self.limit / 60:.0f} minutes: it hangs", file=file)
        with suppress(ProcessLookupError):
            os.killpg(group, signal.SIGKILL)

    @classmethod
    def interrupt(cls) -> None:
        """Ends all commands, and lets no other begin. It takes no lock, so that handlers of signals can call it."""
        cls.interrupted = True
        for group in list(cls.groups):
            cls.terminate(group)

    @staticmethod
    def terminate(group: int) -> None:
        """Asks the processes of a command to end."""
        with suppress(ProcessLookupError):
            os.killpg(group, signal.SIGTERM)

    def all(self, lines: Iterable[str]) -> bool:
        """Runs commands, whatever fails before; returns whether all succeeded."""
        succeeded = [self.run(line) for line in lines]
        return all(succeeded)


def runner(
    logs: Path, root: Path, variables: dict[str, str], limit: float = LIMIT
) -> Callable[[Job], Outcome]:
    """A function that runs a job in `root`, with its output in a file of `logs`."""

    def run(job: Job) -> Outcome:
        log, begin = logs / f"{job.name}.log", time.monotonic()
        log.write_text("", encoding="utf-8")
        commands = Commands(root, variables, log, limit)
        succeeded = commands.all(job.commands)
        results = job.read(log.read_text(encoding="utf-8", errors="replace"))
        retried: list[Failure] = []
        if not succeeded and job.editor and results.failures:
            again = dict.fromkeys(failure.again for failure in results.failures)
            if commands.all(again):
                succeeded, retried = True, list(results.failures)
                results = Results(results.passed + len(retried), results.skipped)
        seconds, busy = time.monotonic() - begin, commands.processor_seconds
        return Outcome(job, log, succeeded, seconds, busy, results, retried)

    return run
