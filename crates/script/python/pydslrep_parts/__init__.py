"""The parts that generated scripts are put together from.

Every module is a plain Python file with its own tests, and at the same time a template: lines that begin with `#:` are
statements of the template engine. The block `#: if standalone` holds what a module needs on its own and a script has at
its top; other blocks hold what only some programs need.
"""
