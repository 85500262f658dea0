"""Shared by the tests of all terminal editors: a private home folder, a program with an error, and checks."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs" / "images" / "editors"

PROGRAM = """\
// Drives along the fence and turns where it ends.
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front : distance

robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }

movement patrol of rover {
      move 4.0 meters at 9.0
  turn right until { front }
}

movement home of rovr {
  turn left 180
}

environment yard has { rover } robots with { patrol home } moves
"""

# The error in it, and the quick fix.
MESSAGE = "there is no robot called `rovr`"
FIX = "[Cc]hange to `rover`"
FIXED = "movement home of rover"


@dataclass
class Session:
    """A home folder with the server on its path."""

    editor: str
    home: Path

    @property
    def program(self) -> Path:
        """The program to edit."""
        return self.home / "work" / "patrol.pyr"

    def environment(self) -> dict[str, str]:
        """Variables that isolate the editor from the user's settings."""
        folders = {
            "CONFIG": ".config",
            "DATA": ".local/share",
            "STATE": ".local/state",
            "CACHE": ".cache",
        }
        variables = {
            f"XDG_{name}_HOME": str(self.home / folder)
            for name, folder in folders.items()
        }
        path = f"{self.home / 'bin'}:{os.environ['PATH']}"
        return {
            **variables,
            "HOME": str(self.home),
            "XDG_RUNTIME_DIR": str(self.home),
            "PATH": path,
        }

    def set_up(self) -> None:
        """Runs the set-up in the editor's readme, with the real folder."""
        readme = (ROOT / "editors" / self.editor / "README.md").read_text()
        script = re.search(r"^```sh\n(.*?)^```", readme, re.M | re.S)
        assert script, "the readme has no set-up"
        commands = script[1].replace("/path/to/pydslrep", str(ROOT))
        variables = {**os.environ, **self.environment()}
        subprocess.run(
            ["bash", "-euc", commands], env=variables, cwd=self.home, check=True
        )

    def check(self, what: str, holds: bool, shown: str = "") -> None:
        """Reports a check and ends the session if it fails, since later checks depend on it."""
        print(("ok   " if holds else "FAIL ") + what, flush=True)
        if not holds:
            print(shown)
            sys.exit(1)


@contextmanager
def open_session(editor: str) -> Iterator[Session]:
    """A session in a scratch folder."""
    server = os.environ.get(
        "PYDSLREP_LSP", str(ROOT / "target" / "debug" / "pydslrep-lsp")
    )
    if not Path(server).exists():
        sys.exit(f"{server} is missing: run cargo build, or set PYDSLREP_LSP")
    # An exiting editor may still write files.
    with tempfile.TemporaryDirectory(
        prefix="pydslrep-", ignore_cleanup_errors=True
    ) as folder:
        session = Session(editor, Path(folder))
        for name in ("bin", "work", ".config"):
            (session.home / name).mkdir()
        (session.home / "bin" / "pydslrep-lsp").symlink_to(Path(server).resolve())
        session.program.write_text(PROGRAM)
        yield session
