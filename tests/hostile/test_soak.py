"""Long sessions: memory, open files, threads and temporary files do not grow with them."""

from __future__ import annotations

import pathlib

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

# What the second half of a session may add to its first: bytes.
MORE_MEMORY = 8 << 20


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


def spend(talk: Conversation, buffer: Buffer, edits: int) -> Use:
    """Edits and asks for everything; returns the use at the end."""
    die = dice("soak")
    for number in range(edits):
        begin = die.randrange(len(buffer.text))
        edit(talk, buffer, 2 * number + 2, begin, die.choice("ab{}4 "))
        name, make = die.choice(list(REQUESTS.items()))
        talk.ask(name.partition("#")[0], make(buffer))
        talk.heard.clear()
    return Use.of(talk.server.process.pid)


def test_a_long_session(tmp_path: pathlib.Path) -> None:
    edits = times(200)
    with session(tmp_path / "it") as (talk, buffer):
        talk.server.send(notification("textDocument/didOpen", item(buffer, 1)))
        first = spend(talk, buffer, edits)
        second = spend(talk, buffer, edits)
    assert second.memory <= first.memory + MORE_MEMORY
    assert second.files <= first.files
    assert second.threads <= first.threads
    report("soak", edits=4 * edits)
