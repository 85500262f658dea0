"""A session that uses everything, with each message checked against the protocol's meta model."""

from __future__ import annotations

import pathlib
import re
from typing import Any

import pytest
from conversation import Conversation, Refused
from editor import capabilities
from lsprotocol import types
from lsprotocol.converters import get_converter
from meta_model import faults_of_message
from pygls.capabilities import ServerCapabilitiesBuilder
from questions import PARTS, PROGRAM, REQUESTS, Buffer, script
from raw import RawServer, notification, request

FEATURES = pathlib.Path(__file__).parents[2] / "docs" / "editor-features.md"

# The protocol's code for methods that there are not.
UNKNOWN_METHOD = -32601

NOWHERE = {"start": {"line": 0, "character": 0}, "end": {"line": 0, "character": 1}}
FAULTLESS = PROGRAM.replace("wheeel", "a")


def opened(uri: str, text: str, version: int = 1) -> bytes:
    item = {"uri": uri, "languageId": "pydslrep", "version": version, "text": text}
    return notification("textDocument/didOpen", {"textDocument": item})


def use_everything(talk: Conversation, folder: pathlib.Path) -> None:
    """Sends all requests and notifications in a folder with two programs and settings."""
    buffer = Buffer((folder / "main.pyr").as_uri(), PROGRAM, "utf-16")
    talk.hear_until("$/progress")
    while talk.heard[-1].get("params", {}).get("value", {}).get("kind") != "end":
        talk.hear()
    talk.server.send(opened(buffer.uri, PROGRAM))
    for name, make in REQUESTS.items():
        talk.ask(name.partition("#")[0], make(buffer))
    for name, make in REQUESTS.items():
        asked = make(buffer)
        if "textDocument" in asked:
            nowhere = {"uri": (folder / "nowhere.pyr").as_uri()}
            try:
                talk.ask(name.partition("#")[0], {**asked, "textDocument": nowhere})
            except Refused:
                assert "rename" in name.lower()
    full = "textDocument/semanticTokens/full"
    named = {"textDocument": buffer.document()}
    known = talk.ask(full, named)["resultId"]
    change = {"textDocument": {"uri": buffer.uri, "version": 2}}
    talk.server.send(
        notification(
            "textDocument/didChange",
            {**change, "contentChanges": [{"text": FAULTLESS}]},
        )
    )
    delta = "textDocument/semanticTokens/full/delta"
    talk.ask(delta, {**named, "previousResultId": known})
    talk.ask("pydslrep/plannedPath", script(buffer))
    robot = {"uri": buffer.uri, "robot": "rover"}
    for command, argument in (
        ("pydslrep.generateScript", script(buffer)),
        ("pydslrep.showKinematics", robot),
    ):
        params = {"command": command, "arguments": [argument]}
        talk.ask("workspace/executeCommand", params)
    with pytest.raises(Refused, match="no command"):
        talk.ask("workspace/executeCommand", {"command": "x", "arguments": []})
    with pytest.raises(Refused):
        talk.ask("no/such", {})
    longer = FAULTLESS.replace("move 4.0", "move 8.0")
    change["textDocument"] = {"uri": buffer.uri, "version": 3}
    talk.server.send(
        notification(
            "textDocument/didChange", {**change, "contentChanges": [{"text": longer}]}
        )
    )
    talk.hear_until("pydslrep/plannedPathChanged")
    settings = (folder / "pydslrep.toml").as_uri()
    talk.server.send(opened(settings, "[inlay-hints]\npose = 7\n"))
    for method in ("hover", "completion"):
        at = {"textDocument": {"uri": settings}, "position": NOWHERE["end"]}
        talk.ask(f"textDocument/{method}", at)
    context: dict[str, Any] = {"diagnostics": []}
    asked = {"textDocument": {"uri": settings}, "range": NOWHERE, "context": context}
    talk.ask("textDocument/codeAction", asked)
    talk.server.send(
        notification("workspace/didChangeConfiguration", {"settings": None}),
        notification(
            "workspace/didChangeWatchedFiles",
            {"changes": [{"uri": (folder / "parts.pyr").as_uri(), "type": 2}]},
        ),
        notification("textDocument/didClose", {"textDocument": {"uri": settings}}),
    )
    talk.hear_until("workspace/inlayHint/refresh")


@pytest.mark.parametrize("pulling", [False, True])
def test_every_message_of_a_session_matches_the_meta_model(
    server: str, tmp_path: pathlib.Path, *, pulling: bool
) -> None:
    (tmp_path / "parts.pyr").write_text(PARTS, encoding="utf-8")
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw)
        talk.settings = {"severety": {}}
        talk.start(folder=tmp_path, pulling=pulling)
        use_everything(talk, tmp_path)
        assert talk.leave() == 0
    said = {message["method"] for message in talk.heard if "method" in message}
    pushed = set() if pulling else {"textDocument/publishDiagnostics"}
    expected = {
        "client/registerCapability",
        "workspace/configuration",
        "window/workDoneProgress/create",
        "$/progress",
        "window/showMessage",
        "window/showDocument",
        "workspace/diagnostic/refresh",
        "workspace/inlayHint/refresh",
        "pydslrep/plannedPathChanged",
    }
    assert said == expected | pushed
    documented = set(re.findall(r"`(\w+(?:/\w+)+)`", FEATURES.read_text("utf-8")))
    assert len(documented) > 30, "the page lists messages"
    exchanged = said | set(talk.methods.values()) | {"textDocument/publishDiagnostics"}
    assert documented - exchanged == set(), "on the page, but never sent"


FRAMING = {"initialize", "initialized", "shutdown", "exit"}
FILE_OPERATIONS = ("will_rename", "did_rename", "did_create", "did_delete")
FILES = types.FileOperationRegistrationOptions([])
# Those that have no default; their content does not matter here.
OPTIONS = {
    types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL: types.SemanticTokensLegend([], []),
    types.TEXT_DOCUMENT_ON_TYPE_FORMATTING: types.DocumentOnTypeFormattingOptions("}"),
    types.WORKSPACE_WILL_RENAME_FILES: FILES,
    types.WORKSPACE_DID_RENAME_FILES: FILES,
    types.WORKSPACE_DID_CREATE_FILES: FILES,
    types.WORKSPACE_DID_DELETE_FILES: FILES,
}


def handled_methods(raw: RawServer) -> set[str]:
    """The methods that the server knows: it says of all others that it does not."""
    methods = [
        method
        for method in types.METHOD_TO_TYPES
        if types.message_direction(method) != "serverToClient" and method not in FRAMING
    ]
    raw.send(*(request(method, method, {}) for method in methods))
    codes = {method: raw.answer(method)["error"]["code"] for method in methods}
    return {method for method, code in codes.items() if code != UNKNOWN_METHOD}


def providers(capabilities: types.ServerCapabilities) -> dict[str, Any]:
    """What is announced, without options that no method belongs to."""
    announced = get_converter().unstructure(capabilities)
    tokens = announced["semanticTokensProvider"]
    return {
        "all": {name for name, value in announced.items() if value is not False},
        "resolves": {
            name
            for name in ("completionProvider", "codeLensProvider")
            if announced[name].get("resolveProvider")
        },
        "tokens": {name for name in ("full", "range") if tokens.get(name)},
        "prepares": announced["renameProvider"]["prepareProvider"],
        "workspace": announced["diagnosticProvider"]["workspaceDiagnostics"],
        "files": announced["workspace"]["fileOperations"].keys(),
    }


def test_what_is_announced_is_handled_and_what_is_handled_is_announced(
    server: str,
) -> None:
    """The client library for tests can also be a server, and knows the capability of every method."""
    client = capabilities("pulling")
    assert client.workspace
    operations = dict.fromkeys(FILE_OPERATIONS, True)
    client.workspace.file_operations = types.FileOperationClientCapabilities(
        **operations
    )
    with RawServer(server, "--stdio") as raw:
        params = {"capabilities": get_converter().unstructure(client)}
        raw.send(request(0, "initialize", params))
        answer = raw.answer(0)["result"]["capabilities"]
        announced = get_converter().structure(answer, types.ServerCapabilities)
        raw.send(notification("initialized", {}))
        handled = handled_methods(raw)
    assert announced.execute_command_provider
    resolves = types.COMPLETION_ITEM_RESOLVE in handled
    completion = types.CompletionOptions(resolve_provider=resolves)
    builder = ServerCapabilitiesBuilder(
        client,
        handled,
        {**OPTIONS, types.TEXT_DOCUMENT_COMPLETION: completion},
        list(announced.execute_command_provider.commands),
        types.TextDocumentSyncKind.Incremental,
    )
    expected = builder.build()  # type: ignore[no-untyped-call]
    assert providers(announced) == providers(expected)


def server_notification(method: str, params: object) -> dict[str, Any]:
    return {"jsonrpc": "2.0", "method": method, "params": params}


def answered(result: object) -> dict[str, Any]:
    return {"jsonrpc": "2.0", "id": 1, "result": result}


HOVER = "textDocument/hover"
SYMBOL = {"name": "a", "kind": 6, "range": NOWHERE, "selectionRange": NOWHERE}
PUBLISH = "textDocument/publishDiagnostics"


@pytest.mark.parametrize(
    ("message", "asked", "fault"),
    [
        (answered({"contents": "x"}), HOVER, None),
        (answered(None), HOVER, None),
        (answered({}), HOVER, "contents is missing"),
        (answered({"contents": 1}), HOVER, "contents"),
        (answered({"contents": "x", "range": None}), HOVER, "null instead"),
        (answered({"contents": "x", "more": 1}), HOVER, "more is unknown"),
        (answered([]), HOVER, "Hover"),
        ({"jsonrpc": "2.0", "id": 1}, HOVER, "a result or an error"),
        ({**answered(None), "error": {}}, HOVER, "a result or an error"),
        ({"jsonrpc": "2.0", "id": 1, "error": {"code": 1}}, HOVER, "message"),
        (answered([SYMBOL]), "textDocument/documentSymbol", None),
        (answered([{**SYMBOL, "kind": 99}]), "textDocument/documentSymbol", "kind"),
        (
            server_notification(PUBLISH, {"uri": "file:///a", "diagnostics": []}),
            None,
            None,
        ),
        (
            server_notification(PUBLISH, {"uri": "file:///a"}),
            None,
            "diagnostics is missing",
        ),
        (
            server_notification(
                PUBLISH, {"uri": "file:///a", "diagnostics": [], "version": True}
            ),
            None,
            "version",
        ),
        (server_notification("textDocument/didOpen", {}), None, "not for servers"),
        (server_notification("textDocument/nothing", {}), None, "not in the protocol"),
        (
            server_notification("$/progress", {"token": 1, "value": {"kind": "x"}}),
            None,
            "value",
        ),
        (
            {**server_notification("workspace/diagnostic/refresh", None), "id": 1},
            None,
            "null instead of missing",
        ),
    ],
)
def test_violations_of_the_meta_model_are_found(
    message: dict[str, Any], asked: str | None, fault: str | None
) -> None:
    found = faults_of_message(message, asked)
    assert bool(found) == bool(fault), found
    assert not fault or any(fault in text for text in found), found


def test_numbers_of_the_protocol_have_limits() -> None:
    below = {"line": -1, "character": 0}
    message = answered({"contents": "x", "range": {"start": below, "end": below}})
    assert faults_of_message(message, HOVER)
