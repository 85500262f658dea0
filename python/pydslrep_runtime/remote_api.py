"""Connections to CoppeliaSim's ZeroMQ remote API.

Its client for Python waits for the reply to each call. Driving takes several calls per robot and step, so `Connection`
also sends requests without waiting: the simulator answers them one after the other, while this process sends the next.
"""

import math
import os
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

from .errors import ReadingError, SetupError, SimulatorError
from .readings import CONSTANT, check, read_reply, shortened, shown
from .settings import CLIENT_TIMEOUT, CONNECT_TIMEOUT, REPLY_TIMEOUT, STOP_TIMEOUT

try:
    import zmq
    from coppeliasim_zmqremoteapi_client import (  # type: ignore[import-untyped]
        RemoteAPIClient,
        cbor,
    )
    from zmq.utils.monitor import recv_monitor_message
except ModuleNotFoundError as missing:
    raise SetupError(
        f"Python module {missing.name} is missing; install it with "
        "`python3 -m pip install coppeliasim-zmqremoteapi-client cbor2`"
    ) from missing

# Plain numbers: combining flags takes longer than sending.
NO_WAIT, SEND_MORE = int(zmq.NOBLOCK), int(zmq.NOBLOCK | zmq.SNDMORE)

# What the simulator replies if a function has not ended yet, and what the client answers.
WAIT, REPEAT, EXECUTED = "_*wait*_", "_*repeat*_", "_*executed*_"


class RefusedError(SimulatorError):
    """The simulator has replied with an error."""


class MissingError(SimulatorError, AttributeError):
    """The simulator lacks a function or a constant."""


Read = tuple[str, int]
"""A function and the handle of the object that it reads."""


# What `pydslrep run` knows its script by: its simulator serves nobody else.
RUN_VARIABLE = "PYDSLREP_RUN"

LOOK_PERIOD = (
    0.25  # s; how long a reply is waited for before the connection is looked at
)
RETRY_PERIOD = 0.05  # s
LINGER = 500  # ms
MAX_MESSAGE = 64 << 20  # bytes; who sends a larger one is disconnected


def new_socket() -> Any:
    """A socket for several requests. All share the thread that sends and receives."""
    return zmq.Context.instance().socket(zmq.DEALER)


class Line:
    """A socket for several requests that connects once.

    A lost connection is not made again: by then, another simulator may listen on the port, and its robots are not ours.
    """

    def __init__(self, address: str) -> None:
        """Begins to connect."""
        self.socket = new_socket()
        self.socket.linger = 0
        self.socket.reconnect_ivl = -1
        self.socket.maxmsgsize = MAX_MESSAGE
        self._events: Any = self.socket.get_monitor_socket(
            zmq.EVENT_CONNECTED | zmq.EVENT_DISCONNECTED | zmq.EVENT_CLOSED
        )
        self._is_connected: bool | None = None  # None before the first event
        self.socket.connect(f"tcp://{address}")

    def is_connected(self, limit: float) -> bool:
        """Whether there is a connection; waits up to `limit` seconds for one."""
        if self._is_connected is None and self._events.poll(math.ceil(1000.0 * limit)):
            self._read_event()
        return bool(self._is_connected)

    def is_lost(self) -> bool:
        """Whether there was a connection, and is none any more."""
        while self._is_connected and self._events.poll(0):
            self._read_event()
        return not self._is_connected

    def close(self, linger: int = 0) -> None:
        """Disconnects; does nothing the second time: the client closes its socket in the end, too."""
        if self.socket.closed:
            return
        self.socket.disable_monitor()
        self._events.close(linger=0)
        self.socket.close(linger)

    def _read_event(self) -> None:
        event = recv_monitor_message(self._events)["event"]
        self._is_connected = event == zmq.EVENT_CONNECTED


def connect(address: str, limit: float) -> Line:
    """Connects within `limit` seconds, as the simulator may still be starting; raises SimulatorError."""
    deadline = time.monotonic() + limit
    while True:
        line = Line(address)
        if line.is_connected(max(deadline - time.monotonic(), 0.0)):
            return line
        line.close()
        if time.monotonic() + RETRY_PERIOD > deadline:
            raise SimulatorError(f"no reply from {address} for {limit:g} s")
        time.sleep(RETRY_PERIOD)


def accepts_connections(address: str) -> bool:
    """Whether anything listens at an address, whatever it is."""
    try:
        connect(address, STOP_TIMEOUT).close()
    except SimulatorError:
        return False
    return True


class TimeoutSocket:
    """Replaces the client's socket, which allows one request at a time and waits forever for its reply.

    A call may take any number of messages. When it takes longer than the limit, `on_silence` gets the seconds that the call
    has taken so far; it raises SimulatorError, or returns to go on waiting for as long again.
    """

    def __init__(self, client: Any, address: str, limit: float) -> None:
        """Replaces the client's socket; `limit` is in seconds."""
        self._line = connect(address, limit)
        client.socket.close(linger=0)
        client.socket = self
        self._address = address
        self._start = self._deadline = 0.0
        self.on_silence: Callable[[float], object] = self._give_up
        self._socket = self._line.socket
        self._socket.rcvtimeo = math.ceil(1000.0 * min(LOOK_PERIOD, limit))
        self.limit = limit

    @contextmanager
    def short_timeout(self) -> Iterator[None]:
        """Within this context, calls fail after STOP_TIMEOUT without a reply."""
        before = self.limit, self.on_silence
        self.limit, self.on_silence = STOP_TIMEOUT, self._give_up
        try:
            yield
        finally:
            self.limit, self.on_silence = before

    def begin(self) -> None:
        """Starts the timeout of a call, `limit` in seconds."""
        self._start = time.monotonic()
        self._deadline = self._start + self.limit

    def is_lost(self) -> bool:
        """Whether the connection has ended."""
        return self._line.is_lost()

    def send(self, request: bytes) -> None:
        """Sends a request, after the empty frame that sockets for single requests send by themselves."""
        self._socket.send(b"", SEND_MORE)
        self._socket.send(request, NO_WAIT)

    def recv(self) -> bytes:
        """Receives a reply; raises SimulatorError."""
        while True:
            now = time.monotonic()
            if now > self._deadline:
                self.on_silence(now - self._start)
                self._deadline = time.monotonic() + self.limit
            try:
                # The first frame of a reply is empty, too.
                reply: bytes = self._socket.recv() or self._socket.recv()
            except zmq.Again:
                if self.is_lost():
                    raise SimulatorError(
                        f"lost connection to {self._address}"
                    ) from None
            else:
                return reply

    def close(self, linger: int = 0) -> None:
        """Disconnects."""
        self._line.close(linger)

    def _give_up(self, _waited: float) -> None:
        raise SimulatorError(f"no reply from {self._address} for {self.limit:g} s")


def ask(address: str, function: str, limit: float) -> Any:
    """What a function without arguments returns to a client of its own; None without a reply within `limit` seconds.

    Raises SimulatorError if nothing accepts a connection.
    """
    line = connect(address, limit)
    try:
        new_id = f"{os.environ.get(RUN_VARIABLE, '')}{uuid.uuid4()}"
        line.socket.send(b"", SEND_MORE)
        line.socket.send(request_of(new_id, function, ()), NO_WAIT)
        line.socket.rcvtimeo = math.ceil(1000.0 * limit)
        reply = cbor.loads(line.socket.recv() or line.socket.recv())
    except Exception:  # the decoders have no error class in common
        return None
    finally:
        line.close()
    try:
        return read_reply(function, reply["ret"])
    except (TypeError, KeyError, ReadingError):
        return None


def request_of(client: str, function: str, arguments: Sequence[Any]) -> bytes:
    """A request as one message."""
    request = {
        "func": function,
        "args": arguments,
        "argsL": len(arguments),
        "uuid": client,
        # For the case that the simulator has forgotten the client.
        "timeout": CLIENT_TIMEOUT,
    }
    message: bytes = cbor.dumps(request)
    return message


class Request:
    """A request whose reply is awaited later."""

    __slots__ = ("function", "message", "reply")

    def __init__(self, function: str, message: bytes) -> None:
        self.function, self.message = function, message
        self.reply: dict[str, Any] | None = None


class Interface:
    """The functions and constants of a simulator, by their names."""

    def __init__(self, functions: Any, address: str) -> None:
        """`functions` are those that the client has made."""
        self._functions, self._address = functions, address

    def __getattr__(self, name: str) -> Any:
        """A function or a constant; raises MissingError, and ReadingError if it is no number."""
        try:
            value = getattr(self._functions, name)
        except AttributeError:
            raise MissingError(
                f"the simulator at {self._address} has no sim.{name}"
            ) from None
        if not callable(value):
            check(f"error from {self._address}: sim.{name}", value, CONSTANT)
        return value


class Connection:
    """A connection to one port, for all robots that use it."""

    def __init__(self, host: str, port: int) -> None:
        """Connects; raises SimulatorError."""
        self.address = f"{host}:{port}"
        self.is_lost = False
        self.is_silent = False  # it has not replied during the shutdown
        self._is_broken = False  # also true while messages are exchanged
        self._under_way: deque[Request] = deque()
        self._reads: dict[Read, None] = {}  # since the latest step
        self._read_ahead: dict[Read, Request] = {}
        self._messages: dict[Read, bytes] = {}
        try:
            self._client = RemoteAPIClient(host, port)
            self._client.uuid = f"{os.environ.get(RUN_VARIABLE, '')}{self._client.uuid}"
            # A script that is killed says no goodbye: until then it holds the time.
            self._client.timeout = CLIENT_TIMEOUT
            # The client's own would run any function of the script that the simulator names.
            self._client.call = self._call_of_client
            self._socket = TimeoutSocket(self._client, self.address, CONNECT_TIMEOUT)
        except zmq.ZMQError as error:
            raise self._loss(error) from error
        functions = self.call(self._client.require, "sim")
        self.sim = Interface(functions, self.address)
        self._socket.limit = REPLY_TIMEOUT

    def call(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Calls a function of the simulator; raises SimulatorError."""
        self.finish()
        self._begin()
        try:
            result = function(*arguments)
        except SimulatorError:
            raise
        except zmq.ZMQError as error:
            raise self._loss(error) from error
        except Exception as error:  # the client has no error class of its own
            self._is_broken = False
            raise self._failure(
                f"the client cannot read a reply: {shortened(str(error))}"
            ) from error
        self._is_broken = False
        return result

    def _call_of_client(self, function: str, arguments: Sequence[Any]) -> Any:
        """Calls a function for the client."""
        # The client adds to its first request what the simulator has to know of it.
        self._client._send({"func": function, "args": list(arguments)})
        request = Request(function, self._encode(function, *arguments))
        self._under_way.append(request)
        return self.result(request)

    def try_call(self, function: str, *arguments: Any) -> Any:
        """The result of a function that older versions lack, or that fails; else None."""
        try:
            return self.call(getattr(self.sim, function), *arguments)
        except ReadingError:
            raise
        except SimulatorError:
            if self._is_broken:
                raise  # the connection failed, not the function
            return None

    def call_on_silence(
        self, on_silence: Callable[[float], object], period: float
    ) -> None:
        """From now on, `on_silence` decides every `period` seconds whether to go on waiting for a reply."""
        self._socket.on_silence, self._socket.limit = on_silence, period

    def last_call(self, function: str, *arguments: Any) -> Any:
        """Calls a function by its name during a shutdown, unless the connection is lost.

        An exchange of messages that was interrupted leaves the socket unusable. A new socket
        serves the same client, which may still be in stepping mode.
        """
        (result,) = self._call_last(function, [arguments], self._client.uuid)
        return result

    def last_calls(self, function: str, calls: Iterable[Sequence[Any]]) -> None:
        """Calls a function several times during a shutdown, whatever becomes of the other calls."""
        # After an interruption the old client may be in the middle of a step, and what it asks for would be lost.
        client = str(uuid.uuid4()) if self._is_broken else self._client.uuid[-36:]
        prefix = self._client.uuid[:-36]
        self._call_last(function, calls, prefix + client)

    def _call_last(
        self, function: str, calls: Iterable[Sequence[Any]], client: str
    ) -> list[Any]:
        """The results of calls, or None: all are sent before any reply is awaited.

        A simulator that is paused answers nothing, and executes them when it goes on.
        """
        calls = list(calls)
        results = [None] * len(calls)
        # Another simulator may be in its place.
        self.is_lost = self.is_lost or self._socket.is_lost()
        if self.is_lost:
            return results
        try:
            self._renew_socket()
            with self._socket.short_timeout():
                self.finish()
                requests = [
                    self._post(function, request_of(client, function, arguments))
                    for arguments in calls
                ]
                for index, request in enumerate(requests):
                    if not self.is_silent:
                        with suppress(RefusedError, ReadingError):
                            results[index] = self.result(request)
        except SimulatorError:
            # The first error is reported. Later calls are sent, but not waited for.
            self.is_lost = self.is_lost or self._socket.is_lost()
            self.is_silent = True
        return results

    def _renew_socket(self) -> None:
        """After an interruption, makes a new socket; raises SimulatorError."""
        if not self._is_broken or self.is_silent:
            return
        while self._under_way:
            self._under_way.popleft().reply = {"err": "interrupted"}
        try:
            self._socket = TimeoutSocket(self._client, self.address, STOP_TIMEOUT)
        except SimulatorError:
            self.is_lost = True
            raise
        self._is_broken = False

    def post(self, function: str, *arguments: Any) -> Request:
        """Calls a function by its name, and does not wait for its result; raises SimulatorError."""
        return self._post(function, self._encode(function, *arguments))

    def result(self, request: Request) -> Any:
        """Waits for the result of a request; raises SimulatorError."""
        if request.reply is None:
            self._begin()
            while request.reply is None:
                self._receive()
            self._is_broken = False
        if "err" in request.reply:
            reason = request.reply["err"]
            reason = reason if isinstance(reason, str) else shown(reason)
            raise RefusedError(str(self._failure(shortened(reason))))
        try:
            return read_reply(request.function, request.reply["ret"])
        except ReadingError as error:
            raise self._failure(error) from None

    def finish(self) -> None:
        """Waits for the replies to all requests; raises SimulatorError."""
        if self._under_way and not self.is_silent:
            self._begin()
            while self._under_way:
                self._receive()
            self._is_broken = False

    def read(self, function: str, handle: int) -> Any:
        """What a function returns for an object, if only steps change it; raises SimulatorError."""
        key = function, handle
        self._reads[key] = None
        if key in self._read_ahead:
            return self.result(self._read_ahead.pop(key))
        return self.result(self._post_read(key))

    def read_ahead(self) -> None:
        """After a step, requests whatever was read after the previous one."""
        self._read_ahead = {key: self._post_read(key) for key in self._reads}
        self._reads.clear()

    def close(self) -> None:
        """Disconnects."""
        # What has not been answered may not even have been sent.
        self._socket.close(LINGER if self.is_silent else 0)

    def _post_read(self, key: Read) -> Request:
        message = self._messages.get(key)
        if message is None:
            message = self._messages[key] = self._encode(*key)
        return self._post(key[0], message)

    def _post(self, function: str, message: bytes) -> Request:
        request = Request(function, message)
        self._is_broken = True
        self._send(request, message)
        self._is_broken = False
        return request

    def _encode(self, function: str, *arguments: Any) -> bytes:
        return request_of(self._client.uuid, function, arguments)

    def _send(self, request: Request, message: bytes) -> None:
        try:
            self._socket.send(message)
        except zmq.ZMQError as error:
            raise self._loss(error) from error
        self._under_way.append(request)

    def _begin(self) -> None:
        self._socket.begin()
        self._is_broken = True

    def _receive(self) -> None:
        """Receives the reply to the oldest request: the simulator replies in order."""
        try:
            reply = cbor.loads(self._socket.recv())
        except SimulatorError:
            raise
        except zmq.ZMQError as error:
            raise self._loss(error) from error
        except Exception as error:  # the decoders have no error class in common
            function = self._under_way[0].function
            raise self._failure(f"the reply to {function} cannot be decoded") from error
        request = self._under_way.popleft()
        match reply:
            case {"ret": _} | {"err": _}:
                request.reply = reply
            case {"func": function} if function == WAIT:
                self._send(request, self._encode(EXECUTED))
            case {"func": function} if function == REPEAT:
                self._send(request, request.message)
            case _:
                raise self._failure(
                    f"unknown reply to {request.function}: {shown(reply)}"
                )

    def _failure(self, reason: object) -> SimulatorError:
        return ReadingError(f"error from {self.address}: {reason}")

    def _loss(self, reason: object) -> SimulatorError:
        return SimulatorError(f"lost connection to {self.address}: {reason}")
