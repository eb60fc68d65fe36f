# Uses the add-on in Blender as its user does, but for the window: graphs of one's own, the editor, watching, masks.
# Usage: blender --background --factory-startup --python graphs_in_blender.py -- ADDON.zip PROGRAM MAPS_FOLDER SCRATCH
import functools
import json
import os
import re
import shutil
import subprocess
import sys
import urllib.request

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import workbench  # noqa: E402
from workbench import addon, digests, give, install, make, node, old_material, picture_of, plane, run_all, start, wait  # noqa: E402

ARCHIVE, PROGRAM, MAPS, SCRATCH = sys.argv[sys.argv.index("--") + 1:]
install(ARCHIVE, PROGRAM, SCRATCH)
wall = functools.partial(workbench.wall, MAPS)


def a_graph_of_ones_own_has_fields_and_is_watched():
    target = wall()
    graph = os.path.join(SCRATCH, "own.json")

    def write(seed):
        with open(graph + ".new", "w") as file:
            file.write(json.dumps({
                "terrazzo": 1, "parameters": {
                    "material": {"type": "path"}, "out": {"type": "path"}, "seed": {"type": "int", "default": seed},
                    "kind": {"type": "choice", "default": "draft", "choices": ["draft", "normal"]},
                    "size": {"type": "size", "default": "=@maps.size * 2"}},
                "presets": {"small": {"set": {"size": 32}}},
                "nodes": {"maps": {"type": "load_material", "path": "$material"},
                          "w": {"type": "weight", "material": "@maps"}, "p": {"type": "pca", "features": "@w"},
                          "i": {"type": "index", "appearance": "@p"},
                          "l": {"type": "synthesize", "index": "@i", "size": "$size", "seed": "$seed", "quality": "$kind"},
                          "r": {"type": "resolve_uv", "uv": "@l", "material": "@maps"},
                          "f": {"type": "export", "material": "@r", "path": "$out/{map}.png"}}}) + " // mine\n")
        os.replace(graph + ".new", graph)

    write(1)
    settings = bpy.context.scene.terrazzo
    settings.use_graph, settings.graph = True, graph
    assert {p.name: p.field() for p in settings.parameters} == {
        "material": "path", "out": "path", "seed": "whole", "kind": "choice", "size": "text"}
    settings.preset = "small"
    make()
    assert tuple(node(target.active_material, "TEX_IMAGE").image.size) == (32, 32)
    start("best_of_eight")
    wait()
    pictures = addon("making").choices["pictures"]
    assert list(pictures) == list(range(1, 9)) and len(digests(os.path.dirname(pictures[3]))) == 5, pictures
    bpy.ops.terrazzo.choose(seed=5)
    wait()
    assert settings.parameters["seed"].value() == "5" and target.active_material.name == "Bricks seed 5"
    start("another_seed")
    wait()
    assert target.active_material.name == "Bricks seed 6"
    settings.preset, settings.parameters["size"].text, settings.parameters["seed"].whole = "", "96x64", 1
    start("watch")
    job = wait(lambda j: j.progress.is_watching)
    material = target.active_material
    image = node(material, "TEX_IMAGE").image
    first = list(image.pixels)
    assert job.made == material.name and tuple(image.size) == (96, 64)
    write(2)
    wait(lambda j: j.progress.runs == 2 and j.progress.is_watching)
    assert target.active_material == material and list(image.pixels) != first
    bpy.ops.terrazzo.cancel(index=0)
    wait()


def maps_that_are_edited_elsewhere_are_watched():
    maps = os.path.join(SCRATCH, "edited")
    shutil.copytree(MAPS, maps)
    target = plane(3, 3)
    give(target, old_material(maps))
    start("watch", factor=1, quality="draft", seed=6)
    wait(lambda j: j.progress.is_watching)
    material = target.active_material
    image = node(material, "TEX_IMAGE").image
    first = numpy.array(image.pixels)
    subprocess.run([PROGRAM, "run", os.path.join(SCRATCH, "dark.json"), "--progress", "none"], check=True)
    os.replace(os.path.join(SCRATCH, "dark.png"), os.path.join(maps, "base_color.png"))
    wait(lambda j: j.progress.runs == 2 and j.progress.is_watching)
    assert target.active_material == material
    assert numpy.array(image.pixels).mean() < first.mean() - 0.05, "the image has not been loaded again"
    bpy.ops.terrazzo.cancel(index=0)
    wait()


def the_editor_opens_and_the_material_follows():
    target = wall()
    browser = os.path.join(SCRATCH, "browser")
    with open(browser, "w") as file:
        file.write(f'#!/bin/sh\necho "$1" >>"{browser}.log"\n')
    os.chmod(browser, 0o755)
    os.environ["BROWSER"] = browser
    settings = bpy.context.scene.terrazzo
    start("edit", factor=1.5, seed=3)
    watched = addon("jobs").jobs[1]
    editor = wait(lambda j: addon("jobs").jobs[0].address and watched.progress.is_watching and os.path.exists(browser + ".log"))
    editor = addon("jobs").jobs[0]
    with open(browser + ".log") as file:
        address = file.read().strip()
    assert address == editor.address
    with urllib.request.build_opener(urllib.request.HTTPCookieProcessor()).open(address) as page:
        assert page.status == 200
    material = target.active_material
    assert material.name == "Bricks seed 3" or watched.made == material.name, (material.name, watched.made)
    image = node(material, "TEX_IMAGE").image
    assert tuple(image.size) == (96, 96)
    first = list(image.pixels)
    path = bpy.path.abspath(settings.graph)
    assert settings.use_graph and os.path.dirname(path) in editor.request["graph"]
    with open(path) as file:
        text = file.read()
    changed = re.sub(r'("seed": *{"type": "int", *"default": )3', r"\g<1>4", text)
    assert changed != text, text
    with open(path + ".new", "w") as file:
        file.write(changed)
    os.replace(path + ".new", path)
    wait(lambda j: watched.progress.runs == 2 and watched.progress.is_watching)
    assert target.active_material == material and list(image.pixels) != first
    # Once more: the same editor, the same watch.
    start("edit")
    assert len(addon("jobs").jobs) == 2
    for _ in range(2):
        bpy.ops.terrazzo.cancel(index=0)
        count = len(addon("jobs").jobs)
        wait(lambda j: len(addon("jobs").jobs) < count)
    assert editor.summary == "closed" and not editor.has_failed
    # A copy of a stock graph, which has the source and the fields' values.
    settings.graph = "stock:material"
    settings.parameters["seed"].whole, settings.parameters["size"].text = 9, "80x64"
    start("edit")
    wait(lambda j: j.progress.is_watching)
    assert tuple(node(target.active_material, "TEX_IMAGE").image.size) == (80, 64)
    with open(bpy.path.abspath(settings.graph)) as file:
        assert re.search(r'"default": "exemplar"', text := file.read()) and re.search(r'"default": 9\b', text), text
    for _ in range(2):
        bpy.ops.terrazzo.cancel(index=0)
        count = len(addon("jobs").jobs)
        wait(lambda j: len(addon("jobs").jobs) < count)


def faces_and_colors_become_masks():
    target = wall()
    settings = bpy.context.scene.terrazzo
    settings.use_graph, settings.graph, settings.mask_size = True, "stock:inpaint", (64, 64)
    bpy.ops.terrazzo.read_graph()
    try:
        target.data.polygons[0].select = False
        bpy.ops.terrazzo.bake_mask(parameter="mask")
        raise AssertionError("a mask of nothing")
    except RuntimeError as e:
        assert "No face is selected" in str(e)
    colors = target.data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    target.data.color_attributes.active_color = colors
    colors.data.foreach_set("color", [0, 0, 0, 1, 0.6, 0.6, 0.6, 1, 0.6, 0.6, 0.6, 1, 0, 0, 0, 1])
    settings.mask_from, settings.mask_over = "COLOR", "EXEMPLAR"
    bpy.ops.terrazzo.bake_mask(parameter="mask")
    drawn = picture_of(settings.parameters["mask"].value())
    # The wall shows the exemplar twice; where white and black meet, white counts.
    across = (numpy.arange(64) + 0.5) / 64
    assert drawn.shape[:2] == (64, 64) and numpy.allclose(drawn[:, :, 0], 0.3 * (across + 1), atol=0.003)
    make()
    assert tuple(node(target.active_material, "TEX_IMAGE").image.size) == (64, 64)
    assert numpy.allclose(node(target.active_material, "MAPPING").inputs["Scale"].default_value[:2], 2)
    # Painted on the result: it is spread over the UV square, and so is the mask.
    settings.graph, settings.mask_over, settings.mask_size = "stock:progression", "RESULT", (64, 32)
    bpy.ops.terrazzo.read_graph()
    settings.parameters["size"].text = "96x80"
    bpy.ops.terrazzo.bake_mask(parameter="target")
    assert numpy.allclose(picture_of(settings.parameters["target"].value())[:, :, 0], 0.6 * across, atol=0.003)
    make()
    assert tuple(node(target.active_material, "TEX_IMAGE").image.size) == (96, 80)
    assert tuple(node(target.active_material, "MAPPING").inputs["Scale"].default_value[:2]) == (1, 1)


run_all([a_graph_of_ones_own_has_fields_and_is_watched, the_editor_opens_and_the_material_follows,
         maps_that_are_edited_elsewhere_are_watched, faces_and_colors_become_masks])
