"""The benchmark runs and our server's responses are right; times are not tested."""

from __future__ import annotations

import pathlib
import subprocess
import sys

from program import program


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


def test_the_program_has_no_problems(command: str, tmp_path: pathlib.Path) -> None:
    # Else every keystroke would also transfer what is found elsewhere.
    path = tmp_path / "program.pyr"
    path.write_text(program(100).text, encoding="utf-8")
    done = subprocess.run(
        [command, "check", path], capture_output=True, text=True, check=False
    )
    assert done.stdout == "No problems in 1 file.\n", done.stdout


def test_control_is_measured() -> None:
    bench = pathlib.Path(__file__).with_name("control.py")
    options = ["--robots", "1,2", "--runs", "1"]
    done = subprocess.run(
        [sys.executable, bench, *options], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [line.split(": ")[0] for line in lines] == ["1 robots", "2 robots"]
