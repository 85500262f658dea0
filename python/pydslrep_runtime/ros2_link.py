"""A node of ROS 2: subscriptions, publishers, and who else is there."""

import os
from collections.abc import Callable
from typing import Any

from .errors import SetupError
from .ros2_topics import Topic

try:
    import rclpy  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from rclpy.duration import Duration  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from rclpy.executors import SingleThreadedExecutor  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from rclpy.node import Node  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from rclpy.qos import (  # type: ignore[import-not-found,import-untyped,unused-ignore]
        DurabilityPolicy,
        HistoryPolicy,
        QoSProfile,
        ReliabilityPolicy,
    )
except ImportError as error:
    raise SetupError(
        f"this Python cannot import rclpy ({error}). Source your ROS 2 first (`source /opt/ros/jazzy/setup.bash`), or "
        'install it with `pip install "ros-rclpy[fastrtps]" ros-geometry-msgs ros-nav-msgs ros-sensor-msgs`; '
        "`--python PATH` of pydslrep chooses another Python"
    ) from error

MAX_MESSAGES = 1000  # that are taken at once; who sends more never stops
OF_ALL_NODES = {"/parameter_events", "/rosout"}  # topics that say nothing of a robot
LAST_WORDS = 0.5  # s for what was published last to arrive


class Link:
    """A node, whose messages are taken one after the other when its owner wants them."""

    def __init__(self, name: str) -> None:
        """Raises SetupError if there is no middleware."""
        self.name = f"{name}_{os.getpid()}"
        try:
            # Signals are the script's: it stops its robots first.
            rclpy.init(args=[], signal_handler_options=rclpy.SignalHandlerOptions.NO)
            self._node = Node(
                self.name, start_parameter_services=False, enable_rosout=False
            )
        except Exception as error:
            raise SetupError(
                f"ROS 2 does not start: {error}. With the packages of PyPI, its middleware is `ros-rclpy[fastrtps]`"
            ) from error
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._taken = 0

    def subscribe(
        self,
        topic: Topic,
        take: Callable[[Any], None],
        *,
        reliable: bool,
        depth: int = 10,
    ) -> None:
        """Passes on the messages of a topic. More than one can wait: else a late one would replace a newer one."""

        def count(message: Any) -> None:
            self._taken += 1
            take(message)

        self._node.create_subscription(
            topic.type.load(), topic.name, count, profile(depth, reliable=reliable)
        )

    def publisher(self, topic: Topic) -> Any:
        """What publishes on a topic, to listeners of any reliability."""
        return self._node.create_publisher(
            topic.type.load(), topic.name, profile(10, reliable=True)
        )

    def wait(self, limit: float) -> None:
        """Takes a message, or what else there is to do; waits for it up to `limit` seconds of real time."""
        self._executor.spin_once(timeout_sec=max(limit, 0.0))

    def take_all(self) -> None:
        """Takes all messages that have arrived."""
        for _ in range(MAX_MESSAGES):
            before = self._taken
            self.wait(0.0)
            if self._taken == before:
                return

    def publishers(self, topic: str) -> list[Any]:
        """Who else publishes on a topic."""
        return self._others(self._node.get_publishers_info_by_topic(topic))

    def listeners(self, topic: str) -> list[Any]:
        """Who else listens to a topic."""
        return self._others(self._node.get_subscriptions_info_by_topic(topic))

    def topics(self) -> list[str]:
        """The topics on which somebody else publishes, or to which somebody else listens."""
        names = [name for name, _ in self._node.get_topic_names_and_types()]
        return sorted(
            name
            for name in names
            if name not in OF_ALL_NODES
            and (self.publishers(name) or self.listeners(name))
        )

    def published(self, message_type: str) -> list[str]:
        """The topics on which somebody else publishes messages of a type."""
        return self._of_type(message_type, self.publishers)

    def listened(self, message_type: str) -> list[str]:
        """The topics on which somebody else wants messages of a type."""
        return self._of_type(message_type, self.listeners)

    def close(self, *publishers: Any) -> None:
        """Waits until everybody has what these published last, and leaves."""
        for publisher in publishers:
            publisher.wait_for_all_acked(Duration(seconds=LAST_WORDS))
        # What it waits for belongs to the context, and must not outlive it until Python ends.
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown()

    def _of_type(
        self, message_type: str, endpoints: Callable[[str], list[Any]]
    ) -> list[str]:
        return [
            name
            for name in self.topics()
            if any(each.topic_type == message_type for each in endpoints(name))
        ]

    def _others(self, endpoints: list[Any]) -> list[Any]:
        return [each for each in endpoints if each.node_name != self.name]


def profile(depth: int, *, reliable: bool) -> Any:
    """A quality of service."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=depth,
        durability=DurabilityPolicy.VOLATILE,
        reliability=ReliabilityPolicy.RELIABLE
        if reliable
        else ReliabilityPolicy.BEST_EFFORT,
    )


def is_best_effort(endpoint: Any) -> bool:
    """Whether a publisher does not send again what was lost."""
    return bool(endpoint.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT)


def misfit(publisher: Any, listener: Any) -> str:
    """Why messages do not get from a publisher with one quality of service to a listener with another; empty if they do.

    rclpy's own comparison takes the infinite deadlines of others for deadlines.
    """
    best_effort, reliable = ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE
    if (publisher.reliability, listener.reliability) == (best_effort, reliable):
        return "messages are sent best effort, and the listener wants them reliable"
    volatile, lasting = DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL
    if (publisher.durability, listener.durability) == (volatile, lasting):
        return "messages are sent volatile, and the listener wants them transient local"
    return ""
