"""Solvers that this project did not write, run on its scenes: CalculiX and NGSolve.

They share nothing with `reference3d` but the scene (CalculiX also the mesh), and are used where they are installed.
"""
