"""Checks the subject of a commit message: `area: what changes`, at most 72 characters.

The hook `commit-subject` of .pre-commit-config.yaml calls it with the file that holds the message.
"""

import re
import sys
from pathlib import Path

MAX_LENGTH = 72
AREA = re.compile(r"[a-z][a-z0-9_-]*(, [a-z][a-z0-9_-]*)*: \S")
# Git writes these itself, and `git rebase --autosquash` takes the second kind away again.
BY_GIT = re.compile(r"(Merge|Revert) |(fixup|squash|amend)! ")


def complaints(message: str) -> list[str]:
    """What is wrong with the subject, and with the line after it."""
    lines = [line for line in message.splitlines() if not line.startswith("#")]
    subject = lines[0] if lines else ""
    if BY_GIT.match(subject):
        return []
    found = []
    if not AREA.match(subject):
        found.append(
            "begin with the area that changes and a colon: `server: answer in order`"
        )
    if len(subject) > MAX_LENGTH:
        found.append(f"{len(subject)} characters; at most {MAX_LENGTH} fit")
    if subject.endswith("."):
        found.append("leave out the full stop at the end")
    if len(lines) > 1 and lines[1]:
        found.append("leave the second line empty; the body begins on the third")
    return found


if __name__ == "__main__":
    found = complaints(Path(sys.argv[1]).read_text(encoding="utf-8"))
    for complaint in found:
        print(f"commit subject: {complaint}", file=sys.stderr)
    sys.exit(bool(found))
