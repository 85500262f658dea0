"""What all tests of the library need."""

from signals_kept import signals_kept

__all__ = ["signals_kept"]
