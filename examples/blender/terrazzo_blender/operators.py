import os

import bpy
import numpy

from . import editor, graph_file, graphs, jobs, making, masks, program, requests, settings as panel
from .preferences import preferences

PROBLEMS = (requests.RequestError, program.ProgramError, graph_file.GraphError, ValueError, OSError)


class Action(bpy.types.Operator):
    """What can go wrong is told as Blender's own operators tell it."""
    bl_options = {"INTERNAL"}

    def execute(self, context):
        try:
            return self.act(context, context.scene.terrazzo) or {"FINISHED"}
        except PROBLEMS as e:
            self.report({"ERROR"}, str(e))
            return {"CANCELLED"}


class TERRAZZO_OT_make(Action):
    bl_idname, bl_label = "terrazzo.make", "Make more"
    bl_description = "Makes a larger material from the source, beside the old one"

    def act(self, context, settings):
        requests.start_make(settings, context.object)


class TERRAZZO_OT_watch(Action):
    bl_idname, bl_label = "terrazzo.watch", "Watch"
    bl_description = "Makes more, and again whenever the graph or a map changes on disk, until it is cancelled"

    def act(self, context, settings):
        requests.start_make(settings, context.object, watch=True)


class TERRAZZO_OT_another_seed(Action):
    bl_idname, bl_label = "terrazzo.another_seed", "Another seed"
    bl_description = "Makes another arrangement of the same exemplar"

    def act(self, context, settings):
        if not settings.use_graph:
            settings.seed += 1
        else:
            panel.set_field(settings.parameters["seed"], str(requests.graph_seed(settings) + 1))
        requests.start_make(settings, context.object)


class TERRAZZO_OT_best_of_eight(Action):
    bl_idname, bl_label = "terrazzo.best_of_eight", "Best of eight"
    bl_description = "Makes lit pictures of eight seeds to choose from"

    def act(self, context, settings):
        requests.start_choices(settings, context.object)


class TERRAZZO_OT_choose(Action):
    bl_idname, bl_label = "terrazzo.choose", "Make this one"
    bl_description = "Makes the material with this seed; what has been computed for its picture is reused"
    seed: bpy.props.IntProperty()

    def act(self, context, settings):
        if settings.use_graph:
            panel.set_field(settings.parameters["seed"], str(self.seed))
        else:
            settings.seed = self.seed
        requests.start_make(settings, context.object)


class TERRAZZO_OT_cancel(Action):
    bl_idname, bl_label = "terrazzo.cancel", "Cancel"
    bl_description = "Ends the run; no partial files are left"
    index: bpy.props.IntProperty()

    def act(self, _context, _settings):
        if self.index < len(jobs.jobs):
            jobs.jobs[self.index].cancel()


class TERRAZZO_OT_measure(Action):
    bl_idname, bl_label = "terrazzo.measure", "As dense as now"
    bl_description = "Sets the pixels per metre that the object shows now"

    def act(self, context, settings):
        material = context.object.active_material if context.object else None
        settings.density = requests.density_now(context.object, requests.picked_from(material))


class TERRAZZO_OT_read_graph(Action):
    bl_idname, bl_label = "terrazzo.read_graph", "Read graph"
    bl_description = "Reads the graph's exposed parameters and presets"

    def act(self, _context, settings):
        graphs.read_into(settings)


class TERRAZZO_OT_edit(Action):
    bl_idname, bl_label = "terrazzo.edit", "Open the editor"
    bl_description = ("Opens the graph in the browser, and updates the material whenever it is changed there. If there is no "
                      "graph of your own yet, one is made of these settings")

    def act(self, context, settings):
        editor.start(settings, context.object)


class TERRAZZO_OT_check_program(Action):
    bl_idname, bl_label = "terrazzo.check_program", "Check the program"
    bl_description = "Says which program is used, and its version"

    def act(self, _context, _settings):
        path = program.find(preferences().program)
        version = program.require(path, 5)
        self.report({"INFO"}, f"{path}: terrazzo {'.'.join(str(n) for n in version)}")


class TERRAZZO_OT_bake_mask(Action):
    bl_idname, bl_label = "terrazzo.bake_mask", "Bake mask"
    bl_description = "Draws the selected faces or the vertex colors into a picture, through the UV map"
    parameter: bpy.props.StringProperty(description="The graph's parameter that gets the picture")

    def act(self, context, settings):
        target = context.object
        chosen, _, uvs = requests.triangles(target, None)
        if settings.mask_from == "SELECTED":
            faces = target.data.polygons
            values = [[1.0 if faces[t.polygon_index].select else 0.0] * 3 for t in chosen]
            if not any(v[0] for v in values):
                raise requests.RequestError("No face is selected: select some in Edit Mode.")
        else:
            values = brightness(target.data, chosen)
        if settings.mask_over == "EXEMPLAR":
            uvs = in_exemplar(uvs, requests.picked_from(requests.original_of(target.active_material)))
        folder = requests.new_folder(target.name + "-mask")
        path = os.path.join(folder, "mask.png")
        masks.write_png(path, masks.draw(uvs, values, tuple(settings.mask_size)))
        if self.parameter in settings.parameters:
            panel.set_field(settings.parameters[self.parameter], path)
            settings.parameters[self.parameter].baked = path if settings.mask_over == "RESULT" else ""
        self.report({"INFO"}, "wrote " + path)


def in_exemplar(uvs, picked):
    """UVs as the Mapping node of the old material places them."""
    if picked.rotation:
        raise requests.RequestError("The Mapping of the material is turned: masks over the exemplar need one that is not.")
    return uvs * numpy.array(picked.scale) + numpy.array(picked.offset)


def brightness(mesh, chosen):
    from .compat import corner_colors
    attribute = mesh.color_attributes.active_color
    if attribute is None:
        raise requests.RequestError(f"'{mesh.name}' has no color attribute: paint one in Vertex Paint.")
    colors = numpy.array(corner_colors(mesh, attribute)).reshape(-1, 4)
    grey = colors[:, :3] @ (0.2126, 0.7152, 0.0722)
    return grey[[list(t.loops) for t in chosen]]


class TERRAZZO_OT_add_result(Action):
    bl_idname, bl_label = "terrazzo.add_result", "Add result"
    bl_description = "Makes a material of a folder that terrazzo has written"
    directory: bpy.props.StringProperty(subtype="DIR_PATH")

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def act(self, context, _settings):
        material = making.add_result(bpy.path.abspath(self.directory))
        if context.object is not None and hasattr(context.object.data, "materials"):
            context.object.data.materials.append(material)
        else:
            material.use_fake_user = True


CLASSES = (TERRAZZO_OT_make, TERRAZZO_OT_watch, TERRAZZO_OT_another_seed, TERRAZZO_OT_best_of_eight, TERRAZZO_OT_choose,
           TERRAZZO_OT_cancel, TERRAZZO_OT_measure, TERRAZZO_OT_read_graph, TERRAZZO_OT_edit, TERRAZZO_OT_check_program,
           TERRAZZO_OT_bake_mask, TERRAZZO_OT_add_result)
