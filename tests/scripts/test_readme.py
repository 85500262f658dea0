"""The script that the README shows is the one of its program."""

from __future__ import annotations

import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).parents[2]


def test_the_program_has_that_script(command: str, tmp_path: pathlib.Path) -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    section = readme.split("\n## A program and its script\n")[1].split("\n## ")[0]
    program, script = re.findall(r"```\w*\n(.*?)```\n", section, re.DOTALL)
    path = tmp_path / "table2.pyr"
    path.write_text(program, encoding="utf-8")
    done = subprocess.run(
        [command, "build", "--stdout", path],
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == script
    table = (ROOT / "tests/paper/table2_two_wheels.pyr").read_text(encoding="utf-8")
    assert program == table.replace("19999", "23000")
