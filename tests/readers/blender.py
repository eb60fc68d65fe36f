# What Blender made of an export, checked and rendered under the light of preview.
# Usage: blender --background --factory-startup --python-exit-code 1 [--python EXPORTED.py] --python blender.py -- \
#          script|FILE.gltf WIDTH REPEATS PICTURE.png [EXPECTED.png BOUND]
# Prints what is wrong, and how far the picture is from the expected one; the exit code is 1 if anything is wrong.
import math
import os
import sys

import bpy
import numpy

numpy.bool = bool  # the importer of glTF in Debian 12 uses the name that its NumPy has dropped

SOURCE, WIDTH, REPEATS, PICTURE, *COMPARED = sys.argv[sys.argv.index("--") + 1:]
AZIMUTH, ELEVATION, AMBIENT, PIXELS = 135, 40, 0.25, 128
wrong = []


def expect(condition, text):
    if not condition:
        wrong.append(text)


def origin(socket):
    """The node and the output that feed an input, or nothing."""
    if socket is None or not socket.links:
        return None, None
    return socket.links[0].from_node, socket.links[0].from_socket.name


def image_of(socket, what, space, channel=None):
    """Checks that an input is fed by an image in a colour space, through a channel of a packed one if there is one."""
    node, output = origin(socket)
    if channel and node is not None:
        expect(node.type in ("SEPRGB", "SEPARATE_COLOR") and output in channel,
               f"{what} comes from {node.type} {output}, not from channel {channel}")
        node, output = origin(node.inputs[0])
    if node is None or node.type != "TEX_IMAGE":
        wrong.append(f"{what} is fed by {node and node.type}, not by an image")
        return
    found = node.image.colorspace_settings.name
    expect(found == space, f"{what}: the colour space of {node.image.name} is {found}, not {space}")
    expect(node.extension == "REPEAT", f"{what} does not repeat")
    mapping, _ = origin(node.inputs["Vector"])
    scale = tuple(mapping.inputs["Scale"].default_value)[:2] if mapping is not None and mapping.type == "MAPPING" else (1, 1)
    expect(all(abs(s - float(REPEATS)) < 1e-6 for s in scale), f"{what} repeats {scale} times, not {REPEATS}")


if SOURCE == "script":
    plane = next(o for o in bpy.data.objects if o.name not in ("Camera", "Cube", "Light"))
else:
    bpy.ops.import_scene.gltf(filepath=os.path.abspath(SOURCE))
    plane = bpy.context.selected_objects[0]
    # Blender has stood the plane up, since glTF's y points there.
    plane.rotation_mode = "XYZ"
    plane.rotation_euler = (-math.pi / 2, 0, 0)
for other in [o for o in bpy.data.objects if o != plane]:
    bpy.data.objects.remove(other)
bpy.context.view_layer.update()
expect(abs(plane.dimensions.x - float(WIDTH)) < 1e-5, f"the plane is {plane.dimensions.x} m wide, not {WIDTH}")

nodes = plane.data.materials[0].node_tree.nodes
surface = next(n for n in nodes if n.type == "BSDF_PRINCIPLED")
image_of(surface.inputs["Base Color"], "base colour", "sRGB")
normal, _ = origin(surface.inputs["Normal"])
if normal is None or normal.type != "NORMAL_MAP":
    wrong.append("no normal map is connected")
else:
    expect(normal.space == "TANGENT", "normals are not in tangent space")
    image_of(normal.inputs["Color"], "normal", "Non-Color")
output = next(n for n in nodes if n.type == "OUTPUT_MATERIAL")
displacement, _ = origin(output.inputs["Displacement"])
if SOURCE == "script":
    image_of(surface.inputs["Roughness"], "roughness", "Non-Color")
    if displacement is None or displacement.type != "DISPLACEMENT":
        wrong.append("the displacement is not connected")
    else:
        image_of(displacement.inputs["Height"], "height", "Non-Color")
        expect(not displacement.inputs["Scale"].links, "the scale of the displacement is fed by a map")
else:
    image_of(surface.inputs["Roughness"], "roughness", "Non-Color", ("G", "Green"))
    image_of(surface.inputs["Metallic"], "metallic", "Non-Color", ("B", "Blue"))
    group = next((n for n in nodes if n.type == "GROUP" and "Occlusion" in n.inputs), None)
    image_of(group and group.inputs["Occlusion"], "occlusion", "Non-Color", ("R", "Red"))

scene = bpy.context.scene
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
camera.data.type, camera.data.ortho_scale = "ORTHO", float(WIDTH)
camera.location = (0, 0, 2)
sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
sun.data.energy, sun.data.angle = math.pi, 0
sun.rotation_euler = (0, math.radians(90 - ELEVATION), math.radians(AZIMUTH))
for o in (camera, sun):
    scene.collection.objects.link(o)
scene.camera = camera
scene.world = bpy.data.worlds.new("World")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.8 * AMBIENT,) * 3 + (1,)
scene.render.engine = "CYCLES"
scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 16, False
# Every sample in the middle of its pixel, where a texel is.
scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BLACKMAN_HARRIS", 0.01
scene.render.resolution_x = scene.render.resolution_y = PIXELS
scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
scene.render.filepath = os.path.abspath(PICTURE + ".exr")
bpy.ops.render.render(write_still=True)


def pixels_of(file):
    image = bpy.data.images.load(os.path.abspath(file))
    image.colorspace_settings.name = "Non-Color"  # the numbers in the file
    return numpy.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)[:, :, :3]


linear = pixels_of(PICTURE + ".exr")
os.remove(PICTURE + ".exr")
# Colours as preview has them: as they are up to 0.75, then a shoulder; sRGB.
over = numpy.maximum(linear - 0.75, 0) / 0.25
shown = numpy.where(linear > 0.75, 0.75 + 0.25 * over / (1 + over), linear).clip(0, 1)
shown = numpy.where(shown <= 0.0031308, 12.92 * shown, 1.055 * shown ** (1 / 2.4) - 0.055)
picture = bpy.data.images.new("Picture", PIXELS, PIXELS)
picture.colorspace_settings.name = "Non-Color"
picture.pixels = numpy.dstack([shown, numpy.ones((PIXELS, PIXELS))]).ravel()
picture.filepath_raw, picture.file_format = os.path.abspath(PICTURE), "PNG"
picture.save()
if COMPARED:
    difference = 255 * (shown - pixels_of(COMPARED[0]))
    mean = numpy.abs(difference).mean()
    side = PIXELS // 8
    block = numpy.abs(difference.reshape(8, side, 8, side, 3).mean(axis=(1, 3))).max()
    print(f"{SOURCE}: the picture differs by {mean:.2f} of 255 on average, by {block:.2f} in the worst block")
    expect(mean < float(COMPARED[1]), f"the picture differs by {mean:.2f} of 255, more than {COMPARED[1]}")
for text in wrong:
    print("WRONG:", text)
sys.exit(1 if wrong else 0)
