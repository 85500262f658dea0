"""The scene of a running CoppeliaSim: building it, reading it, and what is wrong with it."""
