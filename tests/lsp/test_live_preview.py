"""The live preview: a page for a browser, which follows the text and the cursor, and gives other pages nothing."""

from __future__ import annotations

import http.client
import json
import pathlib
import re
import socket
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any
from urllib.parse import urlsplit

import pytest
from raw import RawServer, answer, frame, notification, request

ROOT = pathlib.Path(__file__).parents[2]
URI = "file:///tmp/yard.pyr"
OTHER = "file:///tmp/other.pyr"
PROGRAM = """wheel l with radius 4
wheel r with radius 4
robot a type tw with port 23000 has { l r } wheels
movement m of a {
  move 1 meters
  turn left
}
environment yard has { a } robots with { m } moves
"""
COMMAND = "workspace/executeCommand"
SHOWS = {"window": {"showDocument": {"support": True}}}

# Reached only if something is broken.
LIMIT = 60


class Page:
    """What a browser does for the page."""

    def __init__(self, address: str) -> None:
        parts = urlsplit(address)
        assert parts.hostname == "127.0.0.1"
        assert parts.port
        self.port = parts.port
        self.path = parts.path
        self.origin = f"http://127.0.0.1:{parts.port}"
        self.connection: http.client.HTTPConnection | None = None
        self.stream: http.client.HTTPResponse | None = None

    def close(self) -> None:
        if self.connection and self.stream:
            self.stream.close()
            self.connection.close()

    def fetch(
        self,
        name: str = "",
        method: str = "GET",
        body: bytes | None = None,
        **headers: str,
    ) -> tuple[int, bytes, dict[str, str]]:
        """A response to a request with these headers; underscores are hyphens."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=LIMIT)
        given = {key.replace("_", "-"): value for key, value in headers.items()}
        target = name if name.startswith("/") else self.path + name
        connection.request(method, target, body, given)
        response = connection.getresponse()
        found = (response.status, response.read(), dict(response.getheaders()))
        connection.close()
        return found

    def send(self, body: bytes, **headers: str) -> tuple[int, bytes]:
        own = {"origin": self.origin, "content_type": "application/json", **headers}
        return self.fetch("messages", "POST", body, **own)[:2]

    def ask(self, method: str, params: object) -> Any:
        """The response to a message of the page."""
        message = {"jsonrpc": "2.0", "id": 7, "method": method, "params": params}
        status, body = self.send(json.dumps(message).encode())
        assert status == 200
        response = json.loads(body)
        assert response["id"] == 7
        return response

    def listen(self) -> None:
        """Opens the stream of events."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=LIMIT)
        connection.request("GET", self.path + "events")
        self.connection = connection
        self.stream = connection.getresponse()
        assert self.stream.status == 200
        assert self.stream.headers["content-type"] == "text/event-stream"

    def event(self) -> dict[str, Any] | None:
        """The next event; `None` at the end of the stream."""
        assert self.stream
        while line := self.stream.readline():
            if line.startswith(b"data: "):
                event: dict[str, Any] = json.loads(line.removeprefix(b"data: "))
                return event
        return None

    def until(self, method: str) -> dict[str, Any]:
        while (event := self.event()) is not None:
            if event["method"] == method:
                params: dict[str, Any] = event["params"]
                return params
        raise AssertionError(f"no {method}")


def document(text: str, uri: str = URI) -> bytes:
    opened = {"uri": uri, "languageId": "pydslrep", "version": 1, "text": text}
    return notification("textDocument/didOpen", {"textDocument": opened})


def edit(line: int, start: int, end: int, text: str, version: int = 2) -> bytes:
    span = {
        "start": {"line": line, "character": start},
        "end": {"line": line, "character": end},
    }
    params = {
        "textDocument": {"uri": URI, "version": version},
        "contentChanges": [{"range": span, "text": text}],
    }
    return notification("textDocument/didChange", params)


def at(line: int, character: int, uri: str = URI) -> dict[str, Any]:
    return {
        "textDocument": {"uri": uri},
        "position": {"line": line, "character": character},
    }


def opened(raw: RawServer, *arguments: object) -> Page:
    """The page of a preview that was just opened in an editor that cannot show it."""
    command = {"command": "pydslrep.openPreview", "arguments": list(arguments)}
    raw.send(request(1, COMMAND, command))
    return Page(raw.answer(1)["result"]["address"])


@pytest.fixture
def raw(server: str) -> Iterator[RawServer]:
    with RawServer(server, "--stdio") as raw:
        raw.initialize(SHOWS)
        raw.send(document(PROGRAM))
        yield raw


@pytest.fixture
def page(raw: RawServer) -> Iterator[Page]:
    """A page in a session."""
    command = {"command": "pydslrep.openPreview", "arguments": [{"uri": URI}]}
    raw.send(request(1, COMMAND, command))
    shown = raw.read_until("window/showDocument")
    assert shown["params"]["external"] is True
    raw.send(answer(shown["id"], {"success": True}))
    address = raw.answer(1)["result"]["address"]
    assert address == shown["params"]["uri"]
    page = Page(address)
    yield page
    page.close()


#### What it does ####


def test_the_page_is_served_and_loads_nothing_from_elsewhere(page: Page) -> None:
    status, body, headers = page.fetch()
    assert status == 200
    assert headers["content-type"] == "text/html; charset=utf-8"
    policy = headers["content-security-policy"].split("; ")
    assert policy[0] == "default-src 'none'"
    assert "frame-ancestors 'none'" in policy
    assert not any("unsafe" in part or "http" in part for part in policy)
    names = re.findall(rb'(?:src|href)="([^"]+)"', body)
    assert names == [b"data:,", b"page.css", b"page.js"]
    for name in ("page.css", "page.js"):
        assert page.fetch(name)[0] == 200
    assert headers["cache-control"] == "no-store"
    assert headers["referrer-policy"] == "no-referrer"


def test_an_editor_that_cannot_show_it_says_where_it_is(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(document(PROGRAM))
        command = {"command": "pydslrep.openPreview", "arguments": []}
        raw.send(request(1, COMMAND, command))
        message = raw.read_until("window/showMessage")["params"]
        address = raw.answer(1)["result"]["address"]
    assert message == {"type": 3, "message": f"Path preview: {address}"}


def test_helix_shows_it_without_having_said_so(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        info = {"name": "helix", "version": "25.01"}
        raw.send(
            request(0, "initialize", {"capabilities": {}, "clientInfo": info}),
            notification("initialized", {}),
        )
        raw.answer(0)
        raw.send(document(PROGRAM))
        command = {"command": "pydslrep.openPreview", "arguments": []}
        raw.send(request(1, COMMAND, command))
        shown = raw.read_until("window/showDocument")
        error = {"code": -32601, "message": "an older one cannot"}
        refusal = {"jsonrpc": "2.0", "id": shown["id"], "error": error}
        raw.send(frame(json.dumps(refusal).encode()))
        message = raw.read_until("window/showMessage")["params"]["message"]
        assert message == f"Path preview: {shown['params']['uri']}"


def test_without_a_program_there_is_nothing_to_show(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        command = {"command": "pydslrep.openPreview", "arguments": []}
        raw.send(request(1, COMMAND, command))
        assert "open a program" in raw.answer(1)["error"]["message"]


def test_the_preview_is_opened_once(raw: RawServer, page: Page) -> None:
    page.listen()
    page.until("pydslrep/cursorMoved")
    chosen = {"uri": URI, "environment": "yard"}
    command = {"command": "pydslrep.openPreview", "arguments": [chosen]}
    raw.send(request(2, COMMAND, command))
    again = raw.read_until("window/showDocument")
    raw.send(answer(again["id"], {"success": False}))
    assert raw.read_until("window/showMessage")["params"]["message"].endswith(page.path)
    assert Page(raw.answer(2)["result"]["address"]).port == page.port
    assert page.until("pydslrep/cursorMoved")["environment"] == "yard"
    # A page that opens later begins with it, wherever the cursor is meanwhile.
    raw.send(request(3, "textDocument/hover", at(5, 4)))
    assert page.until("pydslrep/cursorMoved") == {**at(5, 4), "isEdit": False}
    page.close()
    page.listen()
    first = page.until("pydslrep/cursorMoved")
    assert first == {**at(5, 4), "isEdit": False, "environment": "yard"}


def test_the_page_asks_for_paths_and_is_told_of_changes(
    raw: RawServer, page: Page
) -> None:
    page.listen()
    first = page.until("pydslrep/cursorMoved")
    assert first["textDocument"] == {"uri": URI}
    found = page.ask("pydslrep/plannedAt", at(4, 3))["result"]
    assert found["environments"] == ["yard"]
    assert found["action"] == {"movement": "m", "index": 0}
    yard = {"uri": URI, "environment": "yard"}
    path = page.ask("pydslrep/plannedPath", yard)["result"]
    assert path["robots"][0]["poses"][-1]["x"] == pytest.approx(1.0)
    assert page.ask("pydslrep/drivenPath", yard)["result"] is None
    raw.send(edit(4, 7, 8, "25"))
    moved = page.until("pydslrep/cursorMoved")
    assert moved == {**at(4, 9), "isEdit": True}
    assert page.until("pydslrep/plannedPathChanged") == yard
    path = page.ask("pydslrep/plannedPath", yard)["result"]
    assert path["robots"][0]["poses"][-1]["x"] == pytest.approx(25.0)


def test_the_page_and_the_editor_are_told_apart(raw: RawServer, page: Page) -> None:
    """An editor without a preview of its own would not understand the notification."""
    page.ask("pydslrep/plannedPath", {"uri": URI, "environment": "yard"})
    page.listen()
    raw.send(edit(4, 7, 8, "2"))
    page.until("pydslrep/plannedPathChanged")
    raw.send(request(3, "textDocument/foldingRange", {"textDocument": {"uri": URI}}))
    methods = []
    while (message := raw.read()) and message.get("id") != 3:
        methods.append(message["method"])
    assert "pydslrep/plannedPathChanged" not in methods
    # Each is told of its own.
    raw.send(
        request(4, "pydslrep/plannedPath", {"uri": URI, "environment": "yard"}),
        edit(4, 7, 8, "3", version=3),
    )
    changed = raw.read_until("pydslrep/plannedPathChanged")["params"]
    assert changed == {"uri": URI, "environment": "yard"}


@pytest.mark.parametrize(
    ("method", "more"),
    [
        ("textDocument/documentHighlight", {}),
        ("textDocument/hover", {}),
        ("textDocument/signatureHelp", {}),
        ("pydslrep/plannedAt", {}),
        ("textDocument/codeAction", {"context": {"diagnostics": []}}),
    ],
)
def test_requests_of_the_editor_say_where_the_cursor_is(
    raw: RawServer, page: Page, method: str, more: dict[str, Any]
) -> None:
    page.listen()
    page.until("pydslrep/cursorMoved")
    place = at(5, 4)
    if more:
        place = {
            "textDocument": {"uri": URI},
            "range": {
                "start": {"line": 5, "character": 2},
                "end": {"line": 5, "character": 4},
            },
            **more,
        }
    raw.send(request(5, method, place))
    assert page.until("pydslrep/cursorMoved") == {**at(5, 4), "isEdit": False}


def test_settings_are_not_followed(raw: RawServer, page: Page) -> None:
    page.listen()
    page.until("pydslrep/cursorMoved")
    settings = "file:///tmp/pydslrep.toml"
    raw.send(
        document("target = 'vrep'", settings),
        request(5, "textDocument/hover", at(0, 2, settings)),
        document(PROGRAM, OTHER),
        request(6, "textDocument/hover", at(1, 2, OTHER)),
    )
    moved = page.until("pydslrep/cursorMoved")
    assert moved["textDocument"] == {"uri": OTHER}


def test_a_click_selects_the_action_in_the_editor(raw: RawServer, page: Page) -> None:
    action = {"uri": URI, "environment": "yard", "movement": "m", "index": 1}
    location = page.ask("pydslrep/actionLocation", action)["result"]
    assert page.ask("pydslrep/reveal", location)["result"] is True
    shown = raw.read_until("window/showDocument")["params"]
    assert shown == {"uri": URI, "takeFocus": True, "selection": location["range"]}
    assert location["range"]["start"] == {"line": 5, "character": 2}


def test_an_editor_that_cannot_show_locations_is_not_asked(server: str) -> None:
    with RawServer(server, "--stdio") as raw:
        raw.initialize()
        raw.send(document(PROGRAM))
        page = opened(raw)
        nowhere = {"line": 0, "character": 0}
        location = {"uri": URI, "range": {"start": nowhere, "end": nowhere}}
        assert page.ask("pydslrep/reveal", location)["result"] is False


def test_the_page_ends_with_the_session(raw: RawServer, page: Page) -> None:
    page.listen()
    page.until("pydslrep/cursorMoved")
    raw.send(request(9, "shutdown", None))
    raw.answer(9)
    while page.event() is not None:
        pass
    raw.send(notification("exit", None))
    assert raw.leave() == 0
    with pytest.raises(ConnectionRefusedError):
        page.fetch()


def test_the_page_ends_when_the_editor_leaves(raw: RawServer, page: Page) -> None:
    page.listen()
    raw.input.close()
    while page.event() is not None:
        pass
    assert raw.leave() == 1


#### What others get ####

NOTHING = (404, b"")


def is_nothing(found: tuple[int, bytes, dict[str, str]]) -> bool:
    return found[:2] == NOTHING and "access-control-allow-origin" not in found[2]


def test_the_address_cannot_be_guessed(server: str) -> None:
    secrets = set()
    for _ in range(3):
        with RawServer(server, "--stdio") as raw:
            raw.initialize()
            raw.send(document(PROGRAM))
            secrets.add(opened(raw).path)
    assert len(secrets) == 3
    assert all(re.fullmatch("/[0-9a-f]{32}/", secret) for secret in secrets)


def test_whoever_guesses_the_port_gets_nothing(page: Page) -> None:
    wrong = "/" + "0" * 32 + "/"
    almost = page.path[:-2] + ("0" if page.path[-2] != "0" else "1") + "/"
    short, doubled = page.path[:-2] + "/", "/" + page.path
    for path in ("/", "/page.js", "//", wrong, almost, short, doubled, page.path[:-1]):
        for name in ("", "page.js", "events", "messages"):
            assert is_nothing(page.fetch(path + name)), path + name
    assert is_nothing(page.fetch("*", "OPTIONS"))


def test_only_what_exists_is_served(page: Page) -> None:
    names = (
        "../page.js", "..%2fpage.js", "page.js/", "./page.js", "%70age.js", "/page.js", "page.js?a",
        "../../etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "..\\..\\etc\\passwd", "main.ts", ".", "..",
    )  # fmt: skip
    for name in names:
        assert is_nothing(page.fetch(page.path + name)), name
    for method in ("POST", "PUT", "DELETE", "HEAD", "OPTIONS", "TRACE"):
        status, body, _ = page.fetch("", method, origin=page.origin)
        assert (status, body) == NOTHING, method


@pytest.mark.parametrize(
    "origin",
    ["http://evil.test", "null", "https://127.0.0.1:{}", "http://localhost:{}", "http://127.0.0.1:1", ""],
)  # fmt: skip
def test_pages_of_other_origins_get_nothing(page: Page, origin: str) -> None:
    origin = origin.format(page.port)
    for name in ("", "page.js", "events"):
        assert is_nothing(page.fetch(name, origin=origin)), name
    assert page.send(b"{}", origin=origin) == NOTHING
    wanted = "POST"
    assert is_nothing(
        page.fetch(
            "messages", "OPTIONS", access_control_request_method=wanted, origin=origin
        )
    )


def test_browsers_say_from_which_site_a_request_comes(page: Page) -> None:
    for site in ("cross-site", "same-site", "nonsense"):
        for name in ("", "page.js", "events"):
            assert is_nothing(page.fetch(name, sec_fetch_site=site)), site
    assert page.fetch(sec_fetch_site="none")[0] == 200
    assert page.fetch("page.js", sec_fetch_site="same-origin")[0] == 200


def test_messages_need_an_origin_and_their_type(page: Page) -> None:
    message = b'{"jsonrpc":"2.0","id":1,"method":"x"}'
    assert page.send(message)[0] == 200
    kind = "application/json"
    assert is_nothing(page.fetch("messages", "POST", message, content_type=kind))
    assert page.send(message, content_type="text/plain") == NOTHING
    assert page.send(message, sec_fetch_site="same-site") == NOTHING


def test_a_name_that_leads_to_this_machine_is_not_enough(page: Page) -> None:
    """A page elsewhere can have its own name resolve to 127.0.0.1; its browser sends that name."""
    port = page.port
    hosts = ("evil.test", f"evil.test:{port}", f"localhost:{port}", "127.0.0.1", f"127.0.0.1:{port + 1}", f"127.0.0.1:{port}.evil.test")  # fmt: skip
    for host in hosts:
        assert is_nothing(page.fetch(host=host)), host
        assert page.send(b"{}", host=host) == NOTHING


def exchange(page: Page, sent: bytes) -> bytes:
    """Everything that the server sends back until it closes the connection."""
    with socket.create_connection(("127.0.0.1", page.port), timeout=LIMIT) as stream:
        stream.sendall(sent)
        received = b""
        try:
            while part := stream.recv(1 << 16):
                received += part
        except ConnectionResetError:
            pass
        return received


def test_headers_that_contradict_each_other_get_nothing(page: Page) -> None:
    host = f"Host: 127.0.0.1:{page.port}\r\n"
    target = f"GET {page.path} HTTP/1.1\r\n"
    absolute = f"GET http://127.0.0.1:{page.port}{page.path} HTTP/1.1\r\n"
    end = "Connection: close\r\n\r\n"
    assert exchange(page, (target + host + end).encode()).startswith(b"HTTP/1.1 200")
    for head in (
        target + host + "Host: evil.test\r\n",
        target + "Host: evil.test\r\n" + host,
        target,
        absolute + "Host: evil.test\r\n",
        absolute + host,
        target + host + f"Origin: {page.origin}\r\nOrigin: http://evil.test\r\n",
    ):
        assert exchange(page, (head + end).encode()).startswith(b"HTTP/1.1 404"), head


def test_what_is_too_large_or_no_http_is_dropped(page: Page) -> None:
    head = f"GET {page.path} HTTP/1.1\r\nHost: 127.0.0.1:{page.port}\r\n".encode()
    assert b"200" not in exchange(page, head + b"A: " + b"a" * 100_000 + b"\r\n\r\n")
    assert b"200" not in exchange(page, head + b"A: b\r\n" * 2_000 + b"\r\n")
    assert b"200" not in exchange(page, b"\x16\x03\x01" + b"\0" * 1_000)
    assert page.send(b" " * 100_000) == NOTHING
    # The server is still there.
    assert page.fetch()[0] == 200


def test_what_is_too_slow_is_dropped(page: Page) -> None:
    """Half a head, and half a body: the server gives up, without a clock on this side."""
    head = f"GET {page.path} HTTP/1.1\r\nHost: 127.0.0.1:{page.port}\r\n"
    body = (
        f"POST {page.path}messages HTTP/1.1\r\nHost: 127.0.0.1:{page.port}\r\nOrigin: {page.origin}\r\n"
        "Content-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
    )
    with ThreadPoolExecutor() as pool:
        sent = [head.encode(), body.encode()]
        for received in pool.map(lambda part: exchange(page, part), sent):
            assert b"200" not in received


def most_connections() -> int:
    """How many connections the server keeps open at a time."""
    text = (ROOT / "crates/server/src/web.rs").read_text(encoding="utf-8")
    found = re.search(r"const MOST_CONNECTIONS: usize = (\d+);", text)
    assert found
    return int(found[1])


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_more_connections_than_may_be_open_keep_nobody_out(
    raw: RawServer, page: Page
) -> None:
    """Those that say nothing are dropped, and then others have their turn."""
    files = pathlib.Path(f"/proc/{raw.process.pid}/fd")
    most = len([*files.iterdir()]) + most_connections()
    idle = [
        socket.create_connection(("127.0.0.1", page.port), timeout=LIMIT)
        for _ in range(most_connections() + 50)
    ]
    # Comes after the others.
    assert page.fetch()[0] == 200
    assert len([*files.iterdir()]) <= most
    assert idle[0].recv(1) == b"", "the first was dropped without an answer"
    for stream in idle:
        stream.close()


def test_one_page_too_many_is_told_so(page: Page) -> None:
    head = f"GET {page.path}events HTTP/1.1\r\nHost: 127.0.0.1:{page.port}\r\n\r\n"
    pages = []
    for _ in range(128):
        stream = socket.create_connection(("127.0.0.1", page.port), timeout=LIMIT)
        stream.sendall(head.encode())
        assert stream.recv(12) == b"HTTP/1.1 200"
        pages.append(stream)
    status, body, _ = page.fetch()
    assert (status, b"close some" in body) == (503, True)
    pages.pop().close()
    assert page.fetch()[0] == 200
    for stream in pages:
        stream.close()


def test_a_page_cannot_ask_for_anything_else(page: Page) -> None:
    for method in (COMMAND, "textDocument/hover", "shutdown", "pydslrep/nonsense"):
        assert page.ask(method, {})["error"]["code"] == -32601, method
    assert page.ask("pydslrep/plannedPath", {"uri": 3})["error"]["code"] == -32602
    missing = {"uri": "file:///etc/passwd", "environment": "yard"}
    assert page.ask("pydslrep/plannedPath", missing)["error"]["code"] == -32803
    status, body = page.send(b"nonsense")
    assert (status, json.loads(body)["error"]["code"]) == (200, -32700)


def test_a_click_may_only_lead_to_a_program(
    raw: RawServer, page: Page, tmp_path: pathlib.Path
) -> None:
    nowhere = {"line": 0, "character": 0}
    span = {"start": nowhere, "end": nowhere}
    for uri in ("https://evil.test/", (tmp_path / "a.html").as_uri()):
        assert (
            page.ask("pydslrep/reveal", {"uri": uri, "range": span})["result"] is False
        )
    raw.send(request(9, "shutdown", None))
    while (message := raw.read()) and message.get("id") != 9:
        assert message.get("method") != "window/showDocument"
