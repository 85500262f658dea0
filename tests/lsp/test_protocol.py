"""Message order, malformed input and exits, at the level of bytes."""

from __future__ import annotations

import pathlib
import socket
import subprocess
import sys
from typing import Any

import pytest
from editor import built
from raw import RawServer, answer, frame, notification, request

URI = "file:///burst.pyr"
EXIT = notification("exit", None)
SHUTDOWN = request("bye", "shutdown", None)


def opened(text: str, uri: str = URI) -> bytes:
    document = {"uri": uri, "languageId": "pydslrep", "version": 1, "text": text}
    return notification("textDocument/didOpen", {"textDocument": document})


def inserted(version: int, text: str) -> bytes:
    start = {"line": 0, "character": 0}
    changes = [{"range": {"start": start, "end": start}, "text": text}]
    document = {"uri": URI, "version": version}
    return notification(
        "textDocument/didChange", {"textDocument": document, "contentChanges": changes}
    )


def outline(ident: int) -> bytes:
    return request(ident, "textDocument/documentSymbol", {"textDocument": {"uri": URI}})


def test_every_read_sees_exactly_the_changes_sent_before_it(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        burst = [opened("")]
        for change in range(1, 1001):
            burst.append(inserted(change + 1, f"wheel w{change} with radius 4.5\n"))
            if change % 50 == 0:
                burst.append(outline(change))
        raw.send(*burst, SHUTDOWN, EXIT)
        for change in range(50, 1001, 50):
            names = [symbol["name"] for symbol in raw.answer(change)["result"]]
            assert names == [f"w{number}" for number in range(change, 0, -1)]
        assert raw.leave() == 0


def test_diagnostics_of_a_burst_end_with_those_of_its_last_version(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(
            opened(""),
            *(inserted(version, "wheel ") for version in range(2, 502)),
            outline(1),
        )
        versions = raw.published_before(1)
        # After the first response, diagnostics arrive before the second one if nothing else has been sent.
        raw.send(outline(2))
        versions += raw.published_before(2)
        assert versions == sorted(versions)
        assert versions[-1] == 501


@pytest.mark.parametrize(
    ("goodbye", "code"),
    [
        ([SHUTDOWN, EXIT], 0),
        ([EXIT], 1),
    ],
)
def test_exit_ends_the_server_while_its_input_stays_open(
    server: str, goodbye: list[bytes], code: int
) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(*goodbye)
        assert raw.leave() == code
        assert not raw.input.closed


@pytest.mark.parametrize("before", [[], [SHUTDOWN]])
def test_the_end_of_the_input_ends_the_server(server: str, before: list[bytes]) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(*before)
        raw.input.close()
        assert raw.leave() == 1


def test_malformed_input_is_answered_and_skipped(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(
            frame(b"{"),
            frame(b'{"jsonrpc": "2.0", "id": 1, "method": "\xff"}'),
            frame(b"[]"),
            frame(b'{"hello": "world"}'),
            b'Content-Length: 99999999999999\r\n\r\n{"garbage": 1}',
            b"\x00\x01\x02 no header at all\r\n\r\n",
            frame(
                b'{"jsonrpc": "2.0", "id": 99, "result": "to nothing that was asked"}'
            ),
            request(2, "no/suchMethod", {}),
            request(3, "textDocument/hover", {"nonsense": True}),
            opened("wheel a with radius 4.5"),
            outline(4),
        )
        codes = [raw.answer(None)["error"]["code"] for _ in range(5)]
        assert codes == [-32700, -32700, -32600, -32600, -32700]
        assert raw.answer(2)["error"]["code"] == -32601
        assert raw.answer(3)["error"]["code"] == -32602
        assert [symbol["name"] for symbol in raw.answer(4)["result"]] == ["a"]


def test_requests_before_initialize_are_refused(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.send(outline(1))
        assert raw.answer(1)["error"]["code"] == -32002
        raw.initialize()
        raw.send(outline(2))
        assert "error" not in raw.answer(2)


@pytest.mark.parametrize("spelling", [["--socket", "{}"], ["--socket={}"]])
def test_the_server_connects_to_a_clients_socket(
    server: str, spelling: list[str]
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        process = subprocess.Popen(
            [server, *(part.format(port) for part in spelling)], stdout=subprocess.PIPE
        )
        connection, _ = listener.accept()
        with connection, connection.makefile("rb") as answers:
            connection.sendall(
                request(1, "initialize", {"capabilities": {}}) + SHUTDOWN + EXIT
            )
            assert b'"capabilities"' in answers.read()
        output, _ = process.communicate()
        assert (process.returncode, output) == (0, b"")


@pytest.mark.parametrize(
    "arguments",
    [[], ["--stdoi"], ["--socket"], ["--socket", "x"], ["--stdio", "--socket=1"]],
)
def test_wrong_arguments_are_refused(server: str, arguments: list[str]) -> None:
    done = subprocess.run(
        [server, *arguments],
        capture_output=True,
        text=True,
        stdin=subprocess.DEVNULL,
        check=False,
    )
    assert done.returncode == 2
    assert done.stdout == ""
    assert "--help" in done.stderr


def test_a_port_without_client_is_an_environment_error(server: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        free = listener.getsockname()[1]
    done = subprocess.run(
        [server, f"--socket={free}"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert str(free) in done.stderr


LITERALS: dict[str, Any] = {
    "codeActionLiteralSupport": {"codeActionKind": {"valueSet": []}}
}


@pytest.mark.parametrize("code_action", [{}, LITERALS])
def test_the_server_writes_the_script_where_the_client_cannot_create_files(
    server: str,
    command: str,
    tmp_path: pathlib.Path,
    table_2: str,
    code_action: dict[str, Any],
) -> None:
    uri = (tmp_path / "table2.pyr").as_uri()
    start = {"line": 0, "character": 0}
    context = {"diagnostics": [], "only": ["source"]}
    anywhere = {
        "textDocument": {"uri": uri},
        "range": {"start": start, "end": start},
        "context": context,
    }
    with RawServer(server, "--stdio") as raw:
        raw.initialize(
            {
                "textDocument": {"codeAction": code_action},
                "window": {"showDocument": {"support": True}},
            }
        )
        raw.send(opened(table_2, uri), request(1, "textDocument/codeAction", anywhere))
        [action] = raw.answer(1)["result"]
        chosen = action["command"] if code_action else action
        assert chosen["command"] == "pydslrep.generateScript"
        raw.send(
            request(
                2,
                "workspace/executeCommand",
                {k: chosen[k] for k in ("command", "arguments")},
            )
        )
        received = raw.read_until("window/showMessage")
        assert "area_1.py" in received["params"]["message"]
        asked = raw.read_until("window/showDocument")
        assert asked["params"]["uri"] == (tmp_path / "area_1.py").as_uri()
        raw.send(answer(asked["id"], {"success": True}))
        assert raw.answer(2)["result"] is None
        assert (tmp_path / "area_1.py").read_text(encoding="utf-8") == built(
            command, tmp_path, table_2
        )
        wrong = {
            "command": "pydslrep.generateScript",
            "arguments": [{"uri": uri, "environment": "nowhere"}],
        }
        raw.send(request(3, "workspace/executeCommand", wrong))
        assert "`nowhere`" in raw.answer(3)["error"]["message"]


@pytest.mark.skipif(
    sys.platform != "linux", reason="processes are watched on Linux only"
)
def test_the_server_exits_when_its_client_dies(server: str) -> None:
    """Even if another process keeps the server's input open, as this test does."""
    client = "import subprocess, sys; subprocess.Popen([sys.argv[1], '--stdio']).wait()"
    with RawServer(sys.executable, "-c", client, server) as raw:
        raw.send(
            request(1, "initialize", {"processId": raw.process.pid, "capabilities": {}})
        )
        raw.answer(1)
        raw.process.kill()
        assert raw.read() is None
        assert not raw.input.closed


def test_a_tracing_client_gets_the_cost_of_changes(server: str) -> None:
    def logged_before(raw: RawServer, ident: int) -> list[dict[str, Any]]:
        raw.send(outline(ident))
        heard = []
        while (message := raw.read()) is not None and message.get("id") != ident:
            heard.append(message)
        return [m["params"] for m in heard if m["method"] == "$/logTrace"]

    def traced(value: str) -> bytes:
        return notification("$/setTrace", {"value": value})

    wheel = "wheel a with radius 3\n"
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(opened(wheel), inserted(2, wheel), traced("messages"))
        raw.send(inserted(3, wheel))
        assert logged_before(raw, 1) == []
        raw.send(traced("verbose"), inserted(4, "wheel b with radius 3\n"))
        [received] = logged_before(raw, 2)
        assert received["message"] == f"changed {URI}"
        assert received["verbose"] == (
            "relexed: 23 tokens, reparsed: 2 entities, revalidated: 4 entities"
        )
        raw.send(traced("off"), inserted(5, wheel))
        assert logged_before(raw, 3) == []
        raw.send(SHUTDOWN, EXIT)
        assert raw.leave() == 0
