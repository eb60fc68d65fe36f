"""Talks to `terrazzo edit` as its page does, for tests and benchmarks. Python's own modules only."""

import http.client
import json
import queue
import signal
import subprocess
import threading
import time
import urllib.parse


class Editor:
    """A running editor, opened by its address, with one stream of events."""

    def __init__(self, program, arguments, tab="test"):
        self.process = subprocess.Popen([program, "edit", "--no-open", *arguments], stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise RuntimeError("it printed no address: " + self.process.stderr.read())
        parts = urllib.parse.urlsplit(self.address)
        self.host = parts.netloc
        answer = self.request("GET", parts.path + "?" + parts.query)
        if answer.status != 303:
            raise RuntimeError(f"the address gave {answer.status}")
        self.cookie = answer.getheader("Set-Cookie").split(";")[0]
        self.events = queue.Queue()
        self.seen = []
        self.tab = tab
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    cookie = None

    def request(self, method, path, body=None):
        connection = http.client.HTTPConnection(self.host, timeout=30)
        headers = {"Origin": "http://" + self.host}
        if self.cookie:
            headers["Cookie"] = self.cookie
        if body is not None:
            headers["Content-Type"] = "application/json"
        connection.request(method, path, body, headers)
        answer = connection.getresponse()
        answer.content = answer.read()
        connection.close()
        return answer

    def call(self, name, **request):
        answer = self.request("POST", "/api/" + name, json.dumps(request))
        data = json.loads(answer.content)
        if answer.status != 200:
            raise RuntimeError(f"{name}: {data.get('error')}")
        return data

    def _listen(self):
        connection = http.client.HTTPConnection(self.host)
        connection.request("GET", "/api/events?tab=" + self.tab, headers={"Cookie": self.cookie})
        answer = connection.getresponse()
        kind = None
        try:
            for line in answer:
                line = line.decode().rstrip("\n")
                if line.startswith("event: "):
                    kind = line[7:]
                elif line.startswith("data: "):
                    self.events.put((time.monotonic(), kind, json.loads(line[6:])))
        except OSError:
            pass
        self.events.put((time.monotonic(), "closed", {}))

    def wait_for(self, kind, wanted=lambda data: True, seconds=60):
        """The time and data of the next such event; all on the way are kept in `seen`."""
        until = time.monotonic() + seconds
        while True:
            try:
                event = self.events.get(timeout=max(0.0, until - time.monotonic()))
            except queue.Empty:
                raise RuntimeError(f"no event {kind} came within {seconds} s") from None
            self.seen.append(event)
            if event[1] == kind and wanted(event[2]):
                return event[0], event[2]

    def wait_until_quiet(self, seconds=2):
        """Until nothing has come for so long; what came is kept in `seen`."""
        while True:
            try:
                self.seen.append(self.events.get(timeout=seconds))
            except queue.Empty:
                return

    def forget_events(self):
        while not self.events.empty():
            self.events.get()
        self.seen.clear()

    def stop(self):
        """Ctrl-C; the seconds until it has ended."""
        start = time.monotonic()
        self.process.send_signal(signal.SIGINT)
        self.process.wait(timeout=30)
        return time.monotonic() - start

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
