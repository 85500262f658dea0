"""The editors that are typed into, each set up as its readme says, with completion that opens by itself."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, cast

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from keyboard import Keyboard
from person import Habits, same_leader, usual_leader
from session import MESSAGE, PROGRAM, ROOT, Session
from terminal import Terminal

HERE = Path(__file__).resolve().parent
# For VS Code: what it has by default, unless the extension asks for something else.
ENTER_ACCEPTS: dict[str, object] = {
    "[pydslrep]": {"editor.acceptSuggestionOnEnter": "on"}
}
# Nothing indents, so one does it oneself.
TAB_INDENTS: dict[str, object] = {
    "[pydslrep]": {"editor.autoIndent": "none", "editor.formatOnType": False}
}
# Variables that name the folders of plugins.
CMP = ("NVIM_CMP", "CMP_NVIM_LSP")
BLINK = ("BLINK_CMP",)


class Editor:
    """An editor that runs, in a folder with empty files to type into."""

    habits: Habits
    # Where programs are.
    work: Path

    def open(self, file: Path) -> None:
        """Opens an empty file, ready to be typed into."""
        raise NotImplementedError

    def type(self, keys: list[str], pace: float) -> float:
        """Types, and returns how many seconds it took."""
        raise NotImplementedError

    def save(self) -> None:
        """Writes the file as it is now."""
        raise NotImplementedError

    def close(self) -> None:
        """Ends the editor."""
        raise NotImplementedError

    def covered(self) -> list[str]:
        """What has covered the line being typed, or the one above it, since it was last asked."""
        return []

    def screen(self) -> str:
        """What it shows."""
        return ""


class InTerminal(Editor):
    """One whose screen is a terminal. Its first file has a mistake: once that is shown, the server is there."""

    mistake = re.escape(MESSAGE)

    def __init__(self, made: Session) -> None:
        self.made = made
        self.work = made.program.parent
        self.set_up()
        command = [*self.command(), str(made.program)]
        self.terminal = Terminal(command, made.program.parent, made.environment())
        self.keyboard = Keyboard(self.terminal)
        if not self.terminal.wait(self.mistake):
            shown = self.screen()
            self.close()
            raise SystemExit(f"the server did not answer:\n{shown}")

    def set_up(self) -> None:
        """Writes its settings."""
        self.made.set_up()

    def command(self) -> list[str]:
        """What starts it."""
        raise NotImplementedError

    def type(self, keys: list[str], pace: float) -> float:
        return self.keyboard.type(keys, pace)

    def say(self, *keys: str) -> None:
        """Presses keys that are no part of a program: names of keys, and texts."""
        for key in keys:
            if key in ("Enter", "Escape") or re.match(r"[CM]-", key):
                self.keyboard.press(key)
            else:
                for character in key:
                    self.keyboard.press(character)

    def close(self) -> None:
        self.keyboard.close()
        self.terminal.__exit__()

    def screen(self) -> str:
        return self.terminal.screen()


class Modal(InTerminal):
    """One with a normal and an insert mode, and commands after a colon."""

    # What is on the screen in normal and in insert mode.
    normal: str
    insert: str

    def open(self, file: Path) -> None:
        self.say(f":e {file}", "Enter")
        self.terminal.wait(re.escape(file.name))
        self.say("i")
        self.terminal.wait(self.insert)

    def save(self) -> None:
        self.say("Escape")
        # A key right after Escape would be taken for one with Alt.
        self.terminal.wait(self.normal)
        self.say(":w", "Enter")


class Neovim(Modal):
    """Neovim with a completion plugin, or with its own completion."""

    habits = Habits(leader=same_leader, ends_last_line=True)
    insert = "-- INSERT --"
    normal = r"(?s)\A(?!.*-- INSERT --)"
    mistake = "(?m)^E "

    def __init__(
        self,
        made: Session,
        plugin: str | None = None,
        variant: str = "",
        needs: tuple[str, ...] = (),
    ) -> None:
        self.plugin = plugin
        self.variant = variant
        self.needs = needs
        super().__init__(made)

    def set_up(self) -> None:
        """The readme's settings without a plugin manager, and the plugin's or all that is optional in the readme."""
        readme = (ROOT / "editors" / "neovim" / "README.md").read_text()
        blocks = re.findall(r"^```lua\n(.*?)^```", readme, re.M | re.S)
        packages = self.made.home / ".local/share/nvim/site/pack/person/start"
        packages.mkdir(parents=True)
        for variable in self.needs:
            folder = Path(os.environ.get(variable, "")).resolve()
            if not (folder / "lua").is_dir():
                raise SystemExit(f"{variable} is to be the folder of that plugin")
            (packages / folder.name).symlink_to(folder)
        settings = self.made.home / ".config" / "nvim" / "init.lua"
        settings.parent.mkdir()
        if self.plugin:
            blocks[2] = f"vim.g.typing_variant = '{self.variant}'\n"
            blocks[2] += (HERE / "neovim" / f"{self.plugin}.lua").read_text()
        text = blocks[0] + blocks[2]
        settings.write_text(text.replace("/path/to/pydslrep", str(ROOT)))

    def command(self) -> list[str]:
        return [os.environ["NVIM"]]


class Helix(Modal):
    """Helix as it comes: completion and auto-closing brackets are on.

    Ctrl+U scrolls parameter hints, and whoever types without a pause meets hints that Helix has not asked about anew.
    """

    habits = Habits(leader=usual_leader, deletes_by_line=False, closes_braces=True)
    mistake = "● 1"
    insert = "(?m)^ INS"
    normal = "(?m)^ NOR"

    def command(self) -> list[str]:
        return [os.environ["HX"]]


class Kakoune(Modal):
    """Kakoune with kakoune-lsp, as it comes."""

    habits = Habits(ends_last_line=True)
    insert = r"\binsert\b"
    normal = r"(?s)\A(?!.*\binsert\b)"

    def set_up(self) -> None:
        link = self.made.home / "bin" / "kak-lsp"
        if not link.exists():
            link.symlink_to(os.environ["KAK_LSP"])
        super().set_up()

    def command(self) -> list[str]:
        return [os.environ["KAK"]]


QUIET = """
(setq native-comp-jit-compilation nil inhibit-startup-screen t make-backup-files nil auto-save-default nil
      create-lockfiles nil eglot-sync-connect 10 custom-file "/dev/null")
(menu-bar-mode -1)
"""


class Emacs(InTerminal):
    """Emacs with eglot and a package that completes while one types."""

    habits = Habits(closes_braces=True)
    mistake = r"\[eglot:"

    def __init__(self, made: Session, package: str) -> None:
        self.package = package
        super().__init__(made)

    def set_up(self) -> None:
        readme = (ROOT / "editors" / "emacs" / "README.md").read_text()
        block = re.search(r"^```elisp\n(.*?)^```", readme, re.M | re.S)
        assert block, "the readme has no elisp"
        settings = self.made.home / ".emacs.d" / "init.el"
        settings.parent.mkdir()
        found = '(file-expand-wildcards (concat (getenv "ELPA") "/*"))'
        packages = f"(setq load-path (append {found} load-path))\n"
        own = packages + (HERE / "emacs" / f"{self.package}.el").read_text()
        text = QUIET + block[1].replace("/path/to/pydslrep", str(ROOT)) + own
        settings.write_text(text)
        self.made.set_up()

    def command(self) -> list[str]:
        options = os.environ.get("EMACS_OPTIONS", "").split()
        return [os.environ["EMACS"], *options, "-nw"]

    def open(self, file: Path) -> None:
        self.say("C-x", "C-f")
        self.terminal.wait("Find file: ")
        self.say("C-a", "C-k", str(file), "Enter")
        self.terminal.wait(rf"{re.escape(file.name)} .*All")

    def save(self) -> None:
        self.say("C-x", "C-s")


class VsCode(Editor):
    """Visual Studio Code with default settings; vscode.mjs drives it."""

    def __init__(
        self,
        _: Session,
        settings: dict[str, object] | None = None,
        indents: bool = True,
    ) -> None:
        self.habits = Habits(closes_braces=True, indents=indents)
        self.file = ""
        self.node = subprocess.Popen(
            ["node", str(HERE / "vscode.mjs")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.found: list[str] = []
        self.work = Path(
            self.ask("start", program=PROGRAM, settings=settings or {})["folder"]
        )

    def ask(self, action: str, **details: object) -> dict[str, Any]:
        """Has something done, and waits for it."""
        assert self.node.stdin
        assert self.node.stdout
        self.node.stdin.write(json.dumps({"action": action, **details}) + "\n")
        self.node.stdin.flush()
        answer = self.node.stdout.readline()
        if not answer:
            raise SystemExit(f"the editor has ended while it was to {action}")
        return cast("dict[str, Any]", json.loads(answer))

    def open(self, file: Path) -> None:
        self.file = file.stem
        self.ask("open", name=file.name)

    def type(self, keys: list[str], pace: float) -> float:
        kept = os.environ.get("FRAMES")
        frames = str(Path(kept, self.file)) if kept else None
        typed = self.ask("type", keys=keys, pace=pace, frames=frames)
        self.found = typed["covered"]
        return float(typed["seconds"])

    def save(self) -> None:
        self.ask("save")

    def close(self) -> None:
        assert self.node.stdin
        self.node.stdin.close()
        self.node.wait()

    def covered(self) -> list[str]:
        return self.found


EDITORS: dict[str, Callable[[Session], Editor]] = {
    "vscode": VsCode,
    "vscode-enter": lambda made: VsCode(made, ENTER_ACCEPTS),
    "vscode-tab": lambda made: VsCode(made, TAB_INDENTS, indents=False),
    "neovim": Neovim,
    "neovim-cmp": lambda made: Neovim(made, "cmp", "", CMP),
    "neovim-cmp-select": lambda made: Neovim(made, "cmp", "select", CMP),
    "neovim-blink": lambda made: Neovim(made, "blink", "default", BLINK),
    "neovim-blink-enter": lambda made: Neovim(made, "blink", "enter", BLINK),
    "helix": Helix,
    "emacs-company": lambda made: Emacs(made, "company"),
    "emacs-corfu": lambda made: Emacs(made, "corfu"),
    "kakoune": Kakoune,
}
