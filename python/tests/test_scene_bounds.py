"""A scene that cannot be ends a request in one sentence, whatever its objects say of each other."""

import json
import math
from collections.abc import Callable, Iterator
from itertools import count
from typing import Any

import pytest
from pydslrep_runtime.answers import answer
from pydslrep_runtime.errors import SimulatorError
from pydslrep_runtime.readings import MAX_DEPTH, MAX_NAMESAKES, read_mark
from pydslrep_runtime.scene.lookup import objects_at
from pydslrep_runtime.scene.reader import SceneReader


class Liar:
    """A connection to a simulator with the functions of a test."""

    def __init__(self, **functions: Callable[..., Any]) -> None:
        self.sim = self
        self.address = "127.0.0.1:23000"
        for name, function in functions.items():
            setattr(self, name, function)

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Calls a function."""
        return function(*arguments)


def ancestors(parent: Callable[[int], int]) -> Iterator[int]:
    """The objects above the first one, as the checks walk up."""
    scene = SceneReader(Liar(getObjectParent=parent))  # type: ignore[arg-type]
    handle: int | None = 0
    while handle is not None:
        yield handle
        handle = scene.parent(handle)


@pytest.mark.parametrize(
    ("parent", "words"),
    [
        (lambda handle: handle, "object 0 of the scene is its own ancestor"),
        (lambda handle: (handle + 1) % 4, "object 3 of the scene is its own ancestor"),
        (lambda handle: 1 if handle == 2 else handle + 1, "object 2 of the scene is"),
        (lambda handle: handle + 1, f"a branch of more than {MAX_DEPTH} objects"),
    ],
)
def test_ancestors_end(parent: Callable[[int], int], words: str) -> None:
    with pytest.raises(SimulatorError, match=words):
        list(ancestors(parent))


def test_a_branch_has_a_limit_from_above() -> None:
    scene = SceneReader(Liar(getObjectParent=lambda handle: handle + 1))  # type: ignore[arg-type]
    with pytest.raises(SimulatorError, match="a branch of more than"):
        [scene.parent(handle) for handle in reversed(range(MAX_DEPTH + 2))]


def test_a_line_of_ancestors_is_fine() -> None:
    top = MAX_DEPTH - 2
    assert len(list(ancestors(lambda handle: handle + 1 if handle < top else -1))) == (
        MAX_DEPTH - 1
    )


def test_objects_with_one_path_end() -> None:
    handles = count(1)
    liar = Liar(getObject=lambda _path, _options: next(handles))
    with pytest.raises(SimulatorError, match=f"more than {MAX_NAMESAKES} objects /one"):
        list(objects_at(liar, "/one"))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "data", [None, "", b"\xff", "x", "[" * 10**5, "[]", '{"grip": 1}']
)
def test_other_data_is_no_mark(data: Any) -> None:
    assert read_mark("object 1", data) is None


@pytest.mark.parametrize(
    "wrong",
    [
        '{"kind": "robot", "grip": NaN}',
        '{"kind": "robot", "grip": "high"}',
        '{"kind": 7}',
        '{"kind": "obstacle", "corners": [[0, 1e308]]}',
        '{"kind": "obstacle", "corners": [1, 2]}',
        '{"kind": "obstacle", "origin": [1, 0, 0]}',
    ],
)
def test_a_mark_is_checked(wrong: str) -> None:
    with pytest.raises(SimulatorError, match="object 1"):
        read_mark("object 1", wrong)


@pytest.mark.parametrize(
    ("task", "words"),
    [
        (lambda _: {"x": math.nan}, "internal error: ValueError"),
        (lambda _: dict[str, str]()["robots"], "internal error: KeyError: 'robots'"),
        (
            lambda _: "x".nothing,  # type: ignore[attr-defined]
            "internal error: AttributeError",
        ),
        (lambda _: "x" * int("9" * 5000), "internal error: ValueError"),
    ],
)
def test_an_answer_is_always_one(task: Callable[[Any], Any], words: str) -> None:
    text, code = answer('{"task": "test"}', task)
    assert json.loads(text)["error"].startswith(words)
    assert code == 2
