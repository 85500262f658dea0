"""The server at the level of bytes, for messages that a client library cannot send."""

from __future__ import annotations

import json
import os
import pathlib
import subprocess
from typing import Any

ROOT = pathlib.Path(__file__).parents[2]
DEBUG = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "debug"
SERVER = os.environ.get("PYDSLREP_LSP", str(DEBUG / "pydslrep-lsp"))


class RawServer:
    """A running server and its pipes. Every wait ends when the server exits: no timeouts are involved."""

    def __init__(self, *command: str) -> None:
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        assert self.process.stdin
        assert self.process.stdout
        self.input = self.process.stdin
        self.output = self.process.stdout

    def __enter__(self) -> RawServer:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.wait()
        self.input.close()
        self.output.close()

    def send(self, *messages: bytes) -> None:
        """Sends messages in one write."""
        self.input.write(b"".join(messages))
        self.input.flush()

    def initialize(self, capabilities: dict[str, Any] | None = None) -> None:
        """Begins a session."""
        self.send(
            request(0, "initialize", {"capabilities": capabilities or {}}),
            notification("initialized", {}),
        )
        self.answer(0)

    def answer(self, ident: int | str | None) -> dict[str, Any]:
        """The response to a request; earlier messages are dropped."""
        while (message := self.read()) is not None:
            if "method" not in message and message.get("id") == ident:
                return message
        raise AssertionError(f"the server left without an answer to {ident}")

    def read_until(self, method: str) -> dict[str, Any]:
        """The next notification or request of a kind."""
        while (message := self.read()) is not None:
            if message.get("method") == method:
                return message
        raise AssertionError(f"the server left without {method}")

    def published_before(self, ident: int) -> list[int]:
        """The versions of the diagnostics published before the response to a request."""
        versions = []
        while (message := self.read()) is not None and message.get("id") != ident:
            if message["method"] == "textDocument/publishDiagnostics":
                versions.append(message["params"]["version"])
        return versions

    def read(self) -> dict[str, Any] | None:
        """The next message, `None` when the server has closed its output."""
        length = None
        while line := self.output.readline():
            if line == b"\r\n":
                assert length is not None, "a frame without length"
                message: dict[str, Any] = json.loads(self.output.read(length))
                return message
            name, _, value = line.partition(b": ")
            assert name == b"Content-Length", f"not a frame: {line!r}"
            length = int(value)
        return None

    def leave(self) -> int:
        """Waits until the server exits; returns the exit code."""
        return self.process.wait()


def frame(body: bytes) -> bytes:
    """A message with its header."""
    return b"Content-Length: %d\r\n\r\n" % len(body) + body


def request(ident: int | str, method: str, params: object) -> bytes:
    """A request."""
    return frame(
        json.dumps(
            {"jsonrpc": "2.0", "id": ident, "method": method, "params": params}
        ).encode()
    )


def notification(method: str, params: object) -> bytes:
    """A notification."""
    return frame(
        json.dumps({"jsonrpc": "2.0", "method": method, "params": params}).encode()
    )


def answer(ident: int | str, result: object) -> bytes:
    """A response to a request of the server."""
    return frame(json.dumps({"jsonrpc": "2.0", "id": ident, "result": result}).encode())
