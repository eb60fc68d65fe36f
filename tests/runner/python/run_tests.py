"""Runs the tests of the Python package, or those that are named: run_tests.py SOURCE PROGRAM PACKAGES [TEST...].
PACKAGES is the folder that the package is in. Exit code 77, skipped tests, without NumPy."""

import os
import sys
import unittest

if __name__ == "__main__":
    try:
        import numpy  # noqa: F401
    except ImportError:
        print("skipped: there is no NumPy (apt-get install python3-numpy)")
        sys.exit(77)
    os.environ["TERRAZZO_SOURCE"], os.environ["TERRAZZO_PROGRAM"], packages = map(os.path.abspath, sys.argv[1:4])
    here = os.path.dirname(os.path.abspath(__file__))
    os.environ["PYTHONPATH"] = packages
    sys.path[:0] = [packages, here]
    loader = unittest.TestLoader()
    tests = loader.loadTestsFromNames(sys.argv[4:]) if sys.argv[4:] else loader.discover(here, "*_test.py")
    sys.exit(not unittest.TextTestRunner(verbosity=2).run(tests).wasSuccessful())
