"""The benchmark runs and our server's responses are right; times are not tested."""

from __future__ import annotations

import pathlib
import subprocess
import sys


def test_every_figure_can_be_taken(command: str) -> None:
    bench = pathlib.Path(__file__).parent
    done = subprocess.run(
        [
            sys.executable,
            str(bench),
            "--sizes",
            "100",
            "--samples",
            "2",
            f"{command} lsp",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    rows = done.stdout.splitlines()
    assert len(rows) == 12, done.stdout
    assert not any("n/a" in row for row in rows), done.stdout
