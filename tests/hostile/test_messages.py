"""Messages that no client should send: each request has one answer, and the session goes on as before."""

from __future__ import annotations

import pathlib
import random
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from amount import dice, report, times
from conversation import Conversation, Refused
from mutation import mutated
from questions import PARTS, PROGRAM, REQUESTS, Buffer
from raw import SERVER, RawServer, frame, notification, request

# Requests are sent in batches that the pipes can hold.
BATCH = 10

# A server that says nothing for so long hangs.
LIMIT = 300.0


@contextmanager
def session(folder: pathlib.Path) -> Iterator[tuple[Conversation, Buffer]]:
    """A session about a folder with two programs; a server that hangs is killed, which fails the test."""
    folder.mkdir(exist_ok=True)
    (folder / "parts.pyr").write_text(PARTS, encoding="utf-8")
    (folder / "main.pyr").write_text(PROGRAM, encoding="utf-8")
    with RawServer(SERVER, "--stdio") as server:
        watchdog = threading.Timer(LIMIT * max(1, times(1) // 10), server.process.kill)
        watchdog.start()
        try:
            talk = Conversation(server)
            talk.sends_nonsense = True
            talk.start(folder=folder)
            yield talk, Buffer((folder / "main.pyr").as_uri(), PROGRAM, "utf-16")
            assert talk.leave() == 0
        finally:
            watchdog.cancel()


def item(buffer: Buffer, version: int) -> dict[str, Any]:
    """A document to open."""
    return {
        "textDocument": {
            "uri": buffer.uri,
            "languageId": "pydslrep",
            "version": version,
            "text": buffer.text,
        }
    }


def notifications(buffer: Buffer, version: int) -> list[tuple[str, Any]]:
    """Valid notifications of every kind."""
    change = {"range": buffer.span("wheel a"), "text": "wheel a"}
    document = {"uri": buffer.uri, "version": version}
    return [
        ("textDocument/didOpen", item(buffer, version)),
        (
            "textDocument/didChange",
            {"textDocument": document, "contentChanges": [change]},
        ),
        ("textDocument/didSave", {"textDocument": buffer.document()}),
        ("textDocument/didClose", {"textDocument": buffer.document()}),
        (
            "workspace/didChangeWatchedFiles",
            {"changes": [{"uri": buffer.uri, "type": 2}]},
        ),
        ("workspace/didChangeConfiguration", {"settings": {}}),
        ("workspace/didRenameFiles", {"files": [{"oldUri": "a", "newUri": "b"}]}),
        ("$/cancelRequest", {"id": version}),
        ("$/setTrace", {"value": "verbose"}),
        ("initialized", {}),
        ("no/such", {}),
    ]


def control(talk: Conversation, buffer: Buffer, version: int) -> dict[str, Any]:
    """The answers to all requests about a document that is opened again."""
    document = {"textDocument": buffer.document()}
    talk.server.send(
        notification("workspace/didChangeConfiguration", {"settings": {}}),
        notification("textDocument/didClose", document),
        notification("textDocument/didOpen", item(buffer, version)),
    )
    found: dict[str, Any] = {}
    for name, make in REQUESTS.items():
        try:
            found[name] = talk.ask(name.partition("#")[0], make(buffer))
        except Refused as refused:
            found[name] = str(refused)
    return {name: stable(known(result, buffer)) for name, result in found.items()}


def known(value: Any, buffer: Buffer) -> Any:
    """A result without what is about documents that wrong messages have opened."""
    files = {buffer.uri, buffer.uri.replace("main.pyr", "parts.pyr")}
    if isinstance(value, dict):
        return {key: known(one, buffer) for key, one in value.items()}
    if isinstance(value, list):
        return [known(one, buffer) for one in value if uri_of(one) in (None, *files)]
    return value


def uri_of(value: Any) -> str | None:
    """The document that a part of a result is about, if it says so."""
    if not isinstance(value, dict):
        return None
    place = value.get("location") or value.get("textDocument") or value
    uri = place.get("uri")
    return uri if isinstance(uri, str) else None


def stable(value: Any) -> Any:
    """A value without the numbers of results, which count up."""
    if isinstance(value, dict):
        return {
            k: stable(v) for k, v in value.items() if k not in ("resultId", "version")
        }
    return [stable(one) for one in value] if isinstance(value, list) else value


def a_message(
    talk: Conversation, buffer: Buffer, die: random.Random
) -> tuple[list[int], bytes]:
    """A random message, mostly wrong; and its id if it must be answered."""
    method, params = die.choice(
        [(name.partition("#")[0], make(buffer)) for name, make in REQUESTS.items()]
    )
    kind = die.random()
    if kind < 0.3:
        method, params = die.choice(notifications(buffer, die.randrange(1000)))
        return [], notification(method, mutated(params, die))
    for _ in range(die.randrange(4)):
        params = mutated(params, die)
    if kind < 0.35:
        odd: Any = die.choice([None, True, 1.5, [], {}, "x" * 1000, -(2**70)])
        body: Any = mutated({"jsonrpc": "2.0", "method": method, "params": params}, die)
        if isinstance(body, dict):
            body["id"] = odd
        return [], frame(to_json(body))
    if kind < 0.4:
        return [], frame(
            die.choice(
                [b"", b"[]", b"{", b"null", b"\xff\xfe", b'"\\ud800"', b"[" * 9999]
            )
        )
    ident, message = talk.request(method, params)
    return [ident], message


def to_json(value: Any) -> bytes:
    """As the client's own messages."""
    return request(0, "x", value).partition(b'"params": ')[2][:-1]


def test_hostile_messages(tmp_path: pathlib.Path) -> None:
    die, sent, refused = dice("messages"), 0, 0
    with session(tmp_path / "it") as (talk, buffer):
        before = control(talk, buffer, 1)
        for number in range(times(40)):
            batch = [a_message(talk, buffer, die) for _ in range(BATCH)]
            talk.server.send(*(message for _, message in batch))
            sent += len(batch)
            for ident in [ident for idents, _ in batch for ident in idents]:
                try:
                    talk.answer(ident)
                except Refused:
                    refused += 1
            if number % 200 == 199:
                assert control(talk, buffer, number) == before
        assert control(talk, buffer, 1001) == before
    report("messages", sent=sent, refused=refused)


def test_everything_is_cancelled(tmp_path: pathlib.Path) -> None:
    die, cancelled = dice("cancels"), 0
    with session(tmp_path / "it") as (talk, buffer):
        before = control(talk, buffer, 1)
        for _ in range(times(20)):
            idents = []
            for _ in range(BATCH):
                name, make = die.choice(list(REQUESTS.items()))
                ident, message = talk.request(name.partition("#")[0], make(buffer))
                cancel = notification("$/cancelRequest", {"id": ident})
                talk.server.send(*die.choice([(message, cancel), (cancel, message)]))
                idents.append(ident)
            for ident in idents:
                try:
                    talk.answer(ident)
                except Refused:
                    cancelled += 1
        assert control(talk, buffer, 2) == before
    report("cancels", sent=times(20) * BATCH, cancelled=cancelled)
