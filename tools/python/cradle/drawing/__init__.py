"""The pictures: a module for each kind draws from a Result of the package, in the style of style.py."""
