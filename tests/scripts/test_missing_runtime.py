"""Without the runtime, a script's error says how to get it: Python prints the first line of the import."""

from __future__ import annotations

import pathlib
import subprocess
import sys

import pytest

SNAPSHOTS = pathlib.Path(__file__).parents[2] / "crates" / "script" / "snapshots"


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("area_1", "pydslrep build"),
        ("area_1_vrep", "pydslrep build --target vrep table2.pyr"),
        ("factory", "pydslrep build table2.pyr"),
    ],
)
def test_the_error_says_how_to_get_the_runtime(name: str, hint: str) -> None:
    script = SNAPSHOTS / f"{name}.py"
    # Isolated: nothing is imported from this folder or the user's packages.
    done = subprocess.run(
        [sys.executable, "-I", "-S", script],
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 1
    lines = done.stderr.splitlines()
    assert any(line.endswith(f"  # if missing: {hint}") for line in lines), done.stderr
    assert lines[-1] == "ModuleNotFoundError: No module named 'pydslrep_runtime'"
