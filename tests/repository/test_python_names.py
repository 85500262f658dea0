"""The names that scripts do not use as identifiers are Python's own."""

import builtins
import keyword
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Names of other versions of Python, of Windows, and of mypy.
ELSEWHERE = {
    "BaseExceptionGroup",
    "ExceptionGroup",
    "PythonFinalizationError",
    "WindowsError",
    "reveal_locals",
    "reveal_type",
}


def listed() -> list[str]:
    path = ROOT / "crates/script/src/python_names.txt"
    return path.read_text(encoding="utf-8").splitlines()


def of_python() -> set[str]:
    names = {*keyword.kwlist, *keyword.softkwlist, *dir(builtins)}
    # Scripts use no identifiers that begin with an underscore.
    return {name for name in names if not name.startswith("_")}


def test_all_keywords_and_builtins_are_listed() -> None:
    assert of_python() - set(listed()) == set()


def test_nothing_else_is_listed() -> None:
    assert set(listed()) - of_python() - ELSEWHERE == set()


def test_names_are_listed_in_order() -> None:
    assert listed() == sorted(set(listed()))
