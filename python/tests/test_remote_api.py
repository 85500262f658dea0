"""Connections on which several requests are under way."""

import threading
from collections.abc import Callable, Iterator
from typing import Any

import cbor2
import pytest
import zmq
from pydslrep_runtime import remote_api
from pydslrep_runtime.errors import SimulatorError
from pydslrep_runtime.remote_api import EXECUTED, REPEAT, WAIT, Connection
from pydslrep_runtime.settings import CLIENT_TIMEOUT

Answer = Callable[[dict[str, Any]], object]


class Server(threading.Thread):
    """Replies to one request after the other, as CoppeliaSim does."""

    def __init__(self) -> None:
        super().__init__()
        # Not one of its own: to end one takes for ever now and then.
        self.socket: zmq.Socket[bytes] = zmq.Context.instance().socket(zmq.REP)
        self.port: int = self.socket.bind_to_random_port("tcp://127.0.0.1")
        self.answer: Answer = lambda request: {"ret": request["args"]}
        self.requests: list[tuple[str, list[Any]]] = []
        self.clients: set[str] = set()
        self.done = threading.Event()

    def run(self) -> None:
        """Replies until `done` is set."""
        while not self.done.is_set():
            if self.socket.poll(20):
                request = cbor2.loads(self.socket.recv())
                self.socket.send(self.reply_to(request))
        self.socket.close(linger=0)

    def reply_to(self, request: dict[str, Any]) -> bytes:
        """The reply to a request; those that every client begins with are not the test's."""
        assert request["argsL"] == len(request["args"])
        self.clients.add(request["uuid"])
        if request["func"].startswith("zmqRemoteApi."):
            is_info = request["func"].endswith("info")
            info: Any = {"echo": {"func": {}}} if is_info else None
            return cbor2.dumps({"ret": [info]})
        self.requests.append((request["func"], request["args"]))
        reply = self.answer(request)
        return reply if isinstance(reply, bytes) else cbor2.dumps(reply)


@pytest.fixture(name="server")
def fixture_server() -> Iterator[Server]:
    """A server that returns the arguments of each request."""
    server = Server()
    server.start()
    yield server
    server.done.set()
    server.join()


@pytest.fixture(name="connection")
def fixture_connection(server: Server) -> Iterator[Connection]:
    """A connection to the server."""
    connection = Connection("127.0.0.1", server.port)
    yield connection
    connection.close()


def test_each_request_gets_its_own_reply(connection: Connection) -> None:
    requests = [connection.post("sim.echo", number) for number in range(20)]
    assert [connection.result(request) for request in requests] == list(range(20))


def test_replies_may_be_taken_in_any_order(connection: Connection) -> None:
    first, second = connection.post("sim.echo", 1), connection.post("sim.echo", 2)
    assert connection.result(second) == 2
    assert connection.call(connection.sim.echo, 3) == 3
    assert connection.result(first) == 1
    assert connection.result(first) == 1


def test_a_function_that_waits_is_overtaken(
    server: Server, connection: Connection
) -> None:
    waits = iter([WAIT, REPEAT])

    def answer(request: dict[str, Any]) -> object:
        is_slow = request["args"] == ["slow"] or request["func"] == EXECUTED
        if is_slow and (wait := next(waits, None)):
            return {"func": wait, "args": []}
        return {"ret": request["args"]}

    server.answer = answer
    slow, quick = connection.post("sim.echo", "slow"), connection.post("sim.echo", "q")
    assert connection.result(slow) == "slow"
    assert connection.result(quick) == "q"
    assert [function for function, _ in server.requests] == [
        "sim.echo",
        "sim.echo",
        EXECUTED,
        "sim.echo",
    ]


def test_an_error_belongs_to_its_request(
    server: Server, connection: Connection
) -> None:
    server.answer = lambda request: (
        {"err": "no such joint"} if request["args"] == [1] else {"ret": []}
    )
    good, bad = connection.post("sim.echo", 0), connection.post("sim.echo", 1)
    connection.finish()
    connection.result(good)
    with pytest.raises(SimulatorError, match="no such joint"):
        connection.result(bad)
    assert connection.post("sim.echo", 2) is not None, "the connection is fine"


@pytest.mark.parametrize(
    "reply", [b"HTTP/1.1 400 Bad Request", [1, 2], {}, {"func": "f", "args": []}]
)
def test_nonsense_is_reported(
    server: Server, connection: Connection, reply: object
) -> None:
    server.answer = lambda _: reply
    with pytest.raises(SimulatorError, match=f"error from 127.0.0.1:{server.port}: "):
        connection.result(connection.post("sim.echo"))


def test_what_was_read_after_a_step_is_requested_after_the_next(
    server: Server, connection: Connection
) -> None:
    assert connection.read("sim.echo", 7) == 7
    assert connection.read("sim.echo", 8) == 8
    connection.read_ahead()
    connection.finish()
    assert len(server.requests) == 4
    assert connection.read("sim.echo", 8) == 8
    assert len(server.requests) == 4
    assert connection.read("sim.echo", 8) == 8, "a second look asks again"
    assert len(server.requests) == 5
    connection.read_ahead()
    connection.finish()
    assert len(server.requests) == 6, "7 was not read after the latest step"


def test_requests_before_an_interruption_are_given_up(
    server: Server, connection: Connection, monkeypatch: pytest.MonkeyPatch
) -> None:
    lost = connection.post("sim.echo", 1)
    socket: Any = connection._socket

    def interrupt() -> bytes:
        raise KeyboardInterrupt

    monkeypatch.setattr(socket, "recv", interrupt)
    with pytest.raises(KeyboardInterrupt):
        connection.result(lost)
    assert connection.last_call("sim.echo", 2) == 2
    with pytest.raises(SimulatorError, match="interrupted"):
        connection.result(lost)
    assert not connection.is_lost


def test_a_lost_connection_is_not_made_again() -> None:
    """Another simulator on the same port belongs to somebody else."""
    with zmq.Context() as context, context.socket(zmq.ROUTER) as first:
        port = first.bind_to_random_port("tcp://127.0.0.1")
        line = remote_api.connect(f"127.0.0.1:{port}", 5.0)
        assert not line.is_lost()
        first.close(linger=0)
        while not line.is_lost():
            pass
        with context.socket(zmq.ROUTER) as second:
            second.bind(f"tcp://127.0.0.1:{port}")
            with pytest.raises(zmq.Again):
                line.socket.send(b"drive", zmq.NOBLOCK)
            # Longer than a socket takes to connect again by itself.
            assert second.poll(300) == 0
            line.close()


def test_a_simulator_that_dies_is_noticed_at_once(
    server: Server, connection: Connection
) -> None:
    server.done.set()
    server.join()
    with pytest.raises(SimulatorError, match="lost connection to"):
        connection.result(connection.post("sim.echo", 1))
    assert connection.last_call("sim.echo", 1) is None
    assert connection.is_lost


def test_nobody_waits_for_the_reply_of_a_dead_simulator(connection: Connection) -> None:
    with zmq.Context() as context, context.socket(zmq.ROUTER) as silent:
        port = silent.bind_to_random_port("tcp://127.0.0.1")
        socket = remote_api.TimeoutSocket(connection._client, f"127.0.0.1:{port}", 5.0)
        socket.limit = 1e9
        socket.begin()
        socket.send(b"drive")
        silent.recv_multipart()
        silent.close(linger=0)
        with pytest.raises(SimulatorError, match="lost connection to"):
            socket.recv()


def test_a_simulator_may_still_be_starting() -> None:
    with zmq.Context() as context, context.socket(zmq.ROUTER) as late:
        port = late.bind_to_random_port("tcp://127.0.0.1")
        late.unbind(f"tcp://127.0.0.1:{port}")
        begin = threading.Timer(0.1, lambda: late.bind(f"tcp://127.0.0.1:{port}"))
        begin.start()
        remote_api.connect(f"127.0.0.1:{port}", 5.0).close()
        begin.join()


def test_the_simulator_of_a_run_knows_its_script(
    server: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYDSLREP_RUN", "run-7")
    remote_api.Connection("127.0.0.1", server.port).close()
    (client,) = server.clients
    assert client.startswith("run-7")


def test_every_call_of_a_shutdown_is_sent_whatever_the_others_get(
    server: Server, connection: Connection
) -> None:
    server.answer = lambda request: (
        {"err": "no such joint"} if request["args"] == [1] else {"ret": []}
    )
    connection.last_calls("sim.echo", [(1,), (2,)])
    assert server.requests == [("sim.echo", [1]), ("sim.echo", [2])]
    assert not connection.is_silent


def test_a_silent_simulator_executes_the_calls_of_a_shutdown_later(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(remote_api, "STOP_TIMEOUT", 0.2)
    with zmq.Context() as context, context.socket(zmq.ROUTER) as silent:
        port = silent.bind_to_random_port("tcp://127.0.0.1")

        def answer_two() -> None:
            replies: list[dict[str, Any]] = [
                {"ret": []},
                {"ret": [{"echo": {"func": {}}}]},
            ]
            for reply in replies:
                *envelope, _ = silent.recv_multipart()
                silent.send_multipart([*envelope, cbor2.dumps(reply)])

        begin = threading.Thread(target=answer_two)
        begin.start()
        connection = Connection("127.0.0.1", port)
        begin.join()
        connection.last_calls("sim.echo", [(1,), (2,)])
        connection.last_call("sim.echo", 3)
        connection.close()
        found = [cbor2.loads(silent.recv_multipart()[-1])["args"] for _ in range(3)]
        assert found == [[1], [2], [3]]


def test_the_simulator_forgets_a_killed_client_soon(
    server: Server, connection: Connection
) -> None:
    timeouts = []

    def answer(request: dict[str, Any]) -> dict[str, Any]:
        timeouts.append(request["timeout"])
        return {"ret": []}

    server.answer = answer
    connection.result(connection.post("sim.echo", 1))
    assert timeouts == [CLIENT_TIMEOUT]
    assert connection._client.timeout == CLIENT_TIMEOUT


def test_a_patient_call_waits_as_long_as_it_is_told_to(
    server: Server, connection: Connection
) -> None:
    may_reply = threading.Event()

    def answer(request: dict[str, Any]) -> object:
        assert may_reply.wait(60.0)
        return {"ret": request["args"]}

    waits: list[float] = []

    def on_silence(waited: float) -> None:
        waits.append(waited)
        if len(waits) == 3:
            may_reply.set()

    server.answer = answer
    connection.call_on_silence(on_silence, 0.05)
    assert connection.result(connection.post("sim.echo", 1)) == 1
    assert len(waits) >= 3
    assert waits == sorted(waits)


def test_a_new_client_asks(server: Server) -> None:
    server.answer = lambda _: {"ret": [8]}
    address = f"127.0.0.1:{server.port}"
    assert remote_api.ask(address, "sim.getSimulationState", 5.0) == 8
    assert remote_api.ask(address, "sim.getSimulationState", 5.0) == 8
    assert len(server.clients) == 2
