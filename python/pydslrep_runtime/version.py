"""The version of the runtime, which is that of PyDSLRep."""

__version__ = "0.2.0"
