"""Settings of all tests: examples that hypothesis draws are the same in every run, and their time is no test."""

from hypothesis import settings

settings.register_profile("rodcheck", derandomize=True, deadline=None)
settings.load_profile("rodcheck")
