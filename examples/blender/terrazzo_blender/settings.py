# What the panel asks for, stored with the scene.
import bpy

from . import graph_file, program

MAP_NAMES = (("base_color", "Base color", 1.0), ("normal", "Normal", 0.5), ("height", "Height", 0.7),
             ("roughness", "Roughness", 0.3), ("metallic", "Metallic", 0.5), ("ambient_occlusion", "Occlusion", 0.3))


def choice_items(self, _context):
    # Blender does not keep the texts of dynamic items, so the list has to live.
    _items[self.name] = [(c, c, "") for c in self.choices.split("\n") if c] or [("", "none", "")]
    return _items[self.name]


_items = {}


class GraphParameter(bpy.types.PropertyGroup):
    """A field for a parameter of a graph; empty texts leave it at its default."""
    kind: bpy.props.StringProperty()
    help: bpy.props.StringProperty()
    choices: bpy.props.StringProperty()
    default: bpy.props.StringProperty()
    role: bpy.props.StringProperty()
    baked: bpy.props.StringProperty(description="The mask over the UV square that was drawn for it")
    text: bpy.props.StringProperty(name="Value", description="Empty: the graph's default")
    path: bpy.props.StringProperty(name="Path", subtype="FILE_PATH", description="Empty: the graph's default")
    switch: bpy.props.BoolProperty(name="Value")
    whole: bpy.props.IntProperty(name="Value")
    number: bpy.props.FloatProperty(name="Value", precision=4)
    choice: bpy.props.EnumProperty(name="Value", items=choice_items)

    def field(self):
        if self.default.startswith("="):
            return "text"
        return {"path": "path", "bool": "switch", "int": "whole", "number": "number",
                "choice": "choice"}.get(self.kind, "text")

    def value(self):
        """As a text for --set, or nothing to leave the default."""
        field = self.field()
        value = getattr(self, field)
        if field == "path":
            value = bpy.path.abspath(value) if value.startswith("//") else value
        text = {True: "true", False: "false"}[value] if field == "switch" else (
            f"{value:.7g}" if field == "number" else str(value))
        return "" if text == self.default else text


def read_graph(settings, _context):
    """When another graph has been chosen."""
    from . import graphs
    settings.graph_problem = ""
    settings.parameters.clear()
    settings.use_graph = bool(settings.graph)
    try:
        if settings.graph:
            graphs.read_into(settings)
    except (graph_file.GraphError, program.ProgramError) as e:
        settings.graph_problem = str(e)


def fill_parameters(settings, document, path):
    """Makes a field for each exposed parameter; values of fields that stay are kept."""
    before = {p.name: (p.value(), p.baked) for p in settings.parameters}
    settings.parameters.clear()
    for name, declaration in graph_file.parameters(document):
        field = settings.parameters.add()
        field.name = name
        field.kind = declaration.get("type", "text")
        field.help = declaration.get("help", "")
        field.choices = "\n".join(declaration.get("choices", []))
        field.default = graph_file.text_of(declaration["default"]) if "default" in declaration else ""
        field.role = graph_file.role(name, declaration)
        text, field.baked = before.get(name, ("", ""))
        text = text or ("" if field.field() in ("text", "path") else field.default)
        try:
            set_field(field, text)
        except (ValueError, TypeError):
            set_field(field, field.default)
    settings.graph_presets = "\n".join(graph_file.presets(path, document))
    settings.graph_problem = ""


def set_field(field, text):
    kind = field.field()
    if not text and kind not in ("text", "path"):
        return
    setattr(field, kind, {"switch": lambda t: t == "true", "whole": lambda t: int(float(t)),
                          "number": float}.get(kind, str)(text))


class Settings(bpy.types.PropertyGroup):
    source: bpy.props.EnumProperty(name="Source", items=[
        ("MATERIAL", "From the active material", "The image textures of the active material"),
        ("FOLDER", "From a folder", "A folder of maps")])
    folder: bpy.props.StringProperty(name="Folder", subtype="DIR_PATH", description="The folder of maps")
    name: bpy.props.StringProperty(name="Name", description="Which material of a folder that holds several")
    size_by: bpy.props.EnumProperty(name="Size", items=[
        ("OBJECT", "Fit object", "Covers the active object's surface once, as dense as it shows the material now"),
        ("DENSITY", "Fit object at a density", "Covers the active object's surface once, at so many pixels per metre"),
        ("FACTOR", "Times the exemplar", "How many times the exemplar, in each direction"),
        ("PIXELS", "Pixels", "Width and height in pixels")])
    factor: bpy.props.FloatProperty(name="Times", default=2, min=0.1, max=64)
    size: bpy.props.IntVectorProperty(name="Pixels", size=2, default=(2048, 2048), min=1, max=32768)
    density: bpy.props.FloatProperty(name="Pixels per m", default=512, min=0.01, description="Pixels per metre of surface")
    most: bpy.props.IntProperty(name="Pixels at most", default=4096, min=16, max=32768,
                                description="Along each side; a larger surface repeats the result")
    seed: bpy.props.IntProperty(name="Seed", default=1, min=0, description="Another seed gives another arrangement")
    tileable: bpy.props.EnumProperty(name="Tileable", default="xy", items=[
        ("none", "Not tileable", "The result has borders"), ("x", "Tileable in x", ""), ("y", "Tileable in y", ""),
        ("xy", "Tileable", "It wraps around")])
    quality: bpy.props.EnumProperty(name="Quality", default="normal", items=[
        ("draft", "Draft quality", "For trying settings"), ("normal", "Normal quality", ""),
        ("best", "Best quality", "For final results")])
    method: bpy.props.EnumProperty(name="Method", items=[
        ("layout", "Layout of pieces", "Lays pieces of the exemplar: for all that has structure"),
        ("noise", "Noise by example", "Blends random samples: for surfaces without structure, such as sand")])
    blend: bpy.props.FloatProperty(name="Blend", default=0, min=0, max=8, description="Width of seams in pixels")
    use_weights: bpy.props.BoolProperty(name="Weights", description="How much each map counts when parts are compared")
    weights: bpy.props.FloatVectorProperty(size=len(MAP_NAMES), default=[w for _, _, w in MAP_NAMES], min=0, max=100)
    use_graph: bpy.props.BoolProperty(name="Own graph", description="Run a graph of your own")
    graph: bpy.props.StringProperty(name="Graph", subtype="FILE_PATH", update=read_graph,
                                    description="A graph file, or stock:NAME for one that comes with the program")
    graph_problem: bpy.props.StringProperty()
    graph_presets: bpy.props.StringProperty()
    preset: bpy.props.StringProperty(name="Preset", description="A preset of the graph; its values count where a field is "
                                     "at its default")
    parameters: bpy.props.CollectionProperty(type=GraphParameter)
    as_uv: bpy.props.BoolProperty(
        name="Sample the exemplar", description="Keeps the exemplar and a uv map instead of the resolved maps: less memory "
        "for large results. Seams are hard, and joined heights and tones are left out")
    assign: bpy.props.BoolProperty(name="Assign", default=True, description="Put the result into the object's slot; the "
                                   "old material stays in the file")
    relief: bpy.props.FloatProperty(name="Relief", min=0, subtype="DISTANCE", description="Displacement from the lowest "
                                    "to the highest point; 0: as the old material has it")
    mask_from: bpy.props.EnumProperty(name="From", items=[
        ("SELECTED", "Selected faces", "White where faces are selected"),
        ("COLOR", "Vertex colors", "The brightness of the active color attribute")])
    mask_over: bpy.props.EnumProperty(name="Over", items=[
        ("RESULT", "UV square", "For what is painted on the result, which is then spread over the UV square once"),
        ("EXEMPLAR", "Exemplar", "For what is painted on the exemplar, wherever the object shows it")])
    mask_size: bpy.props.IntVectorProperty(name="Pixels", size=2, default=(1024, 1024), min=1, max=16384)


def values_of(settings):
    """Values for material.json, but material, size and out."""
    values = {"method": settings.method, "seed": settings.seed, "tileable": settings.tileable,
              "quality": settings.quality, "blend": round(settings.blend, 4)}
    if settings.use_weights:
        values["weights"] = {n: round(w, 4) for (n, _, _), w in zip(MAP_NAMES, settings.weights)}
    return values


def graph_values(settings):
    """Values of the fields that are not at the graph's defaults."""
    return {p.name: p.value() for p in settings.parameters if not p.role and p.value()}
