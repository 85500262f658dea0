"""Every call of CoppeliaSim's functions is listed, and exists in the oldest supported version."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pydslrep_runtime
from pydslrep_runtime.api_calls import CALLS, OLDEST, OPTIONAL

PACKAGE = Path(pydslrep_runtime.__file__).parent
FUNCTION = re.compile(r"[a-z]+[A-Z][A-Za-z0-9]*")  # constants have underscores
CALLERS = {"call", "get", "last_call", "post", "read", "try_call"}


def name_of(node: ast.expr) -> str:
    match node:
        case ast.Attribute(attr=name) | ast.Name(id=name):
            return name
    return ""


def called(tree: ast.AST) -> Iterator[str]:
    """Functions as `sim.f`, as "sim.f", and as "f" in a call by name."""
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=owner, attr=name) if FUNCTION.fullmatch(name):
                if name_of(owner).strip("_") == "sim":
                    yield name
            case ast.Constant(value=str(text)) if re.fullmatch(r"sim\.\w+", text):
                yield text.removeprefix("sim.")
            case ast.Call(func=function, args=[ast.Constant(value=str(text)), *_]):
                if name_of(function) in CALLERS and FUNCTION.fullmatch(text):
                    yield text


def version(text: str) -> tuple[int, ...]:
    return tuple(int(part) for part in text.split("."))


def test_all_calls_are_listed() -> None:
    # The legacy remote API is another one.
    files = [file for file in PACKAGE.rglob("*.py") if file.name != "vrep.py"]
    found = {
        name
        for file in files
        for name in called(ast.parse(file.read_text(encoding="utf-8")))
    }
    assert found == set(CALLS)


def test_the_oldest_version_has_them() -> None:
    later = {name for name, v in CALLS.items() if version(v) > version(OLDEST)}
    assert later == OPTIONAL
