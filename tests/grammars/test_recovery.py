"""A mistake in one entity does not affect its neighbours in either grammar."""

from __future__ import annotations

import random
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import pytest
from colours import Colours, TextMate, TreeSitter, random_programs

ACTIONS = Path(__file__).with_name("actions.pyr").read_text(encoding="utf-8")
TOKEN = re.compile(
    r'//[^\r\n]*|/\*.*?\*/|"[^"\r\n]*"|\^?[A-Za-z_]\w*|-?[0-9][0-9.]*|[{}:,]', re.S
)
BEGINS_ENTITY = re.compile(r"(wheelH?|sensor|ip|robot|parallel|movement|environment)\b")
# Tokens to insert; none begins an entity or a comment.
STRAY = re.split(
    " ",
    "with radius has { } , : 4.5 -1 name distance 1.2.3.4 port wheels sensors of move turn left until at meters robots "
    "moves type tw slam § left-wheel größe ^ 4. ; ( ) = ' wait seconds repeat times if else do in reverse clear detect "
    "within",
)


@dataclass
class Broken:
    """A program with a mistake in one entity."""

    before: str
    entity: str
    mistaken: str
    following: str

    @property
    def whole(self) -> str:
        return self.before + self.entity + self.following

    @property
    def text(self) -> str:
        return self.before + self.mistaken + self.following


def broken(program: str, starts: list[int], choose: random.Random) -> Broken:
    """The program with an entity that breaks off, or has one token too much or too few; those that begin entities
    do not count."""
    index = choose.randrange(len(starts))
    start, end = [*starts, len(program)][index : index + 2]
    entity = program[start:end]
    _, *tokens = TOKEN.finditer(entity)
    token = choose.choice(tokens)
    if choose.random() < 0.3:
        return Broken(
            program[:start], entity, f"{entity[: token.start()]}\n", program[end:]
        )
    is_plain = not token[0].startswith(("/", '"')) and not BEGINS_ENTITY.match(token[0])
    if is_plain and choose.random() < 0.5:
        mistaken = entity[: token.start()] + entity[token.end() :]
    else:
        stray = f" {choose.choice(STRAY)} "
        mistaken = entity[: token.start()] + stray + entity[token.start() :]
    return Broken(program[:start], entity, mistaken, program[end:])


@pytest.fixture(scope="module")
def mistakes(tree_sitter: TreeSitter) -> list[Broken]:
    choose = random.Random(7)
    found = []
    for program, count in [
        *((text, 4) for text in random_programs(40, 12)),
        (ACTIONS, 100),
    ]:
        starts = tree_sitter.entities(program)
        found += [broken(program, starts, choose) for _ in range(count) if starts]
    return found


class Reader(Protocol):
    def __call__(self, texts: list[str]) -> list[Colours]: ...


def check_neighbours(mistakes: list[Broken], read: Reader) -> None:
    whole = read([mistake.whole for mistake in mistakes])
    after = read([mistake.text for mistake in mistakes])
    for mistake, sound, seen in zip(mistakes, whole, after, strict=True):
        head, tail = len(mistake.before), len(mistake.following)
        assert seen[:head] == sound[:head], mistake
        assert seen[len(seen) - tail :] == sound[len(sound) - tail :], mistake


def test_textmate_keeps_the_neighbours(
    mistakes: list[Broken], textmate: TextMate
) -> None:
    check_neighbours(
        mistakes, lambda texts: [colours for _, colours in textmate.read(texts)]
    )


def test_tree_sitter_keeps_the_neighbours(
    mistakes: list[Broken], tree_sitter: TreeSitter
) -> None:
    check_neighbours(
        mistakes, lambda texts: [tree_sitter.read(text)[1] for text in texts]
    )
