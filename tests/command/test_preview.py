"""`preview`: the planned path of a saved program, as a page that follows it."""

from __future__ import annotations

import http.client
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from typing import IO, Any
from urllib.parse import urlsplit

import pytest

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")

PROGRAM = """wheel l with radius 4
wheel r with radius 4
robot a type tw with port 23000 has { l r } wheels
movement m of a { move 1 meters }
environment yard has { a } robots with { m } moves
"""

# Reached only if something is broken.
LIMIT = 60


class Preview:
    """A running `preview`, and its page."""

    def __init__(self, command: str, program: pathlib.Path, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [command, "preview", program.name, "--no-open", *arguments],
            cwd=program.parent,
            stdout=subprocess.PIPE,
            encoding="utf-8",
        )
        self.uri = program.as_uri()
        assert self.process.stdout
        self.output: IO[str] = self.process.stdout
        found = re.fullmatch(r"Path preview: (http://127\.0\.0\.1:(\d+)/\w+/)\n", self.output.readline())  # fmt: skip
        assert found
        self.port = int(found[2])
        self.path = urlsplit(found[1]).path
        self.connections: list[http.client.HTTPConnection] = []
        self.events = self._request("GET", "events")

    def _request(
        self, method: str, name: str, body: str | None = None
    ) -> http.client.HTTPResponse:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=LIMIT)
        self.connections.append(connection)
        headers = {
            "Origin": f"http://127.0.0.1:{self.port}",
            "Content-Type": "application/json",
        }
        connection.request(method, self.path + name, body, headers)
        return connection.getresponse()

    def end(self) -> float | None:
        """Where the robot of the page's path ends; `None` if the program has no path."""
        message = {
            "jsonrpc": "2.0",
            "id": 1,
            "method": "pydslrep/plannedPath",
            "params": {"uri": self.uri, "environment": "yard"},
        }
        answer = json.loads(
            self._request("POST", "messages", json.dumps(message)).read()
        )
        if "error" in answer:
            return None
        x: float = answer["result"]["robots"][0]["poses"][-1]["x"]
        return x

    def follows_to(self, end: float) -> bool:
        """Waits until the page's path ends there. A file may have been truncated before it is written."""
        while self.until("pydslrep/plannedPathChanged"):
            if self.end() == pytest.approx(end):
                return True
        return False

    def until(self, method: str) -> dict[str, Any] | None:
        """The parameters of the next event of a kind; `None` when the page has ended."""
        while line := self.events.readline():
            if line.startswith(b"data: "):
                event = json.loads(line.removeprefix(b"data: "))
                if event["method"] == method:
                    params: dict[str, Any] = event["params"]
                    return params
        return None

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        self.output.close()
        self.events.close()
        for connection in self.connections:
            connection.close()


@pytest.fixture
def program(tmp_path: pathlib.Path) -> pathlib.Path:
    path = tmp_path / "yard.pyr"
    path.write_text(PROGRAM, encoding="utf-8")
    return path


@pytest.fixture
def preview(command: str, program: pathlib.Path) -> Iterator[Preview]:
    preview = Preview(command, program)
    yield preview
    preview.kill()


def test_the_page_follows_the_saved_program(
    preview: Preview, program: pathlib.Path
) -> None:
    moved = preview.until("pydslrep/cursorMoved")
    assert moved
    assert moved["textDocument"]["uri"] == preview.uri
    assert preview.end() == pytest.approx(1.0)
    # A shorter text first, as an editor that truncates the file.
    program.write_text("", encoding="utf-8")
    program.write_text(PROGRAM.replace("move 1", "move 2"), encoding="utf-8")
    assert preview.follows_to(2.0)


def test_the_page_follows_imports_and_scenes(
    command: str, tmp_path: pathlib.Path
) -> None:
    lines = PROGRAM.splitlines(keepends=True)
    (tmp_path / "parts.pyr").write_text("".join(lines[:4]), encoding="utf-8")
    program = tmp_path / "yard.pyr"
    program.write_text('import "parts.pyr"\n' + lines[4], encoding="utf-8")
    preview = Preview(command, program)
    try:
        assert preview.end() == pytest.approx(1.0)
        moved = "".join(lines[:4]).replace("move 1", "move 3")
        (tmp_path / "parts.pyr").write_text(moved, encoding="utf-8")
        assert preview.follows_to(3.0)
        scene = tmp_path / "yard.scene.toml"
        scene.write_text("[robots.a]\nstart = [1.0, 0.0, 0]\n", encoding="utf-8")
        assert preview.follows_to(4.0)
    finally:
        preview.kill()


def test_an_interrupt_ends_it(preview: Preview) -> None:
    assert preview.output.readline() == "Press Ctrl+C to stop.\n"
    preview.process.send_signal(signal.SIGINT)
    assert preview.until("nothing") is None
    assert preview.process.wait(LIMIT) == 130


def test_the_page_is_opened_in_the_browser(command: str, program: pathlib.Path) -> None:
    address = program.parent / "address"
    browser = program.parent / "browser"
    # Ends the command.
    browser.write_text(
        f'#!/bin/sh\necho "$1" > {address}\nkill -INT $PPID\n', encoding="utf-8"
    )
    browser.chmod(0o755)
    done = subprocess.run(
        [command, "preview", program],
        env={**os.environ, "BROWSER": str(browser)},
        stdout=subprocess.PIPE,
        encoding="utf-8",
        check=False,
        timeout=LIMIT,
    )
    assert done.returncode == 130
    opened = address.read_text(encoding="utf-8")
    assert done.stdout.startswith(f"Path preview: {opened}")


def test_it_serves_on_the_given_port(
    command: str, program: pathlib.Path, preview: Preview
) -> None:
    done = subprocess.run(
        [command, "preview", program, "--no-open", "--port", str(preview.port)],
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 2
    assert "cannot start the preview" in done.stderr
    assert "choose another port" in done.stderr


@pytest.mark.parametrize(("name", "says"), [("-", "cannot be followed"), ("none.pyr", "none.pyr")])  # fmt: skip
def test_what_cannot_be_shown(
    command: str, tmp_path: pathlib.Path, name: str, says: str
) -> None:
    done = subprocess.run(
        [command, "preview", name],
        cwd=tmp_path,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 2
    assert says in done.stderr
