# What the add-on for Blender takes from node trees and images, what it makes of surfaces and files. Without Blender.
import json
import math
import os
import sys
import tempfile
import types
import unittest
import zlib

import numpy

sys.path.insert(0, os.path.join(sys.argv.pop(1), "examples/blender"))
from terrazzo_blender import masks, result, sources, surface, tree  # noqa: E402

import fakes  # noqa: E402


class Trees(unittest.TestCase):
    def setUp(self):
        self.tree = fakes.Tree()
        self.surface, self.output = self.tree.surface()

    def normal_map(self, **more):
        node = self.tree.add("NORMAL_MAP", ["Color", ("Strength", 0.7)], ["Normal"], space="TANGENT", **more)
        self.tree.link(node, "Normal", self.surface, "Normal")
        return node

    def test_maps_of_their_own(self):
        t = self.tree
        t.link(t.image("a", "sRGB"), "Color", self.surface, "Base Color")
        t.link(t.image("r"), "Color", self.surface, "Roughness")
        t.link(t.image("n"), "Color", self.normal_map(), "Color")
        height = t.add("DISPLACEMENT", ["Height", ("Scale", 0.2), ("Midlevel", 0.5)], ["Displacement"])
        t.link(t.image("h"), "Color", height, "Height")
        t.link(height, "Displacement", self.output, "Displacement")
        picked = tree.pick(t)
        self.assertEqual({m: u.image.name for m, u in picked.maps.items()},
                         {"base_color": "a", "roughness": "r", "normal": "n", "height": "h"})
        self.assertEqual((picked.relief, picked.midlevel, picked.normal_strength), (0.2, 0.5, 0.7))
        self.assertEqual(picked.notes, [])
        self.assertFalse(picked.maps["normal"].normal_down)

    def test_channels_and_inversion(self):
        t = self.tree
        packed = t.image("orm")
        for kind, names in (("SEPRGB", ["R", "G", "B"]), ("SEPARATE_COLOR", ["Red", "Green", "Blue"])):
            parts = t.add(kind, ["Image"], names)
            t.link(packed, "Color", parts, "Image")
            t.link(parts, names[2], self.surface, "Metallic")
            invert = t.add("INVERT", ["Fac", "Color"])
            t.link(parts, names[1], invert, "Color")
            t.link(invert, "Color", self.surface, "Roughness")
            picked = tree.pick(t)
            self.assertEqual(picked.maps["metallic"].channel, "b")
            self.assertEqual(picked.maps["roughness"].channel, "g")
            self.assertTrue(picked.maps["roughness"].inverted)
        math_node = t.add("MATH", [("Value", 1.0), ("Value", 0.0)], ["Value"], operation="SUBTRACT")
        t.link(packed, "Alpha", math_node, 1)
        t.link(math_node, "Value", self.surface, "Roughness")
        use = tree.pick(t).maps["roughness"]
        self.assertEqual((use.channel, use.inverted), ("a", True))

    def test_directx_normals(self):
        t, target = self.tree, self.normal_map()
        source = t.image("n")
        parts = t.add("SEPARATE_COLOR", ["Color"], ["Red", "Green", "Blue"], mode="RGB")
        invert = t.add("INVERT", ["Fac", "Color"])
        whole = t.add("COMBINE_COLOR", ["Red", "Green", "Blue"])
        t.link(source, "Color", parts, "Color")
        t.link(parts, "Green", invert, "Color")
        for name in ("Red", "Blue"):
            t.link(parts, name, whole, name)
        t.link(invert, "Color", whole, "Green")
        t.link(whole, "Color", target, "Color")
        self.assertTrue(tree.pick(t).maps["normal"].normal_down)
        t.link(parts, "Green", whole, "Green")
        self.assertFalse(tree.pick(t).maps["normal"].normal_down)

        def curve(first, last):
            return types.SimpleNamespace(points=[types.SimpleNamespace(location=(0, first)),
                                                 types.SimpleNamespace(location=(1, last))])
        curves = t.add("CURVE_RGB", ["Fac", "Color"],
                       mapping=types.SimpleNamespace(curves=[curve(0, 1), curve(1, 0), curve(0, 1), curve(0, 1)]))
        t.link(source, "Color", curves, "Color")
        t.link(curves, "Color", target, "Color")
        self.assertTrue(tree.pick(t).maps["normal"].normal_down)

    def test_groups_and_reroutes(self):
        t, inner = self.tree, fakes.Tree("inner")
        reroute = t.add("REROUTE", ["Input"], ["Output"])
        t.link(t.image("outside", "sRGB"), "Color", reroute, "Input")
        start = inner.add("GROUP_INPUT", [], ["Tint"])
        end = inner.add("GROUP_OUTPUT", ["Through", "Own"], [])
        inner.link(start, "Tint", end, "Through")
        inner.link(inner.image("inside"), "Color", end, "Own")
        group = t.add("GROUP", ["Tint"], ["Through", "Own"], node_tree=inner)
        t.link(reroute, "Output", group, "Tint")
        t.link(group, "Through", self.surface, "Base Color")
        t.link(group, "Own", self.surface, "Roughness")
        maps = tree.pick(t).maps
        self.assertEqual((maps["base_color"].image.name, maps["roughness"].image.name), ("outside", "inside"))

    def test_occlusion(self):
        t = self.tree
        mix = t.add("MIX_RGB", ["Fac", "Color1", "Color2"], blend_type="MULTIPLY")
        t.link(t.image("wall_ao"), "Color", mix, "Color1")
        t.link(t.image("wall", "sRGB"), "Color", mix, "Color2")
        t.link(mix, "Color", self.surface, "Base Color")
        picked = tree.pick(t)
        self.assertEqual(picked.maps["base_color"].image.name, "wall")
        self.assertEqual(picked.maps["ambient_occlusion"].image.name, "wall_ao")
        self.assertTrue(picked.multiplies_occlusion)
        t.link(t.image("wall", "sRGB"), "Color", self.surface, "Base Color")
        group = t.add("GROUP", ["Occlusion"], [], node_tree=fakes.Tree("glTF Material Output.001"))
        t.link(t.image("o"), "Color", group, "Occlusion")
        picked = tree.pick(t)
        self.assertEqual(picked.maps["ambient_occlusion"].image.name, "o")
        self.assertFalse(picked.multiplies_occlusion)

    def test_what_is_left_out_is_said(self):
        t = self.tree
        change = t.add("HUE_SAT", ["Hue", "Color"])
        t.link(t.image("a", "sRGB"), "Color", change, "Color")
        t.link(change, "Color", self.surface, "Base Color")
        mapping = t.add("MAPPING", ["Vector", ("Location", (0.1, 0, 0)), ("Rotation", (0, 0, 1)), ("Scale", (3, 2, 1))],
                        ["Vector"])
        place = t.add("TEX_COORD", [], ["Generated", "UV"])
        t.link(place, "Generated", mapping, "Vector")
        t.link(mapping, "Vector", t.nodes[3], "Vector")
        picked = tree.pick(t)
        self.assertEqual((picked.scale, picked.offset, picked.rotation), ((3, 2), (0.1, 0), 1))
        self.assertIn("what 'Hue_Sat' does to a is left out", picked.notes[0])
        self.assertIn("the new material uses the UV map", picked.notes[1])
        value = t.add("VALUE", [], ["Value"])
        value.outputs[0].default_value = 4.0
        t.link(value, "Value", mapping, "Scale")
        self.assertEqual(tree.pick(t).scale, (4, 4))
        mapping.vector_type = "TEXTURE"
        self.assertEqual((tree.pick(t).scale, tree.pick(t).offset), ((0.25, 0.25), (-0.025, -0)))
        layer = t.add("UVMAP", [], ["UV"], uv_map="Second")
        t.link(layer, "UV", mapping, "Vector")
        self.assertEqual(tree.pick(t).uv_layer, "Second")

    def test_bump(self):
        t = self.tree
        bump = t.add("BUMP", [("Strength", 0.5), ("Distance", 0.1), "Height", "Normal"], ["Normal"], invert=False)
        t.link(t.image("h"), "Color", bump, "Height")
        t.link(bump, "Normal", self.surface, "Normal")
        picked = tree.pick(t)
        self.assertAlmostEqual(picked.bump, 0.05)
        self.assertEqual(list(picked.maps), ["height"])

    def test_nothing_to_start_from(self):
        with self.assertRaisesRegex(ValueError, "No image texture reaches"):
            tree.pick(self.tree)
        with self.assertRaisesRegex(ValueError, "no Principled BSDF"):
            tree.pick(fakes.Tree())
        mix = self.tree.add("MIX_SHADER", ["Fac", "Shader", "Shader"], ["Shader"])
        mix.inputs[1].type = "SHADER"
        self.tree.link(self.surface, "BSDF", mix, 1)
        self.tree.link(mix, "Shader", self.output, "Surface")
        self.tree.link(self.tree.image("a", "sRGB"), "Color", self.surface, "Base Color")
        self.assertEqual(list(tree.pick(self.tree).maps), ["base_color"])


def read(path):
    with open(path, "rb") as file:
        return file.read()


def use(image, **more):
    return types.SimpleNamespace(image=image, channel="", inverted=False, normal_down=False, **more)


class Sources(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.grey = os.path.join(self.scratch.name, "grey.png")
        masks.write_png(self.grey, numpy.zeros((2, 2)))

    def gather(self, maps, path):
        folder = os.path.join(self.scratch.name, "exemplar")
        notes = sources.gather(maps, folder, lambda image: path, "wall", (1.5, 1.5))
        with open(os.path.join(folder, "terrazzo-material.json"), encoding="utf-8") as file:
            return json.load(file), notes, folder

    def test_packed_bytes_stay(self):
        data = read(self.grey) + b"as it is"
        packed = use(fakes.image("p", "sRGB", packed=data))
        rough = use(packed.image)
        rough.channel, rough.inverted = "a", True
        said, notes, folder = self.gather({"base_color": packed, "roughness": rough}, "")
        self.assertEqual(read(os.path.join(folder, "base_color.png")), data)
        self.assertEqual(said["files"], {"base_color.png": {"maps": {"base_color": "r", "roughness": "a"},
                                                            "color_space": "srgb_texture", "inverted": ["roughness"]}})
        self.assertEqual((said["metres"], notes), ([1.5, 1.5], []))

    def test_files_are_linked(self):
        normal = use(fakes.image("n", "sRGB"))
        normal.normal_down = True
        said, notes, folder = self.gather({"normal": normal}, self.grey)
        self.assertTrue(os.path.samefile(os.path.join(folder, "normal.png"), self.grey))
        self.assertEqual(said["files"]["normal.png"]["normal_y"], "down")
        self.assertEqual(said["files"]["normal.png"]["color_space"], "raw")
        self.assertIn("n holds normal but is marked sRGB", notes[0])
        self.gather({"height": use(fakes.image("h"))}, self.grey)
        self.assertFalse(os.path.lexists(os.path.join(folder, "normal.png")))
        self.assertTrue(os.path.isfile(self.grey))

    def test_images_without_a_usable_file(self):
        for says, image in (("no file /missing.png", fakes.image("x", source="TILED", tile=1011)),
                            ("has changes that are not saved", fakes.image("x", dirty=True)),
                            ("is generated", fakes.image("x", source="GENERATED")),
                            ("only single images", fakes.image("x", source="SEQUENCE")),
                            ("no file /missing.png", fakes.image("x"))):
            with self.assertRaisesRegex(sources.SourceError, says):
                self.gather({"base_color": use(image)}, "/missing.png")
        self.assertEqual(sources.File(fakes.image("x", source="GENERATED", packed=b"x"), "", 0).problem(), "")

    def test_a_tile_of_a_udim_set(self):
        for tile, token, name in ((1012, "<UDIM>", "wall.1012.png"), (1012, "<UVTILE>", "wall.u2_v2.png")):
            path = os.path.join(self.scratch.name, name)
            masks.write_png(path, numpy.zeros((2, 2)))
            color, rough = (use(fakes.image(n, source="TILED", tile=t)) for n, t in (("c", tile), ("r", 1001)))
            _, notes, folder = self.gather({"base_color": color, "roughness": rough}, path.replace(name, f"wall.{token}.png"))
            self.assertTrue(os.path.samefile(os.path.join(folder, "roughness.png"), path))
            self.assertIn(f"Tile {tile} of the UDIM set is taken: the active one of 'c'", notes[0])
        parts = [types.SimpleNamespace(tile_number=t, packed_file=types.SimpleNamespace(data=read(self.grey) + bytes([t - 1000])))
                 for t in (1001, 1002)]
        packed = fakes.image("p", source="TILED", tile=1002, packed=b"not this", packed_files=parts)
        _, _, folder = self.gather({"height": use(packed)}, "wall.<UDIM>.tif")
        self.assertEqual(read(os.path.join(folder, "height.png")), read(self.grey) + b"\2")

    def test_headers(self):
        self.assertEqual(sources.channels_of(b"\x89PNG" + bytes(21) + b"\x06"), 4)
        jpeg = b"\xff\xd8\xff\xe0\x00\x04ab\xff\xc0\x00\x0b\x08\x00\x02\x00\x02\x01" + bytes(20)
        self.assertEqual(sources.channels_of(jpeg), 1)
        self.assertEqual(sources.channels_of(b"\x76\x2f\x31\x01"), 0)
        self.assertEqual(sources.File(fakes.image("x", packed=b"\x76\x2f\x31\x01..."), "x.png", 0).ending(), ".exr")


class Surfaces(unittest.TestCase):
    # A plane of 4 x 3 m that takes the UVs from (0, 0) to (2, 1).
    points = [[(0, 0, 0), (4, 0, 0), (4, 3, 0)], [(0, 0, 0), (4, 3, 0), (0, 3, 0)]]
    uvs = [[(0, 0), (2, 0), (2, 1)], [(0, 0), (2, 1), (0, 1)]]

    def test_measures(self):
        found = surface.measure(self.points, self.uvs)
        numpy.testing.assert_allclose(found.metres_per_uv, (2, 3))
        self.assertEqual((found.low, found.high), ((0, 0), (2, 1)))
        self.assertAlmostEqual(found.stretch, 1)
        turned = numpy.array(self.points) @ [[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]]
        numpy.testing.assert_allclose(surface.measure(turned, self.uvs).metres_per_uv, (2, 3))
        self.assertAlmostEqual(surface.density_now(found, (512, 768), (1, 1)), 256)
        with self.assertRaisesRegex(ValueError, "no usable UV map"):
            surface.measure(self.points, numpy.zeros((2, 3, 2)))
        with self.assertRaisesRegex(ValueError, "No face"):
            surface.measure([], [])

    def test_fits(self):
        found = surface.measure(self.points, numpy.array(self.uvs) + (0.5, 0))
        fit = surface.fit(found, 100)
        self.assertEqual((fit.size, fit.repeats, fit.notes), ((400, 300), False, []))
        for uv, expected in (((0.5, 0), (0, 0)), ((2.5, 1), (1, 1))):
            numpy.testing.assert_allclose(numpy.array(uv) * fit.scale + fit.offset, expected, atol=1e-12)
        small = surface.fit(found, 100, 200)
        self.assertEqual((small.size, small.repeats), ((200, 200), True))
        numpy.testing.assert_allclose(small.scale, (1, 1.5))
        self.assertIn("covers 2 x 2 m and repeats", small.notes[0])

    def test_stretched(self):
        points = self.points + [[(9, 0, 0), (17, 0, 0), (17, 6, 0)]]
        found = surface.measure(points, self.uvs + [self.uvs[0]])
        self.assertAlmostEqual(found.stretch, 2)
        self.assertIn("stretched", surface.fit(found, 10).notes[0])


class Masks(unittest.TestCase):
    def test_triangles(self):
        square = [[(0, 0), (1, 0), (1, 1)], [(0, 0), (1, 1), (0, 1)]]
        drawn = masks.draw(square, [[0, 1, 1], [0, 1, 0]], (16, 8))
        numpy.testing.assert_allclose(drawn, numpy.tile((numpy.arange(16) + 0.5) / 16, (8, 1)), atol=1e-9)
        corner = masks.draw([[(0, 0.5), (0.5, 0.5), (0, 1)]], [[1, 1, 1]], (8, 8), margin=0)
        self.assertEqual([int(r) for r in corner.sum(axis=1)], [1, 2, 3, 4, 0, 0, 0, 0])
        wrapped = masks.draw([[(2, -0.5), (2.5, -0.5), (2, 0)]], [[1, 1, 1]], (8, 8), margin=0)
        numpy.testing.assert_array_equal(wrapped, corner)
        self.assertGreater(masks.draw([[(0, 0.5), (0.5, 0.5), (0, 1)]], [[1, 1, 1]], (8, 8), margin=1).sum(), 10)

    def test_png(self):
        with tempfile.TemporaryDirectory() as scratch:
            path = os.path.join(scratch, "m.png")
            masks.write_png(path, numpy.array([[0, 1], [0.5, 2]]))
            data = read(path)
        at = data.index(b"IDAT")
        size = int.from_bytes(data[at - 4:at], "big")
        self.assertEqual(zlib.decompress(data[at + 4:at + 4 + size]), bytes([0, 0, 255, 0, 128, 255]))


class Results(unittest.TestCase):
    def test_descriptions(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "terrazzo-material.json")
            with open(path, "w") as file:
                json.dump({"terrazzo_material": 1, "name": "w", "metres": [1, 2], "files": {
                    "c.exr": {"maps": {"base_color": "rgb"}, "color_space": "lin_rec709"},
                    "m.png": {"maps": {"metallic": "r", "roughness": "a"}, "inverted": ["roughness"], "color_space": "raw"},
                    "n.png": {"maps": {"normal": "rgb"}, "normal_y": "down", "color_space": "raw"}}}, file)
            found = result.from_files([os.path.join(folder, "c.exr"), path])
            self.assertEqual(found.files, {
                "base_color": {"file": "c.exr", "color_space": "Linear"},
                "metallic": {"file": "m.png", "color_space": "Non-Color", "channel": "r"},
                "roughness": {"file": "m.png", "color_space": "Non-Color", "channel": "a", "inverted": True},
                "normal": {"file": "n.png", "color_space": "Non-Color", "normal_y": "down"}})
            with open(path, "w") as file:
                file.write("{")
            with self.assertRaisesRegex(ValueError, "cannot be read"):
                result.read(folder)
        with self.assertRaisesRegex(ValueError, "There is no result in"):
            result.read(folder)

    def test_names(self):
        found = result.from_files(["/a/lit.png", "/b/wall_base_color.png", "/b/wall_normal.tif", "/c/height.png"])
        self.assertEqual((found.folder, found.name), ("/b", "b"))
        self.assertEqual(found.files["base_color"], {"file": "wall_base_color.png", "color_space": "sRGB"})
        self.assertEqual(set(found.files), {"base_color", "normal"})
        with self.assertRaisesRegex(ValueError, "has written no maps"):
            result.from_files(["/a/lit.png"])


if __name__ == "__main__":
    unittest.main()
