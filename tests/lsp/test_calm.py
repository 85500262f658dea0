"""Hints, lenses and signature help stay calm while the user types.

Each keystroke is a change, after which the client requests everything again, as editors do.
"""

from __future__ import annotations

import pathlib
from collections.abc import Iterator
from typing import Any

import pytest
from conversation import Conversation
from questions import Buffer
from raw import RawServer, notification

PARTS = """\
wheel a with radius 4.5
wheel b with radius 4.5
sensor s
robot rover with port 23000 has { a b } wheels with sensors { s }
"""
PROGRAM = f"""\
{PARTS}
movement lap of rover {{
  move 4.0 meters
  turn right
  move 2 meters
  turn left
}}

movement back of rover {{
  move -1 meters
}}

environment yard has {{ rover }} robots with {{ lap back }} moves
"""


class Editor:
    """A client with one open program, its hints and its lenses."""

    def __init__(self, raw: RawServer, folder: pathlib.Path) -> None:
        self.talk = Conversation(raw)
        self.uri = (folder / "main.pyr").as_uri()
        self.version = 1
        self.buffer = Buffer(self.uri, "", "utf-16")

    def open(self, text: str, settings: dict[str, Any] | None = None) -> None:
        """Starts a session and requests the hints and lenses of a program."""
        self.talk.settings = settings or {}
        self.talk.start(pulling=True)
        self.buffer = Buffer(self.uri, text, "utf-16")
        item = {"languageId": "pydslrep", "version": 1, "text": text, "uri": self.uri}
        self.notify("textDocument/didOpen", {"textDocument": item})
        self.hints()
        self.lenses()

    def notify(self, method: str, params: dict[str, Any]) -> None:
        self.talk.server.send(notification(method, params))

    def named(self, **others: Any) -> dict[str, Any]:
        return {"textDocument": {"uri": self.uri}, **others}

    def change(self, *changes: tuple[int, int, str]) -> None:
        """Sends one message with changes, each based on the text after the previous one."""
        received = []
        for start, end, new in changes:
            place = {
                "start": self.buffer.position(start),
                "end": self.buffer.position(end),
            }
            received.append({"range": place, "text": new})
            text = self.buffer.text[:start] + new + self.buffer.text[end:]
            self.buffer = Buffer(self.uri, text, "utf-16")
        self.tell(received)

    def tell(self, changes: list[dict[str, Any]]) -> None:
        self.version += 1
        document = {"uri": self.uri, "version": self.version}
        params = {"textDocument": document, "contentChanges": changes}
        self.notify("textDocument/didChange", params)

    def after(self, text: str) -> int:
        """The end of a text that occurs once."""
        assert self.buffer.text.count(text) == 1, text
        return self.buffer.text.index(text) + len(text)

    def type(self, place: str, keys: str) -> Iterator[int]:
        """Types after a text, key by key; yields the line of the cursor after each."""
        at = self.after(place)
        for key in keys:
            self.change((at, at, key))
            at += 1
            yield int(self.buffer.position(at)["line"])

    def hints(self) -> list[tuple[int, str]]:
        """All hints, with their lines."""
        asked = self.named(range=self.buffer.everything())
        found = self.talk.ask("textDocument/inlayHint", asked)
        return [(hint["position"]["line"], hint["label"]) for hint in found]

    def hinted(self) -> dict[str, str]:
        """The hints by the text of their line."""
        lines = self.buffer.text.split("\n")
        shown: dict[str, str] = {}
        for line, label in self.hints():
            shown[lines[line]] = f"{shown.get(lines[line], '')} {label}".strip()
        return shown

    def lenses(self) -> list[str]:
        """The titles of all lenses, each with its line."""
        shown = []
        for lens in self.talk.ask("textDocument/codeLens", self.named()):
            done = (
                lens if "command" in lens else self.talk.ask("codeLens/resolve", lens)
            )
            line = self.buffer.text.split("\n")[lens["range"]["start"]["line"]]
            shown.append(f"{' '.join(line.split()[:2])}: {done['command']['title']}")
        return shown

    def cursor(self, place: str) -> None:
        """Moves the cursor, as editors do that highlight the name there."""
        at = self.buffer.position(self.after(place))
        self.talk.ask("textDocument/documentHighlight", self.named(position=at))

    def parameters(self, place: str, context: dict[str, Any] | None) -> Any:
        asked = self.named(position=self.buffer.position(self.after(place)))
        if context is not None:
            asked["context"] = context
        return self.talk.ask("textDocument/signatureHelp", asked)


@pytest.fixture
def editor(server: str, tmp_path: pathlib.Path) -> Iterator[Editor]:
    with RawServer(server, "--stdio") as raw:
        yield Editor(raw, tmp_path)


FIRST = {"  move 4.0 meters": "at 9.0 · 44.8 s → 4.00, 0.00, 0°"}
SECOND = {"  turn right": "90 · 2.9 s → 4.00, 0.00, -90°"}
THIRD = {"  move 2 meters": "at 9.0 · 22.6 s → 4.00, -2.00, -90°"}
FOURTH = {"  turn left": "90 · 2.9 s → 4.00, -2.00, 0°"}
OTHER = {"  move -1 meters": "at 9.0 · 11.4 s → -1.00, 0.00, 0°"}


#### Hints ####


def test_hints_never_move_the_edited_text(editor: Editor) -> None:
    editor.open(PROGRAM)
    assert editor.hinted() == FIRST | SECOND | THIRD | FOURTH | OTHER
    for line in editor.type("move 2 meters", " at 12"):
        assert all(place != line for place, _ in editor.hints())
        assert editor.hinted() == FIRST | SECOND | FOURTH | OTHER


def test_a_new_line_removes_no_hints(editor: Editor) -> None:
    editor.open(PROGRAM)
    kept = FIRST | SECOND | OTHER
    seen = []
    for line in editor.type("turn right", "\n  move 100 centimeters"):
        hints = editor.hints()
        assert all(place != line for place, _ in hints)
        shown = editor.hinted()
        assert kept.items() <= shown.items()
        after = {key: shown.get(key) for key in (*THIRD, *FOURTH)}
        if after not in seen:
            seen.append(after)
    moved = {
        "  move 2 meters": "at 9.0 · 22.6 s → 4.00, -3.00, -90°",
        "  turn left": "90 · 2.9 s → 4.00, -3.00, 0°",
    }
    assert seen == [THIRD | FOURTH, moved], "as before, until there is something new"


def test_an_error_removes_no_other_hints(editor: Editor) -> None:
    editor.open(PROGRAM)
    at = editor.after("  turn right")
    editor.change((at - 1, at, ""))
    assert editor.hinted() == FIRST | THIRD | FOURTH | OTHER
    # The line stays invalid while another one is typed.
    for _ in editor.type("move -1 meters", " at 2"):
        assert editor.hinted() == FIRST | THIRD | FOURTH
    at = editor.after("wheel b with radius 4.5")
    editor.change((at - 3, at, ""))
    assert editor.hinted().keys() == (FIRST | THIRD | FOURTH).keys() | {
        "  move -1 meters at 2"
    }, "not a robot with a broken wheel either"


def test_a_line_with_an_error_has_no_hints(editor: Editor) -> None:
    editor.open(PROGRAM.replace("turn left", "turn left until { nobody }"))
    assert editor.hinted() == FIRST | SECOND | THIRD | OTHER


def test_hints_return_when_the_cursor_moves(editor: Editor) -> None:
    editor.open(PROGRAM)
    list(editor.type("move 2 meters", " "))
    shown = FIRST | SECOND | FOURTH | OTHER
    editor.cursor("move 2 mete")
    assert editor.hinted() == shown, "the cursor is still there"
    editor.cursor("turn le")
    editor.talk.hear_until("workspace/inlayHint/refresh")
    editor.talk.hear_until("workspace/codeLens/refresh")
    assert editor.hinted() == shown | {
        "  move 2 meters ": "at 9.0 · 22.6 s → 4.00, -2.00, -90°"
    }
    # The request for a light bulb also shows the cursor; requests on saving do not.
    list(editor.type("move 2 meters ", "\b".replace("\b", " ")))
    place = editor.buffer.position(editor.after("move 4.0"))
    context: dict[str, Any] = {"diagnostics": [], "triggerKind": 1}
    asked = editor.named(range={"start": place, "end": place}, context=context)
    editor.talk.ask("textDocument/codeAction", asked)
    assert editor.hinted() == shown
    context["triggerKind"] = 2
    editor.talk.ask("textDocument/codeAction", asked)
    editor.talk.hear_until("workspace/inlayHint/refresh")
    assert len(editor.hinted()) == len(shown) + 1


def test_hints_return_when_another_document_is_edited(
    editor: Editor, tmp_path: pathlib.Path
) -> None:
    editor.open(PROGRAM)
    list(editor.type("move 2 meters", " "))
    other = (tmp_path / "other.pyr").as_uri()
    item = {"languageId": "pydslrep", "version": 1, "text": "\n", "uri": other}
    editor.notify("textDocument/didOpen", {"textDocument": item})
    assert len(editor.hinted()) == 4, "to open one is not to edit it"
    document = {"uri": other, "version": 2}
    start = {"line": 0, "character": 0}
    change = {"range": {"start": start, "end": start}, "text": "w"}
    params = {"textDocument": document, "contentChanges": [change]}
    editor.notify("textDocument/didChange", params)
    editor.talk.hear_until("workspace/inlayHint/refresh")
    assert len(editor.hinted()) == 5


def test_several_cursors_edit_several_lines(editor: Editor) -> None:
    editor.open(PROGRAM)
    second = editor.after("move 2 meters")
    first = editor.after("move 4.0 meters")
    editor.change((second, second, " "), (first, first, " "))
    assert editor.hinted() == SECOND | FOURTH | OTHER
    # Formatting is not typing: the cursor does not move.
    second = editor.after("move 2 meters ")
    editor.change((second - 1, second, ""), (first, first + 1, "\n"))
    assert len(editor.hinted()) == 4


def test_full_text_changes_count_as_typing(editor: Editor) -> None:
    """Some clients send the whole text with each keystroke."""
    editor.open(PROGRAM)
    text = PROGRAM.replace("move 2 meters", "move 2 meters ")
    editor.buffer = Buffer(editor.uri, text, "utf-16")
    editor.tell([{"text": text}])
    assert editor.hinted() == FIRST | SECOND | FOURTH | OTHER
    editor.tell([{"text": text}])
    assert editor.hinted() == FIRST | SECOND | FOURTH | OTHER, "nothing changed"


#### Lenses ####

OF_YARD = [
    f"environment yard: {title}" for title in ("Run", "Preview", "Generate script")
]
OF_OTHERS = [
    "robot rover: 3 references",
    "movement lap: 1 reference",
    "movement back: 1 reference",
]


def test_wheels_and_sensors_have_lenses_only_where_wanted(editor: Editor) -> None:
    editor.open(PROGRAM)
    assert editor.lenses() == [*OF_OTHERS, *OF_YARD]


@pytest.mark.parametrize("spelling", ["codeLens", "code-lens"])
def test_each_kind_of_lens_has_a_setting(editor: Editor, spelling: str) -> None:
    ip = PROGRAM.replace("sensor s\n", "sensor s\nip here 127.0.0.1\n")
    editor.open(ip)
    kinds = {
        "wheels": "wheel a: 1 reference",
        "sensors": "sensor s: 1 reference",
        "ips": "ip here: 0 references",
        "robots": "robot rover: 3 references",
        "movements": "movement lap: 1 reference",
        "generate-script": "environment yard: Generate script",
        "run": "environment yard: Run",
        "preview": "environment yard: Preview",
    }
    for kind, lens in kinds.items():
        for wanted in (True, False):
            editor.talk.settings = {spelling: {kind: wanted}}
            editor.notify("workspace/didChangeConfiguration", {"settings": None})
            editor.talk.hear_until("workspace/inlayHint/refresh")
            assert (lens in editor.lenses()) is wanted, kind


def test_a_name_being_typed_has_no_lens(editor: Editor) -> None:
    editor.open(PROGRAM)
    typed = "\n\nmovement third of rover {\n  slam\n}"
    for _ in editor.type("{\n  move -1 meters\n}", typed):
        assert not any(lens.startswith("movement third") for lens in editor.lenses())
        assert len(editor.lenses()) == 6, "all others stay"
    for _ in editor.type("{ lap back", " third"):
        pass
    assert "movement third: 1 reference" in editor.lenses(), "the edit is elsewhere"
    for _ in editor.type("movement third", "_one"):
        assert not any(lens.startswith("movement third") for lens in editor.lenses())


def test_a_new_environment_has_lenses_once_saved(editor: Editor) -> None:
    editor.open(PROGRAM[: PROGRAM.index("environment")] + "\n")
    line = "environment yard has { rover } robots with { lap } moves"
    for _ in editor.type("move -1 meters\n}\n", line):
        assert not any("Run" in lens for lens in editor.lenses())
    editor.notify("textDocument/didSave", editor.named())
    editor.talk.hear_until("workspace/codeLens/refresh")
    assert "environment yard: Run" in editor.lenses()


#### Signature help ####


def moved(shown: Any) -> dict[str, Any]:
    return {"triggerKind": 3, "isRetrigger": True, "activeSignatureHelp": shown}


def test_typing_never_opens_parameter_hints(editor: Editor) -> None:
    line = "robot other with port 1 has { a b } wheels with sensors { s }\n"
    editor.open(PARTS + line + "movement m of other { move 1 meters }\n")
    assert "triggerCharacters" not in editor.talk.capabilities["signatureHelpProvider"]
    for place, key in ("port 1 has {", "{"), ("other with port ", " "):
        typed = {"triggerKind": 2, "triggerCharacter": key, "isRetrigger": False}
        assert editor.parameters(place, typed) is None


def test_parameters_that_are_asked_for_end_with_the_statement(editor: Editor) -> None:
    editor.open(PARTS + "movement m of rover {\n  move 1 meters\n  turn left 9\n}\n")
    shown = editor.parameters("  move ", {"triggerKind": 1, "isRetrigger": False})
    assert shown == editor.parameters("  move ", None)
    signature, with_until = shown["signatures"]
    assert signature["label"].startswith("move DISTANCE")
    assert with_until["label"].endswith("...")
    assert "documentation" not in signature, "one line"
    assert editor.parameters("move 1 ", moved(shown))["signatures"][0] == {
        **signature,
        "activeParameter": 2,
    }
    assert editor.parameters("move 1 meters\n", moved(shown)) is None
    assert editor.parameters("turn left 9\n", moved(shown)) is None
