"""A proxy between a client and a simulator that changes, delays or drops chosen answers."""

from __future__ import annotations

import math
import threading
from collections import Counter, defaultdict, deque
from dataclasses import dataclass
from typing import Any

import cbor2
import zmq

# What a server answers that has not finished, and what clients say to that.
WAIT, REPEAT, EXECUTED = "_*wait*_", "_*repeat*_", "_*executed*_"

ERROR = "316: in the engine: no \x1b[31m\x9b31m such thing.\n" * 1_300_000  # 53 MB

NUMBERS = {"nan": math.nan, "infinity": math.inf, "1e308": 1e308}
KINDS = ("type", "length", *NUMBERS, "error", "silence", "half")


@dataclass(frozen=True)
class Lie:
    """What to do with one answer, and with silence, with all that follow."""

    function: str  # such as sim.getObject
    kind: str
    occurrence: int  # 1 for the first answer of the function

    def __str__(self) -> str:
        return f"{self.function} {self.kind} {self.occurrence}"


def with_numbers(value: Any, number: float) -> Any:
    """The same value with another number in the place of all."""
    if isinstance(value, list):
        return [with_numbers(each, number) for each in value]
    if isinstance(value, dict):
        return {key: with_numbers(each, number) for key, each in value.items()}
    return value if isinstance(value, bool) or value is None else number


def of_another_type(value: Any) -> Any:
    """A value of another type."""
    return 7 if isinstance(value, str) else "north"


def of_another_length(values: list[Any]) -> list[Any]:
    """Less values, or more where there is none."""
    match values:
        case []:
            return [0, 0, 0]
        case [list(value)] if value:
            return [value[:-1]]
        case [dict(value)] if value:
            return [dict(list(value.items())[: len(value) // 2])]
        case _:
            return values[:-1]


def changed(body: bytes, kind: str) -> bytes:
    """An answer as a liar gives it."""
    if kind == "half":
        return body[: len(body) // 2]
    if kind == "error":
        return cbor2.dumps({"err": ERROR})
    values = cbor2.loads(body).get("ret", [])
    values = list(values) if values else []
    if kind == "type":
        lied = [of_another_type(value) for value in values] or ["north"]
    elif kind == "length":
        lied = of_another_length(values)
    else:
        lied = with_numbers(values, NUMBERS[kind])
        # Where there is no number to change.
        lied = lied if repr(lied) != repr(values) else [NUMBERS[kind]]
    assert repr(lied) != repr(values), "that is no lie"
    return cbor2.dumps({"ret": lied})


class LyingEngine(threading.Thread):
    """A simulator's address, on which somebody else answers now and then."""

    def __init__(self, port: int) -> None:
        """`port` is the simulator's."""
        super().__init__(daemon=True)
        self._context = zmq.Context()
        self._front = self._context.socket(zmq.ROUTER)
        self._front.linger = 0
        self.port: int = self._front.bind_to_random_port("tcp://127.0.0.1")
        self._engine = f"tcp://127.0.0.1:{port}"
        self._lock = threading.Lock()
        self._done = threading.Event()
        self._forget()

    def _forget(self) -> None:
        self._lie: Lie | None = None
        self.answers: Counter[str] = Counter()
        self.told = 0
        self._backs: dict[bytes, zmq.Socket[bytes]] = {}
        self._asked: dict[bytes, deque[str]] = defaultdict(deque)
        self._waiting: dict[bytes, deque[str]] = defaultdict(deque)
        self._silent: set[bytes] = set()

    def begin(self, lie: Lie | None) -> None:
        """From now on there is one lie at most; what was before is over."""
        with self._lock:
            for back in self._backs.values():
                back.close(linger=0)
            self._forget()
            self._lie = lie

    def close(self) -> None:
        """Ends it."""
        self._done.set()
        self.join()
        for socket in (self._front, *self._backs.values()):
            socket.close(linger=0)
        self._context.term()

    def run(self) -> None:
        """Passes messages on."""
        while not self._done.is_set():
            with self._lock:
                backs = dict(self._backs)
            poller = zmq.Poller()
            for socket in (self._front, *backs.values()):
                if not socket.closed:
                    poller.register(socket, zmq.POLLIN)
            try:
                ready = dict(poller.poll(20))
            except zmq.ZMQError:
                continue  # another run has begun
            with self._lock:
                if self._front in ready:
                    self._ask()
                for client, back in backs.items():
                    if back in ready and self._backs.get(client) is back:
                        self._answer(client, back)

    def _ask(self) -> None:
        client, *_, body = self._front.recv_multipart()
        if client in self._silent:
            return
        if client not in self._backs:
            self._backs[client] = self._context.socket(zmq.DEALER)
            self._backs[client].connect(self._engine)
        function = cbor2.loads(body)["func"]
        if function == EXECUTED and self._waiting[client]:
            function = self._waiting[client].popleft()
        self._asked[client].append(function)
        self._backs[client].send_multipart([b"", body])

    def _answer(self, client: bytes, back: zmq.Socket[bytes]) -> None:
        *_, body = back.recv_multipart()
        function = self._asked[client].popleft()
        if cbor2.loads(body).get("func") in (WAIT, REPEAT):
            self._waiting[client].append(function)
        else:
            self.answers[function] += 1
            lie = self._lie
            if (
                lie
                and function == lie.function
                and self.answers[function] == lie.occurrence
            ):
                self.told += 1
                if lie.kind == "silence":
                    self._silent.add(client)
                else:
                    body = changed(body, lie.kind)
        if client not in self._silent:
            self._front.send_multipart([client, b"", body])
