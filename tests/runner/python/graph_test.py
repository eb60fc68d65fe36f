import pathlib
import unittest
import warnings

import numpy as np
from support import SMALL, Case

import terrazzo as tz


class GraphTest(Case):
    def test_parameters_are_those_of_the_document(self):
        g = self.small()
        self.assertEqual(dict(g.params), {"seed": 1, "radius": 2, "out": "out"})
        g.params["seed"] = np.int64(7)
        self.assertEqual(g.params["seed"], 7)
        del g.params["seed"]
        self.assertEqual(g.params["seed"], 1)
        self.assertEqual(g.params.describe("radius")["type"], "number")
        self.assertEqual(g.nodes, ["surface", "height", "soft", "files"])
        self.assertEqual(g["surface"].size, [64, 48])
        self.assertEqual(g["surface"].seed, "$seed")
        self.assertEqual(g["soft"]["image"], "@height")
        self.assertIn("radius", dir(g["soft"]))
        g["surface"].size = (32, 32)
        self.assertEqual(g["surface"].size, [32, 32])
        with self.assertRaises(TypeError):
            g["surface"].size = object()

    def test_names_with_mistakes_are_refused_with_the_nearest(self):
        g = self.small()
        for wrong, nearest in [
            (lambda: g.params["sead"], '"seed"'),
            (lambda: g.params.update(radios=3), '"radius"'),
            (lambda: g["sorface"], '"surface"'),
            (lambda: g["soft"].raduis, '"radius"'),
            (lambda: setattr(g["soft"], "imag", "@height"), '"image"'),
            (lambda: tz.Graph.stock("materiel"), '"material"'),
        ]:
            with self.assertRaises(tz.Error) as raised:
                wrong()
            self.assertIn(f"did you mean {nearest}", str(raised.exception))
        self.assertRaises(AttributeError, lambda: g["soft"].raduis)
        self.assertRaises(KeyError, lambda: g["sorface"])
        self.assertFalse(hasattr(g["soft"], "raduis"))
        with self.assertRaisesRegex(AttributeError, r'are set by name: params\["seed"\] = 7'):
            g.params.seed = 7

    def test_copies_are_independent(self):
        g = self.small()
        h = g.copy()
        h.params["seed"] = 5
        self.assertEqual(g.params["seed"], 1)

    def test_problems_say_where_they_are(self):
        g = tz.Graph.loads(SMALL.replace('"bricks"', '"brics"'), "some/wall.json")
        g["soft"].radius = "wide"
        g.params["seed"] = 1.5
        problems = {p.pointer: p for p in g.check()}
        self.assertEqual(set(problems), {"/nodes/surface/kind", "/nodes/soft/radius", "/parameters/seed/default"})
        kind = problems["/nodes/surface/kind"]
        self.assertEqual((kind.line, kind.node, kind.file), (10, "surface", "some/wall.json"))
        self.assertIn("bricks", kind.message)
        self.assertGreater(kind.column, 10)
        self.assertEqual(problems["/nodes/soft/radius"].line, 0)
        self.assertEqual(problems["/nodes/soft/radius"].code, "override")
        self.assertTrue(str(kind).startswith("some/wall.json:10:"))
        with self.assertRaises(tz.GraphError) as raised:
            self.session().run(g)
        self.assertEqual({p.pointer for p in raised.exception.problems}, set(problems))

    def test_a_check_looks_at_files(self):
        g = tz.Graph.stock("material")
        g.params["material"] = self.folder / "nowhere"
        self.assertTrue(any("nowhere" in p.message for p in g.check()))

    def test_files_that_are_no_graphs_are_refused(self):
        self.assertRaises(tz.GraphError, tz.Graph.load, "nowhere.json")
        pathlib.Path("broken.json").write_text('{"terrazzo": 1,,}')
        with self.assertRaises(tz.GraphError) as raised:
            tz.Graph.load("broken.json")
        self.assertEqual(raised.exception.problems[0].line, 1)

    def test_warnings_on_demand(self):
        g = tz.Graph.loads(SMALL.replace('"$seed"', "2"))
        self.assertEqual(g.check(), [])
        self.assertEqual([p.severity for p in g.check(warnings=True)], ["warning"])

    def test_saving_changes_values_and_nothing_else(self):
        pathlib.Path("wall.json").write_text(SMALL)
        g = tz.Graph.load("wall.json")
        g.save("same.json")
        self.assertEqual(pathlib.Path("same.json").read_text(), SMALL)
        g.params["seed"] = 7
        g["surface"].size = (8, 9)
        g["soft"].mute = False
        g.save("wall2.json")
        expected = SMALL.replace('"default": 1}, //', '"default": 7}, //').replace("[64, 48]", "[8, 9]")
        expected = expected.replace('"$radius"}', '"$radius", "mute": false}')
        self.assertEqual(pathlib.Path("wall2.json").read_text(), expected)
        again = tz.Graph.load("wall2.json")
        self.assertEqual((again.params["seed"], again.check()), (7, []))

    def test_saved_paths_mean_the_same_elsewhere(self):
        pathlib.Path("wall.json").write_text(SMALL)
        pathlib.Path("sub").mkdir()
        g = tz.Graph.load("wall.json")
        g.params["out"] = "sub/result"
        g.save("sub/wall.json")
        self.assertEqual(tz.Graph.load("sub/wall.json").params["out"], "result")
        g.save("wall.json")
        self.assertEqual(tz.Graph.load("wall.json").params["out"], "sub/result")

    def test_saving_warns_of_paths_that_lose_their_meaning(self):
        pathlib.Path("sub").mkdir()
        self.session().run(self.small())
        text = SMALL.replace('"type": "pattern", "kind": "bricks", "size": [64, 48], "seed": "$seed"',
                             '"type": "load_material", "path": "out"')
        text = text.replace('"default": "out"', '"default": "result"')
        pathlib.Path("wall.json").write_text(text)
        g = tz.Graph.load("wall.json")
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            g.save("sub/wall.json")
        self.assertEqual(len(caught), 1)


if __name__ == "__main__":
    unittest.main()
