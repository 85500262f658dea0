"""Takes the pictures of Neovim for the documentation, set up as its readme says."""

from __future__ import annotations

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from session import PICTURES, ROOT, Session, open_session
from terminal import Terminal

SIZE = (110, 36)
FENCE = """\
// Drives along the fence and turns where it ends.
wheel wheelL with radius 4.5
wheel wheelR with radius 4.5
sensor front : distance

robot rover type tw with port 23000 has { wheelL wheelR } wheels with sensors { front }

movement patrol of rover {
  move 4.0 meters at 12.5
  turn left
  move 150 centimeters
  turn right 45
}

environment yard has { rover } robots with { patrol } moves
"""
SHOWN = """\
vim.o.number, vim.o.signcolumn, vim.o.laststatus = true, 'yes', 2
vim.o.completeopt = 'menuone,noselect,popup'
vim.lsp.inlay_hint.enable()
vim.lsp.codelens.enable()
vim.diagnostic.config({ virtual_lines = { current_line = true, format = function(found) return found.message end } })
"""
NO_SERVER = "vim.g.pydslrep = { enable = false }\nvim.o.number = true\n"


def start(session: Session, settings: str) -> Terminal:
    """Starts Neovim with the program, the plugin and some settings."""
    folder = session.home / ".config" / "nvim"
    folder.mkdir(parents=True, exist_ok=True)
    plugin = ROOT / "editors" / "neovim"
    (folder / "init.lua").write_text(
        f"vim.opt.runtimepath:append('{plugin}')\nvim.cmd.colorscheme('catppuccin')\nvim.o.wrap = false\nvim.g.pydslrep = {{ open = print }}\n{settings}"
    )
    command = [os.environ["NVIM"], str(session.program.name)]
    # Keeps what the first run installs.
    kept = {"XDG_CACHE_HOME": str(ROOT / "target" / "editors" / "cache")}
    return Terminal(
        command, session.program.parent, {**session.environment(), **kept}, SIZE
    )


def run(session: Session) -> None:
    session.program.write_text(FENCE)
    with start(session, SHOWN) as terminal:
        session.check(
            "poses and times", terminal.wait(r"meters at 12.5.*→"), terminal.screen()
        )
        session.check("lenses", terminal.wait("Generate script"), terminal.screen())
        terminal.type(":Pydslrep run")
        terminal.press("Enter")
        session.check("a run", terminal.wait(r"yard-driven"), terminal.screen())
        session.check("its end", terminal.wait(r"done"), terminal.screen())
        terminal.picture(PICTURES / "neovim-run.png")


def problem(session: Session) -> None:
    session.program.write_text(FENCE.replace("{ patrol }", "{ patrl }"))
    with start(session, SHOWN) as terminal:
        session.check("lenses", terminal.wait("Generate script"), terminal.screen())
        terminal.type("/patrl")
        terminal.press("Enter")
        session.check("a problem", terminal.wait("did you mean"), terminal.screen())
        terminal.type("gra")
        session.check(
            "its fixes", terminal.wait(r"1: Change to `patrol`"), terminal.screen()
        )
        terminal.picture(PICTURES / "neovim-fix.png")


def colours(session: Session) -> None:
    session.program.write_text(FENCE)
    with start(session, NO_SERVER) as terminal:
        terminal.type(":Pydslrep parser")
        terminal.press("Enter")
        session.check("the parser", terminal.wait("built "), terminal.screen())
        terminal.press("Enter")
        terminal.type(":InspectTree")
        terminal.press("Enter")
        session.check("its tree", terminal.wait("wheel_definition"), terminal.screen())
        terminal.picture(PICTURES / "neovim-colours.png")


with open_session("neovim") as session:
    command = Path(
        os.environ.get("PYDSLREP", str(ROOT / "target" / "debug" / "pydslrep"))
    )
    (session.home / "bin" / "pydslrep").symlink_to(command.resolve())
    for part in (run, problem, colours):
        part(session)
