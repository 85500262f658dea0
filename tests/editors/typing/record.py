"""Types programs key by key into a real editor and compares its buffer with the program.

See README.md.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from corpus import FEW, Program, other_files, programs, ragged
from drivers import EDITORS, LEAVE_SECOND_BRACES, Editor
from keystrokes import Stroke, strokes
from session import ROOT, open_session

PACES = (30, 70, 150)
# How long saving a file may take, seconds: the editor may have keys to handle before.
TIMEOUT = 30.0
SIGNS = {
    " ": "␣",
    "Enter": "⏎\n        ",
    "Tab": "⇥",
    "C-u": "⌫",
    "BSpace": "⌫",
    "Down": "↓",
    "End": "⇲",
    "Right": "→",
}


@dataclass(frozen=True)
class Task:
    """A program and the milliseconds between keys."""

    program: Program
    pace: int

    @property
    def file(self) -> str:
        """The file to type it into."""
        return f"{self.program.name}_{self.pace}.pyr"


@dataclass
class Outcome:
    """The result of a task."""

    task: Task
    keys: int
    seconds: float = 0.0
    problems: list[str] = field(default_factory=list)


def main() -> None:
    options = arguments()
    chosen = list(tasks(options))
    shares = [chosen[number :: options.jobs] for number in range(options.jobs)]
    with ThreadPoolExecutor(options.jobs) as pool:
        shared = pool.map(
            lambda share: record(options.editor, share, options.patient), shares
        )
        outcomes = [outcome for share in shared for outcome in share]
    failed = [outcome for outcome in outcomes if outcome.problems]
    for pace in sorted({outcome.task.pace for outcome in outcomes}):
        print(
            summary(options.editor, [one for one in outcomes if one.task.pace == pace])
        )
    sys.exit(1 if failed or not outcomes else 0)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="run.sh typing", description=__doc__)
    parser.add_argument("--editor", choices=EDITORS, required=True)
    parser.add_argument(
        "--all", action="store_true", help="all programs, at every pace"
    )
    parser.add_argument("--programs", metavar="GLOB", help="programs whose names match")
    parser.add_argument(
        "--pace", type=int, action="append", help="milliseconds per key"
    )
    parser.add_argument(
        "--patient",
        action="store_true",
        help="wait for an editor that is behind, so that the machine's speed does not matter",
    )
    parser.add_argument("--jobs", type=int, default=1, help="editors at the same time")
    return parser.parse_args()


def tasks(options: argparse.Namespace) -> Iterator[Task]:
    """The tasks that the options select."""
    for number, program in enumerate(programs()):
        if program.is_printed and options.editor in LEAVE_SECOND_BRACES:
            continue
        if options.programs:
            is_chosen = fnmatch(program.name, options.programs)
        else:
            is_chosen = options.all or program.name in FEW
        if is_chosen:
            for pace in options.pace or paces(program, number, options.all):
                yield Task(program, pace)


def paces(program: Program, number: int, is_all: bool) -> tuple[int, ...]:
    """The paces for a program. Those that differ only by chance take turns; the few of the test command are typed at the fastest."""
    if not is_all:
        return PACES[:1]
    return (PACES[number % len(PACES)],) if program.is_generated else PACES


def record(name: str, share: list[Task], patient: bool = False) -> list[Outcome]:
    """Types programs one after the other into an editor, which is restarted after a failure."""
    outcomes: list[Outcome] = []
    left = list(share)
    while left:
        with open_session(name.partition("-")[0]) as session:
            # Its settings file makes the folder a project, in which all programs are read.
            write(session.program.parent, {**other_files(), "pydslrep.toml": ""})
            editor = EDITORS[name](session)
            editor.is_patient = patient
            try:
                prepare(editor.work, left)
                while left:
                    outcomes.append(typed(editor, left.pop(0)))
                    show(outcomes[-1])
                    if outcomes[-1].problems:
                        break
            finally:
                editor.close()
    return outcomes


def write(folder: Path, files: dict[str, str]) -> None:
    """Writes files into a folder."""
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)


def prepare(work: Path, left: list[Task]) -> None:
    """Creates empty files and the imports of programs."""
    shutil.copytree(ROOT / "examples" / "parts", work / "parts")
    for task in left:
        (work / task.file).touch()


def typed(editor: Editor, task: Task) -> Outcome:
    """Types a program into its file and compares."""
    file = editor.work / task.file
    program = task.program
    all_strokes = strokes(
        program.text, editor.behaviour, tabs=program.tabs, as_written=program.is_printed
    )
    keys = [stroke.key for stroke in all_strokes]
    editor.open(file)
    outcome = Outcome(task, len(keys), editor.type(keys, task.pace / 1000))
    editor.save()
    outcome.problems += editor.problems()
    text = saved(file, program)
    if not program.matches(text):
        outcome.problems.append(difference(program.text, text, all_strokes))
        if program.is_printed:
            outcome.problems += [f"ragged: {line}" for line in ragged(text)]
        if not text:
            outcome.problems.append(editor.screen())
    return outcome


def saved(file: Path, program: Program) -> str:
    """The text of a saved file; waits for that of the program."""
    until = time.monotonic() + TIMEOUT
    while True:
        # Helix moves the file while it writes.
        text = file.read_text() if file.exists() else ""
        if program.matches(text) or time.monotonic() > until:
            return text
        time.sleep(0.02)


def difference(program: str, text: str, typed: list[Stroke]) -> str:
    """The first line that differs, and its keys."""
    if not text:
        return "nothing was saved"
    wanted, found = program.split("\n"), text.split("\n")
    pairs = zip(wanted, [*found, *[""] * len(wanted)], strict=False)
    number = next(
        (n for n, (one, other) in enumerate(pairs) if one != other), len(wanted)
    )
    around = [stroke.key for stroke in typed if number - 1 <= stroke.line <= number + 1]
    line = wanted[number] if number < len(wanted) else "(the end)"
    shown = "\n              ".join(found[number : number + 3])
    keys = "".join(SIGNS.get(key, key) for key in around)
    # Of what has passed when it was tried again, only the first line is printed.
    said = f"line {number + 1}: {found[number : number + 1]} instead of {[line]}"
    return f"{said}\n  in buffer:  {shown}\n  keys: {keys}"


def show(outcome: Outcome) -> None:
    """Prints the result of a task."""
    verdict = "FAIL" if outcome.problems else "ok  "
    print(
        f"{verdict} {outcome.task.program.name} at {outcome.task.pace} ms", flush=True
    )
    for problem in outcome.problems:
        print("     " + problem.replace("\n", "\n     "), flush=True)


def summary(editor: str, outcomes: list[Outcome]) -> str:
    """A line about an editor at a pace, with the pace that this machine achieved."""
    keys = sum(outcome.keys for outcome in outcomes)
    real = sum(outcome.seconds for outcome in outcomes) * 1000 / keys
    passed = sum(not outcome.problems for outcome in outcomes)
    wanted = outcomes[0].task.pace
    count = f"{passed} of {len(outcomes)} programs as typed"
    return f"{editor} at {wanted} ms per key: {count} ({keys} keys, one every {real:.1f} ms)"


if __name__ == "__main__":
    main()
