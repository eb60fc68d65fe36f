# Command lines for the program. Plain Python.
import json
import os

GRAPH = os.path.join(os.path.dirname(os.path.abspath(__file__)), "material.json")


def value_text(value):
    """A value as --set takes it. A text that begins with = would be an expression."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (dict, list, tuple)):
        return json.dumps(value)
    if isinstance(value, float):
        return repr(value)
    text = str(value)
    return "=" + text if text.startswith("=") else text


def settings(values):
    out = []
    for name, value in values.items():
        out += ["--set", f"{name}={value_text(value)}"]
    return out


def limits(cache="", memory="", threads=0):
    """Options for the preferences; those that are not set are left out."""
    out = ["--cache", cache] if cache else []
    out += ["--memory", memory] if memory else []
    return out + (["--threads", str(threads)] if threads > 0 else [])


def run(graph, values, watch=False, preset="", options=()):
    """Runs a graph file with values of its parameters."""
    return (["run", graph, "--progress", "json"] + (["--preset", preset] if preset else []) + settings(values) +
            (["--watch"] if watch else []) + list(options))


def make(values, watch=False, options=()):
    """Runs the add-on's own graph: values as in material.json."""
    return run(GRAPH, values, watch, "", options)


def choices(values, seeds, table, options=()):
    """A lit picture for each seed: `out`/SEED/lit.png. table: the file to write the variations to."""
    return variations(GRAPH, {**values, "write": "picture"}, seeds, table, options=options)


def variations(graph, values, seeds, table, out="out", preset="", options=()):
    """Runs a graph that has a parameter `seed` for each seed. out: the name of the parameter for the folder of results,
    of which each seed gets one of its own. table: the file to write the variations to."""
    rest = {n: v for n, v in values.items() if n not in ("seed", out)}
    with open(table, "w", encoding="utf-8") as file:
        json.dump([{"seed": s, out: os.path.join(values[out], str(s))} for s in seeds], file)
    return run(graph, rest, preset=preset, options=["--table", table, *options])
