"""What is not shown and not offered while a statement is being typed, and what is as soon as its line is left."""

from __future__ import annotations

import pathlib
from typing import Any

import pytest
from conversation import Conversation
from questions import Buffer
from raw import RawServer, notification

PUSHED = "textDocument/publishDiagnostics"
PULL = "textDocument/diagnostic"
HIGHLIGHT = "textDocument/documentHighlight"
PROGRAM = """\
wheel a with radius 4.5
wheel ab with radius 4.5
sensor s
robot rover type tw with port 23000 has { a ab } wheels with sensors { s }

movement lap of rover {
  move 4.0 meters
}

environment yard has { rover } robots with { lap } moves
"""


class Editor:
    """A client with one open program, in which it types."""

    def __init__(self, raw: RawServer, folder: pathlib.Path, *, pulling: bool) -> None:
        self.talk = Conversation(raw)
        self.uri = (folder / "main.pyr").as_uri()
        self.version = 1
        self.talk.start(pulling=pulling)
        self.buffer = Buffer(self.uri, "", "utf-16")
        self.cursor = 0

    def open(self, text: str) -> None:
        self.buffer = Buffer(self.uri, text, "utf-16")
        item = {"languageId": "pydslrep", "version": 1, "text": text, "uri": self.uri}
        self.notify("textDocument/didOpen", {"textDocument": item})
        self.settle()

    def notify(self, method: str, params: dict[str, Any]) -> None:
        self.talk.server.send(notification(method, params))

    def named(self, **others: Any) -> dict[str, Any]:
        return {"textDocument": {"uri": self.uri}, **others}

    def settle(self) -> None:
        """Waits until what was sent is handled, and what came of it is sent."""
        for _ in range(2):
            self.talk.ask("textDocument/documentSymbol", self.named())

    def go_to(self, text: str) -> None:
        """Puts the cursor behind a text, of which the server learns nothing."""
        self.cursor = self.buffer.text.index(text) + len(text)

    def type(self, text: str) -> None:
        """Types a text key by key; the server handles each key before the next."""
        for key in text:
            self.replace(self.cursor, self.cursor, key)

    def replace(self, start: int, end: int, new: str) -> None:
        place = {
            "start": self.buffer.position(start),
            "end": self.buffer.position(end),
        }
        text = self.buffer.text[:start] + new + self.buffer.text[end:]
        self.buffer = Buffer(self.uri, text, "utf-16")
        self.cursor = start + len(new)
        self.version += 1
        document = {"uri": self.uri, "version": self.version}
        change = [{"range": place, "text": new}]
        self.notify(
            "textDocument/didChange",
            {"textDocument": document, "contentChanges": change},
        )
        self.settle()

    def leave_line(self) -> None:
        """Puts the cursor in the first line; editors then ask what to highlight there."""
        position = self.buffer.position(1)
        self.talk.ask(HIGHLIGHT, self.named(position=position))
        self.settle()

    def pushed(self) -> list[list[str]]:
        """The codes of each push so far, but for hints."""
        pushes = [
            message["params"]["diagnostics"]
            for message in self.talk.heard
            if message.get("method") == PUSHED
        ]
        return [codes(found) for found in pushes]

    def pull(self) -> list[dict[str, Any]]:
        report = self.talk.ask(PULL, self.named())
        found: list[dict[str, Any]] = report["items"]
        return found

    def completions(self, kind: int = 1) -> list[str]:
        params = self.named(
            position=self.buffer.position(self.cursor), context={"triggerKind": kind}
        )
        found = self.talk.ask("textDocument/completion", params)
        return [item["label"] for item in found["items"]]


def codes(found: list[dict[str, Any]]) -> list[str]:
    hint = 4
    return [item["code"] for item in found if item["severity"] != hint]


@pytest.mark.parametrize("action", ["move 2.5 meters at 9", "turn left until { s }"])
def test_nothing_is_pushed_while_an_action_is_typed(
    server: str, tmp_path: pathlib.Path, action: str
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=False)
        editor.open(PROGRAM)
        editor.go_to("move 4.0 meters")
        editor.type("\n  " + action)
        editor.leave_line()
        assert all(found == [] for found in editor.pushed()), editor.pushed()


def test_what_is_missing_is_pushed_once_the_line_is_left(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=False)
        editor.open(PROGRAM)
        editor.go_to("move 4.0 meters")
        editor.type("\n  move 2")
        assert all(found == [] for found in editor.pushed()), editor.pushed()
        editor.leave_line()
        assert editor.pushed()[-1] == ["syntax-error"]


@pytest.mark.parametrize("leaving", ["enter", "save", "other file"])
def test_a_line_is_left_in_other_ways(
    server: str, tmp_path: pathlib.Path, leaving: str
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=False)
        editor.open(PROGRAM)
        editor.go_to("move 4.0 meters")
        editor.type("\n  move 2")
        if leaving == "enter":
            editor.type("\n")
        elif leaving == "save":
            editor.notify("textDocument/didSave", editor.named())
        else:
            uri = (tmp_path / "other.pyr").as_uri()
            item = {"languageId": "pydslrep", "version": 1, "text": "\n", "uri": uri}
            editor.notify("textDocument/didOpen", {"textDocument": item})
            start = {"line": 0, "character": 0}
            change = [{"range": {"start": start, "end": start}, "text": " "}]
            document = {"uri": uri, "version": 2}
            editor.notify(
                "textDocument/didChange",
                {"textDocument": document, "contentChanges": change},
            )
        editor.settle()
        assert ["syntax-error"] in editor.pushed(), editor.pushed()


def test_a_movement_is_not_empty_before_its_first_action(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=False)
        editor.open(PROGRAM)
        editor.go_to("meters\n}\n")
        editor.type("\nmovement back of rover ")
        # The editor closes the brace, and makes two lines of Enter.
        editor.replace(editor.cursor, editor.cursor, "{}")
        editor.replace(editor.cursor - 1, editor.cursor - 1, "\n  \n")
        assert not any("empty-movement" in found for found in editor.pushed())
        editor.leave_line()
        assert "empty-movement" in editor.pushed()[-1]


def test_what_the_next_word_settles_is_marked_for_clients_that_pull(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=True)
        editor.open(PROGRAM)
        editor.go_to("move 4.0 meters")
        editor.type("\n  move 1 parsecs turn left\n  move 2")
        marked = {item["range"]["start"]["line"]: item for item in editor.pull()}
        assert marked[8]["data"] == {"typedLine": 8}
        assert "data" not in marked[7], "what is typed next does not settle it"
        editor.leave_line()
        left = editor.pull()
        assert all("data" not in item for item in left)
        assert [{**item, "data": None} for item in left] == [
            {**item, "data": None} for item in marked.values()
        ]


def test_what_is_said_in_the_end_does_not_depend_on_the_order_of_edits(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=False)
        editor.open(PROGRAM)
        editor.go_to("environment yard has { rover } robots with { lap")
        editor.type(" lop")
        editor.go_to("move 4.0 meters")
        editor.type("\n  move 2\n  turn left until {")
        editor.go_to("wheel a with radius 4.5")
        editor.type("\nsensor")
        editor.leave_line()
        typed = editor.pushed()[-1]
        editor.notify("textDocument/didClose", editor.named())
        editor.open(editor.buffer.text)
        editor.settle()
        assert typed == editor.pushed()[-1]
        assert typed.count("syntax-error") >= 2


def test_the_planned_path_stays_until_the_line_is_left(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=True)
        editor.open(PROGRAM)
        yard = {"uri": editor.uri, "environment": "yard"}
        editor.talk.ask("pydslrep/plannedPath", yard)

        def announced() -> int:
            return sum(
                message.get("method") == "pydslrep/plannedPathChanged"
                for message in editor.talk.heard
            )

        editor.go_to("move 4.0 meters")
        editor.type("\n  move 2")
        assert announced() == 0
        editor.leave_line()
        assert announced() == 1


def test_an_environment_is_named_once_it_lists_robots(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=True)
        editor.open(PROGRAM)
        editor.cursor = len(PROGRAM)

        def environments() -> Any:
            position = editor.buffer.position(editor.cursor)
            found = editor.talk.ask(
                "pydslrep/plannedAt", editor.named(position=position)
            )
            return found["environments"]

        for key in "environment gate":
            editor.type(key)
            assert environments() == ["yard"], editor.buffer.text[len(PROGRAM) :]
        editor.type(" has { rover }")
        assert environments() == ["yard", "gate"]


def test_no_list_opens_at_a_name_that_is_complete(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=True)
        editor.open(PROGRAM + "robot other with port 23000 has {\n")
        editor.cursor = len(editor.buffer.text)
        editor.type("a")
        assert editor.completions() == []
        # The second request at a letter is the user's.
        assert editor.completions() == ["a", "ab"]
        editor.type("b")
        assert editor.completions() == []
        # When the cursor comes back to a word, the user asks for the list.
        editor.type(" ")
        editor.cursor -= 1
        assert editor.completions()[0] == "ab"


def test_a_list_that_is_open_closes_at_a_name_that_is_complete(
    server: str, tmp_path: pathlib.Path
) -> None:
    with RawServer(server, "--stdio") as raw:
        editor = Editor(raw, tmp_path, pulling=True)
        editor.open(PROGRAM + "robot other with port 23000 has {\n")
        editor.cursor = len(editor.buffer.text)
        editor.type("a")
        incomplete = 3
        assert [editor.completions(incomplete) for _ in range(2)] == [[], []]
