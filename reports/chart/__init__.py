"""Error against seconds and unknowns, every method in the same axes: which level, order and mesh for a part?"""
