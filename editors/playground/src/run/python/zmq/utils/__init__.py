"""As in pyzmq."""
