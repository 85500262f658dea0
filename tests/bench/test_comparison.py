"""The comparison shows the figures of comparison.json: `UPDATE_EXPECT=1` writes its table."""

from __future__ import annotations

import hashlib
import os
import pathlib

import comparison
import pytest

DOCS = pathlib.Path(__file__).parents[2] / "docs"
START, END = "<!-- figures: made by tests/bench -->\n", "<!-- end of figures -->"


def test_the_table_is_up_to_date() -> None:
    page = DOCS / "comparison.md"
    before, rest = page.read_text(encoding="utf-8").split(START)
    _, after = rest.split(END)
    expected = f"{before}{START}\n{comparison.table()}\n\n{END}{after}"
    if os.environ.get("UPDATE_EXPECT"):
        page.write_text(expected, encoding="utf-8")
    assert page.read_text(encoding="utf-8") == expected, "run it with UPDATE_EXPECT=1"


def test_the_plot_is_up_to_date() -> None:
    digest = hashlib.sha256(comparison.FIGURES.read_bytes()).hexdigest()
    plot = (DOCS / "images" / "comparison.svg").read_text(encoding="utf-8")
    assert digest in plot, "run tests/bench/comparison_plot.py"


def test_the_smallest_value_of_several_runs_counts(tmp_path: pathlib.Path) -> None:
    row = '[{"figure": "open", "lines": 100, "values": {"textX": %s, "Langium": null}}]'
    files = [tmp_path / name for name in ("a", "b", "c")]
    for file, value in zip(files, ("2.5", "1.5", "2.0"), strict=True):
        file.write_text(row % value, encoding="utf-8")
    assert comparison.read(files) == {comparison.Key("open", 100, "textX"): 1.5}


@pytest.mark.parametrize(
    ("value", "ours", "expected"),
    [
        (None, 0.1, ""),
        (0.1, 0.1, "0.1"),
        (0.25, 0.1, f"0.25 (2.5 {comparison.TIMES})"),
        (1200.0, 0.1, f"1200 (12000 {comparison.TIMES})"),
        (50.0, None, "50"),
    ],
)
def test_cells(value: float | None, ours: float | None, expected: str) -> None:
    assert comparison.cell(value, ours) == expected
