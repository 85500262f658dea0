"""The page of the live preview, without a browser: what it is told, and a click in it."""

from __future__ import annotations

import http.client
import json
import queue
import threading
from urllib.parse import urlsplit

from session import Session
from terminal import Terminal

# Takes the address that an editor opens.
BROWSER = """#!/bin/sh
printf %s "$1" > "{file}.part" && mv "{file}.part" "{file}"
"""

# Reached only if something is broken.
LIMIT = 60


class LivePreview:
    """What an editor's browser would show."""

    def __init__(self, session: Session) -> None:
        self._file = session.home / "address"
        browser = session.home / "bin" / "xdg-open"
        if not browser.exists():
            browser.write_text(BROWSER.format(file=self._file))
            browser.chmod(0o755)
        self._cursors: queue.Queue[int] = queue.Queue()
        self.program = session.program

    def opened(self, terminal: Terminal) -> bool:
        """Whether the editor opens the page, or shows its address."""
        if not terminal.until(self._file.exists):
            return False
        parts = urlsplit(self._file.read_text())
        assert parts.port
        self._file.unlink()
        self._port, self._path = parts.port, parts.path
        threading.Thread(target=self._listen, daemon=True).start()
        return True

    def _listen(self) -> None:
        connection = http.client.HTTPConnection("127.0.0.1", self._port)
        connection.request("GET", f"{self._path}events")
        stream = connection.getresponse()
        while line := stream.readline():
            if line.startswith(b"data: "):
                event = json.loads(line.removeprefix(b"data: "))
                if event["method"] == "pydslrep/cursorMoved" and event["params"]:
                    self._cursors.put(event["params"]["position"]["line"])

    def follows(self, line: int) -> bool:
        """Whether the page is told of a cursor in this line, from 0."""
        try:
            while self._cursors.get(timeout=LIMIT) != line:
                pass
        except queue.Empty:
            return False
        return True

    def click(self, line: int) -> None:
        """A click on the action in this line, from 0."""
        ends = {"line": line, "character": 2}, {"line": line, "character": 4}
        location = {
            "uri": self.program.as_uri(),
            "range": dict(zip(("start", "end"), ends, strict=True)),
        }
        message = {"jsonrpc": "2.0", "id": 1, "method": "pydslrep/reveal"}
        body = json.dumps({**message, "params": location})
        headers = {
            "Origin": f"http://127.0.0.1:{self._port}",
            "Content-Type": "application/json",
        }
        connection = http.client.HTTPConnection("127.0.0.1", self._port, timeout=LIMIT)
        connection.request("POST", f"{self._path}messages", body, headers)
        assert connection.getresponse().status == http.HTTPStatus.OK
        connection.close()
