"""The files that a run writes: whole or not at all, and never in place of something else.

`pydslrep` has the same rules for what it writes itself: crates/output.
"""

import json
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from .errors import SetupError

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

PICTURE_MARK = "Drawn by PyDSLRep"
PNG = b"\x89PNG\r\n\x1a\n"
LOCKED_BYTE = 1 << 30
START = 1 << 16  # bytes; enough for a line of a trace and for the text of a PNG


def is_trace(file: Path) -> bool:
    """Whether a file is a trace: its first line is enough."""
    line = start_of(file).partition(b"\n")[0]
    return has_keys(line, "t", "robot", "x", "y", "theta")


def is_map(file: Path) -> bool:
    """Whether a file has the maps of a run."""
    return has_keys(file.read_bytes(), "environment", "nodes", "edges")


def is_picture(file: Path) -> bool:
    """Whether a file is a PNG of ours."""
    start = start_of(file)
    return start.startswith(PNG) and PICTURE_MARK.encode() in start


def start_of(file: Path) -> bytes:
    """The first bytes of a file."""
    with file.open("rb") as content:
        return content.read(START)


def has_keys(text: bytes, *keys: str) -> bool:
    """Whether a text is a JSON object with some keys."""
    try:
        found = json.loads(text)
    except ValueError:
        return False
    return isinstance(found, dict) and found.keys() >= set(keys)


def output_path(path: Path, is_one: Callable[[Path], bool], what: str) -> Path:
    """Where an output goes; raises SetupError if that may not be replaced.

    It may if it is empty or one of ours already, which `is_one` tells. Links are followed only within their folder.
    """
    place = path.resolve()
    if path.is_symlink() and not (
        place.exists() and place.is_relative_to(path.parent.resolve())
    ):
        raise SetupError(
            f"{path} is a link to {place}, outside of its folder; remove the link, or name the file itself"
        )
    if not place.exists():
        return place
    if not place.is_file() or (place.stat().st_size > 0 and not is_one(place)):
        raise SetupError(f"{path} exists and is not {what}; choose another file")
    return place


@contextmanager
def growing_trace(path: Path) -> Iterator[TextIO]:
    """A trace to write to, called `path` in the end, and until then `path` with `.partial` after it."""
    place = output_path(path, is_trace, "a trace")
    partial = place.with_name(f"{place.name}.partial")
    partial = output_path(partial, is_trace, "a trace")
    with claimed(partial) as file:
        try:
            yield file
        except BaseException:
            # What was driven up to an error is worth keeping, but nothing replaces an older trace.
            give_name(file, partial, place, keep_older=file.tell() == 0)
            raise
        give_name(file, partial, place, keep_older=False)


def give_name(file: TextIO, partial: Path, place: Path, *, keep_older: bool) -> None:
    """Ends a trace: it gets its name, or is removed."""
    file.flush()
    if sys.platform == "win32":
        # A file cannot be renamed there while it is open.
        file.close()
    if keep_older and place.exists():
        partial.unlink()
    else:
        partial.replace(place)


def claimed(path: Path) -> TextIO:
    """An empty file that no other process claims before this one closes it; raises SetupError."""
    while True:
        file = path.open("a", encoding="utf-8", buffering=1)
        try:
            lock(file)
            # Who had claimed it before may have given it another name.
            if path.exists() and os.path.samestat(os.fstat(file.fileno()), path.stat()):
                file.truncate(0)
                return file
        except (BlockingIOError, PermissionError):
            file.close()
            raise SetupError(
                f"cannot write {path}: another process is writing it; choose another file"
            ) from None
        file.close()


def lock(file: TextIO) -> None:
    """Locks a file until it is closed; raises BlockingIOError or PermissionError if another process has done so."""
    if sys.platform == "win32":
        # Nothing is there, so the lock hinders no reader.
        file.seek(LOCKED_BYTE)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        file.seek(0)
    else:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise
        except OSError:
            return  # some file systems have no locks


def write_whole(place: Path, content: bytes) -> None:
    """Writes a file: at any moment it has its old content or the new one."""
    new = place.with_name(f".pydslrep-{os.urandom(8).hex()}")
    with new.open("xb") as file:
        if sys.platform != "win32":
            # Others remove such files if nobody holds a lock.
            fcntl.flock(file, fcntl.LOCK_EX)
        try:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
            if sys.platform == "win32":
                file.close()
            new.replace(place)
        except BaseException:
            new.unlink(missing_ok=True)
            raise
