# What tests of the add-on in Blender share: installing it, waiting for runs, objects, and pictures by Cycles.
import hashlib
import importlib
import os
import sys
import time

import bpy
import numpy

MAPS = ("base_color", "normal", "height", "roughness", "ambient_occlusion")


IS_EXTENSION = bpy.app.version >= (4, 2)
MODULE = "bl_ext.user_default.terrazzo_blender" if IS_EXTENSION else "terrazzo_blender"


def install(archive, program, scratch):
    """As the button in Blender's preferences does it."""
    if IS_EXTENSION:
        bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    else:
        bpy.ops.preferences.addon_install(filepath=archive, overwrite=True)
        bpy.ops.preferences.addon_enable(module=MODULE)
    own = preferences()
    own.program, own.cache, own.results = program, os.path.join(scratch, "cache"), os.path.join(scratch, "results")
    return own


def preferences():
    return bpy.context.preferences.addons[MODULE].preferences


def addon(name):
    """A module of the add-on."""
    return importlib.import_module(f"{MODULE}.{name}")


def wait(until=None, seconds=120):
    """Does what Blender's timer does, until all runs have ended; the last of them."""
    jobs = addon("jobs")
    end = time.monotonic() + seconds
    while jobs.jobs and not (until and until(jobs.jobs[-1])):
        jobs.look()
        time.sleep(0.02)
        assert time.monotonic() < end, jobs.jobs[-1].summary
    return (jobs.jobs[-1:] or jobs.history)[0]


def make(**settings):
    """Makes more with settings of the panel; the run, which has to succeed."""
    start(**settings)
    job = wait()
    assert not job.has_failed and job.made, (job.summary, job.progress.errors)
    return job


def start(operator="make", **settings):
    """Presses a button, with settings of the panel: a factor asks for a size by it."""
    if "factor" in settings:
        settings.setdefault("size_by", "FACTOR")
    for name, value in settings.items():
        setattr(bpy.context.scene.terrazzo, name, value)
    getattr(bpy.ops.terrazzo, operator)()


def refusal(**settings):
    """What the user is told when nothing can be made."""
    try:
        start(**settings)
    except RuntimeError as e:
        return str(e)
    job = wait()
    assert job.has_failed and not job.made, job.summary
    return job.summary


def plane(width, height, uvs=(1, 1)):
    mesh = bpy.data.meshes.new("Wall")
    x, y = width / 2, height / 2
    mesh.from_pydata([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], [], [(0, 1, 2, 3)])
    u, v = uvs
    mesh.uv_layers.new().data.foreach_set("uv", [0, 0, u, 0, u, v, 0, v])
    out = bpy.data.objects.new("Wall", mesh)
    bpy.context.collection.objects.link(out)
    bpy.context.view_layer.objects.active = out
    return out


def old_material(folder, maps=MAPS, repeats=(2, 2), relief=0.02, name="Bricks"):
    files = {m: {"file": m + ".png", "color_space": "sRGB" if m == "base_color" else "Non-Color"} for m in maps}
    return addon("build_material").build_material(name, folder, files, repeats=repeats, relief=relief)


def give(target, material):
    target.data.materials.clear()
    target.data.materials.append(material)


def wall(maps, **more):
    """A plane of 3 x 3 m that shows the maps of a folder."""
    target = plane(3, 3)
    give(target, old_material(maps, **more))
    bpy.context.scene.terrazzo.quality = "draft"
    return target


def digests(folder):
    out = {}
    for name in sorted(os.listdir(folder)):
        if os.path.isfile(os.path.join(folder, name)):
            with open(os.path.join(folder, name), "rb") as file:
                out[name] = hashlib.sha256(file.read()).hexdigest()
    return out


def node(material, kind):
    return next(n for n in material.node_tree.nodes if n.type == kind)


def picture_of(image, space="Non-Color"):
    """The pixels of a file as Blender decodes them: rows from the bottom."""
    loaded = bpy.data.images.load(image)
    loaded.colorspace_settings.name = space
    out = numpy.array(loaded.pixels[:]).reshape(loaded.size[1], loaded.size[0], 4)
    bpy.data.images.remove(loaded)
    return out


def base_colors(target, pixels, scratch):
    """What Cycles makes of the base colour of an object that is seen from above, unlit: (height, width, 3), linear."""
    nodes, links = target.active_material.node_tree.nodes, target.active_material.node_tree.links
    light = nodes.new("ShaderNodeEmission")
    links.new(node(target.active_material, "BSDF_PRINCIPLED").inputs["Base Color"].links[0].from_socket,
              light.inputs["Color"])
    output = node(target.active_material, "OUTPUT_MATERIAL")
    links.new(light.outputs[0], output.inputs["Surface"])
    for link in list(output.inputs["Displacement"].links):
        links.remove(link)
    scene = bpy.context.scene
    for other in [o for o in bpy.data.objects if o != target]:
        bpy.data.objects.remove(other)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", max(target.dimensions)
    camera.location = (0, 0, 2)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 1, False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BLACKMAN_HARRIS", 0.01
    scene.render.resolution_x, scene.render.resolution_y = pixels
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = os.path.join(scratch, "shot.exr")
    bpy.ops.render.render(write_still=True)
    return picture_of(scene.render.filepath, addon("compat").linear_space())[:, :, :3]


def run_all(tests):
    """Runs functions one after the other; prints what has failed, and ends Blender."""
    import traceback
    failed = 0
    for test in tests:
        bpy.ops.wm.read_homefile(use_empty=False, use_factory_startup=True, load_ui=False)
        began = time.monotonic()
        try:
            test()
            print(f"ok: {test.__name__.replace('_', ' ')}, {time.monotonic() - began:.1f} s")
        except Exception:
            traceback.print_exc()
            print(f"WRONG: {test.__name__.replace('_', ' ')}")
            failed += 1
    sys.exit(1 if failed else 0)
