"""Messages that no client should send: each request has one answer, and the session goes on as before."""

from __future__ import annotations

import pathlib
import random
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import pytest
from amount import dice, report, times
from conversation import Conversation, Refused
from mutation import mutated
from questions import OPTIONS, PARTS, PROGRAM, REQUESTS, Buffer
from raw import SERVER, RawServer, frame, notification, request
from until import until
from use import is_at_rest

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
    assert 0 < refused < sent, "some are wrong, some are not"
    report("messages", sent)


# A document about which a request is under way for long: most answers are larger than a megabyte.
WHEELS = 8_000

# Requests about all of it that are answered beside the message loop.
WHOLE = (
    "textDocument/documentSymbol",
    "textDocument/foldingRange",
    "textDocument/semanticTokens/full",
    "textDocument/formatting",
    "textDocument/codeLens",
    "textDocument/inlayHint",
)
LARGE = "textDocument/documentSymbol"

# The protocol's code for a request that was cancelled.
CANCELLED = -32800


def error_code(talk: Conversation, ident: int) -> int | None:
    """The error that a request is answered with."""
    try:
        talk.answer(ident)
    except Refused as refused:
        return refused.code
    return None


class Cancelling:
    """Requests that are under way, and what became of them when they were cancelled."""

    def __init__(self, talk: Conversation, folder: pathlib.Path) -> None:
        self.talk = talk
        self.tried = self.cancelled = 0
        wheels = "".join(f"wheel   w{n} with radius 4.5\n" for n in range(WHEELS))
        uri = (folder / "long.pyr").as_uri()
        self.long = Buffer(uri, wheels, "utf-16")
        talk.server.send(notification("textDocument/didOpen", item(self.long, 1)))

    def close(self) -> None:
        """Closes the long document."""
        document = {"textDocument": self.long.document()}
        self.talk.server.send(notification("textDocument/didClose", document))

    def requests(self, methods: Sequence[str]) -> list[int]:
        """Sends requests about the long document."""
        document = {"textDocument": self.long.document()}
        whole = {"range": self.long.everything(), "options": OPTIONS}
        found = [self.talk.request(name, {**document, **whole}) for name in methods]
        self.talk.server.send(*(message for _, message in found))
        return [ident for ident, _ in found]

    def cancel(self, idents: Sequence[int]) -> None:
        """Cancels requests."""
        self.talk.server.send(
            *(notification("$/cancelRequest", {"id": ident}) for ident in idents)
        )

    def collect(self, idents: Sequence[int]) -> int:
        """Waits for the answers; returns how many of the requests were cancelled."""
        codes = [error_code(self.talk, ident) for ident in idents]
        assert set(codes) <= {None, CANCELLED}
        count = codes.count(CANCELLED)
        self.tried += len(idents)
        self.cancelled += count
        return count

    def while_they_wait(self) -> None:
        """Diagnostics of the workspace wait for a change."""
        method = "workspace/diagnostic"
        reports = self.talk.ask(method, {"previousResultIds": []})["items"]
        known = [{"uri": one["uri"], "value": one["resultId"]} for one in reports]
        asked = [
            self.talk.request(method, {"previousResultIds": known})
            for _ in range(BATCH)
        ]
        self.talk.server.send(*(message for _, message in asked))
        idents = [ident for ident, _ in asked]
        self.cancel(idents)
        assert self.collect(idents) == BATCH

    def while_they_compute(self, die: random.Random) -> None:
        """One after the other is computed while their cancellations come."""
        idents = self.requests([die.choice(WHOLE) for _ in range(BATCH)])
        self.cancel(die.sample(idents, len(idents)))
        self.collect(idents)

    def while_nobody_reads(self) -> None:
        """So many answers are not read that the others are not even computed; then they are cancelled."""
        idents = self.requests([LARGE] * 4 * BATCH)
        pid = self.talk.server.process.pid
        until("the server waits for its client to read", lambda: is_at_rest(pid))
        self.cancel(idents)
        until("the cancellations are read", lambda: is_at_rest(pid))
        assert self.collect(idents) >= 2 * BATCH


def assert_late_and_early_cancellations_change_nothing(
    talk: Conversation, buffer: Buffer
) -> None:
    """Those of requests that are answered, and of others that were never sent."""
    for name, make in REQUESTS.items():
        ident, message = talk.request(name.partition("#")[0], make(buffer))
        cancel = notification("$/cancelRequest", {"id": ident})
        talk.server.send(cancel, message)
        assert error_code(talk, ident) != CANCELLED, name
        talk.server.send(cancel)


@pytest.mark.skipif(not pathlib.Path("/proc").exists(), reason="looks into /proc")
def test_everything_is_cancelled(tmp_path: pathlib.Path) -> None:
    die = dice("cancels")
    with session(tmp_path / "it") as (talk, buffer):
        before = control(talk, buffer, 1)
        assert_late_and_early_cancellations_change_nothing(talk, buffer)
        work = Cancelling(talk, tmp_path / "it")
        talk.checks = False
        for _ in range(times(1)):
            work.while_they_wait()
            work.while_they_compute(die)
            work.while_nobody_reads()
        work.close()
        talk.checks = True
        assert control(talk, buffer, 2) == before
    report("cancels", work.cancelled, work.tried)
