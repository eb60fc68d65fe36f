# Makes a material from maps, for Blender 2.8 to 4: inputs of the Principled BSDF have had several names. The add-on and
# the scripts of the export preset "blender" share it, so it uses nothing but bpy.
import os

import bpy


def gltf_occlusion_group():
    """The group whose input Occlusion the exporter of glTF reads; Cycles and EEVEE have no place for occlusion."""
    name = "glTF Material Output"
    if name not in bpy.data.node_groups:
        group = bpy.data.node_groups.new(name, "ShaderNodeTree")
        if hasattr(group, "interface"):
            group.interface.new_socket("Occlusion", in_out="INPUT", socket_type="NodeSocketFloat")
        else:
            group.inputs.new("NodeSocketFloat", "Occlusion")
        group.nodes.new("NodeGroupOutput")
        group.nodes.new("NodeGroupInput").location = (-200, 0)
    return bpy.data.node_groups[name]


def build_material(name, folder, files, repeats=(1, 1), relief=0, offset=(0, 0), bump=0):
    """files: by map, {"file", "color_space": "sRGB" or "Non-Color", and, if it has only a part of the file,
    "channel": "r", "g", "b" or "a", "inverted": true, "normal_y": "down"}. repeats and offset: Scale and Location of the
    Mapping node. relief: distance from height 0 to height 1, in units of the object; 0 leaves displacement out. bump:
    the same for a Bump node."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    surface = next(n for n in nodes if n.type == "BSDF_PRINCIPLED")
    output = next(n for n in nodes if n.type == "OUTPUT_MATERIAL")
    images = {}

    def new(kind, x, y):
        node = nodes.new(kind)
        node.location = (x, y)
        return node

    coordinates = new("ShaderNodeTexCoord", -1300, 0)
    mapping = new("ShaderNodeMapping", -1100, 0)
    mapping.inputs["Location"].default_value = (offset[0], offset[1], 0)
    mapping.inputs["Scale"].default_value = (repeats[0], repeats[1], 1)
    links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])

    def one_minus(value, x, y):
        difference = new("ShaderNodeMath", x, y)
        difference.operation = "SUBTRACT"
        difference.inputs[0].default_value = 1
        links.new(value, difference.inputs[1])
        return difference.outputs[0]

    def image(map):
        entry = files[map]
        place = (entry["file"], entry["color_space"])
        row = 300 - 280 * len(images)
        if place not in images:
            node = new("ShaderNodeTexImage", -850, row)
            node.label = map
            node.image = bpy.data.images.load(os.path.join(folder, entry["file"]))
            node.image.colorspace_settings.name = entry["color_space"]
            if any(f["file"] == entry["file"] and f.get("channel") == "a" for f in files.values()):
                node.image.alpha_mode = "CHANNEL_PACKED"  # alpha is a map of its own: do not multiply by it
            links.new(mapping.outputs["Vector"], node.inputs["Vector"])
            images[place] = node
        node = images[place]
        color, channel = node.outputs["Color"], entry.get("channel", "")
        if channel == "a":
            color = node.outputs["Alpha"]
        elif channel or entry.get("normal_y") == "down":
            separate = new("ShaderNodeSeparateColor", -550, row)
            links.new(color, separate.inputs[0])
            if channel:
                color = separate.outputs["rgb".index(channel)]
            else:
                combine = new("ShaderNodeCombineColor", -370, row)
                for i in (0, 2):
                    links.new(separate.outputs[i], combine.inputs[i])
                links.new(one_minus(separate.outputs[1], -460, row - 150), combine.inputs[1])
                color = combine.outputs[0]
        return one_minus(color, -370, row) if entry.get("inverted") else color

    def connect(map, *names):
        if map in files:
            links.new(image(map), surface.inputs[next(n for n in names if n in surface.inputs)])

    connect("base_color", "Base Color")
    connect("roughness", "Roughness")
    connect("metallic", "Metallic")
    connect("opacity", "Alpha")
    connect("emission", "Emission Color", "Emission")
    if "emission" in files and "Emission Strength" in surface.inputs:
        surface.inputs["Emission Strength"].default_value = 1
    if "normal" in files:
        normal = new("ShaderNodeNormalMap", -250, -300)
        links.new(image("normal"), normal.inputs["Color"])
        links.new(normal.outputs["Normal"], surface.inputs["Normal"])
    if "height" in files and bump > 0:
        bumps = new("ShaderNodeBump", -250, -550)
        bumps.inputs["Distance"].default_value = bump
        links.new(image("height"), bumps.inputs["Height"])
        if "normal" in files:
            links.new(normal.outputs["Normal"], bumps.inputs["Normal"])
        links.new(bumps.outputs["Normal"], surface.inputs["Normal"])
    if "height" in files and relief > 0:
        displacement = new("ShaderNodeDisplacement", 100, -550)
        displacement.inputs["Midlevel"].default_value = 0
        displacement.inputs["Scale"].default_value = relief
        links.new(image("height"), displacement.inputs["Height"])
        links.new(displacement.outputs["Displacement"], output.inputs["Displacement"])
    if "ambient_occlusion" in files:
        group = new("ShaderNodeGroup", 100, 500)
        group.node_tree = gltf_occlusion_group()
        links.new(image("ambient_occlusion"), group.inputs["Occlusion"])
    return material
