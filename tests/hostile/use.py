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
