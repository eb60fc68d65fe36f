# Runs of the program that Blender waits for, without ever blocking: a timer looks at them. Everything that a job knows is
# plain data, since undo and loading a file make references to Blender's data invalid.
import bpy
from bpy.app.handlers import persistent

from . import child, compat, progress

INTERVAL = 0.2
jobs = []
history = []  # ended jobs, the newest first
KEPT = 5


class Job:
    def __init__(self, title, arguments, preferred, request, on_finished, on_failed, prepare=None, reads_output=False):
        """request: what on_finished(job) needs; it is called in the main thread when a run has been completed.
        on_failed(folder) is called with the folder of results if none has been. The rest as child.Child takes it."""
        self.title, self.request, self._on_finished, self._on_failed = title, request, on_finished, on_failed
        self.progress = progress.Progress()
        self.child = child.Child(preferred, arguments, prepare, reads_output)
        self.file = bpy.data.filepath
        self.is_orphan = False
        self.made = ""  # the name of the material that has been made
        self.messages = []

    def cancel(self):
        self.child.cancel()

    def tick(self):
        """Takes what the program has reported; returns whether that was anything."""
        events = self.child.poll()
        for event in events:
            self.progress.feed(event)
            if event["event"] == "finished" and event.get("ok"):
                self._finish()
        if self.child.has_ended and self.progress.runs == 0:
            self._on_failed(self.request["out"])
        return bool(events)

    def _finish(self):
        if self.is_orphan:
            self.messages = [f"The file was closed. The maps are in {self.request['out']}; "
                             "'Add result' makes a material of them."]
            return
        try:
            self._on_finished(self)
        except Exception as e:  # whatever it is, the user has to see it, and the timer has to go on
            self.progress.errors.append(f"The maps are in {self.request['out']}, but: {e}")
            if not isinstance(e, ValueError):
                import traceback
                traceback.print_exc()

    @property
    def summary(self):
        return self.progress.summary

    @property
    def has_failed(self):
        return bool(self.progress.errors) or self.progress.code not in (None, 0)


def start(*arguments):
    return add(Job(*arguments))


def add(job):
    jobs.append(job)
    if not bpy.app.timers.is_registered(look):
        bpy.app.timers.register(look, first_interval=INTERVAL, persistent=True)
    return job


def look():
    """The timer: takes reports of all jobs. Returns when to be called again, or None."""
    if compat.is_rendering():
        return INTERVAL
    news = [job for job in list(jobs) if job.tick()]
    for job in news:
        if job.child.has_ended:
            jobs.remove(job)
            history.insert(0, job)
            del history[KEPT:]
    if news:
        redraw()
    return INTERVAL if jobs else None


def redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "NODE_EDITOR":
                area.tag_redraw()


@persistent
def after_load(*_):
    """Another file is open: results of jobs that belong to the earlier one make no material here."""
    for job in jobs:
        if not bpy.data.filepath or bpy.data.filepath != job.file:
            job.is_orphan = True


@persistent
def after_save(*_):
    for job in jobs:
        if not job.is_orphan:
            job.file = bpy.data.filepath


def register():
    bpy.app.handlers.load_post.append(after_load)
    bpy.app.handlers.save_post.append(after_save)


def unregister():
    child.end_all()
    for handlers, function in ((bpy.app.handlers.load_post, after_load), (bpy.app.handlers.save_post, after_save)):
        if function in handlers:
            handlers.remove(function)
    if bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)
    jobs.clear()
