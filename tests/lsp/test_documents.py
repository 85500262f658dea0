"""Documents as editors really send them: unusual texts, orders and URIs."""

from __future__ import annotations

import os
import pathlib
import sys
from typing import Any

import pytest
from conversation import Conversation
from questions import Buffer
from raw import RawServer, notification

SYMBOLS = "textDocument/documentSymbol"
PULL = "textDocument/diagnostic"
WHEELS = ["wheel a with radius 4.5", "wheel b with radius 4.5"]


def opened(uri: str, text: str, version: int = 1) -> bytes:
    item = {"uri": uri, "languageId": "pydslrep", "version": version, "text": text}
    return notification("textDocument/didOpen", {"textDocument": item})


def closed(uri: str) -> bytes:
    return notification("textDocument/didClose", {"textDocument": {"uri": uri}})


def changed(uri: str, version: int, *changes: dict[str, Any]) -> bytes:
    document = {"uri": uri, "version": version}
    return notification(
        "textDocument/didChange",
        {"textDocument": document, "contentChanges": list(changes)},
    )


def named(uri: str) -> dict[str, Any]:
    return {"textDocument": {"uri": uri}}


def names(found: list[dict[str, Any]]) -> list[tuple[str, int]]:
    return [(item["name"], item["range"]["start"]["line"]) for item in found]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", []),
        ("\n", []),
        ("\ufeff" + WHEELS[0], [("a", 0)]),
        (WHEELS[0] + "\r" + WHEELS[1] + "\r", [("a", 0), ("b", 1)]),
        (WHEELS[0] + "\r\r\n\n" + WHEELS[1], [("a", 0), ("b", 3)]),
        # Not line breaks in the protocol, although other tools treat them as such.
        ("// \u2028 \u2029 \x0b \x0c \x85\n" + WHEELS[0], [("a", 1)]),
        ("/* \0 \x1b 🤖 */ " + WHEELS[0], [("a", 0)]),
    ],
)
def test_lines_end_where_the_protocol_says(
    server: str, text: str, expected: list[tuple[str, int]]
) -> None:
    uri = "file:///a.pyr"
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start(pulling=True)
        found = talk.ask_behind(opened(uri, text), SYMBOLS, named(uri))
        assert names(found) == expected
        end = Buffer(uri, "x" + WHEELS[0], "utf-16").position(1)
        start = {"start": {**end, "character": 0}, "end": {**end, "character": 0}}
        insert = {"range": start, "text": WHEELS[1] + "\n"}
        found = talk.ask_behind(changed(uri, 2, insert), SYMBOLS, named(uri))
        assert ("b", 0) in names(found)


def test_documents_open_and_close_in_any_order(server: str) -> None:
    uri = "file:///a.pyr"
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start(pulling=True)

        def shown(*before: bytes) -> list[str]:
            found = talk.ask_behind(b"".join(before), SYMBOLS, named(uri))
            return [name for name, _ in names(found or [])]

        whole = {"text": WHEELS[1]}
        assert shown(changed(uri, 7, whole)) == [], "a change before the opening"
        assert shown(opened(uri, WHEELS[0])) == ["a"]
        assert shown(opened(uri, WHEELS[1], 5)) == ["b"], "opened twice"
        assert shown(changed(uri, 3, {"text": WHEELS[0]})) == ["a"], "a lower version"
        assert shown(changed(uri, 4)) == ["a"], "a change of nothing"
        assert shown(closed(uri), closed(uri)) == []
        assert shown(changed(uri, 9, whole)) == [], "a change after the closing"
        assert shown(opened(uri, WHEELS[1], 0)) == ["b"], "opened again with version 0"


def test_the_id_of_diagnostics_is_not_that_of_a_version(server: str) -> None:
    """Editors reopen a file with version 0 and different text."""
    uri = "file:///a.pyr"
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start(pulling=True)
        broken = opened(uri, "wheel a with radius", 0)
        first = talk.ask_behind(broken, PULL, named(uri))
        assert first["items"]
        asked = {**named(uri), "previousResultId": first["resultId"]}
        assert talk.ask(PULL, asked)["kind"] == "unchanged"
        again = opened(uri, WHEELS[0], 0)
        report = talk.ask_behind(closed(uri) + again, PULL, asked)
        assert report["kind"] == "full"
        assert [item["code"] for item in report["items"]] != ["syntax-error"]


def test_unsaved_documents_have_diagnostics(server: str) -> None:
    uri = "untitled:Untitled-1"
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start()
        raw.send(opened(uri, "wheel a with radius"))
        received = talk.hear_until("textDocument/publishDiagnostics")["params"]
        assert received["uri"] == uri
        assert [item["code"] for item in received["diagnostics"]][:1] == [
            "syntax-error"
        ]
        raw.send(closed(uri))
        cleared = talk.hear_until("textDocument/publishDiagnostics")["params"]
        assert (cleared["uri"], cleared["diagnostics"]) == (uri, [])


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("file:///c%3A/a.pyr", "file:///C:/a.pyr"),
        ("file:///a%20b/%C3%A9.pyr", "file:///a%20b/%c3%a9.pyr"),
        ("file:///a.pyr", "file://localhost/a.pyr"),
    ],
)
def test_one_document_has_many_uris(server: str, first: str, second: str) -> None:
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start(pulling=True)
        found = talk.ask_behind(opened(first, WHEELS[0]), SYMBOLS, named(second))
        assert names(found) == [("a", 0)]


def test_diagnostics_follow_a_renamed_file(server: str, tmp_path: pathlib.Path) -> None:
    old, new = tmp_path / "old.pyr", tmp_path / "new.pyr"
    old.write_text("wheel a with radius", encoding="utf-8")
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start(folder=tmp_path)
        received = talk.hear_until("textDocument/publishDiagnostics")["params"]
        assert (received["uri"], bool(received["diagnostics"])) == (old.as_uri(), True)
        old.rename(new)
        changes = [{"uri": old.as_uri(), "type": 3}, {"uri": new.as_uri(), "type": 1}]
        raw.send(notification("workspace/didChangeWatchedFiles", {"changes": changes}))
        after: dict[str, bool] = {}
        while len(after) < 2:
            received = talk.hear_until("textDocument/publishDiagnostics")["params"]
            after[received["uri"]] = bool(received["diagnostics"])
        assert after == {old.as_uri(): False, new.as_uri(): True}


def test_a_long_completion_list_is_incomplete(server: str) -> None:
    """Long lists freeze editors; further typing narrows them down."""
    uri = "file:///a.pyr"
    wheels = "".join(f"wheel w{n:04}_left with radius 4.5\n" for n in range(3000))
    buffer = Buffer(uri, wheels + "robot r has { ", "utf-16")
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start(pulling=True)
        at = {**named(uri), "position": buffer.position(len(buffer.text))}
        method = "textDocument/completion"
        found = talk.ask_behind(opened(uri, buffer.text), method, at)
        assert 0 < len(found["items"]) <= 1000
        assert "w1500_left" not in [item["label"] for item in found["items"]]
        typed = Buffer(uri, buffer.text + "w150", "utf-16")
        change = changed(uri, 2, {"text": typed.text})
        at["position"] = typed.position(len(typed.text))
        labels = [
            item["label"] for item in talk.ask_behind(change, method, at)["items"]
        ]
        assert "w1500_left" in labels


KEYSTROKES = int(os.environ.get("PYDSLREP_KEYSTROKES", "2000"))
"""Eight hours at a keystroke each fifth of a second are 144 000."""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is read in /proc")
def test_memory_stays_flat_while_typing(server: str) -> None:
    uri = "file:///a.pyr"
    text = "".join(f"wheel w{n} with radius 4.5\n" for n in range(300))
    typed = "robot new type tw with port 1 has { w1 w2 } wheels\n"
    questions = (
        "hover",
        "completion",
        "diagnostic",
        "semanticTokens/full",
        "documentSymbol",
        "foldingRange",
    )

    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start(pulling=True)
        raw.send(opened(uri, text))

        def write_a_robot(version: int) -> None:
            """Types letter by letter, with an editor's requests after each word, and deletes everything in the end."""
            burst = []
            for column, letter in enumerate(typed):
                at = {"line": 0, "character": column}
                change = {"range": {"start": at, "end": at}, "text": letter}
                burst.append(changed(uri, version, change))
                if letter.isspace():
                    method = questions[column % len(questions)]
                    asked = {**named(uri), "position": at}
                    talk.ask_behind(b"".join(burst), f"textDocument/{method}", asked)
                    burst.clear()
            end = {"line": 1, "character": 0}
            line = {"start": {"line": 0, "character": 0}, "end": end}
            raw.send(*burst, changed(uri, version, {"range": line, "text": ""}))
            talk.heard.clear()

        def pages() -> int:
            """The memory in use."""
            statm = pathlib.Path(f"/proc/{raw.process.pid}/statm").read_text()
            return int(statm.split()[1])

        eighths = []
        for hour in range(8):
            for _ in range(KEYSTROKES // 8 // len(typed)):
                write_a_robot(hour + 2)
            eighths.append(pages())
        assert max(eighths) <= eighths[0] * 1.1, eighths
