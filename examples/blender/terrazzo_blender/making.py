# Makes or updates materials when runs are done. All in Blender's main thread.
import json
import os
import shutil

import bpy

from . import build_material, compat, result, surface, tree, uv_group

KEY = "terrazzo"  # the custom property of materials that were made
choices = {"pictures": {}}  # a file for each seed


def stored_request(material):
    try:
        found = json.loads(material.get(KEY, "{}"))
        return found if isinstance(found, dict) else {}
    except (TypeError, ValueError):
        return {}


def finish(job):
    """A run is complete: makes its material, or updates the one that an earlier run of a watched graph has made."""
    found = result.from_files(job.progress.files)
    for entry in found.files.values():
        if entry["color_space"] == "Linear":
            entry["color_space"] = compat.linear_space()
    old = bpy.data.materials.get(job.request["source"])
    before = bpy.data.materials.get(job.made) if job.made else None
    if before is not None and files_of(before) >= {e["file"] for e in found.files.values()}:
        reload_images(before, found.folder)
        place(before, job, found, old)
    else:
        material = make(job, found, old)
        if before is not None:
            name = before.name
            before.user_remap(material)
            bpy.data.materials.remove(before)
            material.name = name
        elif job.request["assign"]:
            assign(material, old, job.request["object"])
        if material.users == 0:
            material.use_fake_user = True  # it is saved although nothing shows it
        job.made = material.name
    if not bpy.app.background:
        bpy.ops.ed.undo_push(message="terrazzo: " + job.title)


def discard(folder):
    """Removes what a run that has failed leaves in its new folder: links or copies of the exemplar."""
    shutil.rmtree(os.path.join(folder, "exemplar"), ignore_errors=True)
    for remove, name in ((os.remove, "seeds.json"), (os.rmdir, "")):
        try:
            remove(os.path.join(folder, name))
        except OSError:
            pass  # it is not there, or not empty


def make(job, found, old):
    request = job.request
    picked = picked_of(old)
    relief = request["relief"] or (picked.relief if picked else 0)
    bump = picked.bump if picked and not request["relief"] else 0
    title = f"{request['title']} seed {request['seed']}" if request["seed"] != "" else f"{request['title']} more"
    material = build_material.build_material(title, found.folder, found.files, relief=max(relief, 0), bump=max(bump, 0))
    for node in images_of(material):
        if bpy.data.filepath and bpy.context.preferences.filepaths.use_relative_paths:
            node.image.filepath = bpy.path.relpath(node.image.filepath)
    if request["as_uv"]:
        uv_group.insert(material, os.path.join(found.folder, "uv.png"))
    if picked is not None:
        job.messages += carry_over(old, picked, material, found)
    material[KEY] = json.dumps({k: request[k] for k in ("source", "out", "seed", "title")})
    place(material, job, found, old)
    return material


def picked_of(material):
    try:
        return tree.pick(material.node_tree) if material is not None and material.use_nodes else None
    except ValueError:
        return None


def carry_over(old, picked, material, found):
    """Takes over from the old material what maps do not say. Returns notes."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    target = next(n for n in nodes if n.type == "BSDF_PRINCIPLED")
    notes = []
    taken = {n for m in found.files for n in tree.MAPS.get(m, ("Normal",))}
    for socket in picked.surface.inputs:
        new = target.inputs.get(socket.name)
        if new is None or new.links or not hasattr(socket, "default_value"):
            continue
        new.default_value = socket.default_value
        if socket.links and socket.name not in taken:
            notes.append(f"'{socket.name}' comes from other nodes than images; they are not in the new material.")
    for node in nodes:
        if node.type == "NORMAL_MAP":
            node.inputs["Strength"].default_value = picked.normal_strength
        elif node.type == "DISPLACEMENT":
            node.inputs["Midlevel"].default_value = picked.midlevel
    if picked.multiplies_occlusion and "ambient_occlusion" in found.files and target.inputs["Base Color"].links:
        multiply_occlusion(nodes, links, target)
    compat.copy_render_settings(old, material)
    return notes


def multiply_occlusion(nodes, links, target):
    group = next(n for n in nodes if n.type == "GROUP" and "Occlusion" in n.inputs)
    mix = nodes.new("ShaderNodeMixRGB")
    mix.location, mix.blend_type = (-250, 300), "MULTIPLY"
    mix.inputs["Fac"].default_value = 1
    links.new(target.inputs["Base Color"].links[0].from_socket, mix.inputs["Color1"])
    links.new(group.inputs["Occlusion"].links[0].from_socket, mix.inputs["Color2"])
    links.new(mix.outputs["Color"], target.inputs["Base Color"])


def images_of(material):
    return [n for n in material.node_tree.nodes if n.type == "TEX_IMAGE" and n.image is not None]


def files_of(material):
    return {os.path.basename(bpy.path.abspath(n.image.filepath)) for n in images_of(material)}


def reload_images(material, folder):
    images = [n.image for n in images_of(material)]
    for node in material.node_tree.nodes:
        if node.type == "GROUP" and node.node_tree is not None:
            images += [n.image for n in node.node_tree.nodes if n.type == "TEX_IMAGE" and n.image is not None]
    for image in images:
        if os.path.dirname(bpy.path.abspath(image.filepath)) == os.path.abspath(folder):
            image.reload()


def place(material, job, found, old):
    """Sets the Mapping so that the surface keeps its scale, or as it fits the object."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    mapping = next((n for n in nodes if n.type == "MAPPING"), None)
    if mapping is None:
        return
    picked = picked_of(old)
    request = job.request
    if "scale" in request:
        set_mapping(mapping, request["scale"], request["offset"], 0)
    else:
        size = uv_group.result_size(material) if request["as_uv"] else tuple(images_of(material)[0].image.size)
        exemplar = job.progress.sizes.get("exemplar")
        if exemplar is None and picked is not None:
            exemplar = max(tuple(u.image.size) for u in picked.maps.values())
        scale = surface.scale_of(size, exemplar or size, picked.scale if picked else (1, 1)) if min(size) > 0 else (1, 1)
        factor = [s / r if r else 1 for s, r in zip(scale, picked.scale if picked else (1, 1))]
        offset = [f * o for f, o in zip(factor, picked.offset if picked else (0, 0))]
        set_mapping(mapping, scale, offset, picked.rotation if picked else 0)
        if picked and picked.rotation and abs(factor[0] - factor[1]) > 1e-6:
            job.messages.append("The old Mapping is turned, and the result has other proportions: check the new Mapping.")
    if picked and picked.uv_layer and not any(n.type == "UVMAP" for n in nodes):
        layer = nodes.new("ShaderNodeUVMap")
        layer.uv_map, layer.location = picked.uv_layer, (-1300, -250)
        links.new(layer.outputs["UV"], mapping.inputs["Vector"])


def set_mapping(mapping, scale, offset, rotation):
    mapping.inputs["Scale"].default_value = (scale[0], scale[1], 1)
    mapping.inputs["Location"].default_value = (offset[0], offset[1], 0)
    mapping.inputs["Rotation"].default_value[2] = rotation


def assign(material, old, object_name):
    """Puts the new material into the slots of the object that show the old one, or an earlier result of it."""
    target = bpy.data.objects.get(object_name)
    if target is None or not hasattr(target.data, "materials"):
        return
    family = {m for m in bpy.data.materials if old is not None and (m == old or stored_request(m).get("source") == old.name)}
    slots = [s for s in target.material_slots if s.material in family]
    if not slots and not target.material_slots:
        target.data.materials.append(material)
        return
    for slot in slots or [target.material_slots[target.active_material_index]]:
        if slot.material is not None:
            slot.material.use_fake_user = True  # it stays in the file without a user
        slot.material = material


def offer_choices(job):
    """A picture of each seed is there to choose from."""
    choices["pictures"] = {s: picture_in(os.path.join(job.request["out"], str(s))) for s in job.request["seeds"]}


def picture_in(folder):
    """A lit picture, or the first of the maps that a graph of one's own has written. Raises ValueError."""
    lit = os.path.join(folder, "lit.png")
    if os.path.isfile(lit):
        return lit
    found = result.from_files([os.path.join(f, n) for f, _, names in os.walk(folder) for n in names])
    first = next(m for m in result.NAMES if m in found.files)
    return os.path.join(found.folder, found.files[first]["file"])


def add_result(folder):
    """A material from a folder that an earlier run has written. Raises ValueError."""
    found = result.read(folder)
    for entry in found.files.values():
        if entry["color_space"] == "Linear":
            entry["color_space"] = compat.linear_space()
    return build_material.build_material(found.name, folder, found.files)
