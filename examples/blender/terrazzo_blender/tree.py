# Which image holds which map of a material, from its node tree. Plain Python: nodes and sockets may be Blender's or
# a test's.

MAPS = {"base_color": ("Base Color",), "metallic": ("Metallic",), "roughness": ("Roughness",),
        "opacity": ("Alpha",), "emission": ("Emission Color", "Emission")}
CHANNELS = {"R": "r", "G": "g", "B": "b", "A": "a", "Red": "r", "Green": "g", "Blue": "b", "Alpha": "a"}
SEPARATE = ("SEPRGB", "SEPARATE_COLOR", "SEPXYZ")
COMBINE = ("COMBRGB", "COMBINE_COLOR", "COMBXYZ")
OCCLUSION_GROUPS = ("glTF Material Output", "glTF Settings")


class Use:
    """An image in a map's place."""

    def __init__(self, node):
        self.node, self.image = node, node.image
        self.channel, self.inverted, self.normal_down = "", False, False


class Picked:
    def __init__(self):
        self.maps, self.notes = {}, []
        self.surface = None       # the Principled BSDF
        self.scale, self.offset, self.rotation = (1.0, 1.0), (0.0, 0.0), 0.0
        self.uv_layer = ""        # empty: the active one
        self.relief, self.midlevel, self.bump = 0.0, 0.0, 0.0
        self.normal_strength = 1.0
        self.multiplies_occlusion = False


def pick(tree):
    """Raises ValueError, with a sentence, if there is no image to start from."""
    picked = Picked()
    output = next((n for n in tree.nodes if n.type == "OUTPUT_MATERIAL" and getattr(n, "is_active_output", True)), None)
    tracer = Tracer(picked)
    surface = tracer.surface_of(output) if output else None
    if surface is None:
        raise ValueError("The material has no Principled BSDF. Images are taken from one; or choose a folder of maps.")
    picked.surface = surface
    inside = list(tracer.groups)
    for name, sockets in MAPS.items():
        socket = next((s for s in (surface.inputs.get(n) for n in sockets) if s is not None), None)
        tracer.take(name, socket)
    tracer.take_normal(surface.inputs.get("Normal"))
    tracer.groups = []
    tracer.take_displacement(output.inputs.get("Displacement"))
    for node in tree.nodes:
        if node.type == "GROUP" and node.node_tree and node.node_tree.name.split(".")[0] in OCCLUSION_GROUPS:
            tracer.take("ambient_occlusion", node.inputs.get("Occlusion"))
    tracer.groups = inside
    if not picked.maps:
        raise ValueError("No image texture reaches the Principled BSDF of the material. Connect one, or choose a folder "
                         "of maps.")
    tracer.read_mapping()
    return picked


class Tracer:
    def __init__(self, picked):
        self.picked = picked
        self.groups = []  # the group nodes that lead to where the search is

    def origin(self, socket):
        """The node and the output's name that feed an input, through reroutes and groups; or nothing."""
        while socket is not None and socket.links:
            link = socket.links[0]
            node, output = link.from_node, link.from_socket.name
            if node.type == "REROUTE":
                socket = node.inputs[0]
            elif node.type == "GROUP" and node.node_tree:
                end = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT"), None)
                self.groups.append(node)
                socket = end.inputs.get(output) if end else None
            elif node.type == "GROUP_INPUT" and self.groups:
                socket = self.groups.pop().inputs.get(output)
            else:
                return node, output
        return None, None

    def surface_of(self, output):
        """The Principled BSDF before the output: the first one, where shaders are mixed."""
        pending = [output.inputs.get("Surface")]
        for _ in range(64):
            if not pending:
                return None
            depth = list(self.groups)
            node, _name = self.origin(pending.pop(0))
            if node is not None and node.type == "BSDF_PRINCIPLED":
                return node
            self.groups = depth if node is None else self.groups
            if node is not None:
                pending += [s for s in node.inputs if getattr(s, "type", "SHADER") == "SHADER" and s.links]
        return None

    def use_of(self, socket, what):
        """The image that feeds an input, and what is done to it on the way."""
        depth = list(self.groups)
        try:
            return self._use_of(socket, what, 0)
        finally:
            self.groups = depth

    def _use_of(self, socket, what, steps):
        node, output = self.origin(socket)
        if node is None or steps > 32:
            return None
        if node.type == "TEX_IMAGE":
            if node.image is None:
                return None
            use = Use(node)
            use.channel = "a" if output == "Alpha" else ""
            return use
        if node.type in SEPARATE:
            use = self._use_of(node.inputs[0], what, steps + 1)
            if use is not None and getattr(node, "mode", "RGB") == "RGB":
                use.channel = CHANNELS.get(output, {"X": "r", "Y": "g", "Z": "b"}.get(output, ""))
            return use
        if node.type in COMBINE:
            return self._combined(node, what, steps)
        if node.type == "INVERT" or is_one_minus(node):
            use = self._use_of(node.inputs[1], what, steps + 1)
            if use is not None:
                use.inverted = not use.inverted
            return use
        if node.type == "CURVE_RGB" and turns_green(node):
            use = self._use_of(node.inputs[1], what, steps + 1)
            if use is not None:
                use.normal_down = not use.normal_down
            return use
        return self._through(node, what, steps)

    def _combined(self, node, what, steps):
        """One image taken apart and put together, as to turn green upside down."""
        parts = [self._use_of(s, what, steps + 1) for s in list(node.inputs)[:3]]
        first = parts[0]
        if all(p is not None and p.image == first.image for p in parts) and [p.channel for p in parts] == ["r", "g", "b"]:
            first.channel, first.normal_down = "", parts[1].inverted
            return first
        if first is None:
            first = next((p for p in parts if p is not None), None)
        if first is not None:
            self.picked.notes.append(f"{what}: '{node.name}' puts channels together; only {first.image.name} is taken.")
        return first

    def _through(self, node, what, steps):
        """Other nodes: the image behind them counts, and what they do is left out, which a note says."""
        inputs = [s for s in node.inputs if s.links and getattr(s, "name", "") not in ("Fac", "Factor", "Vector")]
        found = [u for u in (self._use_of(s, what, steps + 1) for s in inputs) if u is not None]
        if not found:
            return None
        is_mix = node.type in ("MIX_RGB", "MIX") and getattr(node, "blend_type", "") == "MULTIPLY"
        if is_mix and what == "base_color" and len(found) == 2:
            occlusion = next((u for u in found if looks_like_occlusion(u)), None)
            if occlusion is not None:
                self.picked.maps.setdefault("ambient_occlusion", occlusion)
                self.picked.multiplies_occlusion = True
                return next(u for u in found if u is not occlusion)
        self.picked.notes.append(f"{what}: what '{node.name}' does to {found[0].image.name} is left out.")
        return found[0]

    def take(self, name, socket):
        use = self.use_of(socket, name) if socket is not None else None
        if use is not None:
            self.picked.maps.setdefault(name, use)

    def take_normal(self, socket):
        node, _ = self.origin(socket) if socket is not None else (None, None)
        if node is not None and node.type == "BUMP":
            self.take("height", node.inputs.get("Height"))
            if "height" in self.picked.maps:
                strength, distance = node.inputs.get("Strength"), node.inputs.get("Distance")
                self.picked.bump = float(strength.default_value) * float(distance.default_value)
                self.picked.bump *= -1 if getattr(node, "invert", False) else 1
            node, _ = self.origin(node.inputs.get("Normal"))
        if node is None:
            return
        if node.type != "NORMAL_MAP":
            self.picked.notes.append(f"normal: '{node.name}' is no Normal Map node; normals are left out.")
            return
        if getattr(node, "space", "TANGENT") != "TANGENT":
            self.picked.notes.append("normal: only normals in tangent space are taken; these are left out.")
            return
        self.take("normal", node.inputs.get("Color"))
        strength = node.inputs.get("Strength")
        self.picked.normal_strength = float(strength.default_value) if strength is not None else 1.0

    def take_displacement(self, socket):
        node, _ = self.origin(socket) if socket is not None else (None, None)
        if node is None or node.type != "DISPLACEMENT":
            if node is not None:
                self.picked.notes.append(f"height: '{node.name}' is no Displacement node; it is left out.")
            return
        self.take("height", node.inputs.get("Height"))
        if "height" in self.picked.maps:
            self.picked.relief = float(node.inputs["Scale"].default_value)
            self.picked.midlevel = float(node.inputs["Midlevel"].default_value)

    def read_mapping(self):
        """From the image of the first map: how often the uv square shows it."""
        first = next(iter(self.picked.maps.values())).node
        if getattr(first, "projection", "FLAT") != "FLAT":
            self.picked.notes.append("The images are projected as a box; the new material uses the UV map.")
        node, output = self.origin(first.inputs.get("Vector"))
        if node is not None and node.type == "MAPPING":
            scale, place = self.vector_of(node, "Scale"), self.vector_of(node, "Location")
            if getattr(node, "vector_type", "POINT") == "TEXTURE":  # the inverse of the others
                scale = [1 / s if s else 1 for s in scale]
                place = [-p * s for p, s in zip(place, scale)]
            self.picked.scale, self.picked.offset = tuple(scale), tuple(place)
            self.picked.rotation = float(node.inputs["Rotation"].default_value[2])
            node, output = self.origin(node.inputs.get("Vector"))
        if node is not None and node.type == "UVMAP":
            self.picked.uv_layer = node.uv_map
        elif node is not None and (node.type != "TEX_COORD" or output != "UV"):
            self.picked.notes.append(f"The images are placed by '{node.name}' {output}; the new material uses the UV map.")

    def vector_of(self, mapping, name):
        """x and y of an input of a Mapping node, which a Value node may feed."""
        node, _ = self.origin(mapping.inputs[name])
        if node is not None and node.type == "VALUE":
            return [float(node.outputs[0].default_value)] * 2
        if node is not None:
            self.picked.notes.append(f"{name} of the Mapping node comes from '{node.name}', which is left out.")
        value = mapping.inputs[name].default_value
        return [float(value[0]), float(value[1])]


def is_one_minus(node):
    """A Math node 1 - x."""
    if node.type != "MATH" or node.operation != "SUBTRACT":
        return False
    return not node.inputs[0].links and float(node.inputs[0].default_value) == 1.0


def turns_green(node):
    """RGB curves that turn only green upside down, as for DirectX normals."""
    ends = [(c.points[0].location[1], c.points[len(c.points) - 1].location[1]) for c in list(node.mapping.curves)[:3]]
    return ends[1][0] > ends[1][1] and ends[0][0] < ends[0][1] and ends[2][0] < ends[2][1]


def looks_like_occlusion(use):
    name = use.image.name.lower()
    return any(w in name for w in ("occlusion", "_ao", "-ao", "ao_", "ao.")) or (
        use.image.colorspace_settings.name == "Non-Color")
