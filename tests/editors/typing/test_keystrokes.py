"""The keys produce the program in a simulated editor, whatever the editor inserts by itself."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))
from corpus import FEW, Program, programs, ragged
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

    def _Right(self) -> None:  # noqa: N802
        self.before, self.after = self.before + self.after[:1], self.after[1:]

    def text(self) -> str:
        end = "\n" if self.behaviour.ends_last_line else ""
        return self.before + self.after + end


@pytest.mark.parametrize("behaviour", BEHAVIOURS)
def test_keys_give_the_program(behaviour: Behaviour, everything: list[Program]) -> None:
    for program in everything:
        # Only a server removes the braces that the editor has inserted.
        if program.is_printed and behaviour.closes_braces:
            continue
        editor = SimulatedEditor(behaviour)
        text = program.text
        typed = strokes(
            text, behaviour, tabs=program.tabs, as_written=program.is_printed
        )
        for stroke in typed:
            editor.press(stroke.key)
        if program.is_printed:
            assert editor.text().split() == text.split(), program.name
        else:
            assert program.matches(editor.text()), program.name


def test_words_of_lists_end_with_a_tab() -> None:
    typed = strokes("wheel a\nrobot r has { a ab } x\n", Behaviour(), tabs=True)
    keys = "".join(stroke.key for stroke in typed)
    assert keys == "wheel aEnterrobot r has { aTab abTab } xEnter"


def test_similar_names_are_in_lists_over_several_lines(
    everything: list[Program],
) -> None:
    [program] = [one for one in everything if one.name == "names_00"]
    assert "robots with {\n  a\n  ab\n  abc\n  a2\n" in program.text
    assert "with sensors {\n  " in program.text
    assert "until { a, ab, abc, a2 }" in program.text


def test_ragged_lines_are_found() -> None:
    assert ragged("robot r has {\n  a\n  b } wheels\n\nsensor s\n") == []
    assert ragged("robot r has {\n  a\n  b } wheels\n  sensor s\n") == ["  sensor s"]
    assert ragged("movement m {\n    slam\n}\n") == ["    slam"]


def test_the_few_programs_exist(everything: list[Program]) -> None:
    assert set(FEW) < {program.name for program in everything}
