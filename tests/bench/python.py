"""What a run costs from Python in which everything is cached, and where: PYTHONPATH=build/python python3 tests/bench/python.py"""

import pathlib
import statistics
import tempfile
import time

import terrazzo as tz

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


def main():
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
    main()
