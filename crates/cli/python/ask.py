"""Prints the version of this interpreter, its path, and which of the named modules an isolated script would find.

The first two lines appear on Python 2 as well, so that an old interpreter is not taken for something else.
"""

import sys

print(".".join(map(str, sys.version_info[:3])))
print(sys.executable)

modules = sys.argv[1:]
# Isolated scripts ignore the current folder, where this one looks first, and what users install for themselves.
del sys.path[0]
found = []
try:
    import site
    from importlib.util import find_spec

    own = site.getusersitepackages()
    sys.path[:] = [folder for folder in sys.path if folder != own]
    found = [module for module in modules if find_spec(module)]
    if "coppeliasim_zmqremoteapi_client" in found:
        from importlib.metadata import version

        # Version 1 of CoppeliaSim's client speaks an older protocol.
        if version("coppeliasim-zmqremoteapi-client").startswith("1."):
            found = []
except ImportError:
    found = []
print(" ".join(found))
