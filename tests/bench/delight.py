"""What `delight` takes out where the truth is known: generated materials, lit by `preview` from a side, by light that
changes slowly, or both. Errors of log luminance, after the mean, of base colours before and after: *slow* of means over
an eighth of the side, *all* of pixels. With FOLDERS, how much it changes their base colours, which nobody lit.
The tables go into experiments.md#delight.
/usr/bin/python3 tests/bench/delight.py PROGRAM [--tune NAME=VALUE]... [--set NAME=VALUE]... [--hint normal,height] [--slow "none; pool"] [FOLDER...]
PROGRAM: build/terrazzo, or build-bench/tests/bench/terrazzo_tuned to try constants (--tune)."""

import argparse
import pathlib
import shutil
import subprocess
import tempfile

import numpy
import OpenImageIO as oiio

KINDS = "ashlar bricks cobbles crazy_paving flagstones gravel panels planks plates rubble slates tiles weave".split()
SIZE = 512
MAKE = """{"terrazzo": 1, "parameters": {"kind": {"type": "text"}, "seed": {"type": "int"}, "out": {"type": "path"}},
  "nodes": {
    "surface": {"type": "pattern", "kind": "$kind", "size": [512, 512], "seed": "$seed", "tileable": false},
    "files": {"type": "export", "material": "@surface", "path": "$out/{map}.png"},
    "high": {"type": "preview", "material": "@surface", "intensity": 0.8, "azimuth": 135, "elevation": 45},
    "high_file": {"type": "export", "material": "@high", "path": "$out/high.png"},
    "low": {"type": "preview", "material": "@surface", "intensity": 0.8, "azimuth": 20, "elevation": 25},
    "low_file": {"type": "export", "material": "@low", "path": "$out/low.png"}}}"""
EVEN = """{"terrazzo": 1, "parameters": {"material": {"type": "path"}, "out": {"type": "path"}}, "nodes": {
    "exemplar": {"type": "load_material", "path": "$material"},
    "even": {"type": "delight", "material": "@exemplar"},
    "file": {"type": "export", "material": "@even", "maps": ["base_color"], "path": "$out/{map}.png"}}}"""


def slow_lights():
    """Linear factors by name; some 1.7 times as bright on one side as on the other, or less in the corners."""
    y, x = (numpy.mgrid[0:SIZE, 0:SIZE] + 0.5) / SIZE * 2 - 1
    slope = 1 - 0.225 * (0.8 * x + 0.6 * y)
    vignette = 1 / (1 + (x * x + y * y) * numpy.tan(numpy.radians(28)) ** 2) ** 2  # the fourth power of the cosine
    pool = 0.5 + 0.6 * numpy.exp(-((x - 0.4) ** 2 + (y + 0.3) ** 2) / 0.6)
    return {"none": numpy.ones_like(x), "slope": slope, "vignette": vignette, "slope, vignette": slope * vignette, "pool": pool}


def linear(path):
    file = oiio.ImageInput.open(str(path))  # an ImageBuf would remember the file that had this name before
    v = file.read_image(oiio.FLOAT)[..., :3].astype(float)
    file.close()
    return numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def write(path, v):
    v = numpy.clip(v, 0, 1)
    v = numpy.where(v <= 0.0031308, v * 12.92, 1.055 * numpy.maximum(v, 1e-9) ** (1 / 2.4) - 0.055)
    pixels = numpy.ascontiguousarray(numpy.round(v * 255).astype(numpy.uint8))
    out = oiio.ImageOutput.create(str(path))
    out.open(str(path), oiio.ImageSpec(v.shape[1], v.shape[0], 3, oiio.UINT8))
    out.write_image(pixels)
    out.close()


def errors(found, truth):
    """Slow and all."""
    luminance = [numpy.log(numpy.maximum(v @ [0.2126, 0.7152, 0.0722], 0.002)) for v in (found, truth)]
    e = luminance[0] - luminance[1]
    e -= e.mean()
    height, width = (n // 8 * 8 for n in e.shape)
    blocks = e[:height, :width].reshape(8, height // 8, 8, width // 8).mean((1, 3))
    return numpy.array([blocks.std(), e.std()])


class Bench:
    def __init__(self, args, scratch):
        self.args, self.scratch = args, scratch
        (scratch / "even.json").write_text(EVEN)
        (scratch / "make.json").write_text(MAKE)

    def run(self, graph, settings, tunes=()):
        command = [self.args.program, *(w for t in tunes for w in ("--tune", t)), "run", str(self.scratch / graph)]
        for s in settings:
            command += ["--set", s]
        subprocess.run(command + ["--progress", "none", "--no-cache"], check=True, stderr=subprocess.DEVNULL)

    def even(self, folder):
        out = self.scratch / "out"
        self.run("even.json", [f"material={folder}", f"out={out}", *(f"even.{s}" for s in self.args.set)], self.args.tune)
        return linear(out / "base_color.png")

    def table(self):
        found = {}
        for kind in KINDS:
            for seed in range(1, self.args.seeds + 1):
                made, lit = self.scratch / "made", self.scratch / "lit"
                self.run("make.json", [f"kind={kind}", f"seed={seed}", f"out={made}"])
                truth = linear(made / "base_color.png")
                shutil.rmtree(lit, ignore_errors=True)
                lit.mkdir()
                for name in self.args.hint.split(",") if self.args.hint else []:
                    shutil.copy(made / f"{name}.png", lit)
                for sun in ("base_color", "high", "low"):
                    picture = linear(made / f"{sun}.png")
                    for slow in self.args.slow.split("; "):
                        factor = slow_lights()[slow]
                        write(lit / "base_color.png", picture * 0.8 * factor[..., None])
                        before = errors(linear(lit / "base_color.png"), truth)
                        found.setdefault((sun, slow), []).append([before, errors(self.even(lit), truth)])
        print("| sun | slow light | slow | worst | all | worst |\n|---|---|---|---|---|---|")
        for (sun, slow), rows in found.items():
            (before, after), worst = numpy.mean(rows, 0), numpy.max(rows, 0)[1]
            name = {"base_color": "none", "high": "45 degrees", "low": "25 degrees"}[sun]
            print(f"| {name} | {slow} | {before[0]:.3f} → {after[0]:.3f} | {worst[0]:.3f} | {before[1]:.3f} → {after[1]:.3f} | {worst[1]:.3f} |")

    def unlit(self):
        print("| exemplar | slow | all |\n|---|---|---|")
        for folder in self.args.folders:
            copy = self.scratch / "exemplar"
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(folder, copy)
            colour = next(f for f in copy.iterdir() if "color" in f.stem.lower())
            slow, every = errors(self.even(copy), linear(colour))
            print(f"| {pathlib.Path(folder).name} | {slow:.3f} | {every:.3f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--tune", action="append", default=[])
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--hint", default="normal")
    parser.add_argument("--slow", default="none; slope; vignette; slope, vignette; pool")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("folders", nargs="*")
    args = parser.parse_intermixed_args()
    with tempfile.TemporaryDirectory(prefix="terrazzo-delight.") as scratch:
        bench = Bench(args, pathlib.Path(scratch))
        bench.unlit() if args.folders else bench.table()


if __name__ == "__main__":
    main()
