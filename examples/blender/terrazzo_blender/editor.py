# The graph editor in the browser, on the graph that makes the material, which follows what is edited.
import os
import webbrowser

import bpy

from . import command, graphs, jobs, requests
from .preferences import preferences


class Editor(jobs.Job):
    """A run of `terrazzo edit`, which says where its page is."""

    def __init__(self, graph, folders):
        """folders: what the graph may read besides its own folder."""
        arguments = ["edit", graph, "--no-open", *requests.options()]
        for folder in folders:
            arguments += ["--allow", folder]
        super().__init__("Editor: " + os.path.basename(graph), arguments, preferences().program, {"out": "", "graph": graph},
                         lambda job: None, lambda folder: None, reads_output=True)
        self.address, self.is_shown = "", False

    def tick(self):
        is_news = super().tick()
        if not self.address and not self.child.has_ended:
            self.address = next((n for n in self.progress.notes if n.startswith("http://")), "")
            if self.address:
                self.show()
        return is_news

    def show(self):
        self.is_shown = webbrowser.open(self.address)

    @property
    def summary(self):
        if self.progress.code is None:
            if not self.address:
                return "starting"
            return "its page is open in the browser" if self.is_shown else f"open {self.address} in a browser"
        return "closed" if self.progress.code == 0 else "\n".join(self.progress.errors or self.progress.notes)


def start(settings, object):
    """Opens the graph, which the panel uses from then on, and watches it."""
    source = requests.Source(settings, object)
    is_own = settings.use_graph and settings.graph
    if not is_own or settings.graph.startswith(graphs.STOCK):
        make_graph(settings, object, source, is_own)
    path = graphs.path_of(settings)
    running = next((j for j in jobs.jobs if isinstance(j, Editor) and j.request["graph"] == path), None)
    if running is not None:
        running.show()
    else:
        jobs.add(Editor(path, folders_of(source)))
    if not any(j.request.get("watched") == path for j in jobs.jobs):
        requests.start_make(settings, object, watch=True)


def make_graph(settings, object, source, is_stock):
    """A file of the panel's settings or of a stock graph, in a folder of its own."""
    folder = requests.new_folder(source.title + "-graph")
    path = os.path.join(folder, requests.file_stem(source.title) + ".json")
    if is_stock:
        graph, values, _ = requests.graph_values(settings, source, folder)
    else:
        graph, values = command.GRAPH, requests.values_of(settings, object, source, {})[0]
        values["material"], _ = source.gather(folder)
        values["out"] = folder

    def named_from_there(value):
        if value == folder:
            return "out"
        is_inside = isinstance(value, str) and value.startswith(folder + os.sep)
        return os.path.relpath(value, folder) if is_inside else value

    graphs.write_with_defaults(graph, {n: named_from_there(v) for n, v in values.items()}, path)
    settings.use_graph = True
    settings.graph = bpy.path.relpath(path) if bpy.data.filepath else path


def folders_of(source):
    """Where the maps of a source lie."""
    if source.folder:
        return [source.folder]
    return sorted({os.path.dirname(os.path.realpath(requests.file_of(u.image))) for u in source.picked.maps.values()
                   if u.image.packed_file is None})
