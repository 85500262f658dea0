"""The table of findings in docs/coppeliasim.md is generated from the rules: `UPDATE_EXPECT=1` writes it."""

import os
import re
from pathlib import Path

from pydslrep_runtime.scene.findings import RULES

PAGE = Path(__file__).resolve().parents[2] / "docs" / "coppeliasim.md"
MARK = (
    "<!-- The table is generated from python/pydslrep_runtime/scene/findings.py. -->\n"
)


def table() -> str:
    rows = ["| finding | | what to do |\n|---|---|---|\n"]
    for rule in RULES:
        help_text = re.sub(r"\{(\w+)[^}]*\}", r"*\1*", rule.help)
        help_text = help_text[0].upper() + help_text[1:]
        rows.append(
            f"| {rule.title} (`{rule.code}`) | {rule.severity} | {help_text}. |\n"
        )
    return "".join(rows)


def test_the_table_is_up_to_date() -> None:
    top, mark, rest = PAGE.read_text(encoding="utf-8").partition(MARK)
    assert mark
    _, _, bottom = rest.lstrip("\n").partition("\n\n")
    page = f"{top}{mark}\n{table()}" + (f"\n{bottom}" if bottom else "")
    if os.environ.get("UPDATE_EXPECT"):
        PAGE.write_text(page, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == page, "run it with UPDATE_EXPECT=1"


def test_rules_have_one_form() -> None:
    for rule in RULES:
        assert re.fullmatch(r"[a-z]+(-[a-z]+)*", rule.code)
        assert rule.title[0].isupper()
        for text in (rule.title, rule.message, rule.help):
            assert not text.endswith("."), text
            assert "|" not in text, text
