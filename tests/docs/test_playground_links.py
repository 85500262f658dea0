"""The site's links that open a program of the pages in the playground."""

from __future__ import annotations

import base64
import html
import importlib.util
import json
import re
import sys
import zlib
from pathlib import Path, PurePosixPath
from types import ModuleType
from typing import Any

import pytest
from pages import PAGES, ROOT, blocks

LINK = re.compile(r'<a href="([^"#]+)#project=([\w-]+)">Open in the playground</a>')


@pytest.fixture
def build(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The site's builder, with a playground that is built."""
    folder = ROOT / "docs" / "site"
    monkeypatch.syspath_prepend(str(folder))
    spec = importlib.util.spec_from_file_location("site_build", folder / "build.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "site_build", module)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "PLAYGROUND", tmp_path)
    monkeypatch.setattr(module, "SOURCE", tmp_path / "src")
    return module


def programs_in(text: str) -> list[tuple[str, dict[str, Any]]]:
    """The page that each link of a page leads to, and the project in it."""
    found = []
    for target, packed in LINK.findall(html.unescape(text)):
        raw = base64.urlsafe_b64decode(packed + "=" * (-len(packed) % 4))
        found.append((target, json.loads(zlib.decompress(raw, wbits=-zlib.MAX_WBITS))))
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_whole_program_has_a_link_that_holds_it(
    page: Path, build: ModuleType
) -> None:
    path = PurePosixPath(page.relative_to(ROOT))
    expected = [
        block.code
        for block in blocks(page)
        if block.language == "pydslrep"
        and "fragment" not in block.info
        and not re.search(r"^\s*import\b", block.code, re.M)
    ]
    pages = {PurePosixPath(page.relative_to(ROOT)) for page in PAGES}
    links = programs_in(build.Page(path, pages).text())
    assert [project["program"] for _, project in links] == expected
    for target, project in links:
        assert project["name"] == "program"
        there = (build.place(path).parent / target).as_posix()
        assert re.sub(r"[^/.]+/\.\./", "", there) == "playground/index.html"


def test_without_a_playground_there_are_no_links(
    build: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(build, "PLAYGROUND", tmp_path / "none")
    tutorial = PurePosixPath("docs/tutorial.md")
    assert programs_in(build.Page(tutorial, {tutorial}).text()) == []
