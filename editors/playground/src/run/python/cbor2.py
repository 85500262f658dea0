"""Stands in for cbor2, whose releases since 6 are compiled code: the kinds of values that the remote API exchanges."""

import struct
from typing import Any

FALSE, TRUE, NULL, UNDEFINED = 0xF4, 0xF5, 0xF6, 0xF7
FLOATS = {0xF9: ">e", 0xFA: ">f", 0xFB: ">d"}
INDEFINITE, BREAK = 31, 0xFF
# The number of bytes after the first that hold a length, by the low bits of the first byte, and as `struct` calls them.
LENGTHS = {24: ">B", 25: ">H", 26: ">I", 27: ">Q"}


def dumps(value: Any, **_options: Any) -> bytes:
    """Encodes a value."""
    out = bytearray()
    write(value, out)
    return bytes(out)


def loads(message: bytes) -> Any:
    """Decodes a message; raises ValueError."""
    try:
        return Reader(message).read()
    except (IndexError, struct.error) as error:
        raise ValueError("incomplete CBOR") from error


def write(value: Any, out: bytearray) -> None:
    """Appends an encoded value."""
    match value:
        case None:
            out.append(NULL)
        case bool():
            out.append(TRUE if value else FALSE)
        case int():
            write_head(0 if value >= 0 else 1, value if value >= 0 else -1 - value, out)
        case float():
            out += b"\xfb" + struct.pack(">d", value)
        case bytes():
            write_head(2, len(value), out)
            out += value
        case str():
            text = value.encode()
            write_head(3, len(text), out)
            out += text
        case list() | tuple():
            write_head(4, len(value), out)
            for item in value:
                write(item, out)
        case dict():
            write_head(5, len(value), out)
            for key, item in value.items():
                write(key, out)
                write(item, out)
        case _:
            raise TypeError(f"cannot encode {type(value).__name__}")


def write_head(kind: int, length: int, out: bytearray) -> None:
    """Appends the kind of a value with its length, or with the value itself if that is an integer."""
    if length < 24:
        out.append(kind << 5 | length)
        return
    for low, form in LENGTHS.items():
        if length < 1 << 8 * struct.calcsize(form):
            out.append(kind << 5 | low)
            out += struct.pack(form, length)
            return
    raise OverflowError(f"{length} has more than 64 bits")


class Reader:
    """Reads values from a message."""

    def __init__(self, message: bytes) -> None:
        self._message, self._at = message, 0

    def read(self) -> Any:
        """The next value."""
        first = self._message[self._at]
        self._at += 1
        if form := FLOATS.get(first):
            return self._unpack(form)
        kind, low = first >> 5, first & 31
        if kind == 7:
            return {FALSE: False, TRUE: True}.get(first)
        length = None if low == INDEFINITE else self._length(low)
        match kind:
            case 0:
                return length
            case 1:
                return -1 - length
            case 2:
                return self._bytes(length)
            case 3:
                return self._bytes(length).decode()
            case 4:
                return [self.read() for _ in self._each(length)]
            case 5:
                return {self.read(): self.read() for _ in self._each(length)}
        raise ValueError(f"unknown CBOR {first:#x}")

    def _length(self, low: int) -> int:
        return self._unpack(LENGTHS[low]) if low in LENGTHS else low

    def _unpack(self, form: str) -> Any:
        (value,) = struct.unpack_from(form, self._message, self._at)
        self._at += struct.calcsize(form)
        return value

    def _bytes(self, length: int | None) -> bytes:
        if length is None:
            return b"".join(self.read() for _ in self._each(None))
        part = self._message[self._at : self._at + length]
        if len(part) < length:
            raise IndexError
        self._at += length
        return part

    def _each(self, length: int | None) -> Any:
        """Counts the items of a list; one of unknown length has an end."""
        if length is not None:
            yield from range(length)
            return
        while self._message[self._at] != BREAK:
            yield
        self._at += 1
