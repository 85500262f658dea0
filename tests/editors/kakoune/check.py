"""Tests Kakoune, set up as its readme says. `--pictures` takes that of the documentation."""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from session import FIX, FIXED, MESSAGE, PICTURES, Session, open_session
from terminal import Terminal


def command(terminal: Terminal, text: str) -> None:
    terminal.type(f":{text}")
    terminal.press("Enter")


def edit(session: Session, terminal: Terminal, takes_pictures: bool) -> None:
    session.check("diagnostics", terminal.wait(MESSAGE), terminal.screen())
    session.check(
        "poses and times after actions",
        terminal.wait(r"9\.0.*\d s"),
        terminal.screen(),
    )
    words = ("robot", "wheelR", "23000", "patrol", "rover", "yard")
    session.check(
        "colours of names", terminal.wait_for_colours(words, 5), terminal.screen()
    )
    if takes_pictures:
        terminal.picture(PICTURES / "kakoune.png")
    terminal.type("2g6l")
    command(terminal, "lsp-hover")
    session.check("hover", terminal.wait("28.3 cm per revolution"), terminal.screen())
    command(terminal, "lsp-rename port_side")
    session.check("rename", terminal.wait(r"\{ port_side wheelR \}"), terminal.screen())
    terminal.type("13g17l")
    command(terminal, "lsp-code-actions")
    session.check("quick fix is offered", terminal.wait(FIX), terminal.screen())
    terminal.press("Enter")
    session.check("quick fix", terminal.wait(FIXED), terminal.screen())
    command(terminal, "lsp-formatting")
    session.check(
        "format", terminal.wait("(?m)^ {3}move 4.0 meters"), terminal.screen()
    )
    terminal.type("ge")
    terminal.type("omovement n of ro")
    session.check(
        "completion is offered", terminal.wait("rover +Class"), terminal.screen()
    )
    terminal.press("C-n")
    session.check("completion", terminal.wait("movement n of rover"), terminal.screen())


def main() -> None:
    with open_session("kakoune") as session:
        (session.home / "bin" / "kak-lsp").symlink_to(os.environ["KAK_LSP"])
        session.set_up()
        start = [os.environ["KAK"], str(session.program)]
        with Terminal(start, session.program.parent, session.environment()) as terminal:
            edit(session, terminal, "--pictures" in sys.argv)


main()
