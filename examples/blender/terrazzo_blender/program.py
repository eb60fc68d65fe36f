# Finds the program terrazzo and asks for its version. Plain Python.
import os
import re
import shutil
import subprocess

OLDEST = (0, 1, 0)
WAY_TO_GET = ("Unpack its tarball, install its package or build it (examples/quickstart.sh), and give its path under "
              "Edit > Preferences > Add-ons > terrazzo")
USUAL_PLACES = ("~/.local/bin/terrazzo", "/usr/local/bin/terrazzo", "/opt/terrazzo/bin/terrazzo")
WRITTEN_BY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "written_by.txt")  # holds the path of the program


class ProgramError(Exception):
    """There is no usable program; the message says what to do."""


def find(preferred="", environment=None, places=USUAL_PLACES, written_by=WRITTEN_BY):
    """The path of the program: the preferred one, $TERRAZZO, the one that wrote this add-on, on the PATH, or in a usual
    place. Raises ProgramError."""
    environment = os.environ if environment is None else environment
    for path, origin in ((preferred, "in the preferences"), (environment.get("TERRAZZO", ""), "in $TERRAZZO")):
        if not path:
            continue
        path = os.path.expanduser(path)
        if os.path.isdir(path):
            path = os.path.join(path, "terrazzo")
        if not os.path.isfile(path):
            raise ProgramError(f"There is no program {path}, which is named {origin}. {WAY_TO_GET}.")
        if not os.access(path, os.X_OK):
            raise ProgramError(f"{path}, which is named {origin}, is not executable. {WAY_TO_GET}.")
        return os.path.abspath(path)
    found = [text_in(written_by), shutil.which("terrazzo", path=environment.get("PATH", ""))]
    for path in found + [os.path.expanduser(p) for p in places]:
        if path and os.path.isfile(path) and os.access(path, os.X_OK):
            return path
    raise ProgramError(f"The program terrazzo was not found. {WAY_TO_GET}.")


def text_in(path):
    try:
        with open(path, encoding="utf-8") as file:
            return file.read().strip()
    except (OSError, ValueError):
        return ""


def version_in(text):
    """(0, 1, 0) of "terrazzo 0.1.0"; None for the output of another program."""
    found = re.match(r"terrazzo (\d+)\.(\d+)\.(\d+)", text)
    return tuple(int(n) for n in found.groups()) if found else None


def require(path, seconds=20):
    """The version of the program, which is at least OLDEST. Raises ProgramError."""
    try:
        asked = subprocess.run([path, "--version"], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, timeout=seconds)
    except subprocess.TimeoutExpired:
        raise ProgramError(f"{path} does not say its version within {seconds} s. {WAY_TO_GET}.")
    except OSError as e:
        raise ProgramError(f"{path} cannot be started: {e.strerror}. {WAY_TO_GET}.")
    text = asked.stdout.decode("utf-8", "replace").strip()
    version = version_in(text)
    if asked.returncode != 0 or version is None:
        said = f': it says "{text.splitlines()[0][:120]}"' if text else ""
        raise ProgramError(f"{path} is not terrazzo, or cannot run{said}. {WAY_TO_GET}.")
    if version < OLDEST:
        oldest, own = (".".join(str(n) for n in v) for v in (OLDEST, version))
        raise ProgramError(f"{path} is too old: it is version {own}, this add-on needs {oldest}. Use the add-on "
                           "that it writes itself (terrazzo blender-addon), or a newer program.")
    return version
