"""Prints whether a script finds the package that it imports among the installed ones."""

import site
import sys
from importlib.util import find_spec

if sys.prefix == sys.base_prefix:
    # Outside of virtual environments, a user's own packages count; isolated Python leaves them out.
    site.addsitedir(site.getusersitepackages())
print(find_spec(sys.argv[1]) is not None)
