"""One job by command line, C++ and Python: whether they write the same bytes, and what a run costs in which everything is
cached, beside many other entries in the cache; and where that goes in Python.
PYTHONPATH=build/python python3 tests/bench/python.py build/terrazzo build-bench/tests/bench/terrazzo_overhead [ENTRIES]"""

import hashlib
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import terrazzo as tz

GRAPHS = pathlib.Path(__file__).resolve().parents[2] / "graphs"

GRAPH = """{
  "terrazzo": 1,
  "parameters": {"seed": {"type": "int", "default": 1}, "out": {"type": "path", "default": "out"}},
  "nodes": {
    "surface": {"type": "pattern", "kind": "bricks", "size": [256, 256], "seed": "$seed"},
    "height":  {"type": "get_map", "material": "@surface", "map": "height"},
    "soft":    {"type": "blur", "image": "@height", "radius": 2},
    "files":   {"type": "export", "material": "@soft", "path": "$out/{map}.png"}
  }
}
"""


def fill(cache, count):
    """Entries that no run asks for."""
    for i in range(count):
        name = hashlib.md5(str(i).encode()).hexdigest()
        kind, ending = [("values", ".tzv"), ("stages", ""), ("files", "")][i % 3]
        folder = cache / "v1" / kind / name[:2]
        folder.mkdir(parents=True, exist_ok=True)
        (folder / (name + ending)).write_bytes(b"x" * 200)


def milliseconds(work, times=200):
    """The median, the least, and the mean of the processor's time, which other programs do not change."""
    work()
    out = []
    before = time.process_time()
    for _ in range(times):
        start = time.perf_counter()
        work()
        out.append((time.perf_counter() - start) * 1e3)
    return statistics.median(out), min(out), (time.process_time() - before) * 1e3 / times


def digests(folder):
    return {f.name: hashlib.sha256(f.read_bytes()).hexdigest() for f in sorted(folder.iterdir())}


def by_all_ways(program, overhead, graph, values, scratch):
    """Milliseconds of a cached run by command line, C++ and Python, all of it; and whether the bytes are the same."""
    written = {}

    def words(way):
        return [f"{k}={v}" for k, v in {**values, "out": scratch / way}.items()]

    def by_command(cache, way):
        sets = [w for pair in words(way) for w in ("--set", pair)]
        subprocess.run([program, "run", graph, *sets, "--cache", cache, "--progress", "none"], check=True)

    def by_python(session, way):
        g = tz.Graph.load(graph)
        for word in words(way):
            name, _, value = word.partition("=")
            g.set(name, value)
        session.run(g)

    def by_cpp(cache, way):
        run = subprocess.run(
            [overhead, graph, *words(way)], check=True, capture_output=True, text=True, env={"TERRAZZO_CACHE": str(cache)}
        )
        return float(run.stdout.splitlines()[-1].split("|")[-2])

    by_command(scratch / "own-1", "command")
    by_cpp(scratch / "own-2", "c++")
    with tz.Session(cache=scratch / "own-3") as s:
        by_python(s, "python")
    for way in ("command", "c++", "python"):
        written[way] = digests(scratch / way)
    same = written["command"] == written["c++"] == written["python"]
    cache = scratch / "cache"
    by_command(cache, "command")
    command = milliseconds(lambda: by_command(cache, "command"), 40)[0]
    with tz.Session(cache=cache) as s:
        python = milliseconds(lambda: by_python(s, "command"), 100)[0]
    return command, by_cpp(cache, "command"), python, same


def compare(program, overhead, entries):
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        fill(scratch / "cache", entries)
        maps = scratch / "maps"
        generate = [program, "run", GRAPHS / "generate-exemplar.json", "--set", "type=tiles", "--set", "size=128x128"]
        subprocess.run([*generate, "--set", f"out={maps}", "--no-cache", "--progress", "none"], check=True)
        small = scratch / "small.json"
        small.write_text(GRAPH)
        jobs = [(small, {}), (GRAPHS / "material.json", {"material": maps, "size": "128x128"})]
        print(f"milliseconds, {entries} other entries: command line, C++, Python")
        for graph, values in jobs:
            *times, same = by_all_ways(program, overhead, graph, values, scratch)
            print(f"{graph.name:16}" + "".join(f"{t:8.2f}" for t in times) + ("" if same else "  other bytes!"))


def parts():
    with tempfile.TemporaryDirectory() as folder, tz.Session(cache=folder + "/cache", threads=2) as s:
        path = pathlib.Path(folder, "small.json")
        path.write_text(GRAPH)
        g = tz.Graph.load(path)
        s.run(g)
        s.run(g, only="surface")
        checked = g._job.checked([])
        rows = [
            ("a run, files up to date", lambda: s.run(g)),
            ("a run with progress", lambda: s.run(g, progress=lambda e: None)),
            ("a run, material from the cache", lambda: s.run(g, only="surface")),
            ("  reading and checking the graph", lambda: g._job.checked([])),
            ("  planning", lambda: s._session.plan(checked, [])),
            ("  planning and running", lambda: s._session.run(checked, [], [], None)),
            ("setting a parameter", lambda: g.params.__setitem__("seed", 1)),
            ("a view of a map", lambda: None),
        ]
        print(f"{'milliseconds':36}  median   least     CPU")
        image = s.run(g, only="surface")["surface"]["height"]
        image.numpy()
        rows[-1] = ("a view of a map of 256x256", lambda: image.numpy())
        for what, work in rows:
            print(f"{what:36}" + "".join(f"{t:8.3f}" for t in milliseconds(work)))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    compare(sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 100000)
    parts()
