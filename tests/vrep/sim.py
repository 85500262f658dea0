"""A client of V-REP's legacy remote API in pure Python, with the functions that scripts and tests use.

V-REP's own client is part of V-REP only. For tests, this one behaves the same: a thread continuously exchanges messages
with the simulator, commands wait in an outbox until the next message, replies are stored in an inbox by command, and
every function takes an operation mode and returns a code first.
"""

from __future__ import annotations

import contextlib
import itertools
import socket
import struct
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

simx_opmode_oneshot = 0x00000
simx_opmode_blocking = 0x10000
simx_opmode_streaming = 0x20000
simx_opmode_discontinue = 0x50000
simx_opmode_buffer = 0x60000
simx_opmode_remove = 0x70000

simx_return_ok = 0
simx_return_novalue_flag = 1
simx_return_timeout_flag = 2
simx_return_illegal_opmode_flag = 4
simx_return_remote_error_flag = 8
simx_return_initialize_error_flag = 64

simx_headeroffset_server_state = 17

BLOCKING_LIMIT = 5.0  # s
MAX_PACKET = 1300

_HEADER = struct.Struct("<HBiiiHB")  # check sum, version, ids and times, scene, state
_COMMAND = struct.Struct("<iiHiiHiBB")
_PACKET = struct.Struct("<HHH")

# The key of an inbox entry: the type of a command and its arguments.
_Name = tuple[int, bytes]


@dataclass
class _Reply:
    message: int
    failed: bool
    time: int
    payload: bytes


@dataclass
class _Connection:
    line: socket.socket
    cycle: float
    changed: threading.Condition = field(default_factory=threading.Condition)
    outbox: dict[_Name, bytes] = field(default_factory=dict)
    inbox: dict[_Name, _Reply] = field(default_factory=dict)
    next_message: int = 0
    state: int = 0
    last_time: int = 0
    busy: bool = False  # a message is being exchanged
    paused: bool = False
    closing: bool = False
    lost: bool = False

    def run(self) -> None:
        """Exchanges messages until the connection ends."""
        with contextlib.suppress(OSError):
            while not self.closing:
                with self.changed:
                    self.changed.wait_for(self._has_news, self.cycle)
                    commands = [] if self.paused else list(self.outbox.values())
                    if not self.paused:
                        self.outbox.clear()
                    self.busy = True
                self._exchange(commands)
        with self.changed:
            self.lost = True
            self.changed.notify_all()

    def _has_news(self) -> bool:
        return self.closing or (bool(self.outbox) and not self.paused)

    def _exchange(self, commands: list[bytes]) -> None:
        clock = int(1000 * time.monotonic()) & 0x7FFFFFFF
        header = _HEADER.pack(0, 11, self.next_message, clock, 0, 0, 0)
        _send(self.line, header + b"".join(commands))
        message = _receive(self.line)
        _, _, number, _, _, _, state = _HEADER.unpack_from(message)
        with self.changed:
            self.next_message += 1
            self.busy = False
            self.state = state
            for name, mode, reply in _replies(message, number):
                if mode == simx_opmode_discontinue >> 16:
                    self.inbox.pop(name, None)
                else:
                    self.inbox[name] = reply
            self.changed.notify_all()


def _send(line: socket.socket, message: bytes) -> None:
    size = MAX_PACKET - _PACKET.size
    parts = [message[start : start + size] for start in range(0, len(message), size)]
    for index, part in enumerate(parts):
        line.sendall(_PACKET.pack(1, len(part), len(parts) - 1 - index) + part)


def _receive(line: socket.socket) -> bytes:
    message, to_come = b"", 1
    while to_come:
        mark, length, to_come = _PACKET.unpack(_read(line, _PACKET.size))
        assert mark == 1
        message += _read(line, length)
    return message


def _read(line: socket.socket, length: int) -> bytes:
    content = b""
    while len(content) < length:
        part = line.recv(length - len(content))
        if not part:
            raise ConnectionResetError
        content += part
    return content


def _replies(message: bytes, number: int) -> Iterator[tuple[_Name, int, _Reply]]:
    start = _HEADER.size
    while start < len(message):
        size, full, key_size, _, command, _, clock, status, _ = _COMMAND.unpack_from(
            message, start
        )
        assert size == full >= _COMMAND.size + key_size
        content = message[start + _COMMAND.size : start + size]
        name = (command & 0xFFFF, content[:key_size])
        yield (
            name,
            command >> 16,
            _Reply(number, bool(status & 1), clock, content[key_size:]),
        )
        start += size


_connections: dict[int, _Connection] = {}
_numbers = itertools.count()


def simxStart(
    address: str,
    port: int,
    wait: bool,
    do_not_reconnect: bool,
    limit: int,
    cycle: int,
) -> int:
    assert all(part.isdecimal() for part in address.split(".")), "knows no names"
    try:
        line = socket.create_connection((address, port), limit / 1000)
    except OSError:
        return -1
    line.settimeout(None)
    line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    number = next(_numbers)
    connection = _connections[number] = _Connection(line, cycle / 1000)
    threading.Thread(target=connection.run, daemon=True).start()
    return number


def simxFinish(number: int) -> None:
    connection = _connections.pop(number, None)
    if connection is None:
        return
    with connection.changed:
        connection.paused = False
        farewell = _COMMAND.pack(30, 30, 4, 0, 0x000A, 0, 0, 0, 0) + bytes(4)
        connection.outbox[0x000A, bytes(4)] = farewell
        connection.changed.notify_all()
        done = (0x000A, bytes(4))
        connection.changed.wait_for(
            lambda: connection.lost or done in connection.inbox, 0.5
        )
        connection.closing = True
        connection.changed.notify_all()
    with contextlib.suppress(OSError):  # the other side may have closed it already
        connection.line.shutdown(socket.SHUT_RDWR)
    connection.line.close()


def simxGetConnectionId(number: int) -> int:
    connection = _connections.get(number)
    return -1 if connection is None or connection.lost else 1


def simxPauseCommunication(number: int, pause: bool) -> int:
    connection = _connections.get(number)
    if connection is None:
        return simx_return_initialize_error_flag
    with connection.changed:
        connection.paused = pause
        connection.changed.notify_all()
    return 0


def simxGetLastCmdTime(number: int) -> int:
    return _connections[number].last_time


def simxGetInMessageInfo(number: int, what: int) -> tuple[int, int]:
    """Unlike others, its first value is no return code: it is 1 on success."""
    assert what == simx_headeroffset_server_state
    return 1, _connections[number].state


def _ask(
    number: int, kind: int, key: bytes, mode: int, payload: bytes = b""
) -> tuple[int, bytes]:
    """The return code and the payload of the reply; empty without a reply."""
    connection = _connections.get(number)
    if connection is None or connection.lost:
        return simx_return_initialize_error_flag, b""
    name = (kind, key)
    operation, period = mode & 0x70000, mode & 0xFFFF
    with connection.changed:
        if operation == simx_opmode_remove:
            connection.inbox.pop(name, None)
            return 0, b""
        if operation != simx_opmode_buffer:
            size = _COMMAND.size + len(key) + len(payload)
            head = _COMMAND.pack(
                size, size, len(key), 0, kind | operation, period, 0, 0, 0
            )
            connection.outbox[name] = head + key + payload
            connection.changed.notify_all()
        if operation == simx_opmode_blocking:
            return _wait(connection, name)
        reply = connection.inbox.get(name)
        if reply is None:
            return simx_return_novalue_flag, b""
        connection.last_time = reply.time
        return simx_return_remote_error_flag * reply.failed, reply.payload


def _wait(connection: _Connection, name: _Name) -> tuple[int, bytes]:
    def has_come() -> bool:
        # Sent from the outbox, and a reply has arrived since.
        reply = connection.inbox.get(name)
        return connection.lost or (reply is not None and reply.message >= earliest)

    # The message being exchanged now cannot hold the reply.
    earliest = connection.next_message + connection.busy
    connection.inbox.pop(name, None)
    came = connection.changed.wait_for(has_come, BLOCKING_LIMIT)
    reply = connection.inbox.pop(name, None)
    if not came or reply is None:
        return simx_return_novalue_flag | simx_return_timeout_flag, b""
    connection.last_time = reply.time
    return simx_return_remote_error_flag * reply.failed, reply.payload


def _numbers_of(payload: bytes, layout: str) -> list[float]:
    """The numbers in a payload; zeros if it is too short."""
    return list(
        struct.unpack_from(layout, payload.ljust(struct.calcsize(layout), b"\0"))
    )


def simxSynchronous(number: int, enable: bool) -> int:
    return _ask(number, 0x0001 if enable else 0x0002, b"", simx_opmode_blocking)[0]


def simxSynchronousTrigger(number: int) -> int:
    return _ask(number, 0x0003, b"", simx_opmode_blocking)[0]


def simxGetPingTime(number: int) -> tuple[int, int]:
    begin = time.monotonic()
    key = struct.pack("<i", 1)
    code, _ = _ask(number, 0x1021, key, simx_opmode_blocking)
    took = round(1000 * (time.monotonic() - begin))
    return code & ~simx_return_remote_error_flag, took


def _control_simulation(number: int, what: int, mode: int) -> int:
    return _ask(number, 0x1007, struct.pack("<i", what), mode)[0]


def simxStartSimulation(number: int, mode: int) -> int:
    return _control_simulation(number, 0, mode)


def simxPauseSimulation(number: int, mode: int) -> int:
    return _control_simulation(number, 1, mode)


def simxStopSimulation(number: int, mode: int) -> int:
    return _control_simulation(number, 2, mode)


def simxGetObjectHandle(number: int, name: str, mode: int) -> tuple[int, int]:
    code, payload = _ask(number, 0x3001, name.encode() + b"\0", mode)
    return code, int(_numbers_of(payload, "<i")[0])


def simxGetObjects(number: int, kind: int, mode: int) -> tuple[int, list[int]]:
    code, payload = _ask(number, 0x102A, struct.pack("<i", kind), mode)
    count = int(_numbers_of(payload, "<i")[0])
    return code, [int(handle) for handle in _numbers_of(payload[4:], f"<{count}i")]


def _get_three(
    number: int, kind: int, handle: int, base: int, mode: int
) -> tuple[int, list[float]]:
    code, payload = _ask(number, kind, struct.pack("<ii", handle, base), mode)
    return code, _numbers_of(payload, "<3f")


def simxGetObjectPosition(
    number: int, handle: int, base: int, mode: int
) -> tuple[int, list[float]]:
    return _get_three(number, 0x200E, handle, base, mode)


def simxGetObjectOrientation(
    number: int, handle: int, base: int, mode: int
) -> tuple[int, list[float]]:
    return _get_three(number, 0x200D, handle, base, mode)


def simxSetJointTargetVelocity(
    number: int, joint: int, velocity: float, mode: int
) -> int:
    key, payload = struct.pack("<i", joint), struct.pack("<f", velocity)
    return _ask(number, 0x1008, key, mode, payload)[0]


def simxGetJointPosition(number: int, joint: int, mode: int) -> tuple[int, float]:
    code, payload = _ask(number, 0x1001, struct.pack("<i", joint), mode)
    return code, _numbers_of(payload, "<f")[0]


def simxReadProximitySensor(
    number: int, sensor: int, mode: int
) -> tuple[int, bool, list[float], int, list[float]]:
    code, payload = _ask(number, 0x1009, struct.pack("<i", sensor), mode)
    values = _numbers_of(payload, "<b3fi3f")
    return code, values[0] > 0, values[1:4], int(values[4]), values[5:]


def simxGetObjectFloatParameter(
    number: int, handle: int, parameter: int, mode: int
) -> tuple[int, float]:
    code, payload = _ask(number, 0x2007, struct.pack("<ii", handle, parameter), mode)
    return code, _numbers_of(payload, "<f")[0]


def simxGetObjectIntParameter(
    number: int, handle: int, parameter: int, mode: int
) -> tuple[int, int]:
    code, payload = _ask(number, 0x2008, struct.pack("<ii", handle, parameter), mode)
    return code, int(_numbers_of(payload, "<i")[0])


def simxGetFloatingParameter(
    number: int, parameter: int, mode: int
) -> tuple[int, float]:
    code, payload = _ask(number, 0x1023, struct.pack("<i", parameter), mode)
    return code, _numbers_of(payload, "<f")[0]


def simxSetBooleanParameter(number: int, parameter: int, value: bool, mode: int) -> int:
    key, payload = struct.pack("<i", parameter), struct.pack("<i", value)
    return _ask(number, 0x1020, key, mode, payload)[0]
