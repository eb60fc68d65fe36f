import importlib.util
import json
import pathlib
import random
import subprocess
import sys
import threading
import time
import unittest
from typing import Literal

import numpy as np
from support import Case

import terrazzo as tz

CONSTANT = 2.0


def helped(x):
    return x * CONSTANT


@tz.node(version=1)
def test_amplify(image: tz.Image, amount: float = 0.5, way: Literal["up", "down"] = "up") -> tz.Image:
    """Amplifies an image.

    And says so."""
    pixels = image.numpy()
    tz.note(f"in the main thread: {threading.current_thread() is threading.main_thread()}")
    tz.progress(0.5)
    if amount < 0:
        raise ValueError("an amount cannot be negative")
    if amount == 99:
        raise tz.Cancelled("by the node")
    out = helped(pixels) * amount
    return tz.Image.from_numpy(out if way == "up" else 1 - out, semantic=image.semantic)


@tz.node()
def test_gather(
    images: list[tz.Image],
    material: tz.Material | None = None,
    size: tuple[int, int] = (2, 3),
    weights: list[float] = [1.0],
    names: list[str] = ["a"],
    flag: bool = True,
    count: int = 3,
    text: str = "t",
    file: pathlib.Path | None = None,
) -> tz.Material:
    size_out = np.full(size[::-1], sum(weights), dtype=np.float32)
    content = file.read_text() if file else ""
    return tz.Material(
        f"{names}{flag}{count}{text}{content}{material is None}",
        {"height": tz.Image.from_numpy(size_out / 10, "height"), "mask": images[-1]},
    )


@tz.node()
def test_liar(way: Literal["honest", "file", "folder", "random", "import", "write"], named: pathlib.Path | None = None) -> tz.Image:
    pixels = np.full((2, 2), 0.5, dtype=np.float32)
    if way == "file":
        pixels[:] = float(pathlib.Path("secret.txt").read_text())
    if way == "folder":
        pixels[:] = float((named / "deep/secret.txt").read_text())
    if way == "random":
        pixels[0, 0] = random.random()
    if way == "import":
        import colorsys
    if way == "write":
        pathlib.Path("scratch.txt").write_text("left")
    return tz.Image.from_numpy(pixels)


@tz.node()
def test_wrong_return(image: tz.Image) -> tz.Image:
    return 3


def graph(nodes):
    surface = {"type": "pattern", "kind": "bricks", "size": [64, 48], "seed": 1}
    height = {"type": "get_map", "material": "@surface", "map": "height"}
    soft = {"type": "blur", "image": "@height", "radius": 2}
    return tz.Graph.loads(
        json.dumps({"terrazzo": 1, "nodes": {"surface": surface, "height": height, "soft": soft, **nodes}})
    )


def module(path, text):
    """Python code as a module in a file, anew."""
    path.write_text(text)
    spec = importlib.util.spec_from_file_location("nodes_of_a_test", path)
    out = importlib.util.module_from_spec(spec)
    # Sources are looked up by file; what is cached of an older one must go.
    import linecache

    linecache.checkcache(str(path))
    spec.loader.exec_module(out)
    return out


@tz.node(version=1)
def test_wavering(image: tz.Image) -> tz.Image:
    """Reports less than before, as work that is shared does."""
    for fraction in (0.5, 0.2, 0.8, 0.3):
        tz.progress(fraction)
        time.sleep(0.15)  # so that each is delivered by itself
    return image


class NodesTest(Case):
    def amplified(self, **params):
        return graph({"sharp": {"type": "test_amplify", "image": "@soft", **params}})

    def test_a_function_is_a_node(self):
        s, g = self.session(), self.amplified()
        self.assertEqual(g.check(), [])
        r = s.run(g, ["sharp", "soft"])
        self.assertTrue(np.allclose(r["sharp"].numpy(), r["soft"].numpy()))
        self.assertEqual(r["sharp"].semantic, "height")
        self.assertIn("sharp: in the main thread: False", r.notes)
        self.assertEqual(g["sharp"].amount, 0.5)
        self.assertRaises(AttributeError, lambda: g["sharp"].amuont)
        self.assertIn("4 cached, 0 run", s.run(g, "sharp").summary + s.plan(g, "sharp").summary)

    def test_progress_never_goes_back(self):
        events = []
        self.session().run(graph({"slow": {"type": "test_wavering", "image": "@soft"}}), "slow", progress=events.append)
        told = [e.fraction for e in events if e.kind == "progress" and e.node == "slow"]
        self.assertEqual(told, [0.5, 0.8])

    def test_parameters_are_checked_like_those_of_others(self):
        problems = self.amplified(way="sideways", amount="much").check()
        self.assertEqual({p.pointer for p in problems}, {"/nodes/sharp/way", "/nodes/sharp/amount"})

    def test_all_kinds_of_arguments(self):
        pathlib.Path("note.txt").write_text("one")
        g = graph({"sharp": {"type": "test_gather", "images": ["@soft", "@height"]}})
        s = self.session()
        material = s.run(g)["sharp"]
        self.assertEqual(material.name, "['a']True3tTrue")
        self.assertEqual(material["height"].numpy().shape, (3, 2))
        self.assertTrue(np.array_equal(material["mask"].numpy(), s.run(g, "height")["height"].numpy()))
        node = g["sharp"]
        node.material, node.size, node.weights, node.names = "@surface", (5, 4), [1, 2], ["b", "c"]
        node.flag, node.count, node.text, node.file = False, -1, "x", "note.txt"
        material = s.run(g)["sharp"]
        self.assertEqual(material.name, "['b', 'c']False-1xoneFalse")
        self.assertAlmostEqual(float(material["height"].numpy()[3, 4]), 0.3, 6)
        pathlib.Path("note.txt").write_text("two")
        self.assertIn("xtwoFalse", s.run(g)["sharp"].name)

    def test_what_a_node_raises_is_a_failure_of_it(self):
        with self.assertRaises(tz.RunError) as raised:
            self.session().run(self.amplified(amount=-1))
        failure = raised.exception.failures[0]
        self.assertEqual(failure.node, "sharp")
        self.assertIn('node "sharp" (test_amplify): ValueError: an amount cannot be negative', failure.message)
        self.assertIn("test_amplify, nodes_test.py:", failure.message)
        self.assertIsInstance(raised.exception.__cause__, ValueError)
        self.assertIsNotNone(raised.exception.__cause__.__traceback__)
        with self.assertRaises(tz.RunError) as raised:
            self.session().run(graph({"sharp": {"type": "test_wrong_return", "image": "@soft"}}))
        self.assertIn("found int", str(raised.exception))

    def test_a_node_can_cancel_the_run(self):
        self.assertRaises(tz.Cancelled, self.session().run, self.amplified(amount=99))

    def lie(self, way, checked=True, **params):
        g = tz.Graph.loads(json.dumps({"terrazzo": 1, "nodes": {"liar": {"type": "test_liar", "way": way, **params}}}))
        return self.session(checked=checked).run(g)["liar"].numpy()[1, 1]

    def test_nodes_that_lie_are_caught_by_name_in_checked_runs(self):
        pathlib.Path("secret.txt").write_text("0.25")
        sys.modules.pop("colorsys", None)
        for way in ("honest", "import", "write"):
            self.assertEqual(self.lie(way), 0.5)
        for way, what in {
            "file": f"reads {self.folder}/secret.txt, which no parameter of type Path names",
            "random": 'gives another "image" when it runs again',
        }.items():
            with self.assertRaises(tz.RunError) as raised:
                self.lie(way)
            self.assertIn(f'node "liar" (test_liar): checked: test_liar {what}', str(raised.exception))
            self.lie(way, checked=False)

    def test_files_in_a_folder_that_a_parameter_names_count(self):
        secret = self.folder / "data/deep/secret.txt"
        secret.parent.mkdir(parents=True)
        for number in (0.25, 0.75):
            secret.write_text(str(number))
            for checked in (True, False):
                self.assertEqual(self.lie("folder", checked, named=str(self.folder / "data")), number)

    def test_checked_runs_in_several_threads_watch_their_own_nodes(self):
        failures = []

        def run():
            try:
                for _ in range(5):
                    self.lie("honest")
            except BaseException as e:
                failures.append(e)

        pathlib.Path("secret.txt").write_text("0.25")
        threads = [threading.Thread(target=run) for _ in range(4)]
        for t in threads:
            t.start()
        for _ in range(5):
            self.assertRaises(tz.RunError, self.lie, "file")
        for t in threads:
            t.join()
        self.assertEqual(failures, [])

    def test_keys_change_with_the_source(self):
        text = "\n".join(
            [
                "import terrazzo as tz",
                "FACTOR = 2.0",
                "def helper(x):",
                "    return x * FACTOR",
                "@tz.node(version=1)",
                "def test_from_file(image: tz.Image) -> tz.Image:",
                "    return tz.Image.from_numpy(helper(image.numpy()) / 8)",
            ]
        )
        s, path = self.session(), self.folder / "nodes_of_a_test.py"

        def state(text):
            module(path, text)
            g = graph({"sharp": {"type": "test_from_file", "image": "@soft"}})
            state = s.plan(g)["sharp"].state
            return state, float(s.run(g)["sharp"].numpy().mean())

        first = state(text)
        self.assertNotEqual(first[0], "cached")
        self.assertEqual(state(text), ("cached", first[1]))
        self.assertEqual(state("# a comment\n" + text)[0], "cached")
        for change in (("FACTOR = 2.0", "FACTOR = 3.0"), ("x * FACTOR", "FACTOR * x * 2"), ("/ 8", "/ 4")):
            changed = state(text.replace(*change))
            self.assertNotEqual(changed[0], "cached", change)
            self.assertNotEqual(changed[1], first[1], change)
        self.assertNotEqual(state(text.replace("version=1", "version=2"))[0], "cached")
        self.assertEqual(state(text), ("cached", first[1]))

    def test_keys_are_the_same_in_another_process(self):
        path = self.folder / "one.py"
        path.write_text(
            "import json, sys\nimport terrazzo as tz\n"
            "@tz.node()\n"
            "def test_shared(image: tz.Image) -> tz.Image:\n    return tz.Image.from_numpy(1 - image.numpy())\n"
            "def main():\n"
            "    g = tz.Graph.loads(open(sys.argv[1]).read())\n"
            "    with tz.Session(cache='cache') as s: print(s.run(g, 'sharp').outcomes[-1].kind)\n"
            "if __name__ == '__main__': main()\n"
        )
        g = graph({"sharp": {"type": "test_shared", "image": "@height"}})
        pathlib.Path("g.json").write_text(g.to_text())
        code = "import sys; sys.path.insert(0, '.'); import one; one.main()"
        script = "import runpy; runpy.run_path('one.py', run_name='__main__')"
        first = self.python(script, "g.json", stdout=subprocess.PIPE).communicate(timeout=60)[0]
        second = self.python(code, "g.json", stdout=subprocess.PIPE).communicate(timeout=60)[0]
        self.assertEqual((first, second), ("run\n", "reused\n"))

    def test_functions_that_cannot_be_nodes_are_refused(self):
        array = np.zeros(3)

        def no_annotation(image) -> tz.Image: ...
        def no_return(image: tz.Image): ...
        def bad_type(image: tz.Image, other: dict = {}) -> tz.Image: ...
        def stars(*images: tz.Image) -> tz.Image: ...
        def bad_choice(image: tz.Image, way: Literal["a", "b"] = "c") -> tz.Image: ...

        for function in (no_annotation, no_return, bad_type, stars, bad_choice):
            with self.assertRaises(tz.Error) as raised:
                tz.node()(function)
            self.assertIn(function.__name__, str(raised.exception))

        def captures(image: tz.Image) -> tz.Image:
            return tz.Image.from_numpy(image.numpy() + array.sum())

        with self.assertRaises(tz.Error) as raised:
            tz.node()(captures)
        self.assertIn("depend on array", str(raised.exception))
        with self.assertRaises(tz.Error):

            @tz.node(name="blur")
            def own_blur(image: tz.Image) -> tz.Image:
                return image

        tz.Graph.loads("{}")

    def test_many_nodes_in_many_threads(self):
        s = self.session(threads=4)
        nodes = {f"n{i}": {"type": "test_amplify", "image": "@soft", "amount": 0.1 + i / 100} for i in range(12)}
        failures = []

        def work(first):
            try:
                r = s.run(graph(nodes), list(nodes), progress=lambda e: None)
                for i in range(12):
                    expected = helped(s.run(graph({}), "soft")["soft"].numpy()) * (0.1 + i / 100)
                    if not np.allclose(r[f"n{i}"].numpy(), expected):
                        failures.append(i)
            except Exception as e:  # noqa: BLE001
                failures.append(repr(e))

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for t in threads:
            t.start()
        for t in threads:
            t.join(60)
        self.assertFalse(any(t.is_alive() for t in threads))
        self.assertEqual(failures, [])


if __name__ == "__main__":
    unittest.main()
