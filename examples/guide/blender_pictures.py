# Draws the pictures of blender.md, in Blender. Called by blender_pictures.sh:
#   blender --background --python blender_pictures.py -- wall ADDON.zip MAPS FOLDER    before.png, after.png
#   xvfb-run blender --python blender_pictures.py -- panel ADDON.zip MAPS FOLDER       panel.png
import math
import os
import sys
import time
import traceback

import bpy

PART, ARCHIVE, MAPS, FOLDER = sys.argv[sys.argv.index("--") + 1:]


def install():
    bpy.ops.preferences.addon_install(filepath=ARCHIVE, overwrite=True)
    bpy.ops.preferences.addon_enable(module="terrazzo_blender")
    bpy.context.preferences.addons["terrazzo_blender"].preferences.results = FOLDER


def wall():
    """A wall of 6 x 3 m with a material that shows the exemplar of 1 m eighteen times."""
    from terrazzo_blender.build_material import build_material
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    mesh = bpy.data.meshes.new("Wall")
    mesh.from_pydata([(-3, 0, 0), (3, 0, 0), (3, 0, 3), (-3, 0, 3)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new().data.foreach_set("uv", [0, 0, 6, 0, 6, 3, 0, 3])
    files = {m: {"file": m + ".png", "color_space": "sRGB" if m == "base_color" else "Non-Color"}
             for m in ("base_color", "normal", "roughness", "height")}
    mesh.materials.append(build_material("Wall", MAPS, files))
    out = bpy.data.objects.new("Wall", mesh)
    bpy.context.collection.objects.link(out)
    bpy.context.view_layer.objects.active = out
    out.select_set(True)
    bpy.context.scene.terrazzo.seed = 2


def wait():
    from terrazzo_blender import jobs
    while jobs.jobs:
        jobs.look()
        time.sleep(0.1)
    if jobs.history[0].has_failed:
        sys.exit(jobs.history[0].summary)


def render(name):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 64, False
    scene.render.resolution_x, scene.render.resolution_y = 1000, 500
    scene.view_settings.view_transform = "Standard"
    scene.render.filepath = os.path.join(FOLDER, name)
    bpy.ops.render.render(write_still=True)


def draw_wall():
    wall()
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location, camera.rotation_euler, camera.data.lens = (0, -7.2, 1.5), (math.pi / 2, 0, 0), 44
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3, (math.radians(50), 0, math.radians(50))
    for thing in (camera, sun):
        scene.collection.objects.link(thing)
    scene.camera = camera
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.5, 0.55, 0.6, 1)
    render("before.png")
    bpy.ops.terrazzo.make()
    wait()
    render("after.png")


class Screen:
    """Steps once a second, as a user would, until the picture is taken."""

    def __init__(self):
        self.steps = iter([self.show_editor, self.show_panel, self.make, self.wait, self.view, self.shoot])
        self.step = next(self.steps)

    def __call__(self):
        try:
            if self.step() is not False:
                self.step = next(self.steps)
            return 1.0
        except StopIteration:
            pass
        except Exception:
            traceback.print_exc()
        bpy.ops.wm.quit_blender()
        return None

    def area(self):
        return max(bpy.context.window_manager.windows[0].screen.areas, key=lambda a: a.width * a.height)

    def show_editor(self):
        self.area().ui_type = "ShaderNodeTree"

    def show_panel(self):
        self.area().spaces[0].show_region_ui = True

    def make(self):
        bpy.ops.terrazzo.best_of_eight()

    def wait(self):
        from terrazzo_blender import jobs
        if jobs.jobs:
            return False
        if jobs.history[0].title.endswith("eight seeds"):
            bpy.ops.terrazzo.choose(seed=4)
            return False
        return True

    def view(self):
        area = self.area()
        window = bpy.context.window_manager.windows[0]
        region = next(r for r in area.regions if r.type == "WINDOW")
        with bpy.context.temp_override(window=window, screen=window.screen, area=area, region=region):
            bpy.ops.node.view_all()

    def shoot(self):
        bpy.ops.screen.screenshot(filepath=os.path.join(FOLDER, "panel.png"))


def show_panel():
    wall()
    bpy.context.scene.terrazzo.quality = "draft"
    # The side bar opens on the first of its tabs: without the others, that is the add-on's.
    for panel in bpy.types.Panel.__subclasses__():
        if getattr(panel, "bl_space_type", "") == "NODE_EDITOR" and getattr(panel, "bl_region_type", "") == "UI":
            if panel.bl_category != "terrazzo" and panel.is_registered:
                bpy.utils.unregister_class(panel)
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(Screen(), first_interval=2)


install()
if PART == "wall":
    draw_wall()
else:
    show_panel()
