"""The page on reliability names every fault that the hostile tests inject."""

import pathlib
import re

ROOT = pathlib.Path(__file__).parents[2]
HOSTILE = ROOT / "tests" / "hostile"


def test_the_table_has_a_row_for_every_fault() -> None:
    tests = "".join(file.read_text() for file in HOSTILE.glob("test_*.py"))
    reported = set(re.findall(r'report\(f?"(\w+)', tests))
    rows = re.findall(
        r'^    "(\w+)": \(\n        "([^"]+)"', (HOSTILE / "table.py").read_text(), re.M
    )
    assert reported == {name for name, _ in rows}
    page = (ROOT / "docs" / "reliability.md").read_text()
    for _, fault in rows:
        assert re.search(
            rf"^\| {re.escape(fault)} \| [\d ]*[1-9][\d ]* \|", page, re.M
        ), fault
