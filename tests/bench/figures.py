"""The figures: each is a step that is repeated, and whose response is verified every time."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from client import URI, Client

if TYPE_CHECKING:
    from collections.abc import Callable

    from program import Program, Site

DOCUMENT = {"textDocument": {"uri": URI}}

BURST = 200


class WrongAnswerError(Exception):
    """A wrong response, which would make the figure meaningless."""


def expect(condition: object, what: str) -> None:
    """Raises WrongAnswerError if a response is wrong."""
    if not condition:
        raise WrongAnswerError(what)


class Bench:
    """One server with one program open. Each step returns seconds; a figure is the median of many."""

    def __init__(self, client: Client, program: Program) -> None:
        self.client = client
        self.program = program
        self.wrong = self.is_broken = False
        self.settled(client.open(program.text), [])

    def settled(self, started: float, lines: list[int]) -> float:
        """The seconds until the diagnostics arrive, which must be on these lines."""
        found, arrived = self.client.settled(lines)
        expect(found == lines, f"errors on lines {found[:5]}, not {lines}")
        return arrived - started

    def toggle(self, site: Site) -> tuple[float, list[int]]:
        """Types an extra letter or deletes it again; the resulting errors are on `lines`."""
        line, column = site
        end, text = (column + 1, "") if self.wrong else (column, "x")
        self.wrong = not self.wrong
        started = self.client.change(line, column, end, text)
        return started, [line] if self.wrong else []

    def open(self) -> float:
        """Reopens the document, until its diagnostics.

        It has an error then, by which its diagnostics differ from those that a server may publish for a closed document.
        """
        line, column = self.program.unit
        lines = list(self.program.lines)
        lines[line] = f"{lines[line][:column]}x{lines[line][column:]}"
        self.client.close()
        started = self.client.open("\n".join(lines) + "\n")
        self.is_broken = True
        return self.settled(started, [line])

    def restore(self) -> None:
        """Removes the error that `open` leaves."""
        if self.is_broken:
            line, column = self.program.unit
            self.settled(self.client.change(line, column, column + 1, ""), [])
            self.is_broken = False

    def keystroke(self, site: Site) -> float:
        """A keystroke, until the diagnostics."""
        return self.settled(*self.toggle(site))

    def syntax(self) -> float:
        """A keystroke that makes or fixes a syntax error."""
        return self.keystroke(self.program.unit)

    def reference(self) -> float:
        """A keystroke that breaks or fixes a reference."""
        return self.keystroke(self.program.reference)

    def completion(self) -> float:
        """A keystroke and the completion right after it, until the list."""
        line, column = self.program.robot
        robot = self.program.lines[line][:column].split()[-1]
        self.wrong = not self.wrong
        if self.wrong:
            started = self.client.change(line, column - 1, column, "")
            column -= 1
        else:
            started = self.client.change(line, column - 1, column - 1, robot[-1])
        place = {"position": {"line": line, "character": column}}
        result, arrived = self.client.ask(
            "textDocument/completion", {**DOCUMENT, **place}
        )
        items = result["items"] if isinstance(result, dict) else result
        # At a complete name, no list opens.
        offered = [item["label"] for item in items or []]
        expect(not self.wrong or robot in offered, f"no {robot} in the list")
        self.settled(started, [line] if self.wrong else [])
        return arrived - started

    def burst(self) -> float:
        """200 changes in a row, from the first to the diagnostics after the last."""
        line, column = self.program.unit
        self.client.change(line, column, column, "x")
        self.settled(time.perf_counter(), [line])
        comment = next(
            number
            for number, text in enumerate(self.program.lines)
            if text.lstrip().startswith("//")
        )
        end = len(self.program.lines[comment])
        started = self.client.change(comment, end, end, "y")
        for more in range(1, BURST - 2):
            self.client.change(comment, end + more, end + more, "y")
        self.client.change(comment, end, end + BURST - 2, "")
        self.client.change(line, column, column + 1, "")
        return self.settled(started, [])

    def request(self, method: str, few: int, **params: object) -> float:
        """One request about the whole document, whose response must have at least so many parts."""
        ident, started = self.client.send(
            f"textDocument/{method}", {**DOCUMENT, **params}
        )
        result, arrived = self.client.answer(ident)
        parts = result["data"] if isinstance(result, dict) else result
        expect(len(parts or []) >= few, f"{method}: {len(parts or [])} parts")
        return arrived - started

    def symbols(self) -> float:
        """The outline."""
        return self.request("documentSymbol", len(self.program.lines) // 10)

    def tokens(self) -> float:
        """All semantic tokens."""
        return self.request("semanticTokens/full", len(self.program.lines))

    def folding(self) -> float:
        """All folding ranges."""
        return self.request("foldingRange", len(self.program.lines) // 20)

    def formatting(self) -> float:
        """Formatting of the whole document, half of which changes."""
        return self.request(
            "formatting", 0, options={"tabSize": 2, "insertSpaces": True}
        )

    def hover(self) -> float:
        """The fastest response: the cost of a round trip."""
        line, column = self.program.robot
        position = {"line": line, "character": column - 1}
        ident, started = self.client.send(
            "textDocument/hover", {**DOCUMENT, "position": position}
        )
        # Some servers respond with null here, which takes as long.
        _, arrived = self.client.answer(ident)
        return arrived - started


FIGURES: dict[str, tuple[Callable[[Bench], float], str | None]] = {
    "hover": (Bench.hover, "hoverProvider"),
    "open": (Bench.open, None),
    "keystroke, syntax": (Bench.syntax, None),
    "keystroke, reference": (Bench.reference, None),
    "keystroke + completion": (Bench.completion, "completionProvider"),
    "burst of 200": (Bench.burst, None),
    "symbols": (Bench.symbols, "documentSymbolProvider"),
    "semantic tokens": (Bench.tokens, "semanticTokensProvider"),
    "folding": (Bench.folding, "foldingRangeProvider"),
    "formatting": (Bench.formatting, "documentFormattingProvider"),
}
"""Each with the capability it needs."""
