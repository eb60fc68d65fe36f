#!/usr/bin/env python3
"""The command `edit` as users meet it: opens a graph, edits it, looks at results, runs it, and is stopped.

Usage: tests/edit_test.py PROGRAM
"""

import os
import pathlib
import subprocess
import sys
import tempfile

from editor_client import Editor

GRAPH = """{
  // the editor keeps this comment
  "terrazzo": 1,
  "nodes": {
    "exemplar": {"type": "pattern", "kind": "bricks", "size": 96},
    "weighted": {"type": "weight", "material": "@exemplar"},
    "space":    {"type": "pca", "features": "@weighted"},
    "index":    {"type": "index", "appearance": "@space"},
    "layout":   {"type": "synthesize", "index": "@index", "size": 192, "seed": 1},
    "result":   {"type": "resolve_uv", "uv": "@layout", "material": "@exemplar"},
    "files":    {"type": "export", "material": "@result", "path": "out/{map}.png"}
  }
}
"""

program = str(pathlib.Path(sys.argv[1]).resolve())
failures = []


def check(what, holds):
    if not holds:
        failures.append(what)
        print("failed:", what, file=sys.stderr)


def run(*arguments, **more):
    return subprocess.run([program, *arguments], capture_output=True, text=True, timeout=120, **more)


def test_usage(folder):
    for name, why in (("none", "ends in .json"), ("gone/new.json", "there is no folder")):
        missing = run("edit", str(folder / name))
        check(f"{name} is an error: {why}", missing.returncode == 2 and why in missing.stderr)
    shown = run("edit", str(folder / "new.json"), "--read-only")
    check("--read-only begins no graph", shown.returncode == 2 and "--read-only" in shown.stderr)
    nowhere = run("edit", "graph.json", "--allow", "nowhere", cwd=folder)
    check("a missing folder to allow is an error", nowhere.returncode == 2 and "--allow nowhere" in nowhere.stderr)
    helped = run("edit", "--help")
    check("--help tells of the folder of maps", helped.returncode == 0 and "FOLDER.json" in helped.stdout)


def test_new_graph(folder):
    graph = folder / "new.json"
    with Editor(program, [str(graph), "--cache", str(folder / "cache")]) as editor:
        state = editor.call("state")
        check("a graph that does not exist is not written by opening it", not graph.exists())
        editor.call("edit", base=state["revision"], edits=[{"op": "add", "type": "pattern"}])
        editor.wait_for("state", lambda d: '"pattern"' in d["text"])
        check("the first edit writes it", graph.exists() and '"pattern"' in graph.read_text())


def test_session(folder):
    graph = folder / "graph.json"
    with Editor(program, [str(graph), "--cache", str(folder / "cache")]) as editor:
        state = editor.call("state")
        check("the state has the text", state["text"] == GRAPH)
        _, told = editor.wait_for("state")
        check("the stream begins with the state", told["revision"] == state["revision"])
        check("opening runs nothing", not (folder / "out").exists())

        editor.call("show", tab="test", looked={"level": "", "node": "result"}, pinned=[], side=192)
        _, picture = editor.wait_for("picture", lambda d: d["node"] == "result" and not d["coarse"])
        answer = editor.request("GET", picture["url"])
        check("a picture comes by its digest", answer.status == 200 and answer.getheader("Content-Type") in
              ("image/jpeg", "image/png"))
        check("an unknown digest has none", editor.request("GET", "/picture/" + "0" * 32).status == 404)
        editor.wait_for("ran")
        check("looking writes nothing", not (folder / "out").exists())
        pixels = editor.call("pixels", digest=picture["digest"], x=0, y=0, width=2, height=1)
        check("values under the pointer", pixels["channels"] == 3 and len(pixels["values"]) == 6)

        before = editor.call("state")["revision"]
        editor.forget_events()
        editor.call("edit", base=before, edits=[{"op": "set", "node": "layout", "key": "seed", "value": 7}])
        _, changed = editor.wait_for("state", lambda d: d["revision"] > before)
        check("the edit is in the text", '"seed": 7' in changed["text"] and "keeps this comment" in changed["text"])
        _, other = editor.wait_for("picture", lambda d: d["node"] == "result" and not d["coarse"])
        check("the picture is another one", other["digest"] != picture["digest"])

        editor.forget_events()
        editor.call("run", sinks=True)
        _, ran = editor.wait_for("ran", lambda d: "files" in d)
        check("the run wrote files", ran["ok"] and (folder / "out/base_color.png").exists())
        shown = (folder / "out/base_color.png").read_bytes()

        editor.call("undo")
        _, back = editor.wait_for("state", lambda d: '"seed": 1' in d["text"])
        check("undo gives the text as it was", back["text"] == GRAPH)
        # What was being shown may come first.
        _, again = editor.wait_for("picture", lambda d: d["digest"] == picture["digest"])
        check("and its picture", again["node"] == "result" and not again["coarse"])
        editor.call("redo")
        try:
            editor.call("edit", base=0, edits=[{"op": "remove", "nodes": ["no such node"]}])
            check("an impossible edit is refused", False)
        except RuntimeError:
            pass
        listed = editor.call("files", folder="")
        check("files of the folder are listed", "graph.json" in [e["name"] for e in listed["entries"]])
        check("stopping takes less than a second", editor.stop() < 1)
        check("and is no error", editor.process.returncode == 0)
        editor.wait_for("bye")
        editor.wait_for("closed")
    run("run", str(graph), "--cache", str(folder / "cache"))
    check("the saved graph gives what the page's run gave", (folder / "out/base_color.png").read_bytes() == shown)


def test_stopping_while_it_runs(folder):
    text = GRAPH.replace('"size": 192', '"size": 2048')
    (folder / "large.json").write_text(text)
    with Editor(program, [str(folder / "large.json"), "--no-cache"]) as editor:
        editor.call("show", tab="test", looked={"level": "", "node": "result"}, pinned=[], side=512)
        editor.wait_for("start", lambda d: d["node"] == "layout")
        check("stopping a run takes less than a second", editor.stop() < 1)
        editor.wait_for("bye")


def test_read_only(folder):
    graph = folder / "graph.json"
    text = graph.read_text()
    with Editor(program, [str(graph), "--read-only", "--no-cache"]) as editor:
        check("the state says so", editor.call("state")["readOnly"])
        for name, request in (("edit", {"base": 1, "edits": [{"op": "set", "node": "layout", "key": "seed", "value": 3}]}),
                              ("undo", {}), ("run", {"sinks": True})):
            try:
                editor.call(name, **request)
                check(f"{name} is refused", False)
            except RuntimeError:
                pass
        editor.stop()
    check("and nothing was written", graph.read_text() == text)


def test_folder(folder):
    run("run", str(folder / "graph.json"), "--cache", str(folder / "cache"))
    maps = folder / "bricks"
    maps.mkdir()
    for picture in (folder / "out").glob("*.png"):
        (maps / picture.name).write_bytes(picture.read_bytes())
    with Editor(program, [str(maps), "--no-cache"]) as editor:
        graph = folder / "bricks.json"
        check("a folder of maps begins with a graph", graph.exists())
        check("which is shown", editor.call("state")["file"]["name"] == "bricks.json")
        editor.call("show", tab="test", looked={"level": "", "node": "exemplar"}, pinned=[], side=64)
        editor.wait_for("picture", lambda d: d["node"] == "exemplar")
        editor.stop()
    text = graph.read_text()
    with Editor(program, [str(maps), "--no-cache"]) as editor:
        editor.stop()
        check("the graph that is there is opened", "exists, and is opened" in editor.process.stderr.read())
    check("and kept", graph.read_text() == text)


def main():
    with tempfile.TemporaryDirectory(prefix="terrazzo-edit.") as name:
        folder = pathlib.Path(name)
        os.environ["TERRAZZO_CACHE"] = str(folder / "default-cache")
        (folder / "graph.json").write_text(GRAPH)
        for test in (test_usage, test_new_graph, test_session, test_stopping_while_it_runs, test_read_only, test_folder):
            test(folder)
    if failures:
        sys.exit(f"{len(failures)} checks failed")
    print("ok")


main()
