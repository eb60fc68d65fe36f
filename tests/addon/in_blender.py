# Uses the add-on in Blender as its user does, but for the window: materials of its own graph.
# Usage: blender --background --factory-startup --python in_blender.py -- ADDON.zip PROGRAM MAPS_FOLDER SCRATCH
import functools
import hashlib
import os
import shutil
import subprocess
import sys
import time

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import workbench  # noqa: E402
from workbench import (addon, base_colors, digests, give, install, make, node, old_material, picture_of,  # noqa: E402
                       plane, preferences, refusal, run_all, start, wait)

ARCHIVE, PROGRAM, MAPS, SCRATCH = sys.argv[sys.argv.index("--") + 1:]
install(ARCHIVE, PROGRAM, SCRATCH)
wall = functools.partial(workbench.wall, MAPS)


def more_stands_beside_the_old_material():
    target = wall()
    old = target.active_material
    node(old, "BSDF_PRINCIPLED").inputs["Metallic"].default_value = 0.25
    before = digests(MAPS)
    job = make(factor=1.5)
    new = target.active_material
    assert new.name == job.made == "Bricks seed 1", new.name
    assert old.name in bpy.data.materials and old.use_fake_user
    scale = tuple(node(new, "MAPPING").inputs["Scale"].default_value)[:2]
    assert numpy.allclose(scale, 4 / 3), scale
    assert abs(node(new, "DISPLACEMENT").inputs["Scale"].default_value - 0.02) < 1e-6
    assert node(new, "BSDF_PRINCIPLED").inputs["Metallic"].default_value == 0.25
    assert node(new, "GROUP").inputs["Occlusion"].links
    assert digests(MAPS) == before
    # Another seed starts from the old material again, not from the result.
    start("another_seed")
    wait()
    assert target.active_material.name == "Bricks seed 2"
    assert tuple(node(target.active_material, "TEX_IMAGE").image.size) == (96, 96)
    assert len(target.material_slots) == 1


def an_object_is_fitted():
    target = plane(3, 2, (1.5, 2))
    give(target, old_material(MAPS, repeats=(1, 1)))
    target.scale = (2, 1, 1)
    bpy.context.view_layer.update()
    bpy.ops.terrazzo.measure()
    assert abs(bpy.context.scene.terrazzo.density - (64 / 4 + 64 / 1) / 2) < 1e-3, bpy.context.scene.terrazzo.density
    make(size_by="DENSITY", density=20, quality="draft", tileable="none")
    new = target.active_material
    assert tuple(node(new, "TEX_IMAGE").image.size) == (120, 40)
    assert numpy.allclose(tuple(node(new, "MAPPING").inputs["Scale"].default_value)[:2], (1 / 1.5, 1 / 2))
    make(size_by="OBJECT", seed=2)
    assert tuple(node(target.active_material, "TEX_IMAGE").image.size) == (240, 80)
    job = make(size_by="DENSITY", density=20, most=64)
    assert "repeats" in job.messages[0] and tuple(node(target.active_material, "TEX_IMAGE").image.size) == (64, 40)


def packed_and_deep_images_reach_the_program_as_they_are():
    deep = os.path.join(SCRATCH, "deep")
    subprocess.run([PROGRAM, "run", os.path.join(SCRATCH, "deep.json"), "--progress", "none"], check=True)
    for packed in (False, True):
        target = plane(3, 3)
        give(target, old_material(deep, ("base_color", "height")))
        files = {}
        for n in target.active_material.node_tree.nodes:
            if n.type == "TEX_IMAGE":
                with open(bpy.path.abspath(n.image.filepath), "rb") as file:
                    files[n.label] = file.read()
                if packed:
                    n.image.pack()
                    n.image.filepath = "//nowhere/" + n.label
        job = make(factor=1, quality="draft", seed=3)
        for name, data in files.items():
            with open(os.path.join(job.request["out"], "exemplar", name + ".png"), "rb") as file:
                assert file.read() == data, name
        results = {d for name, d in digests(job.request["out"]).items() if name.endswith(".png")}
        assert not packed or results == unpacked
        unpacked = results
        colors = picture_of(bpy.path.abspath(node(target.active_material, "TEX_IMAGE").image.filepath))
        assert len(numpy.unique(colors[:, :, 0])) > 256, "16 bits have become 8"


def exr_images_stay_linear():
    folder = os.path.join(SCRATCH, "float")
    subprocess.run([PROGRAM, "run", os.path.join(SCRATCH, "float.json"), "--progress", "none"], check=True)
    build_material, linear_space = addon("build_material").build_material, addon("compat").linear_space
    target = plane(3, 3)
    give(target, build_material("Float", folder, {"base_color": {"file": "base_color.exr", "color_space": linear_space()}}))
    make(factor=1, quality="draft")
    image = node(target.active_material, "TEX_IMAGE").image
    before, after = (picture_of(p, linear_space()) for p in (os.path.join(folder, "base_color.exr"),
                                                             bpy.path.abspath(image.filepath)))
    # The result shows the exemplar's own colours: linear ones taken for sRGB would be much darker or lighter.
    shown = picture_of(bpy.path.abspath(image.filepath), image.colorspace_settings.name)
    assert abs(shown[:, :, :3].mean() / before[:, :, :3].mean() - 1) < 0.1, (shown.mean(), before.mean(), after.mean())


def images_without_a_file_are_named():
    def with_image(image):
        target = wall()
        node(target.active_material, "TEX_IMAGE").image = image
        return refusal()

    generated = bpy.data.images.new("New one", 64, 64)
    assert "'New one' is generated" in with_image(generated)
    edited = bpy.data.images.load(os.path.join(MAPS, "base_color.png"))
    edited.pixels[0] = 0.5
    edited.update()
    assert "changes that are not saved" in with_image(edited)
    missing = bpy.data.images.load(os.path.join(MAPS, "base_color.png"))
    missing.filepath = "/nowhere/stone.png"
    assert "is missing: there is no file /nowhere/stone.png" in with_image(missing)
    target = wall()
    target.active_material.node_tree.nodes.remove(node(target.active_material, "BSDF_PRINCIPLED"))
    assert "no Principled BSDF" in refusal()
    give(target, bpy.data.materials.new("Plain"))
    assert "does not use nodes" in refusal()
    assert "There is no folder /nowhere" in refusal(source="FOLDER", folder="/nowhere")


def a_tile_of_a_udim_set_is_the_exemplar():
    tiles = os.path.join(SCRATCH, "tiles")
    os.makedirs(tiles)
    for tile, file in ((1001, "normal.png"), (1002, "base_color.png")):
        shutil.copy(os.path.join(MAPS, file), os.path.join(tiles, f"wall.{tile}.png"))
    udim = bpy.data.images.load(os.path.join(tiles, "wall.1001.png"))
    udim.source = "TILED"
    udim.filepath = os.path.join(tiles, "wall.<UDIM>.png")
    udim.tiles.active_index = 1
    for pack in (lambda: None, udim.pack):
        pack()
        target = wall()
        node(target.active_material, "TEX_IMAGE").image = udim
        job = make(factor=1)
        assert "Tile 1002" in job.messages[0], job.messages
        exemplar = os.path.join(job.request["out"], "exemplar")
        assert digests(exemplar)["base_color.png"] == digests(MAPS)["base_color.png"]
        assert node(target.active_material, "TEX_IMAGE").image.source == "FILE"


def a_program_that_is_missing_or_too_old_is_told():
    wall()
    old = os.path.join(SCRATCH, "old")
    with open(old, "w") as file:
        file.write("#!/bin/sh\necho terrazzo 0.0.1\n")
    os.chmod(old, 0o755)
    try:
        for path, says in (("/nowhere/terrazzo", "no program /nowhere/terrazzo"), (old, "is too old: it is version 0.0.1")):
            preferences().program = path
            said = refusal()
            assert says in said and ("build it" in said or "newer program" in said), said
    finally:
        preferences().program = ""  # the one that wrote the add-on
    make(factor=1)
    preferences().program = PROGRAM


def a_run_can_be_cancelled():
    wall()
    start(factor=30, quality="best")
    began = time.monotonic()
    job = wait(lambda j: "layout" in j.progress.node)
    bpy.ops.terrazzo.cancel(index=0)
    assert time.monotonic() - began < 60
    assert wait() is job and job.summary == "cancelled" and not job.made, job.summary
    assert not os.path.exists(job.request["out"])


def undo_and_saving_do_not_disturb_a_run():
    target = wall()
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(SCRATCH, "first.blend"))
    preferences().results = "//maps"
    bpy.ops.ed.undo_push(message="before")
    target.location.x = 5
    bpy.ops.ed.undo_push(message="moved")
    start(factor=2)
    bpy.ops.ed.undo()
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(SCRATCH, "second.blend"))
    job = wait()
    assert job.made == "Bricks seed 1", job.summary
    new = bpy.data.objects["Wall"].active_material
    assert new.name == job.made
    path = node(new, "TEX_IMAGE").image.filepath
    assert path.startswith("//maps/Bricks-01/"), path
    files = digests(job.request["out"])
    bpy.ops.wm.save_mainfile()
    assert digests(job.request["out"]) == files
    # A file that is closed meanwhile: the maps are there, and nothing lands in the other file.
    start(factor=2, seed=5)
    bpy.ops.wm.open_mainfile(filepath=os.path.join(SCRATCH, "first.blend"))
    job = wait()
    assert not job.made and "The file was closed. The maps are in" in job.messages[0], job.messages
    assert "Bricks seed 5" not in bpy.data.materials and not job.has_failed
    bpy.ops.terrazzo.add_result(directory=job.request["out"])
    assert "Bricks" in bpy.data.objects["Wall"].material_slots[-1].material.name
    preferences().results = os.path.join(SCRATCH, "results")


def one_of_eight_is_chosen():
    target = wall()
    start("best_of_eight", factor=1.5, seed=10)
    job = wait()
    assert not job.has_failed, job.summary
    assert list(addon("making").choices["pictures"]) == list(range(10, 18))
    pictures = {hashlib.sha256(open(os.path.join(job.request["out"], str(s), "lit.png"), "rb").read()).digest()
                for s in range(10, 18)}
    assert len(pictures) == 8
    bpy.ops.terrazzo.choose(seed=12)
    job = wait()
    assert target.active_material.name == "Bricks seed 12" and job.progress.sizes["layout"] == (96, 96)


def the_uv_map_shows_the_resolved_maps():
    # More than 256 pixels, so that high bytes count.
    maps = os.path.join(SCRATCH, "large")
    subprocess.run([PROGRAM, "run", "stock:generate-exemplar", "--set", "type=gravel", "--set", "size=300x64", "--set",
                    "out=" + maps, "--progress", "none"], check=True)
    target = plane(3, 3 * 128 / 600)
    give(target, old_material(maps, repeats=(1, 1), relief=0))
    job = make(factor=2, as_uv=True, seed=4, quality="draft")
    through_uv = target.active_material
    assert sorted(tuple(n.image.size) for n in through_uv.node_tree.nodes if n.type == "TEX_IMAGE") == [(300, 64)] * 4
    graph = os.path.join(os.path.dirname(addon("command").__file__), "material.json")
    resolved = os.path.join(SCRATCH, "resolved")
    values = {"material": os.path.join(job.request["out"], "exemplar"), "out": resolved, "seed": 4, "scale": 2, "join": 0,
              "tones": 0, "quality": "draft", "tileable": "xy"}
    subprocess.run([PROGRAM, "run", graph, "--progress", "none"] + [w for n, v in values.items() for w in
                                                                  ("--set", f"{n}={v}")], check=True)
    node(through_uv, "MAPPING").inputs["Scale"].default_value = (1, 1, 1)
    shot = base_colors(target, (600, 128), SCRATCH)
    expected = picture_of(os.path.join(resolved, "Bricks_base_color.png"), "sRGB")[:, :, :3]
    expected = numpy.where(expected <= 0.04045, expected / 12.92, ((expected + 0.055) / 1.055) ** 2.4)
    assert numpy.abs(shot - expected).max() < 1e-4, numpy.abs(shot - expected).max()
    target = wall()
    assert "has no uv map" in refusal(as_uv=True, method="noise")


run_all([more_stands_beside_the_old_material, an_object_is_fitted, packed_and_deep_images_reach_the_program_as_they_are,
         exr_images_stay_linear, images_without_a_file_are_named, a_tile_of_a_udim_set_is_the_exemplar,
         a_program_that_is_missing_or_too_old_is_told, a_run_can_be_cancelled, undo_and_saving_do_not_disturb_a_run,
         one_of_eight_is_chosen, the_uv_map_shows_the_resolved_maps])
