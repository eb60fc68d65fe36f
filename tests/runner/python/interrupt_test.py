import os
import signal
import subprocess
import threading
import time
import unittest

import numpy as np
from support import LONG, Case

import terrazzo as tz

CHILD = """
import sys, time
import terrazzo as tz
s = tz.Session(cache=sys.argv[1], threads=2)
g = tz.Graph.loads(open(sys.argv[2]).read())
def tell(event):
    if event.kind == "started" and event.node == sys.argv[3]:
        print("started", flush=True)
try:
    s.run(g, progress=tell)
except KeyboardInterrupt:
    print("interrupted", flush=True)
s.run(g, "surface")
print("goes on", flush=True)
"""


#: Its pixels are computed when they are read, which takes a while.
LAZY = """{
  "terrazzo": 1,
  "inputs": {"height": {"type": "image"}},
  "nodes": {
    "soft":   {"type": "blur", "image": "@height", "radius": 60},
    "softer": {"type": "blur", "image": "@soft", "radius": 60}
  }
}"""


def limit():
    """A second, and more on a machine that others keep busy."""
    return max(1, os.getloadavg()[0] / os.cpu_count())


class InterruptTest(Case):
    def test_control_c_from_another_process(self):
        (self.folder / "long.json").write_text(LONG)
        for node in ("surface", "layout"):
            child = self.python(CHILD, self.folder / "cache", self.folder / "long.json", node, stdout=subprocess.PIPE)
            self.addCleanup(child.stdout.close)
            self.assertEqual(child.stdout.readline(), "started\n")
            time.sleep(0.2)
            start = time.monotonic()
            child.send_signal(signal.SIGINT)
            self.assertEqual(child.stdout.readline(), "interrupted\n")
            self.assertLess(time.monotonic() - start, limit())
            self.assertEqual(child.stdout.readline(), "goes on\n")
            self.assertEqual(child.wait(60), 0)

    def test_control_c_from_another_thread(self):
        pressed = []

        def press():
            pressed.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        threading.Timer(0.5, press).start()
        with self.assertRaises(KeyboardInterrupt):
            self.session().run(tz.Graph.loads(LONG))
        self.assertLess(time.monotonic() - pressed[0], limit())

    def test_control_c_while_pixels_are_computed(self):
        g = tz.Graph.loads(LAZY).give("height", tz.Image.from_numpy(np.zeros((3000, 3000)), "height"))
        image = self.session(cache=False).run(g, "softer")["softer"]
        pressed = []

        def press():
            pressed.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        threading.Timer(0.2, press).start()
        with self.assertRaises(KeyboardInterrupt):
            image.numpy()
        self.assertLess(time.monotonic() - pressed[0], limit())
        self.assertEqual(image.numpy().shape, (3000, 3000))

    def test_a_session_cancels_its_runs(self):
        s = self.session()
        threading.Timer(0.5, s.cancel).start()
        self.assertRaises(tz.Cancelled, s.run, tz.Graph.loads(LONG))

    def test_progress_functions_cancel(self):
        def tell(event):
            if event.kind == "started":
                raise tz.Cancelled("enough")

        with self.assertRaises(tz.Cancelled) as raised:
            self.session().run(tz.Graph.loads(LONG), progress=tell)
        self.assertEqual(str(raised.exception), "enough")


if __name__ == "__main__":
    unittest.main()
