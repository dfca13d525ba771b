"""Sweeps: one case for many values of a key or several, as a table and a plot."""
