"""Properties of every request: positions in all encodings, and results for the latest text."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from conversation import ENCODINGS, Conversation, Refused
from questions import (
    ENDINGS,
    PARTS,
    PROGRAM,
    REQUESTS,
    Buffer,
    comparable,
    script,
    with_endings,
)
from raw import RawServer, notification

# The protocol's error code for a result about outdated text.
CONTENT_MODIFIED = -32801

# Their columns are not after the comments.
WITHOUT_COLUMNS = {
    "completionItem/resolve",
    "textDocument/signatureHelp",
    "textDocument/documentLink",
    "textDocument/codeAction#script",
    "codeAction/resolve",
    "workspace/executeCommand",
    "workspace/willRenameFiles",
    "pydslrep/script",
    "pydslrep/plannedPath",
    "pydslrep/plannedAt",
}

# Edits that affect every result: all positions move, counts and lengths grow, and there is a new environment.
EDITS = [
    ('import "', '// 🤖\nimport "'),
    ("wheel b with radius 4.5", "wheel b with radius 4.25"),
    ("move 4.0", "move 4.5"),
    ("wheeel", "wheeel a"),
    ("\n" + "/* 🤖 日本 e\u0301 */ wheel   ", "\nenvironment more has {}\nwheel   "),
]


def changed_text() -> str:
    text = PROGRAM
    for old, new in EDITS:
        assert text.count(old) == 1
        text = text.replace(old, new)
    return text


def opened(buffer: Buffer) -> bytes:
    document = {**buffer.document(), "languageId": "pydslrep", "version": 1}
    return notification(
        "textDocument/didOpen", {"textDocument": {**document, "text": buffer.text}}
    )


def changed(buffer: Buffer, version: int, edits: list[tuple[str, str]]) -> bytes:
    """A change of a buffer's text by consecutive edits."""
    changes, text = [], buffer.text
    for old, new in edits:
        now = Buffer(buffer.uri, text, buffer.encoding)
        changes.append({"range": now.span(old), "text": new})
        text = text.replace(old, new)
    document = {**buffer.document(), "version": version}
    return notification(
        "textDocument/didChange", {"textDocument": document, "contentChanges": changes}
    )


def method_of(name: str) -> str:
    return name.partition("#")[0]


@contextmanager
def conversation(
    server: str, folder: pathlib.Path, encoding: str = "utf-16"
) -> Iterator[Conversation]:
    """A session of a client that requests everything, including diagnostics."""
    (folder / "parts.pyr").write_text(PARTS, encoding="utf-8")
    with RawServer(server, "--stdio") as raw:
        talk = Conversation(raw, encoding)
        talk.start(pulling=True)
        assert talk.capabilities["positionEncoding"] == encoding
        yield talk


def attempt(talk: Conversation, ident: int) -> Any:
    """A response, which may be an error."""
    try:
        return talk.answer(ident)
    except Refused as refused:
        return refused.code, str(refused)


def ask_all(talk: Conversation, asked_of: Buffer) -> dict[str, Any]:
    """The results of all requests, sent in one write; without version numbers and result ids."""
    asked = {
        name: talk.request(method_of(name), make(asked_of))
        for name, make in REQUESTS.items()
    }
    talk.server.send(*(message for _, message in asked.values()))
    return {name: plain(attempt(talk, ident)) for name, (ident, _) in asked.items()}


def plain(answer: Any) -> Any:
    if isinstance(answer, list):
        return [plain(item) for item in answer]
    if not isinstance(answer, dict):
        return answer
    counted = ("version", "resultId")
    return {key: plain(item) for key, item in answer.items() if key not in counted}


@pytest.fixture
def uri(tmp_path: pathlib.Path) -> str:
    return (tmp_path / "main.pyr").as_uri()


def test_positions_are_equivalent_in_every_encoding_and_line_ending(
    server: str, tmp_path: pathlib.Path, uri: str
) -> None:
    answers: dict[tuple[str, str], dict[str, Any]] = {}
    places: dict[tuple[str, str], dict[str, Any]] = {}
    for encoding in ENCODINGS:
        with conversation(server, tmp_path, encoding) as talk:
            for endings in ENDINGS:
                buffer = Buffer(uri, with_endings(PROGRAM, endings), encoding)
                talk.server.send(opened(buffer))
                found = ask_all(talk, buffer)
                assert [name for name in REQUESTS if not found[name]] == []
                answers[encoding, endings] = found
                places[encoding, endings] = {
                    name: comparable(answer, buffer, method_of(name))
                    for name, answer in found.items()
                }
    expected = places["utf-8", "lf"]
    for variant, found in places.items():
        for name in REQUESTS:
            assert found[name] == expected[name], (variant, name)
    for name in REQUESTS.keys() - WITHOUT_COLUMNS:
        written = [repr(answers[encoding, "lf"][name]) for encoding in ENCODINGS]
        assert len(set(written)) == 3, f"{name} says nothing of columns"


SETTINGS = 'inlay-hints = { "🤖 日本 e\u0301" = 1, pse = true }\n'


SCENE = 'robots = { "🤖 日本 e\u0301" = {}, rovr = { track = 1 } }\n'


@pytest.mark.parametrize(
    ("name", "text", "known", "typed", "slip", "fixed"),
    [
        ("pydslrep.toml", SETTINGS, "inlay-hi", ", ps", "pse", "pose"),
        ("yard.scene.toml", SCENE, "tra", ", ro", "rovr", "rover"),
    ],
)
def test_positions_in_toml_files_are_equivalent_in_every_encoding(
    server: str,
    tmp_path: pathlib.Path,
    name: str,
    text: str,
    known: str,
    typed: str,
    slip: str,
    fixed: str,
) -> None:
    asked: dict[str, Callable[[Buffer], dict[str, Any]]] = {
        "textDocument/hover": lambda b: b.at(known),
        "textDocument/completion": lambda b: b.at(typed),
        "textDocument/codeAction": lambda b: {
            "textDocument": b.document(),
            "range": b.span(slip),
            "context": {"diagnostics": []},
        },
        "textDocument/diagnostic": lambda b: {"textDocument": b.document()},
    }
    program = Buffer((tmp_path / "main.pyr").as_uri(), PROGRAM, "utf-8")
    uri = (tmp_path / name).as_uri()
    places = []
    for encoding in ENCODINGS:
        buffer = Buffer(uri, text, encoding)
        with conversation(server, tmp_path, encoding) as talk:
            talk.server.send(opened(program), opened(buffer))
            answers = {
                name: talk.ask(name, make(buffer)) for name, make in asked.items()
            }
            places.append({n: comparable(a, buffer, n) for n, a in answers.items()})
    assert places[0] == places[1] == places[2]
    assert all(places[0].values())
    assert f"Change to `{fixed}`" in str(places[0]["textDocument/codeAction"])


def test_a_response_reflects_the_change_right_before_it(
    server: str, tmp_path: pathlib.Path, uri: str
) -> None:
    before = Buffer(uri, PROGRAM, "utf-16")
    after = Buffer(uri, changed_text(), "utf-16")
    expected = {}
    for buffer in (before, after):
        with conversation(server, tmp_path) as fresh:
            fresh.server.send(opened(buffer))
            expected[buffer.text] = ask_all(fresh, after)
    there, back = EDITS, [(new, old) for old, new in reversed(EDITS)]
    with conversation(server, tmp_path) as talk:
        talk.server.send(opened(before))
        for version, (name, make) in enumerate(REQUESTS.items(), start=1):
            for now, change in (
                (after, changed(before, 2 * version, there)),
                (before, changed(after, 2 * version + 1, back)),
            ):
                ident, message = talk.request(method_of(name), make(after))
                talk.server.send(change, message)
                assert plain(attempt(talk, ident)) == expected[now.text][name], name
            assert expected[before.text][name] != expected[after.text][name], (
                f"{name} would not show that it is late"
            )


def test_token_deltas_reflect_the_change_right_before_them(
    server: str, tmp_path: pathlib.Path, uri: str
) -> None:
    before = Buffer(uri, PROGRAM, "utf-16")
    after = Buffer(uri, changed_text(), "utf-16")
    full = "textDocument/semanticTokens/full"
    with conversation(server, tmp_path) as talk:
        talk.server.send(opened(before))
        first = talk.ask(full, {"textDocument": before.document()})
        params = {
            "textDocument": before.document(),
            "previousResultId": first["resultId"],
        }
        delta = talk.ask_behind(changed(before, 2, EDITS), f"{full}/delta", params)
        data = first["data"]
        for edit in sorted(delta["edits"], key=lambda e: e["start"], reverse=True):
            start = edit["start"]
            data[start : start + edit["deleteCount"]] = edit.get("data", [])
        assert data == talk.ask(full, {"textDocument": after.document()})["data"]
        assert (
            data
            != talk.ask_behind(
                changed(after, 3, [(changed_text(), PROGRAM)]),
                full,
                {"textDocument": before.document()},
            )["data"]
        )


def test_a_command_reflects_the_change_right_before_it(
    server: str, tmp_path: pathlib.Path, uri: str
) -> None:
    before = Buffer(uri, PROGRAM, "utf-16")
    after = Buffer(uri, changed_text(), "utf-16")
    with conversation(server, tmp_path) as talk:
        talk.server.send(opened(before))
        action = REQUESTS["codeAction/resolve"](after)
        old = talk.ask("codeAction/resolve", action)
        command = {"command": "pydslrep.generateScript", "arguments": [script(after)]}
        talk.ask_behind(changed(before, 2, EDITS), "workspace/executeCommand", command)
        written = (tmp_path / "yard.py").read_text(encoding="utf-8")
        new = talk.ask("codeAction/resolve", action)
        assert written == new["edit"]["documentChanges"][-1]["edits"][0]["newText"]
        assert written != old["edit"]["documentChanges"][-1]["edits"][0]["newText"]


def test_work_on_a_long_text_is_current_or_cancelled(
    server: str, tmp_path: pathlib.Path, uri: str
) -> None:
    names = [
        "textDocument/documentSymbol",
        "textDocument/foldingRange",
        "textDocument/formatting",
        "textDocument/semanticTokens/full",
    ]
    more = "".join(f"wheel w{n} with radius 4.5 // {n:0200}\n" for n in range(400))
    texts = [PROGRAM + more, PROGRAM.replace("lap", "round") + more]
    expected = []
    for text in texts:
        buffer = Buffer(uri, text, "utf-16")
        with conversation(server, tmp_path) as fresh:
            fresh.server.send(opened(buffer))
            asked = [(name, REQUESTS[name](buffer)) for name in names]
            expected.append([plain(fresh.ask(*question)) for question in asked])
    with conversation(server, tmp_path) as talk:
        buffer = Buffer(uri, texts[0], "utf-16")
        talk.server.send(opened(buffer))
        sent = [
            [talk.request(name, REQUESTS[name](buffer)) for name in names]
            for _ in (1, 2)
        ]
        talk.server.send(
            *(message for _, message in sent[0]),
            changed(buffer, 2, [(PROGRAM, texts[1].removesuffix(more))]),
            *(message for _, message in sent[1]),
        )
        for (ident, _), right in zip(sent[0], expected[0], strict=True):
            found = plain(attempt(talk, ident))
            assert found == right or found[0] == CONTENT_MODIFIED
        for (ident, _), right in zip(sent[1], expected[1], strict=True):
            assert plain(talk.answer(ident)) == right


ABSURD = [
    {"line": 0, "character": 2**31 - 1},
    {"line": 2**31 - 1, "character": 0},
    {"line": 2**31 - 1, "character": 2**31 - 1},
    {"line": 1, "character": 4},  # inside 🤖
]


def with_places(params: Any, start: dict[str, int], end: dict[str, int]) -> Any:
    """Parameters with every position replaced."""
    if isinstance(params, list):
        return [with_places(item, start, end) for item in params]
    if not isinstance(params, dict):
        return params
    if params.keys() == {"start", "end"}:
        return {"start": start, "end": end}
    if params.keys() == {"line", "character"}:
        return start
    return {key: with_places(item, start, end) for key, item in params.items()}


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_absurd_positions_are_handled(
    server: str, tmp_path: pathlib.Path, uri: str, encoding: str
) -> None:
    buffer = Buffer(uri, PROGRAM, encoding)
    with conversation(server, tmp_path, encoding) as talk:
        talk.server.send(opened(buffer))
        before = ask_all(talk, buffer)
        for start in ABSURD:
            for end in (start, {"line": 0, "character": 0}):
                asked = [
                    talk.request(method_of(name), with_places(make(buffer), start, end))
                    for name, make in REQUESTS.items()
                ]
                talk.server.send(*(message for _, message in asked))
                for ident, _ in asked:
                    found = attempt(talk, ident)
                    is_defect = isinstance(found, tuple) and found[0] == -32603
                    assert not is_defect, (talk.methods[ident], start, end, found)
        assert ask_all(talk, buffer) == before


def test_unopened_documents_have_no_results(
    server: str, tmp_path: pathlib.Path
) -> None:
    with conversation(server, tmp_path) as talk:
        for uri in ("file:///nowhere/a.pyr", "untitled:Untitled-1", "pydslrep:x?y#z"):
            buffer = Buffer(uri, PROGRAM, "utf-16")
            for name, answer in ask_all(talk, buffer).items():
                is_refused = isinstance(answer, tuple) and answer[0] != -32603
                is_empty = not answer or method_of(name).endswith(
                    ("/diagnostic", "/resolve")
                )
                assert is_refused or is_empty, (uri, name, answer)
