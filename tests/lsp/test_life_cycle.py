"""The life cycle of a session at the level of bytes, from the first message to the exit code."""

from __future__ import annotations

import json
import pathlib
import subprocess
import sys
from collections.abc import Iterable
from typing import Any

import pytest
from conversation import EVERYTHING, Conversation
from raw import RawServer, answer, frame, notification, request

URI = "file:///a.pyr"
EXIT = notification("exit", None)
SHUTDOWN = request("bye", "shutdown", None)
NAMED = {"textDocument": {"uri": URI}}


def opened(text: str, uri: str = URI, version: int = 1) -> bytes:
    document = {"uri": uri, "languageId": "pydslrep", "version": version, "text": text}
    return notification("textDocument/didOpen", {"textDocument": document})


def outline(ident: int | str) -> bytes:
    return request(ident, "textDocument/documentSymbol", NAMED)


def everything_left(raw: RawServer) -> list[dict[str, Any]]:
    """All messages until the server exits."""
    messages = []
    while (message := raw.read()) is not None:
        messages.append(message)
    return messages


def code(message: dict[str, Any]) -> int | None:
    error: dict[str, int] = message.get("error", {})
    return error.get("code")


#### Initialization ####


def test_before_initialize_requests_are_answered(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.send(
            opened("wheel"),
            notification("workspace/didChangeConfiguration", {"settings": {"x": 1}}),
            notification("no/such", {}),
            notification("$/setTrace", {"value": "off"}),
            notification("initialized", {}),
            request(1, "no/such", {}),
            request(2, "textDocument/semanticTokens/full", NAMED),
            SHUTDOWN,
            request(3, "initialize", {"capabilities": {}}),
            outline(4),
        )
        messages = [raw.read() for _ in range(5)]
        assert [(m["id"], code(m)) for m in messages if m] == [
            (1, -32002),
            (2, -32002),
            ("bye", -32002),
            (3, None),
            (4, None),
        ]
        assert messages[4] == {"jsonrpc": "2.0", "id": 4, "result": None}


def test_a_session_begins_once_and_only_with_usable_parameters(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.send(
            request(1, "initialize", {"capabilities": 7}),
            request(2, "initialize", None),
            outline(3),
            request(4, "initialize", {"capabilities": {}, "workDoneToken": "t"}),
            request(5, "initialize", {"capabilities": {}}),
            outline(6),
        )
        codes = [code(raw.answer(ident)) for ident in range(1, 7)]
        assert codes == [-32602, -32602, -32002, None, -32600, None]


def test_a_client_without_capabilities_gets_no_requests(
    server: str, tmp_path: pathlib.Path
) -> None:
    (tmp_path / "a.pyr").write_text("wheel a", encoding="utf-8")
    folders = [{"uri": tmp_path.as_uri(), "name": "it"}]
    with RawServer(server, "--stdio") as raw:
        raw.send(
            request(0, "initialize", {"capabilities": {}, "workspaceFolders": folders}),
            notification("initialized", {}),
        )
        # Diagnostics of the folder arrive, which the server sends after all of its possible requests.
        raw.answer(0)
        first = raw.read()
        assert first
        assert first["method"] == "textDocument/publishDiagnostics"
        raw.send(SHUTDOWN, EXIT)
        assert [message["id"] for message in everything_left(raw)] == ["bye"]


#### Shutdown ####


def test_after_shutdown_there_are_only_responses(
    server: str, tmp_path: pathlib.Path
) -> None:
    folders = {
        "event": {"added": [{"uri": tmp_path.as_uri(), "name": "it"}], "removed": []}
    }
    for name in ("a", "b"):
        (tmp_path / f"{name}.pyr").write_text("wheel a", encoding="utf-8")
    with RawServer(server, "--stdio") as raw:
        raw.initialize(EVERYTHING)
        raw.send(
            opened("wheel"),
            SHUTDOWN,
            opened("robot", "file:///b.pyr"),
            notification("workspace/didChangeWorkspaceFolders", folders),
            notification("workspace/didChangeConfiguration", {"settings": {"x": 1}}),
            outline(1),
            request(2, "no/such", {}),
            request(3, "initialize", {"capabilities": {}}),
            request(4, "shutdown", None),
            EXIT,
        )
        messages = everything_left(raw)
        ended = next(
            n for n, message in enumerate(messages) if message.get("id") == "bye"
        )
        following = [
            (message.get("id"), code(message)) for message in messages[ended + 1 :]
        ]
        assert following == [(ident, -32600) for ident in (1, 2, 3, 4)]
        assert raw.leave() == 0


def test_late_results_are_not_sent_after_shutdown(
    server: str, tmp_path: pathlib.Path
) -> None:
    """The server is still searching a folder for programs when the session ends."""
    for number in range(300):
        (tmp_path / f"{number}.pyr").write_text("wheel a", encoding="utf-8")
    folders = [{"uri": tmp_path.as_uri(), "name": "it"}]
    with RawServer(server, "--stdio") as raw:
        raw.send(
            request(0, "initialize", {"capabilities": {}, "workspaceFolders": folders}),
            notification("initialized", {}),
            SHUTDOWN,
        )
        raw.answer("bye")
        # Nothing else arrives although the search continues: it ends before a second one begins to wait.
        raw.send(outline(1))
        refused = raw.read()
        assert refused
        assert (refused.get("id"), code(refused)) == (1, -32600)
        raw.send(EXIT)
        assert everything_left(raw) == []
        assert raw.leave() == 0


LONG = "".join(f"wheel w{n} with radius 4.5 // {n:0200}\n" for n in range(2000))


def test_exit_does_not_wait_for_work(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(opened(LONG), *(outline(n) for n in range(50)), EXIT)
        assert raw.leave() == 1


def test_requests_sent_before_shutdown_are_answered_or_dropped_but_never_twice(
    server: str,
) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(opened(LONG), *(outline(n) for n in range(10)), SHUTDOWN, EXIT)
        found = [m["id"] for m in everything_left(raw) if "method" not in m]
        assert len(found) == len(set(found))
        assert "bye" in found
        assert raw.leave() == 0


@pytest.mark.parametrize(
    "last",
    [
        b"Content-Le",
        b"Content-Length: 100\r\n",
        b"Content-Length: 100\r\n\r\n",
        b'Content-Length: 100\r\n\r\n{"jsonrpc": "2.0", "met',
        b"Content-Length: 268435456\r\n\r\n{",
        outline(1)[:-1],
    ],
)
def test_the_input_may_end_within_a_message(server: str, last: bytes) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(opened("wheel a with radius 4"), last)
        raw.input.close()
        assert all("method" in message for message in everything_left(raw))
        assert raw.leave() == 1


def test_a_client_that_no_longer_reads_is_served_until_its_input_ends(
    server: str,
) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.output.close()
        raw.send(opened(LONG), *(outline(n) for n in range(3)), SHUTDOWN, EXIT)
        assert raw.leave() == 0


#### Messages ####


def test_messages_may_arrive_in_parts(server: str) -> None:
    whole = opened("wheel a with radius 4") + outline(1)
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        for at in range(len(whole)):
            raw.send(whole[at : at + 1])
        assert raw.answer(1)["result"][0]["name"] == "a"


def test_headers_of_any_kind_are_understood(server: str) -> None:
    body = json.dumps({"jsonrpc": "2.0", "id": 7, "method": "no/such"}).encode()
    length = b"Content-Length: %d" % len(body)
    kind = b"Content-Type: application/vscode-jsonrpc; charset=utf-8"
    headers = [
        [length, kind],
        [kind, length],
        [length.lower(), b"X-More: 1"],
        [length.replace(b": ", b":"), kind.replace(b"utf-8", b"utf8")],
        [length.replace(b": ", b":   ")],
    ]
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        for lines in headers:
            raw.send(b"\r\n".join(lines) + b"\r\n\r\n" + body)
            assert code(raw.answer(7)) == -32601
        raw.send(b"\n".join(headers[0]) + b"\n\n" + body)
        assert code(raw.answer(7)) == -32601


@pytest.mark.parametrize(
    "header",
    [
        b"X-Nothing: 1\r\n\r\n",
        b"Content-Length: 1e3\r\n\r\n",
        b"Content-Length: -5\r\n\r\n",
        b"Content-Length: 268435457\r\n\r\n",
        b"Content-Length: 18446744073709551616\r\n\r\n",
        b"Content-Length\r\n\r\n",
        b"\xff\xfe\x00" * 3000 + b"\r\n\r\n",
    ],
)
def test_a_header_without_usable_length_is_answered_once(
    server: str, header: bytes
) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(header, b'{"jsonrpc": "2.0", "id": 1, "method": "x"}', outline(2))
        refused = raw.read()
        assert refused
        assert (refused["id"], code(refused)) == (None, -32700)
        found = raw.read()
        assert found
        assert found["id"] == 2


@pytest.mark.parametrize("ident", ["1", "", "é🤖", 0, -1, 2**53, 2**62, "x" * 10_000])
def test_responses_have_the_id_of_their_request(server: str, ident: int | str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(outline(ident), request(ident, "no/such", {}))
        for expected in (None, -32601):
            message = raw.read()
            assert message
            assert message["id"] == ident
            assert type(message["id"]) is type(ident)
            assert code(message) == expected


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (b"", -32700),
        (b'{"jsonrpc": "2.0", "id": 1, "method": "a"', -32700),
        (b'[{"jsonrpc": "2.0", "id": 1, "method": "a"}]', -32600),
        (b"[]", -32600),
        (b"null", -32600),
        (b'{"jsonrpc": "2.0", "id": 1.5, "method": "a"}', -32600),
        (b'{"jsonrpc": "2.0", "id": {}, "method": "a"}', -32600),
        (b'{"jsonrpc": "2.0"}', -32600),
        (b'{"id": null, "method": "a"}', -32600),
        (b"[" * 100_000, -32700),
        ("\ufeff{}".encode(), -32700),
    ],
)
def test_invalid_messages_are_answered_without_an_id(
    server: str, body: bytes, expected: int
) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(frame(body), outline(2))
        messages = [raw.read(), raw.read()]
        assert [(m["id"], code(m)) for m in messages if m] == [
            (None, expected),
            (2, None),
        ]


def test_an_invalid_notification_has_no_response(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(
            notification("no/such", {"x": [1]}),
            notification("$/no/such", None),
            notification("$/setTrace", {"value": "verbose"}),
            notification("$/setTrace", 7),
            notification("$/cancelRequest", {"id": 99}),
            notification("$/cancelRequest", {"id": [1]}),
            notification("$/cancelRequest", None),
            notification("$/progress", {"token": 1, "value": {}}),
            notification("window/workDoneProgress/cancel", {"token": "none"}),
            notification("textDocument/didOpen", {"textDocument": 1}),
            notification("textDocument/didOpen", None),
            notification("textDocument/didChange", NAMED),
            notification("textDocument/didSave", NAMED),
            notification("textDocument/didClose", NAMED),
            notification("textDocument/willSave", {**NAMED, "reason": 1}),
            notification("workspace/didChangeWatchedFiles", {"changes": [{}]}),
            # Methods of requests, sent without an id.
            notification("textDocument/hover", NAMED),
            notification("textDocument/documentSymbol", NAMED),
            notification("shutdown", None),
            answer(55, None),
            answer("never asked", {"x": 1}),
            frame(b'{"jsonrpc": "2.0", "id": 5, "error": {"code": 1, "message": ""}}'),
            frame(b'{"jsonrpc": "2.0", "id": null, "error": {"code": 1}}'),
            request(1, "$/no/such", None),
            outline(2),
        )
        messages = [raw.read(), raw.read()]
        assert [(m.get("id"), code(m)) for m in messages if m] == [
            (1, -32601),
            (2, None),
        ]
        raw.send(EXIT)
        assert everything_left(raw) == []
        assert raw.leave() == 1, "a notification named shutdown is none"


@pytest.mark.parametrize(
    "params",
    [
        None,
        [],
        [1],
        {},
        {"textDocument": {"uri": ""}, "position": {"line": 0, "character": 0}},
        {"textDocument": {"uri": URI}, "position": {"line": -1, "character": 0}},
        {"textDocument": {"uri": URI}, "position": {"line": 0.5, "character": 0}},
        {"textDocument": {"uri": URI}, "position": {"line": 2**40, "character": 0}},
    ],
)
def test_invalid_parameters_are_refused(server: str, params: object) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(
            opened("wheel a"), request(1, "textDocument/hover", params), outline(2)
        )
        message = raw.answer(1)
        assert code(message) == -32602 or message == {
            "jsonrpc": "2.0",
            "id": 1,
            "result": None,
        }
        if (
            not isinstance(params, dict)
            or params.get("textDocument", {}).get("uri") != ""
        ):
            assert code(message) == -32602
        assert raw.answer(2)["result"]


def test_requests_with_progress_tokens_are_answered_like_others(server: str) -> None:
    """The server does not announce progress for requests, so it must not use their tokens."""
    tokens = {"workDoneToken": "w", "partialResultToken": 3}
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(
            opened("wheel a"),
            request(1, "textDocument/documentSymbol", {**NAMED, **tokens}),
            request(2, "workspace/symbol", {"query": "", **tokens}),
        )
        heard = []
        while (message := raw.read()) is not None and message.get("id") != 2:
            heard.append(message)
        assert message
        assert message["result"][0]["name"] == "a"
        assert "$/progress" not in {m.get("method") for m in heard}


def test_progress_has_a_token_of_its_own_each_time(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.start(folder=tmp_path)
        for name in ("one", "two"):
            (tmp_path / name).mkdir()
            added = [{"uri": (tmp_path / name).as_uri(), "name": name}]
            change = {"event": {"added": added, "removed": []}}
            raw.send(notification("workspace/didChangeWorkspaceFolders", change))
        kinds: dict[str, list[str]] = {}
        while sum(seen.count("end") for seen in kinds.values()) < 3:
            progress = talk.hear_until("$/progress")["params"]
            kinds.setdefault(progress["token"], []).append(progress["value"]["kind"])
        assert list(kinds.values()) == [["begin", "end"]] * 3


def test_progress_that_the_client_refuses_is_not_sent(
    server: str, tmp_path: pathlib.Path
) -> None:
    folders = [{"uri": tmp_path.as_uri(), "name": "it"}]
    (tmp_path / "a.pyr").write_text("wheel a", encoding="utf-8")
    capabilities = {"window": {"workDoneProgress": True}}
    params = {"capabilities": capabilities, "workspaceFolders": folders}
    with RawServer(server, "--stdio") as raw:
        raw.send(request(0, "initialize", params), notification("initialized", {}))
        asked = raw.read_until("window/workDoneProgress/create")
        error = {"code": -32603, "message": "no"}
        refusal = {"jsonrpc": "2.0", "id": asked["id"], "error": error}
        raw.send(frame(json.dumps(refusal).encode()))
        received = raw.read()
        assert received
        assert received["method"] == "textDocument/publishDiagnostics"
        raw.send(SHUTDOWN, EXIT)
        assert [message.get("id") for message in everything_left(raw)] == ["bye"]


def cancelled(idents: Iterable[int]) -> list[bytes]:
    return [notification("$/cancelRequest", {"id": ident}) for ident in idents]


def answers(raw: RawServer, count: int) -> dict[Any, dict[str, Any]]:
    """The next responses, each to another request."""
    found: dict[Any, dict[str, Any]] = {}
    while len(found) < count:
        message = raw.read()
        assert message, f"the server left after {[*found]}"
        if "method" not in message:
            assert message["id"] not in found, "answered twice"
            found[message["id"]] = message
    return found


def test_requests_that_wait_hold_up_nothing_until_they_are_cancelled(
    server: str,
) -> None:
    """Diagnostics of the workspace wait for a change, which does not come."""
    method, idents = "workspace/diagnostic", range(1, 31)
    position = {"line": 0, "character": 7}
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(opened(LONG), request(0, method, {"previousResultIds": []}))
        [report] = raw.answer(0)["result"]["items"]
        known = [{"uri": report["uri"], "value": report["resultId"]}]
        raw.send(
            *(request(ident, method, {"previousResultIds": known}) for ident in idents),
            request("hover", "textDocument/hover", {**NAMED, "position": position}),
        )
        [(ident, hover)] = answers(raw, 1).items()
        assert (ident, bool(hover["result"])) == ("hover", True)
        raw.send(*cancelled(idents), *cancelled(idents))
        found = answers(raw, len(idents))
        codes = {ident: code(message) for ident, message in found.items()}
        assert codes == dict.fromkeys(idents, -32800)
        raw.send(SHUTDOWN, EXIT)
        left = [message for message in everything_left(raw) if "method" not in message]
        assert [message["id"] for message in left] == ["bye"]


def test_work_that_is_cancelled_is_answered_once(server: str) -> None:
    """Some of it may be done before its cancellation is read; tests/hostile sees to it that most is not."""
    idents = range(1, 31)
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(
            opened(LONG), *(outline(ident) for ident in idents), *cancelled(idents)
        )
        found = answers(raw, len(idents))
        assert found.keys() == set(idents)
        assert {code(message) for message in found.values()} <= {None, -32800}
        raw.send(SHUTDOWN, EXIT)
        left = [message for message in everything_left(raw) if "method" not in message]
        assert [message["id"] for message in left] == ["bye"]


@pytest.mark.skipif(sys.platform != "linux", reason="threads are watched in /proc")
def test_an_idle_server_uses_no_time(server: str, tmp_path: pathlib.Path) -> None:
    """No thread of the server wakes up while another session runs from start to end."""

    def wakes(raw: RawServer) -> dict[str, str]:
        tasks = pathlib.Path(f"/proc/{raw.process.pid}/task")
        return {
            task.name: next(
                line
                for line in (task / "status").read_text().splitlines()
                if line.startswith("voluntary_ctxt_switches")
            )
            for task in tasks.iterdir()
        }

    def settled(raw: RawServer) -> dict[str, str]:
        """The counts, once no thread is running and two consecutive readings are equal."""
        tasks = pathlib.Path(f"/proc/{raw.process.pid}/task")
        while True:
            before = wakes(raw)
            states = [
                (task / "stat").read_text().rpartition(")")[2].split()[0]
                for task in tasks.iterdir()
            ]
            if set(states) == {"S"} and wakes(raw) == before:
                return before

    with RawServer(server, "--stdio") as idle:
        talk = Conversation(idle)
        (tmp_path / "a.pyr").write_text("wheel a", encoding="utf-8")
        talk.start(folder=tmp_path)
        idle.send(opened(LONG))
        talk.hear_until("$/progress")
        talk.ask("textDocument/semanticTokens/full", NAMED)
        talk.ask("workspace/symbol", {"query": "w"})
        before = settled(idle)
        with RawServer(server, "--stdio") as busy:
            busy.initialize()
            busy.send(opened(LONG), *(outline(n) for n in range(5)), SHUTDOWN, EXIT)
            everything_left(busy)
            assert busy.leave() == 0
        assert wakes(idle) == before


def test_nothing_but_frames_is_on_the_output(server: str) -> None:
    """Errors go to standard error."""
    wrong = [
        frame(b"{"),
        b"garbage\r\n\r\n",
        opened("wheel \x00 é"),
        notification("textDocument/didChange", {**NAMED, "contentChanges": []}),
        notification("textDocument/didClose", {"textDocument": {"uri": "file:///b"}}),
        answer(55, None),
    ]
    hello = request(0, "initialize", {"capabilities": {}})
    done = subprocess.run(
        [server, "--stdio"],
        input=b"".join([hello, *wrong, SHUTDOWN, EXIT]),
        capture_output=True,
        check=True,
    )
    rest = done.stdout
    while rest:
        header, _, rest = rest.partition(b"\r\n\r\n")
        name, _, length = header.partition(b": ")
        assert name == b"Content-Length"
        json.loads(rest[: int(length)])
        rest = rest[int(length) :]
    assert b"file:///b" in done.stderr
