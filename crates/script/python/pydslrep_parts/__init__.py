"""The parts of generated scripts.

Each module is both a tested Python file and a template: lines that begin with `#:` are statements of the template
engine. The block `#: if standalone` holds the imports of a module, which a script has at its top; other blocks hold code
that only some programs need.
"""
