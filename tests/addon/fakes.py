# Stand-ins for Blender's nodes, sockets and images, as far as the add-on's plain Python looks at them.
import types


class Socket:
    def __init__(self, name, node, value=None, kind="RGBA"):
        self.name, self.node, self.default_value, self.type, self.links = name, node, value, kind, []


class Sockets(list):
    def get(self, name):
        return next((s for s in self if s.name == name), None)

    def __getitem__(self, key):
        return self.get(key) if isinstance(key, str) else list.__getitem__(self, key)


class Node:
    def __init__(self, kind, inputs=(), outputs=("Color",), **more):
        self.type, self.name = kind, kind.title()
        self.inputs = Sockets(Socket(i, self) if isinstance(i, str) else Socket(i[0], self, i[1]) for i in inputs)
        self.outputs = Sockets(Socket(o, self) for o in outputs)
        self.__dict__.update(more)


class Tree:
    def __init__(self, name="tree"):
        self.nodes, self.name = [], name

    def add(self, *arguments, **more):
        self.nodes.append(Node(*arguments, **more))
        return self.nodes[-1]

    @staticmethod
    def link(node, output, target, name):
        socket = node.outputs[output]
        assert socket is not None, (node.type, output)
        target.inputs[name].links = [types.SimpleNamespace(from_node=node, from_socket=socket)]

    def image(self, name, space="Non-Color", **more):
        picture = image(name, space, **more)
        return self.add("TEX_IMAGE", ["Vector"], ["Color", "Alpha"], image=picture, projection="FLAT")

    def surface(self):
        """The Principled BSDF of a new output."""
        names = ["Base Color", "Metallic", "Roughness", "Alpha", "Emission", "Normal"]
        node = self.add("BSDF_PRINCIPLED", names, ["BSDF"])
        output = self.add("OUTPUT_MATERIAL", ["Surface", "Displacement"], [])
        output.inputs["Surface"].type = "SHADER"
        self.link(node, "BSDF", output, "Surface")
        return node, output


class Image(types.SimpleNamespace):
    __hash__ = object.__hash__


def image(name, space="Non-Color", source="FILE", dirty=False, packed=None, tile=1001, packed_files=()):
    return Image(
        name=name, source=source, is_dirty=dirty, size=(64, 64), packed_files=packed_files,
        tiles=types.SimpleNamespace(active=types.SimpleNamespace(number=tile)),
        packed_file=types.SimpleNamespace(data=packed) if packed is not None else None,
        colorspace_settings=types.SimpleNamespace(name=space))
