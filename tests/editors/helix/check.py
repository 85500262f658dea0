"""Tests Helix, set up as its readme says. `--pictures` takes those of the documentation."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from session import FIX, FIXED, MESSAGE, PICTURES, Session, session
from terminal import Terminal

HX = os.environ["HX"]
SHOWS_HINTS = '[editor]\nend-of-line-diagnostics = "hint"\ntrue-color = true\n[editor.lsp]\ndisplay-inlay-hints = true\n'


def health(made: Session) -> None:
    variables = {**os.environ, **made.environment()}
    for language in ("pydslrep", "pydslrep-toml"):
        report = subprocess.run(
            [HX, "--health", language],
            env=variables,
            check=True,
            stdout=subprocess.PIPE,
        )
        text = re.sub(r"\x1b\[[0-9;]*m", "", report.stdout.decode())
        server = re.search("✓ pydslrep.*pydslrep-lsp", text)
        found = server is not None and "Highlight queries: ✓" in text
        made.check(f"health of {language}", found, text)


def normal(terminal: Terminal) -> None:
    """Back to normal mode; a key right after Escape would be read as one with Alt."""
    terminal.press("Escape")
    terminal.wait("(?m)^ NOR")


def edit(made: Session, terminal: Terminal, takes_pictures: bool) -> None:
    made.check("diagnostics", terminal.wait(MESSAGE), terminal.screen())
    terminal.type("jk")
    made.check(
        "poses and times after actions",
        terminal.wait(r"9\.0.*\d s"),
        terminal.screen(),
    )
    words = ("robot", "wheelL", "23000", "patrol", "rover", "yard")
    made.check("colours", terminal.wait_for_colours(words, 5), terminal.screen())
    if takes_pictures:
        terminal.picture(PICTURES / "helix.png")
    terminal.type("6gg6l")
    terminal.press("Space")
    terminal.type("k")
    made.check(
        "hover", terminal.wait("Two-wheel differential drive"), terminal.screen()
    )
    terminal.press("Escape")
    terminal.wait_without("Two-wheel differential drive")
    terminal.type("]d")
    terminal.press("Space")
    terminal.type("a")
    made.check("quick fix is offered", terminal.wait(FIX), terminal.screen())
    terminal.press("Enter")
    made.check("quick fix", terminal.wait(FIXED), terminal.screen())
    terminal.type(":format")
    terminal.press("Enter")
    made.check("format", terminal.wait(r"\d {4}move 4.0 meters"), terminal.screen())
    terminal.type("2gg7l")
    terminal.press("Space")
    terminal.type("r")
    made.check("rename asks", terminal.wait("rename-to:"), terminal.screen())
    terminal.press("C-u")
    terminal.type("port_side")
    terminal.press("Enter")
    made.check("rename", terminal.wait(r"\{ port_side wheelR \}"), terminal.screen())
    terminal.type("5ggo")
    terminal.type("wheel c wi")
    made.check("completion", terminal.wait("with radius +keyword"), terminal.screen())
    terminal.press("Escape")
    normal(terminal)
    terminal.type("uggjjj/move 4")
    terminal.press("Enter")
    terminal.type("o")
    terminal.type("slam")
    made.check("indentation", terminal.wait(r"11 {4}slam"), terminal.screen())
    normal(terminal)
    terminal.type("mafd")
    made.check(
        "text objects", terminal.wait_without("movement patrol of"), terminal.screen()
    )
    made.check(
        "with the right range",
        "movement home of" in terminal.screen(),
        terminal.screen(),
    )
    terminal.type(":q!")
    terminal.press("Enter")


def main() -> None:
    with session("helix") as made:
        made.set_up()
        health(made)
        (made.home / ".config" / "helix" / "config.toml").write_text(SHOWS_HINTS)
        with Terminal(
            [HX, str(made.program)], made.program.parent, made.environment()
        ) as terminal:
            edit(made, terminal, "--pictures" in sys.argv)


main()
