"""A client for measurements: it timestamps messages before it parses them, and does its own work outside of the times."""

from __future__ import annotations

import json
import os
import pathlib
import queue
import subprocess
import threading
import time
from typing import Any

URI = "file:///bench/program.pyr"

CAPABILITIES = {
    "general": {"positionEncodings": ["utf-16"]},
    "workspace": {"configuration": False},
    "textDocument": {
        "publishDiagnostics": {"versionSupport": True, "relatedInformation": True},
        "diagnostic": {},
        "completion": {"completionItem": {"snippetSupport": True}},
        "documentSymbol": {"hierarchicalDocumentSymbolSupport": True},
        "semanticTokens": {
            "requests": {"full": True},
            "formats": ["relative"],
            "tokenTypes": ["type", "class", "variable", "function", "keyword"],
            "tokenModifiers": [],
        },
        "foldingRange": {},
        "formatting": {},
        "hover": {},
    },
}

MAX_WAIT = 120.0


class Client:
    """A running server."""

    def __init__(self, command: list[str], max_wait: float = MAX_WAIT) -> None:
        self.max_wait = max_wait
        self.began = time.perf_counter()
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            bufsize=0,
        )
        self.arrived: queue.SimpleQueue[tuple[float, bytes | None]] = (
            queue.SimpleQueue()
        )
        threading.Thread(target=self._read, daemon=True).start()
        self.published: list[tuple[dict[str, Any], float]] = []
        self.ident = 0
        self.version = 0
        result, _ = self.ask("initialize", {"capabilities": CAPABILITIES})
        self.capabilities: dict[str, Any] = result["capabilities"]
        self.tell("initialized", {})

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """Terminates the server."""
        self.process.kill()
        self.process.wait()

    def tell(self, method: str, params: object) -> float:
        """Sends a notification; returns the time before its first byte."""
        return self._write({"method": method, "params": params})

    def ask(self, method: str, params: object) -> tuple[Any, float]:
        """Sends a request; returns the response and the time when it was complete."""
        ident, _ = self.send(method, params)
        return self.answer(ident)

    def send(self, method: str, params: object) -> tuple[int, float]:
        """Sends a request without waiting; returns the time before its first byte."""
        self.ident += 1
        message = {"id": self.ident, "method": method, "params": params}
        return self.ident, self._write(message)

    def answer(self, ident: int) -> tuple[Any, float]:
        """The response to a request, and the time when it was complete."""
        while True:
            message, arrived = self.receive()
            if message.get("id") == ident and "method" not in message:
                if "error" in message:
                    raise RuntimeError(str(message["error"]))
                return message["result"], arrived

    def open(self, text: str) -> float:
        """Opens the document; returns the time before its first byte."""
        self.version += 1
        self.published.clear()
        return self.tell(
            "textDocument/didOpen",
            {
                "textDocument": {
                    "uri": URI,
                    "languageId": "pydslrep",
                    "version": self.version,
                    "text": text,
                }
            },
        )

    def close(self) -> None:
        """Closes the document."""
        self.tell("textDocument/didClose", {"textDocument": {"uri": URI}})

    def change(self, line: int, start: int, end: int, text: str) -> float:
        """Replaces a part of a line; returns the time before its first byte."""
        self.version += 1
        self.published.clear()
        place = {
            "start": {"line": line, "character": start},
            "end": {"line": line, "character": end},
        }
        return self.tell(
            "textDocument/didChange",
            {
                "textDocument": {"uri": URI, "version": self.version},
                "contentChanges": [{"range": place, "text": text}],
            },
        )

    def has(self, capability: str) -> bool:
        """Whether the server announces a capability."""
        return self.capabilities.get(capability) not in (None, False)

    def settled(self, lines: list[int]) -> tuple[list[int], float]:
        """The lines with errors in the latest version, and the time when they arrived.

        If a server pushes diagnostics without a version, waits until they are on `lines`.
        """
        if self.has("diagnosticProvider"):
            report, arrived = self.ask(
                "textDocument/diagnostic", {"textDocument": {"uri": URI}}
            )
            return lines_of_errors(report["items"]), arrived
        while True:
            while self.published:
                params, arrived = self.published.pop(0)
                found = lines_of_errors(params["diagnostics"])
                version = params.get("version")
                if version == self.version or (version is None and found == lines):
                    return found, arrived
            self.receive()

    def processor_time(self) -> float:
        """Seconds that all threads of the server have run."""
        tasks = pathlib.Path(f"/proc/{self.process.pid}/task").iterdir()
        stats = ((task / "schedstat").read_text() for task in tasks)
        return sum(int(stat.split()[0]) for stat in stats) / 1e9

    def peak_memory(self) -> float:
        """The peak memory in MiB."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(status.split("VmHWM:")[1].split()[0]) / 1024

    def receive(self) -> tuple[dict[str, Any], float]:
        """The next message, and the time when it was complete; requests are answered."""
        arrived, body = self.arrived.get(timeout=self.max_wait)
        if body is None:
            raise RuntimeError("the server exited")
        message: dict[str, Any] = json.loads(body)
        if "id" in message and "method" in message:
            self._write({"id": message["id"], "result": None})
        if message.get("method") == "textDocument/publishDiagnostics":
            self.published.append((message["params"], arrived))
        return message, arrived

    def _write(self, message: dict[str, object]) -> float:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        data = memoryview(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        assert self.process.stdin
        started = time.perf_counter()
        while data:
            data = data[os.write(self.process.stdin.fileno(), data) :]
        return started

    def _read(self) -> None:
        assert self.process.stdout
        out = self.process.stdout.fileno()
        buffer = bytearray()
        while chunk := os.read(out, 1 << 20):
            buffer += chunk
            while (end := buffer.find(b"\r\n\r\n")) >= 0:
                length = int(
                    buffer[:end].lower().split(b"content-length:")[1].split()[0]
                )
                if len(buffer) < end + 4 + length:
                    break
                self.arrived.put(
                    (time.perf_counter(), bytes(buffer[end + 4 : end + 4 + length]))
                )
                del buffer[: end + 4 + length]
        self.arrived.put((time.perf_counter(), None))


def lines_of_errors(diagnostics: list[dict[str, Any]]) -> list[int]:
    """The lines with errors; a diagnostic without severity counts as an error."""
    return [
        item["range"]["start"]["line"]
        for item in diagnostics
        if item.get("severity", 1) == 1
    ]
