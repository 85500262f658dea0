#: if standalone
"""How a robot drives where the program does not say."""
#: endif

RIM_SPEED = 0.09  # m/s, of the wheels' rims in turns and in moves without a speed
RIM_ACCELERATION = 0.5  # m/s², while speeding up and slowing down
ARRIVED = 0.0001  # m at the rim: this near, an action has reached its goal ...
CLOSE = 0.001  # m at the rim: ... and this near, it has after CLOSE_TIME of trying
CLOSE_TIME = 1.0  # s of simulation time
STALL_TIME = 5.0  # s of simulation time without progress that fail an action
MOST_ASIDE = 0.05  # m beside its goal that fail a move, be the wheels slipping or not
CONNECT_TIMEOUT = 5.0  # s to wait for the first answer of a simulator
REPLY_TIMEOUT = 10.0  # s to wait for any later answer
STOP_TIMEOUT = 1.0  # s to wait for an answer while stopping after an error
