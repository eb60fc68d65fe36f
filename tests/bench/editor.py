#!/usr/bin/env python3
"""How soon a change in the editor is visible: from sending the edit until its picture has been fetched, in seconds.

The exemplar has 512x512 pixels, the result 1024x1024, its pictures at most 512. Medians and the worst of seven changes;
meaningful on an idle machine only. A change behind the index counts as visible with the first coarse picture.

Usage: tests/bench/editor.py PROGRAM [PICTURE] [--threads N]    (generated bricks if no picture is given)
"""

import argparse
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from editor_client import Editor  # noqa: E402

GRAPHS = pathlib.Path(__file__).resolve().parents[2] / "graphs"
CHANGES = 7


def is_result(data):
    return data["node"] == "result" and data.get("map", "base_color") == "base_color"


class Bench:
    def __init__(self, editor):
        self.editor = editor

    def set(self, node, key, value, forgets=True):
        if forgets:
            self.editor.forget_events()
        start = time.monotonic()
        edit = {"op": "set", "node": node, "key": key, "value": value} if node else {"op": "value", "name": key, "value": value}
        self.editor.call("edit", base=0, label="bench", edits=[edit])
        return start

    def seen(self, start, coarse):
        """Seconds until a picture has come; without `coarse` the true one."""
        _, picture = self.editor.wait_for("picture", lambda d: is_result(d) and (coarse or not d["coarse"]))
        self.editor.request("GET", picture["url"])
        return time.monotonic() - start

    def cpu_seconds(self):
        """Of the editor so far, which other programs on the machine hardly influence."""
        fields = pathlib.Path(f"/proc/{self.editor.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def idle(self):
        self.editor.wait_for("ran")
        time.sleep(0.3)

    def measure(self, what, node, key, values):
        first, whole, cpu = [], [], []
        for value in values:
            before = self.cpu_seconds()
            start = self.set(node, key, value)
            first.append(self.seen(start, coarse=True))
            cpu.append(self.cpu_seconds() - before)
            coarse = self.editor.seen[-1][2]["coarse"]
            whole.append(self.seen(start, coarse=False) if coarse else first[-1])
            self.idle()
        line = (f"| {what} | {statistics.median(first):.2f} | {max(first):.2f} | {statistics.median(cpu):.2f} | "
                f"{statistics.median(whole):.2f} |")
        print(line, flush=True)

    def drag(self, what, node, key, values):
        """Two seconds of changes, sixty a second, as a slider makes them."""
        self.editor.forget_events()
        for value in values:
            start = self.set(node, key, value, forgets=False)
            time.sleep(max(0.0, 1 / 60 - (time.monotonic() - start)))
        last = start
        while not self.editor.events.empty():
            self.editor.seen.append(self.editor.events.get())
        on_the_way = sum(1 for _, kind, data in self.editor.seen if kind == "picture" and is_result(data))
        self.editor.wait_until_quiet()
        whole = max(at for at, kind, data in self.editor.seen
                    if kind == "picture" and is_result(data) and not data["coarse"]) - last
        begun = sum(1 for _, kind, data in self.editor.seen if kind == "start" and data["node"] == "layout")
        print(f"| {what} | {len(values)} | {on_the_way} | {begun} | {whole:.2f} |", flush=True)


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("program")
    arguments.add_argument("picture", nargs="?")
    arguments.add_argument("--threads", default="2")
    given = arguments.parse_args()
    with tempfile.TemporaryDirectory(prefix="terrazzo-editor-bench.") as name:
        folder = pathlib.Path(name)
        picture = folder / "exemplar.png"
        if given.picture:
            shutil.copy(given.picture, picture)
        else:
            subprocess.run([given.program, "run", GRAPHS / "generate-exemplar.json", "--set", "size=512x512", "--set",
                            f"out={folder}/maps", "--no-cache"], check=True, capture_output=True)
            shutil.copy(folder / "maps/base_color.png", picture)
        text = (GRAPHS / "texture.json").read_text()
        text = text.replace('"image":    {"type": "path",', '"image":    {"type": "path", "default": "exemplar.png",')
        text = text.replace('"=round(@exemplar.size * scale)"', "1024")
        (folder / "graph.json").write_text(text)
        with Editor(given.program, [str(folder / "graph.json"), "--cache", str(folder / "cache"), "--threads",
                                    given.threads]) as editor:
            bench = Bench(editor)
            editor.call("show", tab="test", looked={"level": "", "node": "result"}, pinned=[], side=512)
            editor.wait_for("picture", lambda d: is_result(d) and not d["coarse"], seconds=300)
            bench.idle()
            print("| change of | first picture: median | worst | CPU | true picture: median |\n|---|---|---|---|---|")
            bench.measure("the seed, behind the index", "", "seed", range(2, 2 + CHANGES))
            bench.measure("`blend`, which only resolves", "", "blend", [1 + 0.1 * i for i in range(CHANGES)])
            bench.measure("`tones`, which only resolves", "", "tones", [0.01 * i for i in range(1, CHANGES + 1)])
            bench.measure("the seed again, as it was: from the cache", "", "seed", range(CHANGES, 0, -1))
            print("\n| drag of 2 s | changes | pictures on the way | syntheses begun | true picture after it, s |\n|---|---|---|---|---|")
            bench.drag("the seed, behind the index", "", "seed", range(1000, 1120))
            bench.drag("`blend`, which only resolves", "", "blend", [1 + i / 40 for i in range(120)])
            editor.stop()


main()
