"""Tests Emacs, set up as its readme says, without and with the parser. `--pictures` takes those of the documentation."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from live_preview import LivePreview
from session import FIX, FIXED, MESSAGE, PICTURES, PROGRAM, ROOT, Session, open_session
from terminal import Terminal

EMACS = [os.environ["EMACS"], *os.environ.get("EMACS_OPTIONS", "").split()]
# Not in the readme: suppresses questions and files elsewhere, and hides everything but the program.
QUIET = """
(setq native-comp-jit-compilation nil inhibit-startup-screen t make-backup-files nil auto-save-default nil
      create-lockfiles nil browse-url-browser-function #'browse-url-xdg-open eglot-sync-connect 10 eglot-confirm-server-edits nil custom-file "/dev/null")
(menu-bar-mode -1)
(load-theme 'modus-vivendi t)
"""


def command(terminal: Terminal, name: str) -> None:
    terminal.press("M-x")
    terminal.wait(r"M-x\s*$")
    answer(terminal, name)


def answer(terminal: Terminal, text: str) -> None:
    """Answers a prompt. A busy Emacs may lose keys, so this retries."""
    for _ in range(5):
        terminal.press("C-a", "C-k")
        terminal.type(text)
        if terminal.wait(rf" {re.escape(text)}\s*$", timeout=3):
            break
    terminal.press("Enter")


def edit(session: Session, terminal: Terminal, picture: Path | None) -> None:
    session.check("attached", terminal.wait(r"\[eglot:"), terminal.screen())
    command(terminal, "flymake-goto-next-error")
    session.check("diagnostics", terminal.wait(MESSAGE), terminal.screen())
    session.check(
        "poses and times after actions",
        terminal.wait(r"9\.0.*\d s"),
        terminal.screen(),
    )
    words = ("robot", "wheelL", "23000", "patrol", "rover", "yard")
    session.check("colours", terminal.wait_for_colours(words, 5), terminal.screen())
    if picture:
        terminal.picture(picture)
    command(terminal, "eglot-code-actions")
    session.check("quick fix is offered", terminal.wait(FIX), terminal.screen())
    terminal.press("Enter")
    session.check("quick fix", terminal.wait(FIXED), terminal.screen())
    command(terminal, "eglot-format-buffer")
    session.check(
        "format", terminal.wait("(?m)^ {2,4}move 4.0 meters"), terminal.screen()
    )
    terminal.press("M-<")
    terminal.press("C-n")
    terminal.press("M-f", "C-f")
    command(terminal, "eldoc-doc-buffer")
    session.check("hover", terminal.wait("28.3 cm per revolution"), terminal.screen())
    terminal.press("C-x")
    terminal.type("1")
    command(terminal, "eglot-rename")
    session.check("rename asks", terminal.wait("Rename .wheelL. to"), terminal.screen())
    answer(terminal, "port_side")
    session.check("rename", terminal.wait(r"\{ port_side wheelR \}"), terminal.screen())
    terminal.press("M->")
    terminal.press("M-:")
    answer(terminal, '(insert "movement n of ")')
    terminal.press("C-M-i")
    session.check("completion", terminal.wait("movement n of rover"), terminal.screen())


def preview(session: Session, terminal: Terminal) -> None:
    live = LivePreview(session)
    terminal.press("M-<")
    command(terminal, "pydslrep-preview")
    session.check("live preview", live.opened(terminal), terminal.screen())
    session.check("at the cursor", live.follows(0), terminal.screen())
    terminal.press("C-n", "C-n")
    session.check("follows the cursor", live.follows(2), terminal.screen())
    terminal.press("M->")
    terminal.type("// x")
    session.check("and the text", live.follows(17), terminal.screen())
    live.click(8)
    session.check("a click moves the cursor", terminal.wait(r" L9 "), terminal.screen())


def compiles(folder: Path) -> bool:
    mode = folder / "pydslrep-mode.el"
    mode.write_text((ROOT / "editors" / "emacs" / mode.name).read_text())
    strict = [
        "--eval",
        "(setq byte-compile-error-on-warn t)",
        "-f",
        "batch-byte-compile",
    ]
    return (
        subprocess.run(
            [*EMACS, "-Q", "--batch", *strict, str(mode)], check=False
        ).returncode
        == 0
    )


def follows_its_rules() -> bool:
    """Whether the mode without the parser highlights and indents nested blocks."""
    files = (
        ROOT / "editors" / "emacs" / "pydslrep-mode.el",
        Path(__file__).with_name("rules.el"),
    )
    load = [argument for file in files for argument in ("-l", str(file))]
    return (
        subprocess.run(
            [*EMACS, "-Q", "--batch", *load, "-f", "ert-run-tests-batch-and-exit"],
            check=False,
        ).returncode
        == 0
    )


def run(session: Session, takes_pictures: bool) -> None:
    session.program.write_text(PROGRAM)
    start = [*EMACS, "-nw", str(session.program)]
    with Terminal(start, session.program.parent, session.environment()) as terminal:
        edit(session, terminal, PICTURES / "emacs.png" if takes_pictures else None)
    session.program.write_text(PROGRAM)
    with Terminal(start, session.program.parent, session.environment()) as terminal:
        session.check("attached", terminal.wait(r"\[eglot:"), terminal.screen())
        preview(session, terminal)


def main() -> None:
    with open_session("emacs") as session:
        readme = (ROOT / "editors" / "emacs" / "README.md").read_text()
        block = re.search(r"^```elisp\n(.*?)^```", readme, re.M | re.S)
        assert block, "the readme has no elisp block"
        settings = session.home / ".emacs.d" / "init.el"
        settings.parent.mkdir()
        settings.write_text(QUIET + block[1].replace("/path/to/pydslrep", str(ROOT)))
        session.check("compiles without a warning", compiles(session.home))
        session.check("highlights and indents blocks", follows_its_rules())
        print("== without the parser")
        run(session, takes_pictures=False)
        print("== with the parser")
        session.set_up()
        run(session, takes_pictures="--pictures" in sys.argv)


main()
