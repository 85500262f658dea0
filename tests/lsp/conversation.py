"""A client at the level of JSON: it sends requests, replies to mandatory requests, and checks every message."""

from __future__ import annotations

import pathlib
from typing import Any

from meta_model import faults_of_message
from raw import RawServer, answer, notification, request

ENCODINGS = ("utf-8", "utf-16", "utf-32")

# All capabilities that the server can use. Tests override them in `Conversation.start`.
EVERYTHING: dict[str, Any] = {
    "general": {"positionEncodings": ["utf-16"]},
    "textDocument": {
        "publishDiagnostics": {
            "relatedInformation": True,
            "versionSupport": True,
            "codeDescriptionSupport": True,
            "dataSupport": True,
            "tagSupport": {"valueSet": [1, 2]},
        },
        "completion": {
            "completionItem": {
                "snippetSupport": True,
                "documentationFormat": ["markdown"],
                "insertReplaceSupport": True,
                "resolveSupport": {"properties": ["documentation", "detail"]},
            }
        },
        "hover": {"contentFormat": ["markdown"]},
        "signatureHelp": {
            "signatureInformation": {
                "documentationFormat": ["markdown"],
                "parameterInformation": {"labelOffsetSupport": True},
                "activeParameterSupport": True,
            }
        },
        "definition": {"linkSupport": True},
        "declaration": {"linkSupport": True},
        "typeDefinition": {"linkSupport": True},
        "documentLink": {"tooltipSupport": True},
        "rename": {"prepareSupport": True},
        "documentSymbol": {"hierarchicalDocumentSymbolSupport": True},
        "semanticTokens": {
            "requests": {"range": True, "full": {"delta": True}},
            "tokenTypes": [],
            "tokenModifiers": [],
            "formats": ["relative"],
        },
        "codeAction": {
            "codeActionLiteralSupport": {"codeActionKind": {"valueSet": []}},
            "disabledSupport": True,
            "dataSupport": True,
            "isPreferredSupport": True,
            "resolveSupport": {"properties": ["edit"]},
        },
    },
    "workspace": {
        "applyEdit": True,
        "configuration": True,
        "workspaceFolders": True,
        "workspaceEdit": {"documentChanges": True, "resourceOperations": ["create"]},
        "didChangeWatchedFiles": {"dynamicRegistration": True},
        "didChangeConfiguration": {"dynamicRegistration": True},
        "diagnostics": {"refreshSupport": True},
        "inlayHint": {"refreshSupport": True},
        "codeLens": {"refreshSupport": True},
        "semanticTokens": {"refreshSupport": True},
        "fileOperations": {"didRename": True, "willRename": True},
    },
    "window": {"workDoneProgress": True, "showDocument": {"support": True}},
    "experimental": {"commands": {"commands": ["pydslrep.showReferences"]}},
}


class Refused(Exception):  # noqa: N818
    """An error response."""

    def __init__(self, error: dict[str, Any]) -> None:
        super().__init__(error["message"])
        self.code: int = error["code"]


class Conversation:
    """A session that checks every message of the server against the meta model."""

    def __init__(self, server: RawServer, encoding: str = "utf-16") -> None:
        self.server = server
        self.encoding = encoding
        self.methods: dict[int, str] = {}
        self.heard: list[dict[str, Any]] = []
        self.answers: dict[int, dict[str, Any]] = {}
        self.answered: set[int] = set()
        self.capabilities: dict[str, Any] = {}
        self.settings: dict[str, Any] = {}
        # Then there are answers that belong to no request.
        self.sends_nonsense = False
        # Checking an answer of megabytes takes seconds.
        self.checks = True

    def start(
        self, *, folder: pathlib.Path | None = None, pulling: bool = False
    ) -> None:
        """Begins the session."""
        offered = {"general": {"positionEncodings": [self.encoding]}}
        capabilities = {**EVERYTHING, **offered}
        if pulling:
            document = {**EVERYTHING["textDocument"], "diagnostic": {}}
            capabilities["textDocument"] = document
        folders = [{"uri": folder.as_uri(), "name": "it"}] if folder else None
        params = {
            "processId": None,
            "rootUri": None,
            "capabilities": capabilities,
            "workspaceFolders": folders,
        }
        self.capabilities = self.ask("initialize", params)["capabilities"]
        self.server.send(notification("initialized", {}))

    def request(self, method: str, params: object) -> tuple[int, bytes]:
        """A request to send with others, and its id."""
        ident = len(self.methods) + 1
        self.methods[ident] = method
        return ident, request(ident, method, params)

    def ask(self, method: str, params: object) -> Any:
        """Sends a request and waits for the result; an error is raised as `Refused`."""
        ident, message = self.request(method, params)
        self.server.send(message)
        return self.answer(ident)

    def ask_behind(self, before: bytes, method: str, params: object) -> Any:
        """Sends a request in one write with the messages before it."""
        ident, message = self.request(method, params)
        self.server.send(before, message)
        return self.answer(ident)

    def answer(self, ident: int) -> Any:
        """The result of a request."""
        while ident not in self.answers:
            assert self.hear() is not None, "the server left"
        message = self.answers.pop(ident)
        if "error" in message:
            raise Refused(message["error"])
        return message["result"]

    def hear(self) -> dict[str, Any] | None:
        """Handles the next message; `None` at the end."""
        message = self.server.read()
        if message is None:
            return None
        self.heard.append(message)
        asked = None
        if "method" not in message:
            ident = message["id"]
            if self.sends_nonsense and not (
                type(ident) is int and ident in self.methods
            ):
                return message
            asked = self.methods[ident]
            assert ident not in self.answered, f"{asked} is answered twice: {message}"
            self.answered.add(ident)
            self.answers[ident] = message
        elif "id" in message:
            is_settings = message["method"] == "workspace/configuration"
            result: object = [self.settings] if is_settings else None
            if message["method"] == "window/showDocument":
                result = {"success": True}
            if message["method"] == "workspace/applyEdit":
                result = {"applied": True}
            self.server.send(answer(message["id"], result))
        if self.sends_nonsense and asked and asked.endswith("/resolve"):
            return message  # a part of what was asked, which may be wrong
        if not self.checks:
            return message
        found = faults_of_message(message, asked)
        assert not found, (found, message)
        return message

    def hear_until(self, method: str) -> dict[str, Any]:
        """The next notification or request of a kind."""
        while (message := self.hear()) is not None:
            if message.get("method") == method:
                return message
        raise AssertionError(f"the server left without {method}")

    def leave(self) -> int:
        """Ends the session, in which every request must have had its answer, and returns the exit code."""
        self.ask("shutdown", None)
        self.server.send(notification("exit", None))
        while self.hear() is not None:
            pass
        left = {n: name for n, name in self.methods.items() if n not in self.answered}
        assert not left, f"not answered: {left}"
        return self.server.leave()
