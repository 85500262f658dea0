"""The keys produce the program in a simulated editor, whatever the editor inserts by itself."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
from corpus import FEW, Program, programs
from keystrokes import COMMENT, STEP, Behaviour, same_leader, strokes, usual_leader


@pytest.fixture(scope="session", name="everything")
def _everything() -> list[Program]:
    return programs()


BEHAVIOURS = [
    Behaviour(),
    Behaviour(indents=False),
    Behaviour(closes_braces=True),
    Behaviour(closes_braces=True, indents=False),
    Behaviour(ends_last_line=True),
    Behaviour(leader=same_leader, ends_last_line=True),
    Behaviour(leader=usual_leader, closes_braces=True),
    Behaviour(leader=usual_leader, deletes_by_line=False),
]


class SimulatedEditor:
    """A simulated editor with a behaviour."""

    def __init__(self, behaviour: Behaviour) -> None:
        self.behaviour = behaviour
        self.before, self.after = "", ""

    def press(self, key: str) -> None:
        action = "_" + key.replace("-", "_")
        if hasattr(self, action):
            getattr(self, action)()
        elif key == "}" and self.after.startswith("}"):
            self.before, self.after = self.before + key, self.after[1:]
        else:
            self.before += key
            self._after_brace(key)

    def _after_brace(self, key: str) -> None:
        line = self._line()
        if key == "}" and line.strip() == "}" and self.behaviour.indents:
            self.before = self.before.removesuffix(line) + " " * self._depth() + "}"
        if key == "{" and self.behaviour.closes_braces and "//" not in line:
            self.after = "}" + self.after

    def _line(self) -> str:
        return self.before.rpartition("\n")[2]

    def _depth(self) -> int:
        code = COMMENT.sub("", self.before)
        return STEP * (code.count("{") - code.count("}"))

    def _Enter(self) -> None:  # noqa: N802
        line = self._line()
        if self.after.startswith("}") and self.behaviour.indents:
            self.after = "\n" + " " * (self._depth() - STEP) + self.after
        if not line.strip():
            self.before = self.before.removesuffix(line)
        self.before += "\n" + " " * (self._depth() if self.behaviour.indents else 0)
        if line.lstrip().startswith("//"):
            self.before += self.behaviour.leader(line.lstrip())

    def _Tab(self) -> None:  # noqa: N802
        self.before += " " * STEP

    def _BSpace(self) -> None:  # noqa: N802
        self.before = self.before[:-1]

    def _C_u(self) -> None:  # noqa: N802
        line = self._line()
        blank = line[: len(line) - len(line.lstrip())]
        self.before = self.before.removesuffix(line) + blank

    def _Down(self) -> None:  # noqa: N802
        gone, _, self.after = self.after.partition("\n")
        assert gone == "", "Down is pressed only at the end of a line"
        self.before += "\n"

    def _End(self) -> None:  # noqa: N802
        end, newline, rest = self.after.partition("\n")
        self.before, self.after = self.before + end, newline + rest

    def text(self) -> str:
        end = "\n" if self.behaviour.ends_last_line else ""
        return self.before + self.after + end


@pytest.mark.parametrize("behaviour", BEHAVIOURS)
def test_keys_give_the_program(behaviour: Behaviour, everything: list[Program]) -> None:
    for program in everything:
        editor = SimulatedEditor(behaviour)
        for stroke in strokes(program.text, behaviour):
            editor.press(stroke.key)
        assert editor.text() == program.text, program.name


def test_the_few_programs_exist(everything: list[Program]) -> None:
    assert set(FEW) < {program.name for program in everything}
