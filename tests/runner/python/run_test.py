import gc
import pathlib
import pickle
import threading
import tracemalloc
import unittest

import numpy as np
from support import SMALL, UNWRITTEN, Case

import terrazzo as tz


def resident():
    with open("/proc/self/statm") as f:
        return int(f.read().split()[1]) * 4096


class RunTest(Case):
    def test_files_have_the_same_bytes_as_those_of_the_program(self):
        pathlib.Path("small.json").write_text(SMALL)
        g = tz.Graph.load("small.json")
        g.params["seed"], g.params["out"], g["soft"].radius = 4, "ours", 1.5
        files = self.session(cache=False).run(g).files
        self.program("run", "small.json", "--no-cache", "--set", "seed=4", "--set", "out=theirs", "--set", "soft.radius=1.5")
        self.assertEqual([f.name for f in files], ["height.png"])
        self.assertEqual(files[0].read_bytes(), (self.folder / "theirs/height.png").read_bytes())

    def test_what_the_program_has_cached_is_reused(self):
        pathlib.Path("small.json").write_text(SMALL)
        self.program("run", "small.json", "--cache", self.folder / "cache")
        with self.session() as s:
            self.assertIn("0 run", s.run(tz.Graph.load("small.json")).summary)

    def test_plans_say_what_would_run_and_why(self):
        s, g = self.session(), self.small()
        before = g.plan(s)
        self.assertEqual((before["surface"].state, before["soft"].state), ("run", "depends"))
        self.assertIn("never run before", before["surface"].why)
        self.assertIn("surface", str(before))
        s.run(g)
        self.assertEqual([p.state for p in s.plan(g, "soft")][:1], ["cached"])
        self.assertRaises(tz.UnknownName, lambda: before["sofd"])
        self.assertRaises(tz.Error, s.plan, g, "sofd")

    def test_values_come_back_by_name(self):
        s, g = self.session(), self.small()
        r = s.run(g, only=["soft"], keep="surface")
        self.assertIsInstance(r["soft"], tz.Image)
        self.assertIn("height", list(r["surface"]))
        self.assertIs(r["soft.image"], r["soft"])
        with self.assertRaises(tz.UnknownName) as raised:
            r["height"]
        self.assertIn("keep", str(raised.exception))
        self.assertRaises(KeyError, lambda: r["surface"]["hight"])
        self.assertRaises(KeyError, lambda: r["nothing"])
        self.assertEqual(len(s.run(g)), 0)
        self.assertEqual(list(s.run(tz.Graph.loads(UNWRITTEN))), ["soft"])

    def test_pixels_are_views_that_keep_their_owner_alive(self):
        with self.session() as s:
            r = s.run(self.small(), only=["surface", "soft"])
        height = r["surface"]["height"].numpy()
        color = np.asarray(r["surface"]["base_color"])
        soft = r["soft"].numpy()
        before = height.copy(), color.copy(), soft.copy()
        del r, s
        gc.collect()
        for array, copy in zip((height, color, soft), before):
            self.assertTrue(np.array_equal(array, copy))
            self.assertEqual(array.dtype, np.float32)
            self.assertFalse(array.flags.writeable)
            self.assertRaises(ValueError, array.__setitem__, 0, 1)
            self.assertRaises(ValueError, array.setflags, write=True)
        self.assertEqual((height.shape, color.shape), ((48, 64), (48, 64, 3)))

    def test_pixels_in_memory_are_not_copied(self):
        image = tz.Image.from_numpy(np.zeros((4, 5)))
        self.assertEqual(image.numpy().ctypes.data, image.numpy().ctypes.data)
        self.assertFalse(np.shares_memory(image.numpy(), np.asarray(image, dtype=np.float64)))

    def test_images_from_arrays(self):
        pixels = np.random.default_rng(1).integers(0, 256, (6, 5, 3), dtype=np.uint8)
        image = tz.Image.from_numpy(pixels, semantic="base_color")
        self.assertEqual((image.width, image.height, image.channels), (5, 6, 3))
        self.assertEqual((image.semantic, image.depth, image.color_space), ("base_color", "uint8", "srgb_texture"))
        self.assertTrue(np.array_equal(np.round(image.numpy() * 255), pixels))
        self.assertEqual(image.digest, tz.Image.from_numpy(pixels[:, :, :].copy(), "base_color").digest)
        files = tz.export(image, "maps")
        self.assertEqual([f.name for f in files], ["base_color.png"])
        for wrong in ("maps/{map}.pngg", "maps/{map}"):
            with self.assertRaisesRegex(tz.GraphError, "the extension decides the file format"):
                tz.export(image, wrong)
        strided = tz.Image.from_numpy(np.arange(24.0).reshape(4, 6)[::2, ::3] / 24)
        self.assertTrue(np.allclose(strided.numpy() * 24, [[0, 3], [12, 15]]))
        for wrong in (np.zeros(3), np.zeros((2, 2, 5)), np.full((2, 2), np.nan), np.zeros((0, 4))):
            self.assertRaises(ValueError, tz.Image.from_numpy, wrong)
        self.assertRaises(TypeError, tz.Image.from_numpy, np.zeros((2, 2), dtype=np.int32))
        self.assertRaises(ValueError, tz.Image.from_numpy, np.zeros((2, 2)), semantic="hight")

    def test_values_can_be_given_to_nodes_and_inputs(self):
        pixels = np.linspace(0, 1, 64 * 48, dtype=np.float32).reshape(48, 64)
        given = tz.Material("mine", {"height": tz.Image.from_numpy(pixels, "height")}, metres=(2, 1.5))
        self.assertEqual((given.metres, given.size, given.name), ((2, 1.5), (64, 48), "mine"))
        s, g = self.session(), self.small().give("surface", given)
        self.assertTrue(np.array_equal(s.run(g, "height")["height"].numpy(), pixels))
        g.give("nobody", given)
        self.assertRaises(tz.Error, s.run, g)
        self.assertRaises(TypeError, g.give, "surface", pixels)

    def test_progress_is_told_on_the_calling_thread(self):
        events, threads = [], set()

        def tell(event):
            events.append(event)
            threads.add(threading.get_ident())

        self.session().run(self.small(), progress=tell)
        self.assertEqual(threads, {threading.get_ident()})
        self.assertEqual([e.node for e in events if e.kind == "started"][:1], ["surface"])
        self.assertEqual((events[0].kind, events[-1].done, events[-1].total), ("planned", 4, 4))
        events.clear()
        self.session().run(self.small(), progress=tell)
        self.assertIn("reused", {e.kind for e in events})

    def test_what_a_progress_function_raises_ends_the_run(self):
        def tell(event):
            raise ZeroDivisionError("here")

        s = self.session()
        self.assertRaises(ZeroDivisionError, s.run, self.small(), progress=tell)
        s.run(self.small())

    def test_failures_are_listed(self):
        g = self.small()
        g["height"].map = "no_such_map"
        with self.assertRaises(tz.Error) as raised:
            self.session().run(g, "height")
        self.assertIn("no_such_map", str(raised.exception))

    def test_other_threads_go_on_during_a_run(self):
        steps, over = [], threading.Event()

        def count():
            while not over.wait(0.005):
                steps.append(None)

        other = threading.Thread(target=count)
        other.start()
        g = tz.Graph.loads(UNWRITTEN)
        g["surface"].size = (1024, 1024)
        seconds = self.session().run(g, "surface").seconds
        over.set()
        other.join()
        self.assertGreater(len(steps), min(10, seconds / 0.05))

    def test_uv_maps_and_reports(self):
        g = tz.Graph.loads(
            """{"terrazzo": 1, "nodes": {
              "surface": {"type": "pattern", "kind": "gravel", "size": [64, 64]},
              "weighted": {"type": "weight", "material": "@surface"},
              "space": {"type": "pca", "features": "@weighted"},
              "index": {"type": "index", "appearance": "@space"},
              "layout": {"type": "synthesize", "index": "@index", "size": [80, 48], "quality": "draft"},
              "result": {"type": "resolve_uv", "uv": "@layout", "material": "@surface", "join": 0},
              "figures": {"type": "compare", "exemplar": "@surface", "output": "@result", "uv": "@layout"}
            }}"""
        )
        s = self.session()
        r = s.run(g, ["surface", "layout", "result", "figures", "index"])
        uv, xy = r["layout"], r["layout"].numpy()
        self.assertEqual((uv.size, uv.exemplar, xy.shape, xy.dtype), ((80, 48), (64, 64), (48, 80, 2), np.uint16))
        self.assertFalse(xy.flags.writeable)
        exemplar, made = r["surface"]["height"].numpy(), r["result"]["height"].numpy()
        self.assertTrue(np.array_equal(made, exemplar[xy[..., 1], xy[..., 0]]))
        report = r["figures.report"]
        self.assertIsInstance(report.figures["swd"], float)
        self.assertTrue(all(isinstance(p, tz.Image) for p in report.pictures.values()))
        self.assertEqual(r["index"].type, "index")
        self.assertEqual([f.name for f in tz.export(uv, "uv.exr", session=s)], ["uv.exr"])
        for node in ("layout", "index", "surface"):
            self.assertEqual(s.run(g.copy().give(node, r[node]), node)[node].digest, r[node].digest)

    def test_failures_go_to_other_processes(self):
        error = tz.RunError("what", [tz.Failure("node", "what")], object)
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((str(again), again.failures, again.result), ("what", error.failures, None))
        problem = tz.Problem("m", "/p", 1, 2, "c", "n", "f")
        self.assertEqual(pickle.loads(pickle.dumps(tz.GraphError("m", [problem]))).problems, [problem])

    def test_sweeps_leave_unset_what_they_do_not_need(self):
        s, g = self.session(), tz.Graph.loads(SMALL.replace(', "default": "out"', ""))
        for v in s.sweep(g, seed=[1]):
            self.assertEqual(v["soft"].width, 64)
            self.assertEqual([f.name for f in v.export("out/{seed}", "soft")], ["height.png"])
            self.assertRaises(tz.GraphError, v.run)

    def test_sweeps(self):
        s, g = self.session(), self.small()
        found = []
        for v in s.sweep(g, seed=range(2), radius=[1, 2.5]):
            found.append((v.values["seed"], v.values["radius"]))
            files = v.export("sweep/{seed}-{radius}")
            self.assertEqual(files, [self.folder / f"sweep/{found[-1][0]}-{found[-1][1]}/height.png"])
            self.assertEqual(v["soft"].width, 64)
        self.assertEqual(found, [(0, 1), (0, 2.5), (1, 1), (1, 2.5)])
        pathlib.Path("small.json").write_text(SMALL)
        self.program("run", "small.json", "--set", "seed=1", "--set", "radius=2.5")
        self.assertEqual(files[0].read_bytes(), (self.folder / "out/height.png").read_bytes())
        rows = list(s.sweep(g, [{"seed": 5, "surface.size": (32, 16)}, {"seed": 6}]))
        self.assertEqual([r.label for r in rows], ["seed=5, surface.size=32x16", "seed=6"])
        self.assertEqual([r["height"].height for r in rows], [16, 48])
        self.assertEqual([f.name for f in rows[0].export("maps", "surface")][:1], ["base_color.png"])
        self.assertEqual(g.params["seed"], 1)
        self.assertRaises(tz.UnknownName, s.sweep, g, sead=[1])
        self.assertRaises(tz.GraphError, s.sweep, g, seed=[1, "two"])

    def test_a_text_is_one_value_of_a_sweep(self):
        g = self.small()
        self.assertEqual([v.values for v in self.session().sweep(g, {"height.map": "height"})], [{"height.map": "height"}])
        with self.assertRaisesRegex(TypeError, r"seed: expected several values, such as \[3\], found 3"):
            self.session().sweep(g, seed=3)

    def test_variations_do_not_overwrite_one_another(self):
        first, second = self.session().sweep(self.small(), seed=[1, 2])
        files = first.export("same")
        before = files[0].read_bytes()
        with self.assertRaisesRegex(tz.Error, r'same would be written for seed=1 and for seed=2; .*"out/{seed}"'):
            second.export("same")
        with self.assertRaisesRegex(tz.Error, "would be written for seed=1"):
            second.export(self.folder / "same/{map}.png", "surface")
        self.assertEqual(files[0].read_bytes(), before)
        self.assertEqual(first.export("same"), files)

    def test_values_of_other_types_are_told_in_words(self):
        for memory in (1.5, -1, None):
            for call in (tz.set_memory_budget, lambda m: tz.Session(cache=False, memory=m)):
                with self.assertRaisesRegex(TypeError, "memory.*: expected a number of bytes, or a size such as"):
                    call(memory)
        for memory in ("300", "much", ""):
            for call in (tz.set_memory_budget, lambda m: tz.Session(cache=False, memory=m)):
                with self.assertRaisesRegex(ValueError, f'memory.*512M.*"{memory}" is not one'):
                    call(memory)
        tz.Session(cache=False, memory="300M").close()
        tz.Session(cache=False, memory=np.int64(300 << 20)).close()
        for call in (self.session().run, self.session().plan):
            with self.assertRaisesRegex(TypeError, "expected a Graph, as Graph.load gives, found 'small.json'"):
                call("small.json")

    def test_sessions_can_be_closed(self):
        with self.session() as s:
            pass
        self.assertRaises(tz.Error, s.run, self.small())
        with self.assertRaises(tz.Error) as raised:
            tz.Session(cache="/dev/null/cache")
        self.assertNotIn("--", str(raised.exception))  # options of the command line

    def test_the_budget_of_the_process_bounds_what_is_decoded(self):
        self.session().run(self.small())
        read = tz.Graph.loads('{"terrazzo": 1, "nodes": {"m": {"type": "load_map", "path": "out/height.png"}}}')
        self.addCleanup(tz.set_memory_budget, 0)
        tz.set_memory_budget(1024)
        with self.assertRaisesRegex(tz.Error, "at most 2730 are read"):
            self.session().run(read)
        tz.set_memory_budget("1M")
        self.session().run(read)
        tz.set_memory_budget(0)
        self.assertEqual(self.session().run(read)["m"].numpy().shape, (48, 64))

    def test_four_threads_run_at_once(self):
        s, failures = self.session(), []

        def work(first):
            try:
                for seed in range(first, first + 5):
                    g = self.small()
                    g.params["seed"] = seed
                    r = s.run(g, ["soft", "surface"], progress=lambda e: None)
                    own = r["soft"].numpy()
                    if not np.array_equal(own, s.run(g, ["soft"])["soft"].numpy()):
                        failures.append(f"{seed} differs")
            except Exception as e:  # noqa: BLE001
                failures.append(repr(e))

        threads = [threading.Thread(target=work, args=(i,)) for i in (1, 3, 5, 3)]
        for t in threads:
            t.start()
        for t in threads:
            t.join(60)
        self.assertFalse(any(t.is_alive() for t in threads))
        self.assertEqual(failures, [])

    def test_a_hundred_runs_leak_nothing(self):
        s, g = self.session(), self.small()

        def run(times):
            for _ in range(times):
                r = s.run(g, ["surface", "soft"], progress=lambda e: None)
                r["surface"]["base_color"].numpy(), r["soft"].numpy()
                try:
                    g["soft"].nothing
                except AttributeError:
                    pass

        run(30)
        gc.collect()
        tracemalloc.start()
        before, memory = tracemalloc.take_snapshot(), resident()
        run(100)
        gc.collect()
        after = tracemalloc.take_snapshot()
        tracemalloc.stop()
        grown = sum(d.size_diff for d in after.compare_to(before, "filename") if "tracemalloc" not in str(d.traceback))
        self.assertLess(grown, 100_000)
        self.assertLess(resident() - memory, 24 << 20)


if __name__ == "__main__":
    unittest.main()
