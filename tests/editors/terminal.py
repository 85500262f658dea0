"""Runs a program in a private terminal: types, waits for output and takes pictures.

The terminal is a private tmux server. Nothing waits for a fixed time: `wait` returns as soon as the screen matches.
"""

from __future__ import annotations

import html
import os
import re
import shlex
import subprocess
import tempfile
import time
import uuid
from collections.abc import Callable
from pathlib import Path

SIZE = (100, 24)
TIMEOUT = 60.0
SEQUENCE = re.compile(r"\x1b\[([0-9;:]*)m|\x1b\][^\x1b]*\x1b\\|\x1b\(B|[\x0e\x0f]")

BACKGROUND, FOREGROUND = "#1e1e1e", "#d4d4d4"
BASIC = re.split(
    " ",
    "#000000 #cd3131 #0dbc79 #e5e510 #2472c8 #bc3fbc #11a8cd #e5e5e5 "
    "#666666 #f14c4c #23d18b #f5f543 #3b8eea #d670d6 #29b8db #ffffff",
)


class Terminal:
    """A running program and its screen."""

    def __init__(
        self,
        command: list[str],
        folder: Path,
        environment: dict[str, str],
        size: tuple[int, int] = SIZE,
    ) -> None:
        self.size = size
        self.name = f"pydslrep-{uuid.uuid4().hex[:8]}"
        variables = {
            **os.environ,
            **environment,
            "TERM": "xterm-256color",
            "COLORTERM": "truecolor",
        }
        variables |= {"LANG": "C.UTF-8", "LC_ALL": "C.UTF-8"}
        variables.pop("TMUX", None)
        measures = ["-x", str(size[0]), "-y", str(size[1])]
        start = ["-f", "/dev/null", "-u", "new-session", "-d", *measures]
        subprocess.run(
            ["tmux", "-L", self.name, *start, "-c", str(folder), shlex.join(command)],
            env=variables,
            check=True,
        )
        self._tmux("set-option", "-g", "status", "off")
        self._tmux("set-option", "-g", "remain-on-exit", "on")
        self._tmux("set-option", "-sg", "escape-time", "10")

    def __enter__(self) -> Terminal:
        return self

    def __exit__(self, *_: object) -> None:
        self._tmux("kill-server")

    def _tmux(self, *arguments: str) -> str:
        return subprocess.run(
            ["tmux", "-L", self.name, *arguments],
            check=False,
            capture_output=True,
            text=True,
        ).stdout

    def press(self, *keys: str) -> None:
        """Keys by tmux's names: `Enter`, `Escape`, `C-x`."""
        for key in keys:
            self._tmux("send-keys", key)

    def type(self, text: str) -> None:
        """Characters, one at a time."""
        for character in text:
            self._tmux("send-keys", "-l", character)
            time.sleep(0.02)

    def screen(self) -> str:
        """The text of the screen."""
        return self._tmux("capture-pane", "-p")

    def wait(self, pattern: str, timeout: float = TIMEOUT) -> bool:
        """Waits until a pattern appears; returns whether it does."""
        return self._wait(
            lambda screen: re.search(pattern, screen) is not None, timeout
        )

    def wait_without(self, pattern: str) -> bool:
        """Waits until a pattern disappears; returns whether it does."""
        return self._wait(lambda screen: re.search(pattern, screen) is None)

    def until(self, is_reached: Callable[[], bool]) -> bool:
        """Waits for something that is not on the screen; returns whether it happens."""
        return self._wait(lambda _: is_reached())

    def _wait(
        self, is_reached: Callable[[str], bool], timeout: float = TIMEOUT
    ) -> bool:
        until = time.monotonic() + timeout
        while time.monotonic() < until:
            if is_reached(self.screen()):
                return True
            time.sleep(0.05)
        return False

    def styled(self) -> list[list[tuple[str, dict[str, str]]]]:
        """The lines of the screen as styled spans: texts with their CSS."""
        return spans(self._tmux("capture-pane", "-p", "-e", "-N"))

    def colour_of(self, text: str) -> str | None:
        """The colour of the first span that contains a text."""
        for line in self.styled():
            for span, style in line:
                if re.search(rf"(?<!\w){re.escape(text)}(?!\w)", span):
                    return style.get("color", FOREGROUND)
        return None

    def wait_for_colours(self, words: tuple[str, ...], count: int) -> bool:
        """Waits until words have this many different colours; returns whether they do."""

        def has_them(_: str) -> bool:
            colours = {self.colour_of(word) for word in words}
            return None not in colours and len(colours) >= count

        return self._wait(has_them)

    def picture(self, file: Path) -> None:
        """Saves the screen as a PNG with Chromium."""
        lines = ("".join(html_span(*span) for span in line) for line in self.styled())
        font = "font: 15px/19px 'DejaVu Sans Mono', monospace"
        page = '<meta charset="utf-8"><style>span{display:inline-block;height:19px}</style>'
        page += f'<body style="margin:0;background:{BACKGROUND}">'
        page += f'<pre style="margin:8px;{font};color:{FOREGROUND}">' + "\n".join(lines)
        file.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "screen.html").write_text(page)
            window = f"--window-size={self.size[0] * 9 + 24},{self.size[1] * 19 + 16}"
            options = [
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--hide-scrollbars",
                window,
            ]
            options += [f"--user-data-dir={folder}/profile", f"--screenshot={file}"]
            subprocess.run(
                [_browser(), *options, f"file://{folder}/screen.html"],
                check=True,
                capture_output=True,
            )


def _browser() -> str:
    """The program that draws pictures; it is installed if necessary."""
    script = Path(__file__).resolve().parents[1] / "install" / "chromium.sh"
    done = subprocess.run([script], check=True, stdout=subprocess.PIPE, text=True)
    return done.stdout.strip()


def spans(screen: str) -> list[list[tuple[str, dict[str, str]]]]:
    """Parses a screen with escape sequences into lines of styled spans. A style applies until the next one."""
    lines: list[list[tuple[str, dict[str, str]]]] = []
    style: dict[str, str] = {}
    for line in screen.splitlines():
        last = 0
        lines.append([])
        for sequence in SEQUENCE.finditer(line):
            lines[-1].append((line[last : sequence.start()], shown(style)))
            if sequence[0].endswith("m"):
                style = restyled(style, sequence[1])
            last = sequence.end()
        lines[-1].append((line[last:], shown(style)))
    return lines


def restyled(style: dict[str, str], parameters: str) -> dict[str, str]:
    """The style after a sequence of parameters."""
    style = dict(style)
    codes = [
        [int(part or 0) for part in code.split(":")]
        for code in parameters.split(";")
        if code or not parameters
    ]
    while codes:
        code, *details = codes.pop(0) or [0]
        if code in (38, 48, 58):
            if not details:
                count = 2 if codes[0] == [5] else 4
                details = [code[0] for code in codes[:count]]
                codes = codes[count:]
            name = {38: "color", 48: "background", 58: "text-decoration-color"}[code]
            style[name] = (
                palette(details[-1])
                if details[0] == 5
                else "#{:02x}{:02x}{:02x}".format(*details[-3:])
            )
        elif code == 0:
            style = {}
        elif code == 4 and details != [0]:
            style["text-decoration-line"] = "underline"
            style["text-decoration-style"] = "wavy" if details == [3] else "solid"
        elif code in (24, 4):
            style.pop("text-decoration-line", None)
        elif code in PLAIN:
            style |= PLAIN[code]
        elif code in (22, 23, 27, 39, 49):
            for name in ENDED[code]:
                style.pop(name, None)
        elif 30 <= code <= 37 or 90 <= code <= 97:
            style["color"] = BASIC[code - 30 if code < 40 else code - 82]
        elif 40 <= code <= 47 or 100 <= code <= 107:
            style["background"] = BASIC[code - 40 if code < 50 else code - 92]
    return style


PLAIN = {
    1: {"font-weight": "bold"},
    2: {"opacity": "0.7"},
    3: {"font-style": "italic"},
    7: {"reverse": "yes"},
}
ENDED = {
    22: ["font-weight", "opacity"],
    23: ["font-style"],
    27: ["reverse"],
    39: ["color"],
    49: ["background"],
}


def palette(number: int) -> str:
    """One of the 256 colours of xterm."""
    if number < 16:
        return BASIC[number]
    if number >= 232:
        return "#" + f"{8 + (number - 232) * 10:02x}" * 3
    number -= 16
    parts = (number // 36, number // 6 % 6, number % 6)
    return "#" + "".join(f"{55 + 40 * part if part else 0:02x}" for part in parts)


def shown(style: dict[str, str]) -> dict[str, str]:
    """A style with reversed colours resolved."""
    if "reverse" not in style:
        return style
    ends = {
        "color": style.get("background", BACKGROUND),
        "background": style.get("color", FOREGROUND),
    }
    return {
        name: value for name, value in {**style, **ends}.items() if name != "reverse"
    }


def html_span(text: str, style: dict[str, str]) -> str:
    """A styled text as HTML."""
    css = ";".join(f"{name}:{value}" for name, value in style.items())
    return f'<span style="{css}">{html.escape(text)}</span>' if text else ""
