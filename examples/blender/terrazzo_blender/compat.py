# In what versions of Blender differ, 3.4 to 4, for the add-on. (build_material.py stands alone, and asks for itself.)
import bpy


def linear_space():
    """The name of linear Rec.709, which was "Linear" before 4."""
    names = bpy.types.ColorManagedInputColorspaceSettings.bl_rna.properties["name"].enum_items.keys()
    return next((n for n in ("Linear Rec.709", "Linear") if n in names), "Non-Color")


def copy_render_settings(old, new):
    """How a material is displaced and blended: properties that have moved between versions."""
    for name in ("blend_method", "shadow_method", "surface_render_method", "displacement_method", "use_backface_culling",
                 "alpha_threshold"):
        copy_property(old, new, name)
    if hasattr(old, "cycles"):
        copy_property(old.cycles, new.cycles, "displacement_method")  # before 4.1


def copy_property(old, new, name):
    if hasattr(old, name):
        try:
            setattr(new, name, getattr(old, name))
        except (AttributeError, TypeError):
            pass  # read-only in this version


def is_rendering():
    """Data must not change while a render reads it."""
    ask = getattr(bpy.app, "is_job_running", None)
    return bool(ask and ask("RENDER"))


def new_group_sockets(group, inputs, outputs):
    """Sockets of a node group: [(name, type)]."""
    for names, way in ((inputs, "INPUT"), (outputs, "OUTPUT")):
        for name, kind in names:
            if hasattr(group, "interface"):
                group.interface.new_socket(name, in_out=way, socket_type=kind)
            else:
                (group.inputs if way == "INPUT" else group.outputs).new(kind, name)


def corner_colors(mesh, attribute):
    """RGBA of every corner of a color attribute, as a flat list."""
    values = [0.0] * (len(attribute.data) * 4)
    attribute.data.foreach_get("color", values)
    if attribute.domain == "CORNER":
        return values
    out = []
    for loop in mesh.loops:
        out += values[4 * loop.vertex_index:4 * loop.vertex_index + 4]
    return out
