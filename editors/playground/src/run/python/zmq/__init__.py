"""Stands in for pyzmq: sockets that are connected to the simulator in the same worker, which answers at once."""

from collections import deque
from collections.abc import Iterable
from itertools import count
from typing import Any, ClassVar

from _pydslrep_simulator import disconnect, exchange

NOBLOCK, SNDMORE = 1, 2
REQ, DEALER = 3, 5
EVENT_CONNECTED, EVENT_CLOSED, EVENT_DISCONNECTED = 0x1, 0x80, 0x200

# What the simulator has answered to each socket, by its identity.
MAILBOXES: dict[int, deque[bytes]] = {}


def deliver(replies: Iterable[tuple[int, bytes]]) -> None:
    """Puts replies into the mailboxes of the sockets that they are for."""
    for identity, reply in replies:
        if identity in MAILBOXES:
            MAILBOXES[identity].append(bytes(reply))


class ZMQError(Exception):
    """As in pyzmq."""


class Again(ZMQError):  # noqa: N818 - its name
    """Nothing has arrived in time."""


class Context:
    """As in pyzmq."""

    _instance: ClassVar["Context | None"] = None

    @classmethod
    def instance(cls) -> "Context":
        """The one context."""
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance

    def socket(self, kind: int) -> "Socket":
        """A new socket."""
        return Socket(kind)

    def term(self) -> None:
        """Does nothing: there are no threads."""


class Monitor:
    """Tells once that its socket is connected."""

    def __init__(self) -> None:
        self.events: deque[int] = deque()

    def poll(self, _timeout: float) -> bool:
        """Whether there is an event; it comes at once or never."""
        return bool(self.events)

    def close(self, linger: int = 0) -> None:
        """Does nothing."""


class Socket:
    """A client of the simulator."""

    _identities = count(1)

    def __init__(self, _kind: int) -> None:
        self.closed = False
        self.linger = self.rcvtimeo = self.reconnect_ivl = -1
        self._identity = next(Socket._identities)
        self._replies = MAILBOXES[self._identity] = deque()
        self._monitor = Monitor()

    def connect(self, _address: str) -> None:
        """Connects; whatever the address, the simulator is here."""
        self._monitor.events.append(EVENT_CONNECTED)

    def get_monitor_socket(self, _events: int) -> Monitor:
        """A socket that tells of connections."""
        return self._monitor

    def disable_monitor(self) -> None:
        """Does nothing."""

    def send(self, frame: bytes, flags: int = 0) -> None:
        """Sends a request. Frames that more follow are those in front of it, which are empty."""
        if flags & SNDMORE:
            return
        deliver(exchange(self._identity, frame))

    def recv(self) -> bytes:
        """A reply; raises Again if there is none, as none will come while everything waits for this."""
        if not self._replies:
            raise Again
        return self._replies.popleft()

    def close(self, _linger: int = 0, **_options: Any) -> None:
        """Disconnects."""
        if not self.closed:
            self.closed = True
            del MAILBOXES[self._identity]
            deliver(disconnect(self._identity))
