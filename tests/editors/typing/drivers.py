"""The editors under test, each set up as its readme says, with automatic completion."""

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
from keystrokes import Behaviour, same_leader, usual_leader
from session import MESSAGE, ROOT, Session
from terminal import Terminal

HERE = Path(__file__).resolve().parent
# VS Code's own default, which the extension changes.
ENTER_ACCEPTS: dict[str, object] = {
    "[pydslrep]": {"editor.acceptSuggestionOnEnter": "on"}
}
# Without automatic indentation.
TAB_INDENTS: dict[str, object] = {
    "[pydslrep]": {"editor.autoIndent": "none", "editor.formatOnType": False}
}
# Environment variables with the folders of plugins.
CMP = ("NVIM_CMP", "CMP_NVIM_LSP")
BLINK = ("BLINK_CMP",)


class Editor:
    """A running editor and a folder with empty files."""

    behaviour: Behaviour
    work: Path
    # Whether keys wait for an editor that is behind. Only VS Code needs that: the others handle keys in turn.
    is_patient = False

    def open(self, file: Path) -> None:
        """Opens an empty file and puts the cursor in it."""
        raise NotImplementedError

    def type(self, keys: list[str], pace: float) -> float:
        """Presses keys, one each `pace` seconds; returns the seconds it took."""
        raise NotImplementedError

    def save(self) -> None:
        """Saves the file."""
        raise NotImplementedError

    def close(self) -> None:
        """Quits the editor."""
        raise NotImplementedError

    def problems(self) -> list[str]:
        """What was wrong while the latest program was typed, such as popups over its lines."""
        return []

    def screen(self) -> str:
        """The text of the screen."""
        return ""


class InTerminal(Editor):
    """An editor in a terminal. Its first file has an error; once it is shown, the server is running."""

    error_shown = re.escape(MESSAGE)

    def __init__(self, session: Session) -> None:
        self.session = session
        self.work = session.program.parent
        self.set_up()
        command = [*self.command(), str(session.program)]
        self.terminal = Terminal(command, session.program.parent, session.environment())
        self.keyboard = Keyboard(self.terminal)
        if not self.terminal.wait(self.error_shown):
            shown = self.screen()
            self.close()
            raise SystemExit(f"the server did not answer:\n{shown}")

    def set_up(self) -> None:
        """Writes its configuration."""
        self.session.set_up()

    def command(self) -> list[str]:
        """The command that starts it."""
        raise NotImplementedError

    def type(self, keys: list[str], pace: float) -> float:
        return self.keyboard.type(keys, pace)

    def press(self, *keys: str) -> None:
        """Presses keys that are not part of a program: names of keys, and texts."""
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
    """An editor with normal and insert mode, and commands after a colon."""

    # Patterns of the screen in normal and in insert mode.
    normal: str
    insert: str

    def open(self, file: Path) -> None:
        self.press(f":e {file}", "Enter")
        self.terminal.wait(re.escape(file.name))
        self.press("i")
        self.terminal.wait(self.insert)

    def save(self) -> None:
        self.press("Escape")
        # A key right after Escape would be read as one with Alt.
        self.terminal.wait(self.normal)
        self.press(":w", "Enter")


class Neovim(Modal):
    """Neovim with a completion plugin, or with built-in completion."""

    behaviour = Behaviour(leader=same_leader, ends_last_line=True)
    insert = "-- INSERT --"
    normal = r"(?s)\A(?!.*-- INSERT --)"
    error_shown = "(?m)^E "

    def __init__(
        self,
        session: Session,
        plugin: str | None = None,
        variant: str = "",
        needs: tuple[str, ...] = (),
    ) -> None:
        self.plugin = plugin
        self.variant = variant
        self.needs = needs
        super().__init__(session)

    def set_up(self) -> None:
        """Writes the readme's settings without a plugin manager, and the plugin's or else the readme's optional ones."""
        packages = self.session.home / ".local/share/nvim/site/pack/person/start"
        packages.mkdir(parents=True)
        for variable in self.needs:
            folder = Path(os.environ.get(variable, "")).resolve()
            if not (folder / "lua").is_dir():
                raise SystemExit(f"{variable} must be the folder of that plugin")
            (packages / folder.name).symlink_to(folder)
        settings = self.session.home / ".config" / "nvim" / "init.lua"
        settings.parent.mkdir()
        if self.plugin:
            options = f"vim.g.typing_variant = '{self.variant}'\n"
            options += (HERE / "neovim" / f"{self.plugin}.lua").read_text()
        else:
            options = self._block("vim.lsp.completion.enable")
        text = self._block("vim.opt.runtimepath:append") + options
        settings.write_text(text.replace("/path/to/pydslrep", str(ROOT)))

    @staticmethod
    def _block(call: str) -> str:
        """The readme's first block of Lua with this call."""
        readme = (ROOT / "editors" / "neovim" / "README.md").read_text()
        blocks: list[str] = re.findall(r"^```lua\n(.*?)^```", readme, re.M | re.S)
        return next(block for block in blocks if call in block)

    def command(self) -> list[str]:
        return [os.environ["NVIM"]]


class Helix(Modal):
    """Helix with default settings: completion and auto-closing brackets are on.

    Ctrl+U scrolls parameter hints, which may be outdated during fast typing.
    """

    behaviour = Behaviour(
        leader=usual_leader, deletes_by_line=False, closes_braces=True
    )
    error_shown = "● 1"
    insert = "(?m)^ INS"
    normal = "(?m)^ NOR"

    def command(self) -> list[str]:
        return [os.environ["HX"]]


class Kakoune(Modal):
    """Kakoune with kakoune-lsp and default settings."""

    behaviour = Behaviour(ends_last_line=True)
    insert = r"\binsert\b"
    normal = r"(?s)\A(?!.*\binsert\b)"

    def set_up(self) -> None:
        link = self.session.home / "bin" / "kak-lsp"
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
    """Emacs with eglot and a package for automatic completion."""

    behaviour = Behaviour(closes_braces=True)
    error_shown = r"\[eglot:"

    def __init__(self, session: Session, package: str) -> None:
        self.package = package
        super().__init__(session)

    def set_up(self) -> None:
        readme = (ROOT / "editors" / "emacs" / "README.md").read_text()
        block = re.search(r"^```elisp\n(.*?)^```", readme, re.M | re.S)
        assert block, "the readme has no elisp"
        settings = self.session.home / ".emacs.d" / "init.el"
        settings.parent.mkdir()
        found = '(file-expand-wildcards (concat (getenv "ELPA") "/*"))'
        packages = f"(setq load-path (append {found} load-path))\n"
        own = packages + (HERE / "emacs" / f"{self.package}.el").read_text()
        text = QUIET + block[1].replace("/path/to/pydslrep", str(ROOT)) + own
        settings.write_text(text)
        self.session.set_up()

    def command(self) -> list[str]:
        options = os.environ.get("EMACS_OPTIONS", "").split()
        return [os.environ["EMACS"], *options, "-nw"]

    def open(self, file: Path) -> None:
        self.press("C-x", "C-f")
        self.terminal.wait("Find file: ")
        self.press("C-a", "C-k", str(file), "Enter")
        self.terminal.wait(rf"{re.escape(file.name)} .*All")

    def save(self) -> None:
        self.press("C-x", "C-s")


class InBrowser(Editor):
    """An editor in a browser, controlled by a script for Node."""

    script: str

    def __init__(self) -> None:
        self.file = Path()
        self.found: list[str] = []
        self.node = subprocess.Popen(
            ["node", str(HERE / self.script)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def request(self, action: str, **details: object) -> dict[str, Any]:
        """Sends an action to the script and returns its answer."""
        assert self.node.stdin
        assert self.node.stdout
        self.node.stdin.write(json.dumps({"action": action, **details}) + "\n")
        self.node.stdin.flush()
        answer = self.node.stdout.readline()
        if not answer:
            raise SystemExit(f"the editor exited during {action}")
        return cast("dict[str, Any]", json.loads(answer))

    def open(self, file: Path) -> None:
        self.file = file
        self.request("open", name=file.name)

    def type(self, keys: list[str], pace: float) -> float:
        kept = os.environ.get("FRAMES")
        frames = str(Path(kept, self.file.stem)) if kept else None
        details = {"pace": pace, "frames": frames, "patient": self.is_patient}
        typed = self.request("type", keys=keys, **details)
        self.found = typed["covered"]
        return float(typed["seconds"])

    def save(self) -> None:
        self.request("save")

    def close(self) -> None:
        assert self.node.stdin
        self.node.stdin.close()
        self.node.wait()

    def problems(self) -> list[str]:
        return self.found


class VsCode(InBrowser):
    """Visual Studio Code."""

    script = "vscode.mjs"

    def __init__(
        self,
        session: Session,
        settings: dict[str, object] | None = None,
        indents: bool = True,
    ) -> None:
        super().__init__()
        self.behaviour = Behaviour(closes_braces=True, indents=indents)
        folder = session.program.parent
        files = {
            str(file.relative_to(folder)): file.read_text()
            for file in folder.rglob("*")
            if file.is_file()
        }
        started = self.request("start", files=files, settings=settings or {})
        self.work = Path(started["folder"])


class InPlayground(InBrowser):
    """The playground, which sees no files but those that the examples import."""

    script = "playground.mjs"
    behaviour = Behaviour(closes_braces=True)

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.work = session.program.parent
        self.request("start")

    def save(self) -> None:
        errors = self.request("save", file=str(self.file))["errors"]
        self.found += [f"the page: {error}" for error in errors]


EDITORS: dict[str, Callable[[Session], Editor]] = {
    "vscode": VsCode,
    "vscode-enter": lambda session: VsCode(session, ENTER_ACCEPTS),
    "vscode-tab": lambda session: VsCode(session, TAB_INDENTS, indents=False),
    "neovim": Neovim,
    "neovim-cmp": lambda session: Neovim(session, "cmp", "", CMP),
    "neovim-cmp-select": lambda session: Neovim(session, "cmp", "select", CMP),
    "neovim-blink": lambda session: Neovim(session, "blink", "default", BLINK),
    "neovim-blink-enter": lambda session: Neovim(session, "blink", "enter", BLINK),
    "helix": Helix,
    "emacs-company": lambda session: Emacs(session, "company"),
    "emacs-corfu": lambda session: Emacs(session, "corfu"),
    "kakoune": Kakoune,
    "playground": InPlayground,
}
# They step over an inserted brace only where it is the next character, not on the line below.
LEAVE_SECOND_BRACES = ("helix",)
