"""Settings of all tests: examples that hypothesis draws are the same in every run, and their time is no test.

What a test keeps in a cache stays with its process.
"""

from collections.abc import Iterator

import pytest
from hypothesis import settings

settings.register_profile("rodcheck", derandomize=True, deadline=None)
settings.load_profile("rodcheck")


@pytest.fixture(scope="session", autouse=True)
def _own_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The default folder of results is neither the user's nor that of another process of tests."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        yield
