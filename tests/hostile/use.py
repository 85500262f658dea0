"""What a process uses."""

from __future__ import annotations

import os
import pathlib
from dataclasses import dataclass


@dataclass(frozen=True)
class Use:
    """What a process uses."""

    memory: int  # bytes
    files: int
    threads: int

    @classmethod
    def of(cls, process: int) -> Use:
        """The current use."""
        folder = pathlib.Path(f"/proc/{process}")
        pages = int((folder / "statm").read_text().split()[1])
        return cls(
            pages * os.sysconf("SC_PAGE_SIZE"),
            sum(1 for _ in (folder / "fd").iterdir()),
            sum(1 for _ in (folder / "task").iterdir()),
        )


def is_at_rest(process: int) -> bool:
    """Whether every thread of a process waits for something, and none has had anything to do between two looks."""

    def states() -> list[tuple[str, str, str]]:
        found = []
        for task in sorted(pathlib.Path(f"/proc/{process}/task").iterdir()):
            status = dict(
                line.split(":\t", 1)
                for line in (task / "status").read_text().splitlines()
                if ":\t" in line
            )
            found.append(
                (task.name, status["State"][:1], status["voluntary_ctxt_switches"])
            )
        return found

    before = states()
    return all(state == "S" for _, state, _ in before) and states() == before
