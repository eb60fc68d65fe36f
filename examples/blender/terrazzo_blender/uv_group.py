# Samples the exemplar through the uv map: instead of each map of the result, only the exemplar's maps and one image that
# says for each pixel of the result which pixel of the exemplar it shows.
import os

import bpy

from . import compat, uv_file

BYTE = 255  # a byte as Blender reads it is from 0 to 1


def prepare(files):
    """Repacks the uv map among the files of a run, outside of Blender's main thread."""
    uv = next(f for f in files if os.path.basename(f) == "uv.tif")
    uv_file.repack(uv, uv[:-4] + ".png")


def insert(material, uv_path):
    """Puts a group between the Mapping and the images, which are those of the exemplar."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    mapping = next(n for n in nodes if n.type == "MAPPING")
    images = [n for n in nodes if n.type == "TEX_IMAGE"]
    uv = bpy.data.images.load(uv_path)
    uv.colorspace_settings.name = "Non-Color"
    uv.alpha_mode = "CHANNEL_PACKED"  # alpha is a byte of y
    if bpy.data.filepath and bpy.context.preferences.filepaths.use_relative_paths:
        uv.filepath = bpy.path.relpath(uv_path)
    node = nodes.new("ShaderNodeGroup")
    node.location, node.label = (-1000, 250), "uv map"
    node.node_tree = make_group(uv, tuple(images[0].image.size))
    links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    for image in images:
        # Only exactly the pixel that the uv map names: filters would reach over the seams of pieces.
        image.interpolation = "Closest"
        links.new(node.outputs["Vector"], image.inputs["Vector"])


def result_size(material):
    for node in material.node_tree.nodes:
        if node.type == "GROUP" and node.node_tree is not None and node.label == "uv map":
            return tuple(next(n for n in node.node_tree.nodes if n.type == "TEX_IMAGE").image.size)
    return (0, 0)


def make_group(uv, exemplar_size):
    group = bpy.data.node_groups.new("terrazzo uv map", "ShaderNodeTree")
    compat.new_group_sockets(group, [("Vector", "NodeSocketVector")], [("Vector", "NodeSocketVector")])
    nodes, links = group.nodes, group.links
    start, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    image = nodes.new("ShaderNodeTexImage")
    image.image, image.interpolation = uv, "Closest"
    links.new(start.outputs["Vector"], image.inputs["Vector"])
    bytes = nodes.new("ShaderNodeSeparateColor")
    links.new(image.outputs["Color"], bytes.inputs[0])
    whole = nodes.new("ShaderNodeCombineXYZ")
    # The uv map counts from the top left, Blender from the bottom left: (x + 0.5) / width, 1 - (y + 0.5) / height.
    places = ((bytes.outputs[0], bytes.outputs[1], 1 / exemplar_size[0], 0),
              (bytes.outputs[2], image.outputs["Alpha"], -1 / exemplar_size[1], 1))
    for axis, (high, low, step, start_at) in enumerate(places):
        sum = start_at + step / 2
        for value, factor in ((low, BYTE * step), (high, BYTE * 256 * step)):
            node = nodes.new("ShaderNodeMath")
            node.operation, node.location = "MULTIPLY_ADD", (600 + 200 * (factor != BYTE * step), -200 * axis)
            node.inputs[1].default_value = factor
            links.new(value, node.inputs[0])
            if isinstance(sum, float):
                node.inputs[2].default_value = sum
            else:
                links.new(sum, node.inputs[2])
            sum = node.outputs[0]
        links.new(sum, whole.inputs[axis])
    links.new(whole.outputs[0], end.inputs["Vector"])
    for node, x in ((start, -250), (image, 0), (bytes, 350), (whole, 1000), (end, 1250)):
        node.location = (x, 0)
    return group
