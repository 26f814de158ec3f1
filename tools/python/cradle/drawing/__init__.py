"""How the pictures are drawn: a module for each kind, from a Result of the package, in the looks of style.py."""
