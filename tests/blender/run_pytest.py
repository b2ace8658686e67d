"""Runs the tests of this folder in Blender without a window; run by scripts/blender."""

import pathlib
import sys

import pytest

sys.exit(pytest.main([str(pathlib.Path(__file__).parent), "--capture=sys"]))
