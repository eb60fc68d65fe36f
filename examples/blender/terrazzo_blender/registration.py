import bpy

from . import jobs, operators, panels, preferences, settings

CLASSES = (preferences.TerrazzoPreferences, settings.GraphParameter, settings.Settings, *operators.CLASSES,
           *panels.CLASSES)


def register():
    for c in CLASSES:
        bpy.utils.register_class(c)
    bpy.types.Scene.terrazzo = bpy.props.PointerProperty(type=settings.Settings)
    jobs.register()


def unregister():
    jobs.unregister()
    panels.unregister()
    del bpy.types.Scene.terrazzo
    for c in reversed(CLASSES):
        bpy.utils.unregister_class(c)
