"""Robots explore generated worlds by odometry, though their tracks and wheels are others than they know: with `--long` only.

`odometry_table.py` prints the same runs as a table; `python/tests/test_calibration.py` is the short subset.
"""

from __future__ import annotations

import pathlib

import pytest
from odometry_table import RUNS, Run, explore, row_of


@pytest.mark.long
@pytest.mark.parametrize("run", RUNS, ids=str)
def test_generated_worlds(command: str, tmp_path: pathlib.Path, run: Run) -> None:
    result = explore(command, run, tmp_path)
    assert result.is_good, row_of(run, result)
