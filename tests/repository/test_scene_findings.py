"""The tables of findings in docs/coppeliasim.md and docs/ros2.md are generated from the rules: `UPDATE_EXPECT=1` writes them."""

import os
import re
from pathlib import Path

import pytest
from pydslrep_runtime import ros2_findings
from pydslrep_runtime.scene import findings
from pydslrep_runtime.scene.findings import Rule

DOCS = Path(__file__).resolve().parents[2] / "docs"
MARK = "<!-- The table is generated from python/pydslrep_runtime/{}. -->\n"
TABLES = {
    "coppeliasim.md": ("scene/findings.py", findings.RULES),
    "ros2.md": ("ros2_findings.py", ros2_findings.RULES),
}


def table(rules: tuple[Rule, ...]) -> str:
    rows = ["| finding | | what to do |\n|---|---|---|\n"]
    for rule in rules:
        help_text = re.sub(r"\{(\w+)[^}]*\}", r"*\1*", rule.help)
        help_text = help_text[0].upper() + help_text[1:]
        rows.append(
            f"| {rule.title} (`{rule.code}`) | {rule.severity} | {help_text}. |\n"
        )
    return "".join(rows)


@pytest.mark.parametrize("name", TABLES)
def test_the_table_is_up_to_date(name: str) -> None:
    source, rules = TABLES[name]
    page = DOCS / name
    top, mark, rest = page.read_text(encoding="utf-8").partition(MARK.format(source))
    assert mark
    _, _, bottom = rest.lstrip("\n").partition("\n\n")
    text = f"{top}{mark}\n{table(rules)}" + (f"\n{bottom}" if bottom else "")
    if os.environ.get("UPDATE_EXPECT"):
        page.write_text(text, encoding="utf-8")
    assert page.read_text(encoding="utf-8") == text, "run it with UPDATE_EXPECT=1"


@pytest.mark.parametrize("name", TABLES)
def test_rules_have_one_form(name: str) -> None:
    for rule in TABLES[name][1]:
        assert re.fullmatch(r"[a-z]+(-[a-z]+)*", rule.code)
        assert rule.title[0].isupper()
        for text in (rule.title, rule.message, rule.help):
            assert not text.endswith("."), text
            assert "|" not in text, text
