"""New case files from templates: what can be chosen, questions on a terminal, and the file."""
