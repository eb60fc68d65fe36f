#!/usr/bin/env bash
# Blender has two readers of pictures that disagree: Cycles renders other values than image.pixels has.
#
# Version:   blender 3.4.1+dfsg-2+b1 (Debian 12)
# Guess:     one reader, so that what Python sees in image.pixels is what Cycles renders.
# Behaviour: Cycles opens the file itself. EXR with X, Y, Z: Cycles has all three, Blender a grey picture of Y. A channel
#            called roughness alone: Cycles has it, Blender black. Layers: Cycles has the first, Blender no pixels.
#            R and G: Blender has both, Cycles a grey picture of R. Halves in TIFF: Cycles has the numbers, Blender takes
#            their bits for integers, so that 1 is 0.23.
# Matters:   a script that checks or bakes from image.pixels proves nothing about the render, and a picture that looks
#            broken there may render well. R, G, B in EXR, and floats or integers in TIFF, are the same in both.
# Seen on 2026-11-27, Blender and then Cycles:
#   X 0.1, Y 0.2, Z 0.3: 0.2 0.2 0.2 and 0.1 0.2 0.3
#   roughness 0.6: 0.0 0.0 0.0 and 0.6 0.6 0.6
#   stone.R 0.7, stone.G 0.8, stone.B 0.9: nothing and 0.7 0.8 0.9
#   R 0.1, G 0.2: 0.1 0.2 0.0 and 0.1 0.1 0.1
#   half TIFF of 1: 0.23 0.23 0.23 and 1.0 1.0 1.0
#   float TIFF of 1: 1.0 1.0 1.0 and 1.0 1.0 1.0
. "$(dirname "$0")/common/packages.bash"
debian blender=3.4.1+dfsg-2+b1
if [ -d root/usr/share/blender ]; then
  export BLENDER_SYSTEM_SCRIPTS=$dir/root/usr/share/blender/scripts
  export BLENDER_SYSTEM_DATAFILES=$dir/root/usr/share/blender/datafiles
fi

python3 - <<'PY'
from pictures import write_exr, write_tiff
values = {"X": 0.1, "Y": 0.2, "Z": 0.3, "roughness": 0.6, "stone.R": 0.7, "stone.G": 0.8, "stone.B": 0.9, "R": 0.1, "G": 0.2}
window = (0, 0, 7, 7)
for file, names in (("xyz", "XYZ"), ("alone", ["roughness"]), ("layer", ["stone.R", "stone.G", "stone.B"]), ("rg", "RG")):
    write_exr(file + ".exr", {n: (lambda x, y, n=n: values[n]) for n in names}, window, window)
write_tiff("half.tif", [[(1,)] * 8] * 8, halves=True)
write_tiff("float.tif", [[(1,)] * 8] * 8)
PY
cat >look.py <<'PY'
import os
import bpy

scene = bpy.context.scene
scene.render.engine, scene.cycles.device, scene.cycles.samples = "CYCLES", "CPU", 1
scene.cycles.use_denoising = False
scene.render.resolution_x = scene.render.resolution_y = 4
scene.render.threads_mode, scene.render.threads = "FIXED", 1
scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
for thing in list(bpy.data.objects):
    bpy.data.objects.remove(thing)
bpy.ops.mesh.primitive_plane_add(size=2)
plane = bpy.context.object
camera = bpy.data.cameras.new("camera")
camera.type, camera.ortho_scale = "ORTHO", 1
scene.camera = bpy.data.objects.new("camera", camera)
scene.camera.location = (0, 0, 3)
scene.collection.objects.link(scene.camera)
material = bpy.data.materials.new("material")
material.use_nodes = True
plane.data.materials.append(material)
nodes, links = material.node_tree.nodes, material.node_tree.links
nodes.clear()
texture, light, output = (nodes.new("ShaderNode" + n) for n in ("TexImage", "Emission", "OutputMaterial"))
links.new(texture.outputs["Color"], light.inputs["Color"])
links.new(light.outputs["Emission"], output.inputs["Surface"])


def said(pixels):
    return " ".join(str(round(v, 2)) for v in pixels[:3]) or "nothing"


for file in ("xyz.exr", "alone.exr", "layer.exr", "rg.exr", "half.tif", "float.tif"):
    image = bpy.data.images.load(os.path.abspath(file))
    image.colorspace_settings.name = "Non-Color"
    texture.image = image
    scene.render.filepath = os.path.abspath("rendered.exr")
    bpy.ops.render.render(write_still=True)
    rendered = bpy.data.images.load(scene.render.filepath)
    rendered.colorspace_settings.name = "Non-Color"
    print("seen:", file, said(image.pixels), "and", said(rendered.pixels))
    bpy.data.images.remove(rendered)
PY
blender -b -noaudio --factory-startup --python look.py >said 2>&1
grep -q ^seen: said || skip "Blender does not start: $(tail -n 1 said)"
seen() { sed -n "s/^seen: $1 //p" said; }
expect "X 0.1, Y 0.2, Z 0.3" "$(seen xyz.exr)" "0.2 0.2 0.2 and 0.1 0.2 0.3"
expect "roughness 0.6" "$(seen alone.exr)" "0.0 0.0 0.0 and 0.6 0.6 0.6"
expect "stone.R 0.7, stone.G 0.8, stone.B 0.9" "$(seen layer.exr)" "nothing and 0.7 0.8 0.9"
expect "R 0.1, G 0.2" "$(seen rg.exr)" "0.1 0.2 0.0 and 0.1 0.1 0.1"
expect "half TIFF of 1" "$(seen half.tif)" "0.23 0.23 0.23 and 1.0 1.0 1.0"
expect "float TIFF of 1" "$(seen float.tif)" "1.0 1.0 1.0 and 1.0 1.0 1.0"
finish
