import textwrap

import bpy
import bpy.utils.previews

from . import jobs, making, program, settings as panel
from .preferences import preferences

CHARACTER = 5.9  # pixels, on average, at a scale of 1
_pictures = {}


def lines(layout, text, icon="NONE", beside=0):
    """A text in as many lines as the side bar's width asks for; Blender itself wraps nothing. beside: width of what
    stands beside it."""
    column = layout.column(align=True)
    margin = (75 if icon != "NONE" else 50) + beside
    scale = bpy.context.preferences.system.ui_scale
    width = max(16, int((bpy.context.region.width / scale - margin) / CHARACTER))
    for i, line in enumerate(textwrap.wrap(text, width, break_on_hyphens=False) or [""]):
        column.label(text=line, icon=icon if i == 0 else "BLANK1" if icon != "NONE" else "NONE")


class Part:
    bl_space_type, bl_region_type, bl_category = "NODE_EDITOR", "UI", "terrazzo"

    @classmethod
    def poll(cls, context):
        return context.space_data.tree_type == "ShaderNodeTree" and context.space_data.shader_type == "OBJECT"


class TERRAZZO_PT_main(Part, bpy.types.Panel):
    bl_idname, bl_label = "TERRAZZO_PT_main", "Make more material"

    def draw(self, context):
        layout, settings = self.layout, context.scene.terrazzo
        draw_missing_program(layout)
        layout.prop(settings, "source", text="")
        if settings.source == "FOLDER":
            layout.prop(settings, "folder", text="")
            layout.prop(settings, "name")
        elif context.object is None or context.object.active_material is None:
            lines(layout, "Select an object that has a material.", "INFO")
        if settings.use_graph:
            lines(layout, "As the graph below says.", "NODETREE")
        else:
            draw_size(layout, settings)
            column = layout.column(align=True)
            column.prop(settings, "seed")
            column.prop(settings, "quality", text="")
        column = layout.column(align=True)
        column.scale_y = 1.3
        column.operator("terrazzo.make", icon="ADD")
        for i, job in enumerate(jobs.jobs):
            row = layout.row(align=True)
            lines(row, job.title, "RENDER_ANIMATION", 25)
            row.operator("terrazzo.cancel", text="", icon="X").index = i
            lines(layout, job.summary)
        row = layout.row(align=True)
        row.operator("terrazzo.another_seed")
        row.operator("terrazzo.best_of_eight")


def draw_missing_program(layout):
    try:
        program.find(preferences().program)
    except program.ProgramError as e:
        box = layout.box()
        lines(box, str(e), "ERROR", 10)
        box.prop(preferences(), "program", text="")


def draw_size(layout, settings):
    column = layout.column(align=True)
    column.prop(settings, "size_by", text="")
    if settings.size_by == "FACTOR":
        column.prop(settings, "factor")
    elif settings.size_by == "PIXELS":
        column.row(align=True).prop(settings, "size", text="")
    else:
        if settings.size_by == "DENSITY":
            row = column.row(align=True)
            row.prop(settings, "density")
            row.operator("terrazzo.measure", text="", icon="DRIVER_DISTANCE")
        column.prop(settings, "most")


class TERRAZZO_PT_settings(Part, bpy.types.Panel):
    bl_idname, bl_label, bl_parent_id, bl_options = "TERRAZZO_PT_settings", "Settings", "TERRAZZO_PT_main", {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.terrazzo
        column = self.layout.column(align=True)
        if not settings.use_graph:
            for name in ("tileable", "method"):
                column.prop(settings, name, text="")
            for name in ("blend", "as_uv", "use_weights"):
                column.prop(settings, name)
            if settings.use_weights:
                for i, (_, label, _default) in enumerate(panel.MAP_NAMES):
                    column.prop(settings, "weights", index=i, text=label)
        column.prop(settings, "relief")
        column.prop(settings, "assign")


class TERRAZZO_PT_graph(Part, bpy.types.Panel):
    bl_idname, bl_label, bl_parent_id, bl_options = "TERRAZZO_PT_graph", "Own graph", "TERRAZZO_PT_main", {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.terrazzo, "use_graph", text="")

    def draw(self, context):
        layout, settings = self.layout, context.scene.terrazzo
        column = layout.column(align=True)
        column.operator("terrazzo.edit", icon="NODETREE")
        column.operator("terrazzo.watch", icon="HIDE_OFF")
        column = layout.column()
        column.active = settings.use_graph
        row = column.row(align=True)
        row.prop(settings, "graph", text="")
        row.operator("terrazzo.read_graph", text="", icon="FILE_REFRESH")
        if settings.graph_problem:
            lines(column, settings.graph_problem, "ERROR")
        if settings.graph_presets:
            column.prop(settings, "preset")
            lines(column, "Presets: " + settings.graph_presets.replace("\n", ", "))
        for parameter in settings.parameters:
            if parameter.role:
                continue
            has_label = parameter.field() in ("text", "path", "choice")
            if has_label:
                column.label(text=parameter.name)
            row = column.row(align=True)
            row.prop(parameter, parameter.field(), text="" if has_label else parameter.name)
            if parameter.kind == "path":
                row.operator("terrazzo.bake_mask", text="", icon="BRUSH_DATA").parameter = parameter.name


class TERRAZZO_PT_runs(Part, bpy.types.Panel):
    bl_idname, bl_label = "TERRAZZO_PT_runs", "Runs"

    def draw(self, _context):
        layout = self.layout
        if not jobs.jobs and not jobs.history:
            layout.label(text="Nothing has been run yet.")
        for job in jobs.jobs + jobs.history:
            icon = "RENDER_ANIMATION" if job in jobs.jobs else "ERROR" if job.has_failed else "CHECKMARK"
            lines(layout, job.title, icon)
            draw_job(layout, job)
        layout.operator("terrazzo.add_result", icon="FILE_FOLDER")


def draw_job(layout, job):
    lines(layout, job.summary)
    if job.made:
        lines(layout, job.made, "MATERIAL")
    for error in job.progress.errors[1:]:
        lines(layout, error, "ERROR")
    for warning in job.progress.warnings + job.messages:
        lines(layout, warning, "INFO")


class TERRAZZO_PT_notes(Part, bpy.types.Panel):
    bl_idname, bl_label, bl_parent_id, bl_options = "TERRAZZO_PT_notes", "Notes of the last run", "TERRAZZO_PT_runs", {
        "DEFAULT_CLOSED"}

    def draw(self, _context):
        job = (jobs.jobs + jobs.history or [None])[0]
        for note in job.progress.notes if job else []:
            lines(self.layout, note)


class TERRAZZO_PT_choices(Part, bpy.types.Panel):
    bl_idname, bl_label = "TERRAZZO_PT_choices", "Best of eight"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and bool(making.choices["pictures"])

    def draw(self, _context):
        grid = self.layout.grid_flow(columns=2, row_major=True, even_columns=True)
        for seed, path in making.choices["pictures"].items():
            column = grid.column(align=True)
            column.template_icon(icon_value=icon_of(path), scale=6)
            column.operator("terrazzo.choose", text=f"Seed {seed}").seed = seed


def icon_of(path):
    if not _pictures:
        _pictures["choices"] = bpy.utils.previews.new()
    pictures = _pictures["choices"]
    if path not in pictures:
        pictures.load(path, path, "IMAGE")
    return pictures[path].icon_id


class TERRAZZO_PT_mask(Part, bpy.types.Panel):
    bl_idname, bl_label, bl_options = "TERRAZZO_PT_mask", "Masks", {"DEFAULT_CLOSED"}

    def draw(self, context):
        settings = context.scene.terrazzo
        self.layout.prop(settings, "mask_from")
        self.layout.prop(settings, "mask_over")
        self.layout.row(align=True).prop(settings, "mask_size", text="")
        self.layout.operator("terrazzo.bake_mask").parameter = ""
        lines(self.layout, "With a graph of your own, the brush beside a path bakes the mask into it: stock:progression, "
              "stock:inpaint, stock:mix, stock:masked.")


def unregister():
    for pictures in _pictures.values():
        bpy.utils.previews.remove(pictures)
    _pictures.clear()


CLASSES = (TERRAZZO_PT_main, TERRAZZO_PT_settings, TERRAZZO_PT_graph, TERRAZZO_PT_choices, TERRAZZO_PT_runs, TERRAZZO_PT_notes,
           TERRAZZO_PT_mask)
