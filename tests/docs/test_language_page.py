"""The reference says what the language cannot say, and what to write instead."""

from __future__ import annotations

import re

from pages import ROOT

PAGE = (ROOT / "docs" / "language.md").read_text(encoding="utf-8")
MISSING = (
    "`and`", "`or`", "all sensors", "counter", "variable", "parameter", "endless loop", "interrupt",
    "what ended an action", "`move` backwards without a distance",
)  # fmt: skip


def test_what_cannot_be_said_has_something_instead() -> None:
    section = re.search(r"^### What cannot be said\n(.*?)^#", PAGE, re.M | re.S)
    assert section
    rows = re.findall(r"^\| (.+?) \| (.+) \|$", section[1], re.M)[1:]
    assert all(instead.strip("- ") for _, instead in rows[1:])
    for words in MISSING:
        assert any(words in what for what, _ in rows), words
