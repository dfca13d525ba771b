"""What a scene is: frozen dataclasses (`cases.scene`), case files and the loader with its error messages.

Importing this package imports nothing else, so that `rodmodel` can use `cases.scene` without the
machinery of case files.
"""
