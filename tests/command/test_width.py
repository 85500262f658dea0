"""Tables on terminals of several widths: no line is wider, and no number is broken."""

from __future__ import annotations

import fcntl
import os
import pathlib
import pty
import re
import struct
import subprocess
import termios

import pytest

EXAMPLES = pathlib.Path(__file__).parents[2] / "examples"
NUMBER = re.compile(r"-?\d+\.\d+")


def printed(command: str, columns: int, *arguments: str) -> list[str]:
    """The output of a command on a terminal of that width."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
    process = subprocess.Popen(
        [command, *arguments],
        stdin=subprocess.DEVNULL,
        stdout=theirs,
        stderr=subprocess.STDOUT,
        cwd=EXAMPLES,
        env=os.environ | {"NO_COLOR": "1"},
    )
    os.close(theirs)
    out = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:  # the terminal is closed
            break
        if not part:
            break
        out += part
    os.close(ours)
    assert process.wait() == 0, out
    return out.decode().splitlines()


@pytest.mark.parametrize("columns", [56, 70, 80, 120])
@pytest.mark.parametrize("program", ["convoy.pyr", "crossing.pyr", "square.pyr"])
def test_no_line_is_wider_than_the_terminal(
    command: str, tmp_path: pathlib.Path, columns: int, program: str
) -> None:
    for arguments in (
        ("plan", program),
        ("stats", program),
        ("build", program, "-o", str(tmp_path)),
    ):
        lines = printed(command, columns, *arguments)
        assert max(map(len, lines)) <= columns, "\n".join(lines)


@pytest.mark.parametrize("program", ["crossing.pyr", "square.pyr"])
def test_a_narrow_terminal_shows_the_same_numbers(command: str, program: str) -> None:
    wide, narrow = (
        sorted(NUMBER.findall("\n".join(printed(command, columns, "plan", program))))
        for columns in (120, 56)
    )
    assert narrow == wide
