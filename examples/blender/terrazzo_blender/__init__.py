# terrazzo in Blender: more material out of the active one. The panel is in the Shader Editor's side bar.
bl_info = {
    "name": "terrazzo",
    "description": "Makes more material out of a small one, without repeats",
    "author": "The terrazzo authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Shader Editor > Sidebar > terrazzo",
    "doc_url": "",
    "category": "Material",
}


def register():
    from . import registration
    registration.register()


def unregister():
    from . import registration
    registration.unregister()
