"""What `pydslrep run` and the tests install is locked: versions and hashes."""

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).parents[2]


@pytest.mark.parametrize(
    "name",
    [
        "python/requirements",
        "python/requirements-mujoco",
        "python/requirements-slam",
        "tests/requirements",
    ],
)
def test_every_requirement_is_locked_with_its_hashes(name: str) -> None:
    wanted = re.findall(r"^[\w-]+==\S+$", (ROOT / f"{name}.in").read_text(), re.M)
    locked = (ROOT / f"{name}.txt").read_text()
    # A requirement goes on as long as its lines end in a backslash.
    entries = re.findall(r"^(?!#)(?:.*\\\n)*.+", locked, re.M)
    names = {entry.split()[0] for entry in entries if entry}
    assert wanted
    assert set(wanted) <= names
    for entry in filter(None, entries):
        assert re.search(r"--hash=sha256:[0-9a-f]{64}", entry), entry
