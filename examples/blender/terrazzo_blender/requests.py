# From the panel's settings to a run: where files go, what the exemplar is, how large the result shall be.
import os
import re

import bpy
import numpy

from . import command, graphs, jobs, making, program, settings as panel, sources, surface, tree, uv_group
from .preferences import preferences

CHOICES = 8


class RequestError(Exception):
    """What was asked for cannot be done; the message says why."""


def options():
    p = preferences()
    return command.limits(bpy.path.abspath(p.cache) if p.cache else "", p.memory, p.threads)


def results_folder():
    """Beside the Blender file; of one that was never saved, in Blender's data folder, which outlives the session."""
    place = preferences().results
    if place.startswith("//") and not bpy.data.filepath:
        return bpy.utils.user_resource("DATAFILES", path="terrazzo", create=True)
    return bpy.path.abspath(place)


def file_stem(name):
    return re.sub(r"[^\w.-]+", "_", name).strip("._") or "material"


def new_folder(name, root=""):
    """A folder that no other run uses, in the folder of results if no other is given."""
    root = root or results_folder()
    stem = file_stem(name)
    for number in range(1, 100000):
        folder = os.path.join(root, f"{stem}-{number:02}")
        try:
            os.makedirs(folder)
            return folder
        except FileExistsError:
            continue
        except OSError as e:
            raise RequestError(f"The folder {folder} cannot be made: {e.strerror}. The add-on's preferences name another.")
    raise RequestError(f"The folder {root} is full of results.")


def file_of(image):
    return bpy.path.abspath(image.filepath, library=image.library)


def original_of(material):
    """What a material was made from, if that is still there: another result comes from the same exemplar."""
    for _ in range(100):
        origin = making.stored_request(material).get("source", "") if material else ""
        if not origin or origin not in bpy.data.materials or bpy.data.materials[origin] == material:
            break
        material = bpy.data.materials[origin]
    return material


def picked_from(material):
    if material is None:
        raise RequestError("There is no active material. Select an object that has one, or choose a folder of maps.")
    if not material.use_nodes:
        raise RequestError(f"The material '{material.name}' does not use nodes.")
    try:
        return tree.pick(material.node_tree)
    except ValueError as e:
        raise RequestError(str(e))


def density_now(object, picked):
    """The pixels per metre that an object shows of its material."""
    if picked is None:
        raise RequestError("How densely the object shows the maps of a folder is not known: choose another size than 'Fit "
                           "object'.")
    pixels = max(tuple(u.image.size) for u in picked.maps.values())
    if min(pixels) == 0:
        raise RequestError("The images of the material cannot be opened.")
    return surface.density_now(measured(object, object.active_material), pixels, picked.scale)


def triangles(object, material):
    """Corners in metres and in the UV plane of the triangles of an object that have a material (or all)."""
    if object is None or object.type != "MESH":
        raise RequestError("The active object is no mesh, whose UVs say how large it is. Select a mesh, or choose another size.")
    if object.mode == "EDIT":
        object.update_from_editmode()
    mesh = object.data
    if mesh.uv_layers.active is None:
        raise RequestError(f"'{object.name}' has no UV map: unwrap it first (in Edit Mode: UV > Unwrap).")
    mesh.calc_loop_triangles()
    slots = {i for i, s in enumerate(object.material_slots) if s.material == material} if material else None
    chosen = [t for t in mesh.loop_triangles if slots is None or not slots or t.material_index in slots]
    matrix = numpy.array(object.matrix_world)
    points = numpy.empty(len(mesh.vertices) * 3)
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3) @ matrix[:3, :3].T * bpy.context.scene.unit_settings.scale_length
    uvs = numpy.empty(len(mesh.loops) * 2)
    mesh.uv_layers.active.data.foreach_get("uv", uvs)
    uvs = uvs.reshape(-1, 2)
    return (chosen, points[[list(t.vertices) for t in chosen]] if chosen else numpy.empty((0, 3, 3)),
            uvs[[list(t.loops) for t in chosen]] if chosen else numpy.empty((0, 3, 2)))


def measured(object, material):
    _, points, uvs = triangles(object, material)
    try:
        return surface.measure(points, uvs)
    except ValueError as e:
        raise RequestError(str(e))


class Source:
    """The exemplar: a material with its picked images, or a folder."""

    def __init__(self, settings, object):
        self.material = self.picked = None
        self.folder = ""
        self.name = settings.name
        if settings.source == "FOLDER":
            self.folder = bpy.path.abspath(settings.folder)
            if not settings.folder or not os.path.isdir(self.folder):
                raise RequestError(f"There is no folder {self.folder}." if settings.folder else "Choose a folder of maps.")
            self.title = settings.name or os.path.basename(os.path.normpath(self.folder))
        else:
            self.material = original_of(object.active_material if object else None)
            self.picked = picked_from(self.material)
            self.title = self.material.name

    def gather(self, folder):
        """The folder of the exemplar's maps, and notes."""
        if self.folder:
            return self.folder, []
        try:
            target = os.path.join(folder, "exemplar")
            return target, self.picked.notes + sources.gather(self.picked.maps, target, file_of, self.title)
        except sources.SourceError as e:
            raise RequestError(str(e))
        except OSError as e:
            raise RequestError(f"The maps cannot be gathered in {folder}: {e}")


def start_make(settings, object, watch=False):
    program.find(preferences().program)
    source = Source(settings, object)
    request = {"source": source.material.name if source.material else "", "object": object.name if object else "",
               "assign": settings.assign, "relief": settings.relief, "title": source.title,
               "as_uv": settings.as_uv and not settings.use_graph}
    if settings.use_graph:
        return start_graph(settings, source, request, watch)
    values, notes = values_of(settings, object, source, request)
    request["seed"] = values["seed"]
    folder = new_folder(source.title)
    values["material"], more = source.gather(folder)
    values["write"] = "uv" if request["as_uv"] else "maps"
    values["out"] = request["out"] = folder
    job = jobs.start(f"{source.title}, seed {values['seed']}", command.make(values, watch, options()),
                     preferences().program, request, making.finish, making.discard,
                     uv_group.prepare if request["as_uv"] else None)
    job.messages = notes + more
    return job


def values_of(settings, object, source, request):
    """Values for material.json, but material and out, and notes. The Mapping goes to the request where the object decides."""
    if settings.as_uv and settings.method == "noise":
        raise RequestError("Noise blends samples, so it has no uv map: choose the method Layout.")
    values, notes = panel.values_of(settings), []
    if source.name and source.folder:
        values["name"] = source.name
    if settings.size_by == "FACTOR":
        values["scale"] = round(settings.factor, 5)
    elif settings.size_by == "PIXELS":
        values["size"] = list(settings.size)
    else:
        shown = measured(object, object.active_material if object else None)
        density = settings.density if settings.size_by == "DENSITY" else density_now(object, source.picked)
        fit = surface.fit(shown, density, settings.most)
        values["size"] = list(fit.size)
        request["scale"], request["offset"] = list(fit.scale), list(fit.offset)
        notes = fit.notes
        if fit.repeats and values["tileable"] != "xy":
            values["tileable"] = "xy"
            notes.append("It is made tileable for that.")
        if not fit.repeats:
            notes.append("{} x {} pixels cover the object once.".format(*fit.size))
    return values, notes


def start_graph(settings, source, request, watch):
    folder = new_folder(source.title)
    path, values, notes = graph_values(settings, source, folder)
    if any(p.baked and p.value() == p.baked for p in settings.parameters):
        request["scale"], request["offset"] = [1, 1], [0, 0]  # where the mask was painted
    request["out"], request["seed"] = folder, values.get("seed", "")
    if watch:
        request["watched"] = path
    job = jobs.start(f"{source.title}, {os.path.basename(path)}",
                     command.run(path, values, watch, settings.preset, options()), preferences().program, request,
                     making.finish, making.discard)
    job.messages = notes
    return job


def graph_values(settings, source, folder):
    """A graph of one's own, values of its parameters, and notes. folder: for what it writes."""
    graphs.read_into(settings)
    values, notes = panel.graph_values(settings), []
    for parameter in settings.parameters:
        if parameter.role == "source":
            values[parameter.name], notes = source.gather(folder)
        elif parameter.role == "out":
            values[parameter.name] = folder
    return graphs.path_of(settings), values, notes


def start_choices(settings, object):
    """Pictures of several seeds, in a folder that goes when Blender ends."""
    program.find(preferences().program)
    source = Source(settings, object)
    folder = new_folder(source.title + "-choices", bpy.app.tempdir)
    table = os.path.join(folder, "seeds.json")
    if settings.use_graph:
        path, values, notes = graph_values(settings, source, folder)
        seeds = seeds_from(graph_seed(settings))
        out = next((p.name for p in settings.parameters if p.role == "out"), "")
        if not out:
            raise RequestError("The graph has no parameter 'out' for the folder that it writes to.")
        arguments = command.variations(path, values, seeds, table, out, settings.preset, options())
    else:
        values, notes = values_of(settings, object, source, {})
        values["material"], more = source.gather(folder)
        notes, seeds = notes + more, seeds_from(settings.seed)
        arguments = command.choices({**values, "out": folder}, seeds, table, options())
    job = jobs.start(f"{source.title}, eight seeds", arguments, preferences().program,
                     {"out": folder, "title": source.title, "seeds": seeds}, making.offer_choices, making.discard)
    job.messages = notes
    return job


def graph_seed(settings):
    """The seed of a graph of one's own."""
    field = settings.parameters.get("seed")
    text = (field.value() or field.default) if field is not None else ""
    if not text.isdigit():
        raise RequestError("The graph has no parameter 'seed' that is a number.")
    return int(text)


def seeds_from(first):
    return list(range(first, first + CHOICES))
