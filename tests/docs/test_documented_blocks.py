"""Every block of code in the documentation: programs are checked, commands run, files valid, pictures made.

* A paragraph that ends in a file's name and a colon makes the next block that file; if it says *Append*, the block goes to
  the file's end.
* `pydslrep`: a program without errors and warnings. With `wrong`, it has some; with `fragment`, it is a part of a program
  and only its syntax is checked.
* `console`: commands after `$`, with their output. `sh`: commands that are looked up, and run if the block says `run`. With
  `slow`, either is run at full length only (`tests/run.sh --long`), and when outputs are written anew.
* A picture of a page that its commands make is the one that they make.

`UPDATE_EXPECT=1` writes outputs and pictures anew.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import jsonschema  # type: ignore[import-untyped]
import pytest
from pages import PAGES, ROOT, Block, Session, blocks, commands, comparable, pictures

UPDATE = "UPDATE_EXPECT" in os.environ
IS_PATIENT = UPDATE or "LONG" in os.environ
SCHEMAS = [
    json.loads((ROOT / "editors" / name).read_text(encoding="utf-8"))
    for name in ("pydslrep.schema.json", "scene.schema.json")
]

# A fragment that begins with one of these is a part of a movement.
ACTION = re.compile(r"(move|turn|wait|repeat|if|do|slam)\b")

# What nothing here can check: drawings of text, formulas, and the settings of editors, which their tests use.
UNCHECKED = {"", "elisp", "lua", "text", "ebnf", "math"}
# tests/repository/test_protocol_types.py compares these with the server's types.
ELSEWHERE = {"typescript"}

ALL = [block for page in PAGES for block in blocks(page)]
RUN = {"console", "pydslrep"}


def is_runnable(block: Block) -> bool:
    """Whether a block takes part in the session of its page."""
    if "slow" in block.info and not IS_PATIENT:
        return False
    return block.language in RUN or "run" in block.info or bool(block.file)


# The pages of diagnostics have a test of their own.
SESSIONS = sorted(
    {
        block.page
        for block in ALL
        if is_runnable(block) and block.page.parent.name != "diagnostics"
    }
)


def name(page: Path) -> str:
    """A page's name in the output of tests."""
    return str(page.relative_to(ROOT))


def of(*languages: str) -> pytest.MarkDecorator:
    """The blocks in some languages."""
    chosen = [block for block in ALL if block.language in languages]
    return pytest.mark.parametrize("block", chosen, ids=str)


def problems(session: Session, path: Path) -> list[dict[str, Any]]:
    """What `check` reports of a program."""
    done = subprocess.run(
        [session.command, "check", "--format=json", path],
        cwd=session.cwd,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


def severe(found: list[dict[str, Any]]) -> list[str]:
    """The errors and warnings among problems."""
    return [
        f"{problem['severity']}[{problem['code']}]: {problem['message']}"
        for problem in found
        if problem["severity"] in ("error", "warning")
    ]


def check_program(session: Session, block: Block) -> list[str]:
    """What is wrong with a program in a page."""
    if "fragment" in block.info:
        is_action = re.match(ACTION, block.code)
        code = f"movement m of r {{\n{block.code}}}\n" if is_action else block.code
        path = session.folder / "fragment.pyr"
        path.write_text(code, encoding="utf-8")
        found = [
            problem
            for problem in problems(session, path)
            if "syntax" in problem["code"]
        ]
        path.unlink()
        return severe(found)
    path = session.write(block)
    found = problems(session, path)
    if not block.file:
        path.unlink()
    if "wrong" in block.info:
        return [] if severe(found) else ["it has no errors"]
    return severe(found)


def play(command: str, folder: Path, page: Path) -> list[str]:
    """Goes through a page from top to bottom; returns what is wrong with it."""
    session = Session(command, folder)
    text, wrong, edits = page.read_text(encoding="utf-8"), [], []
    for block in blocks(page):
        if block.language == "pydslrep":
            wrong += [f"{block}: {said}" for said in check_program(session, block)]
        elif not is_runnable(block):
            continue
        elif block.language == "console":
            is_now = session.transcript(block)
            if comparable(is_now) != comparable(block.code):
                wrong.append(f"{block}: it is now\n{is_now}")
                edits.append((block, is_now))
        elif "run" in block.info:
            for line in commands(block):
                code, output = session.run(line)
                if code:
                    wrong.append(f"{block}: {line}: {output}")
        elif block.file:
            session.write(block)
    if UPDATE:
        for block, is_now in reversed(edits):
            start, end = block.span
            shown = re.sub(r"^(?=.)", block.indent, is_now, flags=re.M)
            text = text[:start] + shown + text[end:]
        page.write_text(text, encoding="utf-8")
    return wrong + different_pictures(session, page)


def different_pictures(session: Session, page: Path) -> list[str]:
    """The pictures of a page that its commands make otherwise."""
    wrong = []
    for picture in drawn(page, [block for block in blocks(page) if is_runnable(block)]):
        made = next(session.folder.rglob(picture.name), None)
        shown = picture.relative_to(ROOT)
        if made is None:
            wrong.append(f"{shown} is not made")
        elif not picture.exists() or made.read_bytes() != picture.read_bytes():
            wrong.append(f"{shown} is not what the page makes")
            if UPDATE:
                picture.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(made, picture)
    return wrong


def drawn(page: Path, chosen: list[Block]) -> list[Path]:
    """The pictures of a page that commands in some of its blocks name: their commands make them."""
    words = {
        word
        for block in chosen
        if block.language in ("console", "sh")
        for line in commands(block)
        for word in line.split()
    }
    return [picture for picture in pictures(page) if picture.name in words]


@pytest.fixture(scope="module")
def used(command: str, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The command after its first run, which installs the client library, and says so."""
    first = Session(command, tmp_path_factory.mktemp("first") / "run")
    code, output = first.run("pydslrep run examples/junction.pyr")
    assert code == 0, output
    return command


@pytest.mark.parametrize("page", SESSIONS, ids=name)
def test_a_page_is_as_it_says(used: str, tmp_path: Path, page: Path) -> None:
    wrong = play(used, tmp_path / "page", page)
    assert not wrong, "\n\n".join(wrong)


def test_every_drawing_is_made_by_a_page() -> None:
    # The plot of the comparison is drawn from its measurements: tests/bench/test_comparison.py.
    images = ROOT / "docs" / "images"
    drawings = {*images.glob("*.svg")} - {images / "comparison.svg"}
    made = {picture for page in PAGES for picture in drawn(page, blocks(page))}
    assert drawings <= made


@pytest.mark.parametrize(
    "page",
    sorted((ROOT / "docs" / "diagnostics").glob("[a-z]*.md")),
    ids=lambda page: page.stem,
)
def test_a_diagnostic_has_its_example(command: str, tmp_path: Path, page: Path) -> None:
    session = Session(command, tmp_path / "page")
    found: dict[str, list[str]] = {}
    for target in ("coppeliasim", "vrep"):
        settings = session.folder / "pydslrep.toml"
        edition = "article" if page.stem == "not-in-article" else "current"
        settings.write_text(
            f'target = "{target}"\nedition = "{edition}"\n', encoding="utf-8"
        )
        for block in blocks(page):
            if block.language == "text":
                continue
            path = session.write(block)
            if not block.file:
                codes = [problem["code"] for problem in problems(session, path)]
                found[block.heading] = found.get(block.heading) or codes
    assert found == {"Example": [page.stem], "Write instead": []}


def test_languages_are_known() -> None:
    known = {"pydslrep", "console", "sh", "toml", "json", "python"}
    assert {block.language for block in ALL} - known <= UNCHECKED | ELSEWHERE


@of("toml")
def test_toml_fits_a_schema(block: Block) -> None:
    value = tomllib.loads(block.code)
    valid = [jsonschema.Draft7Validator(schema).is_valid(value) for schema in SCHEMAS]
    assert any(valid), block.code


@of("json")
def test_json_is_valid(block: Block) -> None:
    json.loads(block.code)


@pytest.mark.parametrize(
    "page",
    sorted({block.page for block in ALL if block.language == "python"}),
    ids=name,
)
def test_python_is_clean(page: Path) -> None:
    # Blocks go on from those above them; what is complete is run by tests/scripts.
    code = "\n".join(block.code for block in blocks(page) if block.language == "python")
    options = ["--isolated", "--no-cache", "--ignore=E402,F811", "-"]
    subprocess.run(
        [sys.executable, "-m", "ruff", "check", *options],
        input=code,
        encoding="utf-8",
        check=True,
    )


PLACES = (
    "crates/",
    "docs/",
    "editors/",
    "examples/",
    "grammar/",
    "python/",
    "tests/",
)


@of("sh", "console")
def test_commands_exist(command: str, block: Block) -> None:
    for line in commands(block):
        words = re.findall(r"[^\s'\"]+", line.partition(" #")[0])
        for word in words:
            if word.startswith(PLACES):
                assert (ROOT / word).exists(), word
            if word.startswith("pydslrep-"):
                folder = word.removeprefix("pydslrep-")
                assert (ROOT / "crates" / folder).is_dir() or word == "pydslrep-lsp"
        if words[0] == "pydslrep" and len(words) > 1:
            asked = subprocess.run(
                [command, "help", words[1]],
                capture_output=True,
                encoding="utf-8",
                check=False,
            )
            assert asked.returncode == 0 or words[1].startswith("-"), line
            for option in re.findall(r"--[\w-]+", line):
                assert f"{option} " in asked.stdout or f"{option}\n" in asked.stdout
