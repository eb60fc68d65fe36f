"""What the tests share."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import terrazzo as tz

SOURCE = pathlib.Path(os.environ["TERRAZZO_SOURCE"])
PROGRAM = os.environ["TERRAZZO_PROGRAM"]

#: A pattern, its height, blurred; with a comment and columns that saving must leave alone.
SMALL = """{
  "terrazzo": 1,
  "parameters": {
    "seed":   {"type": "int", "default": 1}, // which one
    "radius": {"type": "number", "default": 2},
    "out":    {"type": "path", "default": "out"}
  },
  "nodes": {
    // made here
    "surface": {"type": "pattern", "kind": "bricks", "size": [64, 48], "seed": "$seed"},
    "height":  {"type": "get_map", "material": "@surface", "map": "height"},
    "soft":    {"type": "blur", "image": "@height", "radius": "$radius"}, // so
    "files":   {"type": "export", "material": "@soft", "path": "$out/{map}.png"}
  }
}
"""

#: The same without its sink.
UNWRITTEN = SMALL[: SMALL.index(", // so")] + "}\n}"

#: Takes long enough to be interrupted.
LONG = """{
  "terrazzo": 1,
  "nodes": {
    "surface":  {"type": "pattern", "kind": "cobbles", "size": [512, 512], "seed": 3},
    "weighted": {"type": "weight", "material": "@surface"},
    "space":    {"type": "pca", "features": "@weighted"},
    "index":    {"type": "index", "appearance": "@space"},
    "layout":   {"type": "synthesize", "index": "@index", "size": [2048, 2048], "quality": "best"}
  }
}
"""


class Case(unittest.TestCase):
    """A test in a folder of its own, with a cache of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="terrazzo-python.")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name).resolve()
        before = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, before)
        os.environ["TERRAZZO_CACHE"] = str(self.folder / "cache")

    def small(self):
        return tz.Graph.loads(SMALL, self.folder / "small.json")

    def session(self, **options):
        session = tz.Session(**{"cache": self.folder / "cache", "threads": 2, **options})
        self.addCleanup(session.close)
        return session

    def program(self, *args):
        run = subprocess.run([PROGRAM, *map(str, args)], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout

    def python(self, code, *args, **options):
        """Another Python, running."""
        return subprocess.Popen([sys.executable, "-c", code, *map(str, args)], text=True, **options)
