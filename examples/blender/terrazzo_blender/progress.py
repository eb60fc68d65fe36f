# What a run has reported so far. Plain Python.



class Progress:
    """Takes the events of child.Child."""

    def __init__(self):
        self.notes, self.warnings, self.errors = [], [], []
        self._begin(0)
        self.sizes = {}  # of the results of nodes, in pixels, as far as the plan knows them
        self.runs = 0  # completed ones, of which --watch makes many
        self.is_watching = False
        self.code = None

    def _begin(self, stages):
        self._stages = stages
        self._ended, self._partial = set(), {}
        self.node = ""
        self.files, self.ok, self.cancelled = [], False, False

    def feed(self, event):
        kind, node, message = event["event"], event.get("node", ""), event.get("message", "")
        if kind == "plan":
            self.is_watching = False
            self.notes, self.warnings, self.errors = [], [], []
            self._begin(len(event.get("stages", [])))
            self.sizes = {s["node"]: tuple(s["size"]) for s in event.get("stages", []) if "size" in s}
        elif kind == "start":
            self.node = node
        elif kind == "progress":
            self._partial[node] = event.get("fraction", 0)
        elif kind in ("done", "cached", "skipped"):
            self._ended.add(node)
        elif kind == "wait":
            self.node = f"{node} (another process is computing it)"
        elif kind == "note":
            self.notes.append(f"{node}: {message}" if node else message)
        elif kind == "warning":
            self.warnings.append(f"{node}: {message}" if node else message)
        elif kind in ("error", "failed"):
            self.errors.append(f"{node}: {message}" if node and node not in message else message)
        elif kind == "finished":
            self.files = event.get("files", [])
            self.ok, self.cancelled = event.get("ok", False), event.get("cancelled", False)
            self.runs += 1 if self.ok else 0
        elif kind == "watching":
            self.is_watching = True
        elif kind == "exited":
            self.code = event["code"]
            self.is_watching = False

    @property
    def fraction(self):
        """From 0 to 1, by the number of stages."""
        if self.ok:
            return 1.0  # stages that need not run report nothing
        if not self._stages:
            return 0.0
        partial = sum(f for node, f in self._partial.items() if node not in self._ended)
        return min(1.0, (len(self._ended) + partial) / self._stages)

    @property
    def summary(self):
        """One line: what it does, or how it has ended."""
        if self.code is None and not self.is_watching:
            return f"{round(100 * self.fraction)} %  {self.node}" if self._stages else "starting"
        if self.errors:
            return self.errors[0]
        if self.is_watching:
            return "done; waits for changes"
        if self.cancelled or self.code in (130, -15, -9):
            return "cancelled"
        return "done" if self.code == 0 else f"the program has ended with code {self.code}"
