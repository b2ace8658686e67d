import signal
import sys

import hypothesis
import pytest

# No clock decides, and every run tries the same examples: a failure can be repeated.
hypothesis.settings.register_profile("echinus", deadline=None, derandomize=True, database=None, max_examples=50)
hypothesis.settings.load_profile("echinus")


@pytest.fixture
def huge_switch_interval():
    """A thread runs on until it gives Python's lock back by itself."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    yield
    sys.setswitchinterval(before)

# A program that a shell starts in the background ignores Ctrl-C, and so would its children: tests of it would never end.
signal.signal(signal.SIGINT, signal.default_int_handler)
