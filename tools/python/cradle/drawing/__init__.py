"""How the pictures are drawn: a module for each kind, from the arrays of reading.py, in the looks of style.py."""
