import bpy


class TerrazzoPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program", subtype="FILE_PATH",
        description="The program terrazzo. If empty, $TERRAZZO and the PATH are searched")
    cache: bpy.props.StringProperty(
        name="Cache", subtype="DIR_PATH", description="Where analyses and results are kept. If empty, the program's own")
    memory: bpy.props.StringProperty(
        name="Memory", description="Memory for the program to stay within, such as 4G; half of the machine's if empty")
    threads: bpy.props.IntProperty(
        name="Threads", min=0, max=1024, description="Threads for the program to use; 0: one for each core")
    results: bpy.props.StringProperty(
        name="Results", default="//textures/terrazzo",
        description="Folder for the maps that are made. // is the folder of the Blender file; of a file that was never "
                    "saved, they are kept in Blender's own data folder")

    def draw(self, _context):
        column = self.layout.column()
        column.prop(self, "program")
        column.operator("terrazzo.check_program", icon="QUESTION")
        for name in ("cache", "memory", "threads", "results"):
            column.prop(self, name)


def preferences():
    return bpy.context.preferences.addons[__package__].preferences
