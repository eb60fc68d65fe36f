# Samples the exemplar through the uv map: instead of each map of the result, only the exemplar's maps and one image that
# says for each pixel of the result which pixel of the exemplar it shows.
import bpy

from . import compat

STEPS = 65535  # of the 16 bits of the uv map


def insert(material, uv_path):
    """Puts a group between the Mapping and the images, which are those of the exemplar."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    mapping = next(n for n in nodes if n.type == "MAPPING")
    images = [n for n in nodes if n.type == "TEX_IMAGE"]
    uv = bpy.data.images.load(uv_path)
    uv.colorspace_settings.name = "Non-Color"
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
    # The uv map counts from the top left, Blender from the bottom left: (x + 0.5) / width, 1 - (y + 0.5) / height.
    scale = nodes.new("ShaderNodeVectorMath")
    scale.operation = "MULTIPLY_ADD"
    width, height = exemplar_size
    scale.inputs[1].default_value = (STEPS / width, -STEPS / height, 0)
    scale.inputs[2].default_value = (0.5 / width, 1 - 0.5 / height, 0)
    links.new(image.outputs["Color"], scale.inputs[0])
    links.new(scale.outputs[0], end.inputs["Vector"])
    for i, node in enumerate((start, image, scale, end)):
        node.location = (250 * i, 0)
    return group
