"""The examples run, what the guide says is true, and types are right."""

import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from support import SOURCE, Case


class ExamplesTest(Case):
    def run_python(self, *args):
        run = subprocess.run([sys.executable, *map(str, args)], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return run.stdout

    def test_batch(self):
        self.assertIn("20 made, 0 failed", self.run_python(SOURCE / "examples/python/batch.py", "out"))
        self.assertTrue(pathlib.Path("out/made/bricks-0/height.png").exists())

    def test_custom_node(self):
        self.assertIn("30% of the surface is worn", self.run_python(SOURCE / "examples/python/wear.py", "out"))
        self.assertIn("3 cached, 0 run", self.run_python(SOURCE / "examples/python/wear.py", "out"))

    def test_sweep(self):
        self.assertIn("6 variations", self.run_python(SOURCE / "examples/python/sweep.py", "out"))
        self.assertEqual(pathlib.Path("out/table.csv").read_text().count("\n"), 7)
        self.assertTrue(pathlib.Path("out/sheet.png").exists())

    def test_the_blocks_of_the_guide(self):
        shutil.copytree(SOURCE / "graphs", "graphs", ignore=shutil.ignore_patterns("*.cpp", "*.h"))
        text = (SOURCE / "examples/guide/programs.md").read_text()
        # Each block on the lines that it has in the guide, so that tracebacks name these.
        code, line = "", 1
        for block in re.finditer(r"^```python\n(.*?)^```", text, re.M | re.S):
            first = text.count("\n", 0, block.start(1)) + 1
            code += "\n" * (first - line) + block.group(1)
            line = first + block.group(1).count("\n")
        self.assertGreater(line, 100)
        pathlib.Path("guide.py").write_text(code)
        said = self.run_python("guide.py")
        self.assertIn('has no parameter "mod" (did you mean "mode"?)', said)
        self.assertIn("/nodes/lattice/mode", said)

    def test_types(self):
        if subprocess.run([sys.executable, "-c", "import mypy"], capture_output=True).returncode:
            self.skipTest("there is no mypy (apt-get install mypy)")
        package = SOURCE / "runner/python/terrazzo"
        self.run_python("-m", "mypy", "--strict", "--cache-dir", self.folder / "types", package)

    def test_stubs_have_all_that_there_is(self):
        import terrazzo._terrazzo as compiled

        stubs = (SOURCE / "runner/python/terrazzo/_terrazzo.pyi").read_text()
        for name, value in vars(compiled).items():
            if name.startswith("_"):
                continue
            self.assertRegex(stubs, rf"(?m)^((class|def) {name}\b|{name}: )")
            for member in vars(value) if isinstance(value, type) else ():
                if not member.startswith("_"):
                    self.assertRegex(stubs, rf"(?m)^    def {member}\b", f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
