"""Defaults for speeds, tolerances and timeouts."""

RIM_SPEED = 0.09  # m/s at the wheels' rims, in turns and in moves without a speed
RIM_ACCELERATION = 0.5  # m/s², when accelerating and braking
ARRIVAL_TOLERANCE = 0.0001  # m at the rim within which an action is complete
CLOSE_TOLERANCE = (
    0.001  # m at the rim within which it is complete if the robot comes no nearer
)
STALL_TIME = 5.0  # s of simulation time without progress before an action fails
MAX_LATERAL_ERROR = 0.05  # m to the side of its goal, above which a move fails
CONNECT_TIMEOUT = 5.0  # s to wait for the simulator's first reply
REPLY_TIMEOUT = 10.0  # s to wait for any later reply
STOP_TIMEOUT = 1.0  # s to wait for a reply while stopping after an error
CLIENT_TIMEOUT = 30.0  # s of silence after which the simulator forgets this client
PROBE_PERIOD = 2.0  # s without a reply after which the simulator is asked why
HOLD_LIMIT = 40.0  # s to wait for another client that holds the time; longer than the timeout of a killed script
SILENCE_LIMIT = 600.0  # s to wait for a simulator that answers nothing, perhaps because it is paused
