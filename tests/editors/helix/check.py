"""Tests Helix, set up as its readme says. `--pictures` takes those of the documentation."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from live_preview import LivePreview
from session import FIX, FIXED, MESSAGE, PICTURES, Session, open_session
from terminal import Terminal

HX = os.environ["HX"]
SHOWS_HINTS = '[editor]\nend-of-line-diagnostics = "hint"\ntrue-color = true\n[editor.lsp]\ndisplay-inlay-hints = true\n'


def health(session: Session) -> None:
    variables = {**os.environ, **session.environment()}
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
        session.check(f"health of {language}", found, text)


def normal(terminal: Terminal) -> None:
    """Back to normal mode; a key right after Escape would be read as one with Alt."""
    terminal.press("Escape")
    terminal.wait("(?m)^ NOR")


def edit(session: Session, terminal: Terminal, takes_pictures: bool) -> None:
    session.check("diagnostics", terminal.wait(MESSAGE), terminal.screen())
    terminal.type("jk")
    session.check(
        "poses and times after actions",
        terminal.wait(r"9\.0.*\d s"),
        terminal.screen(),
    )
    words = ("robot", "wheelL", "23000", "patrol", "rover", "yard")
    session.check("colours", terminal.wait_for_colours(words, 5), terminal.screen())
    if takes_pictures:
        terminal.picture(PICTURES / "helix.png")
    terminal.type("6gg6l")
    terminal.press("Space")
    terminal.type("k")
    session.check(
        "hover", terminal.wait("Two-wheel differential drive"), terminal.screen()
    )
    terminal.press("Escape")
    terminal.wait_without("Two-wheel differential drive")
    terminal.type("]d")
    terminal.press("Space")
    terminal.type("a")
    session.check("quick fix is offered", terminal.wait(FIX), terminal.screen())
    terminal.press("Enter")
    session.check("quick fix", terminal.wait(FIXED), terminal.screen())
    terminal.type(":format")
    terminal.press("Enter")
    session.check("format", terminal.wait(r"\d {4}move 4.0 meters"), terminal.screen())
    terminal.type("2gg7l")
    terminal.press("Space")
    terminal.type("r")
    session.check("rename asks", terminal.wait("rename-to:"), terminal.screen())
    terminal.press("C-u")
    terminal.type("port_side")
    terminal.press("Enter")
    session.check("rename", terminal.wait(r"\{ port_side wheelR \}"), terminal.screen())
    terminal.type("5ggo")
    terminal.type("wheel c wi")
    session.check(
        "completion", terminal.wait("with radius +keyword"), terminal.screen()
    )
    terminal.press("Escape")
    normal(terminal)
    terminal.type("uggjjj/move 4")
    terminal.press("Enter")
    terminal.type("o")
    terminal.type("slam")
    session.check("indentation", terminal.wait(r"11 {4}slam"), terminal.screen())
    normal(terminal)
    terminal.type("mafd")
    session.check(
        "text objects", terminal.wait_without("movement patrol of"), terminal.screen()
    )
    # Helix draws hints where they were until it has new ones.
    session.check(
        "with the right range", terminal.wait("movement home of"), terminal.screen()
    )
    terminal.type(":q!")
    terminal.press("Enter")


def preview(session: Session, terminal: Terminal) -> None:
    live = LivePreview(session)
    session.check("diagnostics", terminal.wait(MESSAGE), terminal.screen())
    terminal.type(":lsp-workspace-command pydslrep.openPreview")
    terminal.press("Enter")
    session.check("live preview", live.opened(terminal), terminal.screen())
    terminal.type("geO")
    terminal.type("// x")
    session.check("it follows the text", live.follows(16), terminal.screen())
    normal(terminal)
    live.click(8)
    session.check(
        "a click moves the cursor", terminal.wait(r" 9:[35]\b"), terminal.screen()
    )
    terminal.type(":q!")
    terminal.press("Enter")


def main() -> None:
    with open_session("helix") as session:
        session.set_up()
        health(session)
        (session.home / ".config" / "helix" / "config.toml").write_text(SHOWS_HINTS)
        with Terminal(
            [HX, str(session.program)], session.program.parent, session.environment()
        ) as terminal:
            edit(session, terminal, "--pictures" in sys.argv)
        with Terminal(
            [HX, str(session.program)], session.program.parent, session.environment()
        ) as terminal:
            preview(session, terminal)


main()
