# Runs the program as a child process. A thread reads what it reports, so nothing here ever waits. Plain Python.
import atexit
import ctypes
import json
import queue
import signal
import subprocess
import threading

from . import program

PR_SET_PDEATHSIG = 1

_running = set()
try:
    _prctl = ctypes.CDLL(None).prctl
except (OSError, AttributeError, TypeError):
    _prctl = None  # not Linux


def _end_with_parent():
    """In the new process: the system ends it with the thread that has started it, even if Blender crashes."""
    if _prctl is not None:
        _prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


class Child:
    """A run of the program: events of `--progress json`, and at the end {"event": "exited", "code"}."""

    def __init__(self, preferred, arguments, prepare=None, reads_output=False):
        """preferred: the path of the program, or nothing to look for it. arguments: of the program, as texts.
        prepare(files): called in the thread, which may take its time, when a run is complete; it may raise ValueError.
        reads_output: lines of the standard output are events, too."""
        self._prepare, self._reads_output = prepare, reads_output
        self._events = queue.SimpleQueue()
        self._process = None
        self._cancelled = False
        self._lock = threading.Lock()
        self.has_ended = False
        _running.add(self)
        threading.Thread(target=self._run, args=(preferred, list(arguments)), daemon=True).start()

    def poll(self):
        """The events since the last call."""
        out = []
        while not self._events.empty():
            out.append(self._events.get())
        if any(e["event"] == "exited" for e in out):
            self.has_ended = True
            _running.discard(self)
        return out

    def cancel(self):
        """Ends the program as Ctrl-C does, so that it leaves no partial files."""
        with self._lock:
            self._cancelled = True
            if self._process is not None and self._process.poll() is None:
                self._process.send_signal(signal.SIGTERM)

    def _run(self, preferred, arguments):
        code = 1
        try:
            path = program.find(preferred)
            program.require(path)
            with self._lock:
                if not self._cancelled:
                    out, err = ((subprocess.PIPE, subprocess.STDOUT) if self._reads_output else
                                (subprocess.DEVNULL, subprocess.PIPE))
                    self._process = subprocess.Popen([path, *arguments], stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                                     start_new_session=True, preexec_fn=_end_with_parent)
            if self._process is not None:
                with self._process.stdout or self._process.stderr as lines:
                    for line in lines:
                        self._take(event_in(line.decode("utf-8", "replace")))
                code = self._process.wait()
            else:
                code = 130
        except program.ProgramError as e:
            self._events.put({"event": "error", "message": str(e)})
        except OSError as e:
            self._events.put({"event": "error", "message": f"The program cannot be run: {e}"})
        finally:
            self._events.put({"event": "exited", "code": code})

    def _take(self, event):
        if self._prepare is not None and event["event"] == "finished" and event.get("ok"):
            try:
                self._prepare(event.get("files", []))
            except (ValueError, OSError) as e:
                self._events.put({"event": "error", "message": str(e)})
                event["ok"] = False
        self._events.put(event)


def event_in(line):
    """The object in a line; a line that is none, as of a library, is a note."""
    try:
        event = json.loads(line)
        if isinstance(event, dict) and isinstance(event.get("event"), str):
            return event
    except ValueError:
        pass
    return {"event": "note", "message": line.strip()}


def end_all():
    """Ends all children: Blender quits, or the add-on is switched off."""
    for child in list(_running):
        child.cancel()


atexit.register(end_all)
