"""What the test command prints: a line for each job, and at the end what failed."""

from __future__ import annotations

import re
from pathlib import Path

from results import COLOURS, Results
from schedule import Outcome

TAIL = 40
"""How many lines of a failed job's output are printed."""

VERDICT = re.compile(r"✔|✖|\u2139|==|(?:[\w-]+: )?(?:ok  |FAIL)|(?:not )?ok ")
"""The beginning of a line about one test, or about all of them."""


def line(outcome: Outcome) -> str:
    """One line about a job."""
    verdict = "ok" if outcome.succeeded else "not run" if outcome.missing else "FAILED"
    time = "" if outcome.missing else times(outcome)
    return f"{outcome.job.name:<17}{verdict:<8}{counted(outcome.results):<28}{time}"


def times(outcome: Outcome) -> str:
    """How long a job took, and how long it kept a processor busy."""
    return f"{outcome.seconds:6.0f} s {outcome.processor_seconds:6.0f} s busy"


def counted(results: Results) -> str:
    """How many tests there were."""
    if not (results.passed or results.failures):
        return ""
    parts = [f"{results.passed + len(results.failures)} tests"]
    if results.failures:
        parts.append(f"{len(results.failures)} failed")
    if results.skipped:
        parts.append(f"{results.skipped} skipped")
    return ", ".join(parts)


def end(outcomes: list[Outcome], seconds: float, root: Path) -> str:
    """What failed, with the output around it and the command that runs it again; and the sum."""
    failed = [outcome for outcome in outcomes if not outcome.succeeded]
    text = [excerpt(outcome, root) for outcome in failed if not outcome.missing]
    text += [
        f"retried: {outcome.job.name}: {one.name}: {reason(outcome, one.name)}"
        for outcome in outcomes
        for one in outcome.retried
    ]
    for outcome in failed:
        text += verdicts(outcome)
    total = sum(outcome.results.passed for outcome in outcomes)
    ended = (
        f"{total} tests passed"
        if not failed
        else f"{len(failed)} of {len(outcomes)} parts failed"
    )
    text.append(
        f"\n{ended} after {seconds // 60:.0f} min {seconds % 60:.0f} s; the output is in {(root / 'target/tests').relative_to(root)}"
    )
    return "\n".join(text)


def excerpt(outcome: Outcome, root: Path) -> str:
    """The end of a job's output."""
    lines = outcome.log.read_text(encoding="utf-8", errors="replace").splitlines()
    return "\n".join(
        [
            f"\n== {outcome.job.name}: the end of {outcome.log.relative_to(root)}",
            *lines[-TAIL:],
            "",
        ]
    )


def verdicts(outcome: Outcome) -> list[str]:
    """What failed of a job, a line each, and below it the command that runs only that."""
    name = outcome.job.name
    if outcome.missing:
        return [f"not run: {name}, because {outcome.missing} failed"]
    failures = outcome.results.failures
    if not failures:
        return [f"FAILED: {name}\n    tests/run.sh {name}"]
    return [f"FAILED: {name}: {one.name}\n    {one.again}" for one in failures]


def reason(outcome: Outcome, name: str) -> str:
    """What a failed test says, or the line that follows it. Node lists all tests first, and the reasons afterwards."""
    output = outcome.log.read_text(encoding="utf-8", errors="replace")
    lines = [line.strip() for line in COLOURS.sub("", output).splitlines()]
    lines = [line for line in lines if line]
    last = name.rpartition(": ")[2]
    failed = [
        number
        for number, text in enumerate(lines)
        if last in text and re.match(r"✖|(?:[\w-]+: )?FAIL|not ok", text)
    ]
    for number in reversed(failed):
        following = lines[number + 1 : number + 2]
        if following and not VERDICT.match(following[0]):
            return following[0]
    return lines[failed[0]] if failed else "see the output"
