"""A case looked at before anything is solved: what it says, how large it is, what may surprise, and how it looks."""
