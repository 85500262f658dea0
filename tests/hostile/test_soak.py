"""Long sessions: memory, open files, threads and temporary files do not grow with them."""

from __future__ import annotations

import pathlib
import statistics

import pytest
from amount import dice, report, times
from conversation import Conversation
from questions import REQUESTS, Buffer
from raw import notification
from test_messages import item, session
from use import Use

pytestmark = pytest.mark.skipif(
    not pathlib.Path("/proc").exists(), reason="looks into /proc"
)

# A session is looked at so many times; at first it still grows to the size that it keeps.
PARTS, FIRST_PARTS = 12, 4

# The most that memory may grow by: bytes an edit, of which each comes with a request.
MAX_GROWTH = 4096


def edit(
    talk: Conversation, buffer: Buffer, version: int, begin: int, text: str
) -> None:
    """Types a text at an index, key by key, and deletes it again."""
    place = buffer.position(begin)
    changes = [{"range": {"start": place, "end": place}, "text": text}]
    after = {**place, "character": place["character"] + len(text)}
    back = [{"range": {"start": place, "end": after}, "text": ""}]
    for step, change in enumerate((changes, back)):
        document = {"uri": buffer.uri, "version": version + step}
        params = {"textDocument": document, "contentChanges": change}
        talk.server.send(notification("textDocument/didChange", params))


def spend(talk: Conversation, buffer: Buffer, first: int, edits: int) -> Use:
    """Edits and asks for everything; returns the use at the end."""
    die = dice("soak")
    for number in range(first, first + edits):
        begin = die.randrange(len(buffer.text))
        edit(talk, buffer, 2 * number + 2, begin, die.choice("ab{}4 "))
        name, make = die.choice(list(REQUESTS.items()))
        talk.ask(name.partition("#")[0], make(buffer))
        talk.heard.clear()
    return Use.of(talk.server.process.pid)


def growth(uses: list[Use], edits: int) -> float:
    """Bytes an edit: the median of the slopes between any two looks, which a single jump does not change."""
    return statistics.median(
        (late.memory - early.memory) / ((there - here) * edits)
        for here, early in enumerate(uses)
        for there, late in enumerate(uses)
        if here < there
    )


def test_a_long_session(tmp_path: pathlib.Path) -> None:
    edits = times(40)
    with session(tmp_path / "it") as (talk, buffer):
        talk.server.send(notification("textDocument/didOpen", item(buffer, 1)))
        uses = [spend(talk, buffer, part * edits, edits) for part in range(PARTS)]
    kept = uses[FIRST_PARTS:]
    assert growth(kept, edits) <= MAX_GROWTH, [use.memory for use in uses]
    assert kept[-1].files <= kept[0].files
    assert kept[-1].threads <= kept[0].threads
    # Each is typed and deleted again.
    report("soak", 2 * PARTS * edits)
