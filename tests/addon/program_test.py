# How the add-on for Blender finds, runs and cancels the program, and reads graph files. Without Blender.
# Usage: program_test.py SOURCE_FOLDER PROGRAM
import glob
import json
import os
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

import numpy

SOURCE, PROGRAM = sys.argv[1:3]
del sys.argv[1:3]
sys.path.insert(0, os.path.join(SOURCE, "examples/blender"))
from terrazzo_blender import child, command, graph_file, program, progress, uv_file  # noqa: E402


def events_of(run, enough=lambda events: False, seconds=60):
    """All events of a child, until it has ended or they are enough."""
    events, end = [], time.monotonic() + seconds
    while time.monotonic() < end and not run.has_ended and not enough(events):
        events += run.poll()
        time.sleep(0.02)
    return events


class Scratch(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def script(self, name, text, mode=0o755):
        with open(self.path(name), "w") as file:
            file.write("#!/bin/sh\n" + text)
        os.chmod(self.path(name), mode)
        return self.path(name)

    def maps(self):
        subprocess.run([PROGRAM, "run", "stock:generate-exemplar", "--set", "type=bricks", "--set", "size=64", "--set",
                        "out=" + self.path("it's = \"wall\""), "--progress", "none", "--cache", self.path("cache")],
                       check=True)
        return self.path("it's = \"wall\"")


class Programs(Scratch):
    def test_found(self):
        own = self.script("terrazzo", "")
        self.assertEqual(program.find(own, {}), own)
        self.assertEqual(program.find(self.folder, {}), own)
        self.assertEqual(program.find("", {"TERRAZZO": own}), own)
        self.assertEqual(program.find("", {"PATH": "/nowhere:" + self.folder}), own)
        self.assertEqual(program.find("", {"PATH": "/nowhere"}, [own]), own)
        other = self.script("other", "")
        with open(self.path("written_by.txt"), "w") as file:
            file.write(other + "\n")
        path = {"PATH": self.folder}
        self.assertEqual(program.find("", path, [], self.path("written_by.txt")), other)
        os.remove(other)
        self.assertEqual(program.find("", path, [], self.path("written_by.txt")), own)

    def test_not_found(self):
        plain = self.script("plain", "", 0o644)
        for preferred, environment, says in (
                ("/nowhere/terrazzo", {}, "no program /nowhere/terrazzo, which is named in the preferences"),
                ("", {"TERRAZZO": "/nowhere"}, r"no program /nowhere, which is named in \$TERRAZZO"),
                (plain, {}, "not executable"), ("", {"PATH": ""}, "was not found")):
            with self.assertRaisesRegex(program.ProgramError, says + ".*build it"):
                program.find(preferred, environment, [])

    def test_versions(self):
        self.assertGreaterEqual(program.require(PROGRAM), program.OLDEST)
        for text, says in (("echo terrazzo 0.0.9", "is too old: it is version 0.0.9, this add-on needs 0.1.0"),
                           ("echo hello", 'is not terrazzo, or cannot run: it says "hello"'),
                           ("exit 3", "is not terrazzo"), ("exec sleep 60", "does not say its version within 0.5 s")):
            with self.assertRaisesRegex(program.ProgramError, says):
                program.require(self.script("other", text), 0.5)
        with open(self.path("binary"), "wb") as file:
            file.write(bytes(100))
        os.chmod(self.path("binary"), 0o755)
        with self.assertRaisesRegex(program.ProgramError, "cannot be started"):
            program.require(self.path("binary"))


class Children(Scratch):
    def test_a_run(self):
        values = {"material": self.maps(), "size": [96, 64], "quality": "draft", "weights": {"height": 1.5},
                  "tileable": "xy", "out": self.path("==out")}
        run = child.Child(PROGRAM, command.make(values, options=command.limits(self.path("cache"), "1G", 1)))
        state = progress.Progress()
        for event in events_of(run):
            state.feed(event)
        self.assertEqual((state.code, state.errors, state.summary, state.fraction), (0, [], "done", 1))
        self.assertIn(self.path("==out/terrazzo-material.json"), state.files)
        self.assertEqual((state.sizes["exemplar"], state.sizes["layout"]), ((64, 64), (96, 64)))
        self.assertTrue(any("base_color" in n for n in state.notes))

    def test_uv_maps(self):
        values = {"material": self.maps(), "scale": 2, "quality": "draft", "write": "uv", "out": self.path("uv")}
        run = child.Child(PROGRAM, command.make(values, options=command.limits(self.path("cache"))))
        self.assertEqual(events_of(run)[-1]["code"], 0)
        with open(self.path("uv/uv.tif"), "rb") as file:
            places = numpy.concatenate(list(uv_file.strips_of(file.read())))
        self.assertEqual(places.shape, (128, 128, 3))
        self.assertTrue((places[:, :, :2] < 64).all() and (places[:, :, 2] == 0).all())
        # Most neighbours are neighbours in the exemplar too.
        self.assertGreater((numpy.diff(places[:, :, 0].astype(int), axis=1) == 1).mean(), 0.5)
        uv_file.repack(self.path("uv/uv.tif"), self.path("uv.png"))
        with open(self.path("uv.png"), "rb") as file:
            data = file.read()
        at, packed = 8, b""
        while at < len(data):
            size = int.from_bytes(data[at:at + 4], "big")
            packed += data[at + 8:at + 8 + size] if data[at + 4:at + 8] == b"IDAT" else b""
            at += 12 + size
        lines = numpy.frombuffer(zlib.decompress(packed), numpy.uint8).reshape(128, 1 + 128 * 4)
        pixels = numpy.cumsum(lines[:, 1:].reshape(128, 128, 4), axis=1, dtype=numpy.uint8).astype(int)
        numpy.testing.assert_array_equal(pixels[:, :, ::2] * 256 + pixels[:, :, 1::2], places[:, :, :2])
        for damage in (data, b"II*\0" + bytes(40)):
            with open(self.path("uv/uv.tif"), "wb") as file:
                file.write(damage)
            with self.assertRaisesRegex(ValueError, "cannot be read"):
                uv_file.repack(self.path("uv/uv.tif"), self.path("uv.png"))

    def test_choices(self):
        values = {"material": self.maps(), "scale": 1, "quality": "draft", "seed": 5, "out": self.path("it's")}
        os.mkdir(self.path("it's"))
        run = child.Child(PROGRAM, command.choices(values, [5, 6], self.path("table.json"),
                                                   command.limits(self.path("cache"))))
        self.assertEqual(events_of(run)[-1], {"event": "exited", "code": 0})
        self.assertEqual(sorted(glob.glob(self.path("it's/*/*"))), [self.path(f"it's/{s}/lit.png") for s in (5, 6)])

    def test_mistakes(self):
        state = progress.Progress()
        for event in events_of(child.Child(PROGRAM, command.make({"material": "/nowhere", "out": self.path("o")}))):
            state.feed(event)
        self.assertEqual(state.code, 2)
        self.assertIn("/nowhere", state.summary)
        state = progress.Progress()
        for event in events_of(child.Child("/nowhere/terrazzo", [])):
            state.feed(event)
        self.assertEqual(state.code, 1)
        self.assertIn("There is no program /nowhere/terrazzo", state.summary)

    def test_cancelled_at_any_time(self):
        values = {"material": self.maps(), "size": [1500, 1500], "quality": "best", "out": self.path("o")}

        def is_laying(events):
            return {"event": "start", "node": "layout"} in events

        for enough in (lambda events: True, lambda events: bool(events), is_laying):
            run = child.Child(PROGRAM, command.make(values, options=["--no-cache"]))
            events = events_of(run, enough)
            run.cancel()
            state = progress.Progress()
            for event in events + events_of(run):
                state.feed(event)
            self.assertEqual((state.code in (130, -15), state.summary, run.has_ended), (True, "cancelled", True))
            self.assertFalse(glob.glob(self.path("o/*")))

    def test_nothing_runs_on(self):
        """The child ends with the program that started it, however that ends."""
        values = {"material": self.maps(), "size": [4000, 4000], "quality": "best", "out": self.path("o")}
        for end, code in (("", 0), ("os.kill(os.getpid(), 9)", -9)):
            text = (f"import os, sys, time; sys.path.insert(0, {os.path.join(SOURCE, 'examples/blender')!r})\n"
                    "from terrazzo_blender import child, command\n"
                    f"run = child.Child({PROGRAM!r}, command.make({values!r}, options=['--no-cache']))\n"
                    "while not any(e.get('node') == 'layout' for e in run.poll()): time.sleep(0.02)\n"
                    f"print(run._process.pid, flush=True)\n{end}\n")
            parent = subprocess.run([sys.executable, "-c", text], stdout=subprocess.PIPE, timeout=60)
            self.assertEqual(parent.returncode, code)
            pid = int(parent.stdout)
            deadline = time.monotonic() + 30
            while is_alive(pid) and time.monotonic() < deadline:
                time.sleep(0.05)
            self.assertFalse(is_alive(pid), end)

    def test_watch(self):
        graph = self.path("g.json")

        def write(radius):
            with open(graph + ".new", "w") as file:
                json.dump({"terrazzo": 1, "nodes": {
                    "map": {"type": "load_map", "path": maps + "/height.png"},
                    "soft": {"type": "blur", "image": "@map", "radius": radius},
                    "files": {"type": "export", "material": "@soft", "path": self.path("o") + "/{map}.png"}}}, file)
            os.replace(graph + ".new", graph)

        maps = self.maps()
        write(1)
        run = child.Child(PROGRAM, command.run(graph, {}, watch=True, options=command.limits(self.path("cache"))))
        state = progress.Progress()
        for runs in (1, 2):
            for event in events_of(run, lambda events: any(e["event"] == "watching" for e in events)):
                state.feed(event)
            self.assertEqual((state.runs, state.is_watching, state.summary), (runs, True, "done; waits for changes"))
            write(2)
        run.cancel()
        self.assertIn(events_of(run)[-1]["code"], (130, 0))

    def test_lines_that_are_no_events(self):
        other = self.script("other", 'if [ "$1" = --version ]; then echo terrazzo 9.0.0; else echo "a library says" >&2; '
                                     'printf "\\377{\\n" >&2; exit 7; fi')
        events = events_of(child.Child(other, ["run"]))
        self.assertEqual(events[0], {"event": "note", "message": "a library says"})
        self.assertEqual(events[-1], {"event": "exited", "code": 7})


def is_alive(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


class Texts(Scratch):
    def test_values(self):
        self.assertEqual(command.settings({"a": "=x", "b": True, "c": 0.5, "d": [1, 2], "e": {"f": 1}}),
                         ["--set", "a===x", "--set", "b=true", "--set", "c=0.5", "--set", "d=[1, 2]", "--set", 'e={"f": 1}'])
        self.assertEqual(command.limits(), [])

    def test_own_graph_is_valid(self):
        checked = subprocess.run([PROGRAM, "check", command.GRAPH, "--set", "material=" + self.maps()],
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout)

    def test_graph_files(self):
        for path in glob.glob(os.path.join(SOURCE, "graphs/*.json")):
            document = graph_file.read(path)
            self.assertEqual([n for n, _ in graph_file.parameters(document)], list(document.get("parameters", {})))
        with open(self.path("g.json"), "w") as file:
            file.write('// a "comment"\n{"terrazzo": 1, /* {"x": */ "parameters": {"out": {"type": "path"}, // last\n'
                       '"url": {"type": "text", "default": "http://a, ]"}, }, "presets": {"p": {}}, // end\n}')
        with open(self.path("g.presets.json"), "w") as file:
            file.write('{"q": {}}')
        document = graph_file.read(self.path("g.json"))
        self.assertEqual(document["parameters"]["url"]["default"], "http://a, ]")
        self.assertEqual(graph_file.presets(self.path("g.json"), document), ["p", "q"])
        self.assertEqual(graph_file.role("out", {"type": "path"}), "out")
        self.assertEqual(graph_file.role("out", {"type": "text"}), "")
        self.assertEqual([graph_file.typed(v, t) for v, t in (("2", "int"), ("true", "bool"), ("64x32", "size"), ("2", "text"),
                                                              ([1, 2], "size"), ('{"height": 2}', "number_map"))],
                         [2, True, "64x32", "2", [1, 2], {"height": 2}])
        for text, says in (("{", "is no graph file"), ("[]", "has no \"terrazzo\"")):
            with open(self.path("g.json"), "w") as file:
                file.write(text)
            with self.assertRaisesRegex(graph_file.GraphError, says):
                graph_file.read(self.path("g.json"))

    def test_progress(self):
        state = progress.Progress()
        self.assertEqual(state.summary, "starting")
        for event in ({"event": "plan", "stages": [{"node": "a"}, {"node": "b"}]}, {"event": "cached", "node": "a"},
                      {"event": "start", "node": "b"}, {"event": "progress", "node": "b", "fraction": 0.5},
                      {"event": "warning", "node": "b", "message": "odd"}):
            state.feed(event)
        self.assertEqual((state.fraction, state.summary, state.warnings), (0.75, "75 %  b", ["b: odd"]))
        for event in ({"event": "failed", "node": "b", "message": "node \"b\": no"}, {"event": "exited", "code": 1}):
            state.feed(event)
        self.assertEqual(state.summary, 'node "b": no')


if __name__ == "__main__":
    unittest.main()
