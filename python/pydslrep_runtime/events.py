"""What a run reports: lines for people and, for programs that ask for them, events.

docs/run-events.md describes the events, editors/run-events.schema.json has their fields.
"""

import json
import os
import stat
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TextIO

from .errors import MovementError, SetupError, SimulatorError
from .outputs import claimed, has_keys, output_path, start_of
from .places import Place
from .pose import Pose, heading_degrees
from .readings import printable
from .version import __version__

STANDARD_OUTPUT = "-"

FileKind = Literal["trace", "map", "map-picture"]


@dataclass(frozen=True)
class Moment:
    """Where a robot is at a time in seconds, and what it is doing."""

    time: float
    robot: str
    place: Place
    text: str  # the action in words
    here: Pose


class Reporter:
    """Reports a run to people, to a program, or to both."""

    def __init__(self, file: TextIO | None = None, *, prints: bool = True) -> None:
        """`file` is what events are written to; without `prints`, people are told nothing."""
        self._file, self._prints = file, prints

    @property
    def is_read(self) -> bool:
        """Whether events are written."""
        return self._file is not None

    def started(self, environment: str, robots: Sequence[str]) -> None:
        """The run has begun; the robots are not connected yet."""
        self._write(
            "started",
            environment=environment,
            robots=list(robots),
            version=__version__,
        )

    def action_begun(self, moment: Moment) -> None:
        """A robot has begun an action."""
        self._write_moment("action-begun", moment)

    def action_ended(self, moment: Moment) -> None:
        """A robot has completed an action."""
        if self._prints:
            line = line_of(moment)
            # Names may contain anything; programs read them as they are.
            print(printable(line) if sys.stdout.isatty() else line, flush=True)
        self._write_moment("action-ended", moment)

    def contact(self, moment: Moment) -> None:
        """Something seems to be in the way of a robot: its failure says what follows from that."""
        self._write_moment("contact", moment)

    def progress(self, time: float, robot: str, text: str) -> None:
        """A robot has come further in a long action; people are not told."""
        self._write("progress", t=round(time, 6), robot=robot, text=text)

    def note(self, text: str) -> None:
        """Something is worth knowing while the run goes on."""
        if self._prints:
            print(f"note: {text}", file=sys.stderr, flush=True)
        self._write("note", text=text)

    def warning(self, text: str) -> None:
        """Something is wrong, but the run goes on."""
        if self._prints:
            print(f"warning: {text}", file=sys.stderr, flush=True)
        self._write("warning", text=text, help=None)

    def file(self, kind: FileKind, path: Path) -> None:
        """A file of results is complete."""
        self._write("file", kind=kind, path=str(path))

    def failed(self, error: Exception) -> None:
        """An error has ended the run; both may be gone: who reads the lines, and who reads the events."""
        match error:
            case MovementError():
                kind = "action"
            case SetupError():
                kind = "setup"
            case SimulatorError():
                kind = "simulator"
            case _:
                kind = "file"
        message = printable(str(error))
        self._say(f"error: {message}")
        self._write_failure(
            kind, message, error if isinstance(error, MovementError) else None
        )

    def interrupted(self) -> None:
        """The user has ended the run."""
        self._say("interrupted")
        self._write_failure("interrupted", "interrupted")

    def crashed(self, error: BaseException) -> None:
        """The script, or code that it uses, has an error. Python tells people about it."""
        self._write_failure("crash", f"{type(error).__name__}: {error}")

    def _say(self, message: str) -> None:
        if self._prints:
            with suppress(OSError):
                print(message, file=sys.stderr, flush=True)

    def _write_failure(
        self,
        kind: str,
        message: str,
        error: MovementError | None = None,
    ) -> None:
        error = error or MovementError("")
        place = Place(rounds=error.rounds, calls=error.calls)
        with suppress(OSError):
            self._write(
                "failed",
                **{"class": kind},
                message=message,
                robot=error.robot,
                movement=error.movement,
                action=error.number,
                line=error.line,
                **place.parts(),
                help=None,
                output=None,
            )

    def _write_moment(self, event: str, moment: Moment) -> None:
        here = moment.here
        self._write(
            event,
            t=round(moment.time, 6),
            robot=moment.robot,
            movement=moment.place.movement,
            action=moment.place.action,
            line=moment.place.line,
            **moment.place.parts(),
            text=moment.text,
            x=round(here.x, 6) + 0.0,  # no -0
            y=round(here.y, 6) + 0.0,
            theta=round(here.theta, 6) + 0.0,
        )

    def _write(self, event: str, **fields: object) -> None:
        if self._file is None:
            return
        line = json.dumps({"event": event, **fields}, ensure_ascii=False)
        # A path may contain what is no text.
        self._file.write(line.encode("utf-8", "replace").decode() + "\n")
        self._file.flush()


def line_of(moment: Moment) -> str:
    """An action that has ended, for people."""
    here = moment.here
    # Adding zero turns -0 into 0. The precision is that of the inlay hints in editors.
    x, y = round(here.x, 2) + 0.0, round(here.y, 2) + 0.0
    return (
        f"{moment.time:8.2f} s  {moment.robot}  {moment.place.movement}  {moment.place.way(moment.text)}  "
        f"at x {x:.2f} m, y {y:.2f} m, {heading_degrees(here.theta):g} deg"
    )


@contextmanager
def reporter(target: str | None) -> Iterator[Reporter]:
    """What reports a run whose events go to a file, to standard output (`-`), or nowhere; raises SetupError and OSError."""
    if target is None:
        yield Reporter()
    elif target == STANDARD_OUTPUT:
        with standard_output() as file:
            yield Reporter(file, prints=False)
    else:
        with events_file(Path(target)) as file:
            yield Reporter(file)


def standard_output() -> TextIO:
    """Standard output, for events alone: anything else that the process prints goes to standard error."""
    sys.stdout.flush()
    own = os.dup(1)
    os.dup2(2, 1)
    return os.fdopen(own, "w", encoding="utf-8", newline="\n")


def events_file(path: Path) -> TextIO:
    """A file for events: a new one, one with events of an earlier run, or a pipe; raises SetupError and OSError."""
    with suppress(OSError):
        mode = path.stat().st_mode
        if stat.S_ISFIFO(mode) or stat.S_ISCHR(mode):
            return path.open("w", encoding="utf-8", newline="\n")
    return claimed(output_path(path, is_events, "a file of events"))


def is_events(file: Path) -> bool:
    """Whether a file has the events of a run: its first line is enough."""
    return has_keys(start_of(file).partition(b"\n")[0], "event")


current = Reporter()
"""Of the run in this process; `use` replaces it."""


@contextmanager
def use(target: str | None) -> Iterator[Reporter]:
    """From now on, the run is reported to a target as for `reporter`."""
    global current
    before = current
    with reporter(target) as current:
        try:
            yield current
        finally:
            current = before
