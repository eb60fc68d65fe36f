import subprocess
import sys
import unittest

import numpy as np
from support import LONG, SMALL, UNWRITTEN, Case

import terrazzo as tz

DAEMON = """
import sys, threading
import terrazzo as tz
s = tz.Session(cache=sys.argv[1], threads=2)
begun = threading.Event()
def run():
    while True:
        s.run(tz.Graph.loads(open(sys.argv[2]).read()), progress=lambda e: begun.set() if e.kind == "started" else None)
threading.Thread(target=run, daemon=True).start()
begun.wait()
"""


@tz.node()
def test_leaver(image: tz.Image) -> tz.Image:
    sys.exit(0)


class TrustTest(Case):
    def test_what_cannot_be_a_node_is_refused_where_it_is_declared(self):
        def f(x: int = 1) -> tz.Image:
            return tz.Image.from_numpy(np.zeros((2, 2)))

        for version in (0, -1, "1", True, 2**31, 1.5, None):
            with self.assertRaisesRegex(tz.Error, '"f" cannot be a node: expected a version'):
                tz.node(version=version)(f)
        for name in ("", "a b", "../x", "\u00e9t\u00e9", "9a", "a\0b", "\ud800"):
            with self.assertRaisesRegex(tz.Error, '"f" cannot be a node'):
                tz.node(name=name)(f)
        with self.assertRaisesRegex(tz.Error, "expected a text for its name, found 3"):
            tz.node(name=3)(f)

        def g(x: int = "one") -> tz.Image:
            return tz.Image.from_numpy(np.zeros((2, 2)))

        def h(type: int = 1) -> tz.Image:
            return tz.Image.from_numpy(np.zeros((2, 2)))

        for wrong in (g, h):
            self.assertRaises(tz.Error, tz.node(), wrong)
        self.assertEqual(self.session().run(tz.Graph.loads(UNWRITTEN), "height")["height"].width, 64)

    def test_names_of_maps_lead_nowhere_else(self):
        image = tz.Image.from_numpy(np.zeros((4, 4)), "height")
        for name in ("../../x", "..", "/tmp/x", "a/b", "a\0b"):
            inside = self.folder / "a/b/c"
            with self.assertRaisesRegex(tz.Error, "cannot be a part of a file's name"):
                tz.export(tz.Material("m", {name: image}), inside / "{map}" / "x.png")
            with self.assertRaisesRegex(tz.Error, "cannot be a part of a file's name"):
                tz.export(tz.Material(name, {"height": image}), inside / "{material}" / "{map}.png")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir() if p.name != "cache"), [])
        self.assertEqual(len(tz.export(tz.Material("m", {"a.b": image}), self.folder / "out")), 1)

    def test_python_ends_well_while_a_daemon_runs(self):
        (self.folder / "long.json").write_text(LONG)
        child = self.python(DAEMON, self.folder / "cache", self.folder / "long.json", stderr=subprocess.PIPE)
        said = child.communicate(timeout=120)[1]
        self.assertEqual(child.returncode, 0, said)
        self.assertNotIn("terminate", said)

    def test_a_node_that_ends_the_program_fails(self):
        g = tz.Graph.loads(UNWRITTEN[: UNWRITTEN.rindex("}", 0, UNWRITTEN.rindex("}"))] +
                           ', "leaver": {"type": "test_leaver", "image": "@height"}}}')
        with self.assertRaisesRegex(tz.RunError, "SystemExit"):
            self.session().run(g, "leaver")

    def test_texts_that_are_no_unicode_are_refused_in_words(self):
        g = tz.Graph.loads(SMALL)
        image = tz.Image.from_numpy(np.zeros((4, 4)), "height")
        lone = "a\ud800b"
        for act in (
            lambda: g.params.update(out=lone) or g.check(),
            lambda: g.set("files.path", lone) or g.check(),
            lambda: tz.Graph.loads(SMALL.replace("made here", lone)),
            lambda: tz.Material(lone, {"height": image}),
            lambda: tz.Material("m", {lone: image}),
            lambda: tz.Image.from_numpy(np.zeros((4, 4)), lone),
            lambda: g.give(lone, image),
            lambda: self.session().run(tz.Graph.loads(SMALL), only=[lone]),
        ):
            with self.assertRaisesRegex((tz.Error, ValueError), "surrogate|no Unicode"):
                act()

    def test_file_names_and_exceptions_that_are_no_unicode_are_shown(self):
        with self.assertRaisesRegex(tz.Error, r"nowhere\\x80\.json"):
            tz.Graph.load("nowhere\udc80.json")

        @tz.node(version=1)
        def raises_a_lone_surrogate(image: tz.Image) -> tz.Image:
            raise ValueError("a\ud800b")

        g = tz.Graph.loads("""{"terrazzo": 1, "nodes": {
            "from": {"type": "solid", "size": 16, "value": [0.5, 0.5, 0.5], "semantic": "base_color"},
            "raises": {"type": "raises_a_lone_surrogate", "image": "@from"},
            "files": {"type": "export", "material": "@raises", "path": "made here/{map}.png"}}}""")
        with self.assertRaisesRegex(tz.Error, r"a\\ud800b"):
            self.session().run(g)

    def test_arrays_that_are_too_large_are_refused_before_they_are_copied(self):
        huge = np.broadcast_to(np.float32(0), (60000, 60000, 4))
        with self.assertRaisesRegex(ValueError, "takes 54931 MiB, more than the memory budget of"):
            tz.Image.from_numpy(huge)
        self.addCleanup(tz.set_memory_budget, 0)
        tz.set_memory_budget("1M")
        with self.assertRaisesRegex(ValueError, "set_memory_budget"):
            tz.Image.from_numpy(np.zeros((1024, 512), dtype=np.uint8))


if __name__ == "__main__":
    unittest.main()
