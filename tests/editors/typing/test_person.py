"""The keys of a person give the program in an editor that does what it should, whatever it does by itself."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
from corpus import FEW, Program, programs
from person import COMMENT, STEP, Habits, same_leader, strokes, usual_leader


@pytest.fixture(scope="session", name="everything")
def _everything() -> list[Program]:
    return programs()


KINDS = [
    Habits(),
    Habits(indents=False),
    Habits(closes_braces=True),
    Habits(closes_braces=True, indents=False),
    Habits(ends_last_line=True),
    Habits(leader=same_leader, ends_last_line=True),
    Habits(leader=usual_leader, closes_braces=True),
    Habits(leader=usual_leader, deletes_by_line=False),
]


class Ideal:
    """An editor as the habits have it."""

    def __init__(self, habits: Habits) -> None:
        self.habits = habits
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
        if key == "}" and line.strip() == "}" and self.habits.indents:
            self.before = self.before.removesuffix(line) + " " * self._depth() + "}"
        if key == "{" and self.habits.closes_braces and "//" not in line:
            self.after = "}" + self.after

    def _line(self) -> str:
        return self.before.rpartition("\n")[2]

    def _depth(self) -> int:
        code = COMMENT.sub("", self.before)
        return STEP * (code.count("{") - code.count("}"))

    def _Enter(self) -> None:  # noqa: N802
        line = self._line()
        if self.after.startswith("}") and self.habits.indents:
            self.after = "\n" + " " * (self._depth() - STEP) + self.after
        if not line.strip():
            self.before = self.before.removesuffix(line)
        self.before += "\n" + " " * (self._depth() if self.habits.indents else 0)
        if line.lstrip().startswith("//"):
            self.before += self.habits.leader(line.lstrip())

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
        assert gone == "", "goes down from the end of a line only"
        self.before += "\n"

    def _End(self) -> None:  # noqa: N802
        end, newline, rest = self.after.partition("\n")
        self.before, self.after = self.before + end, newline + rest

    def text(self) -> str:
        end = "\n" if self.habits.ends_last_line else ""
        return self.before + self.after + end


@pytest.mark.parametrize("habits", KINDS)
def test_keys_give_the_program(habits: Habits, everything: list[Program]) -> None:
    for program in everything:
        editor = Ideal(habits)
        for stroke in strokes(program.text, habits):
            editor.press(stroke.key)
        assert editor.text() == program.text, program.name


def test_the_few_are_there(everything: list[Program]) -> None:
    assert set(FEW) < {program.name for program in everything}
