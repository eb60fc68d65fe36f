#!/usr/bin/env python3
"""Writes the node reference, examples/guide/nodes.md and a page for each node type, from what the program says of them.

Usage: examples/guide/nodes.py [--check | --pictures] [PROGRAM]
--check writes nothing, and exits 1 if a page is not current or an example or its picture is missing.
--pictures runs the examples, examples/guide/nodes/NAME.json, and takes over their pictures as well.
PROGRAM is build/terrazzo if none is given.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
GUIDE = ROOT / "examples" / "guide"
MADE = pathlib.Path("out/guide/nodes")

# Examples that read what the example of another node type has written, and what that is.
READS = {"load_material": ("export", "maps"), "load_uv": ("export", "uv.png"),
         "load_analysis": ("save_analysis", "pavers.analysis")}
CATEGORIES = {"source": "Sources", "image": "Images and materials", "analysis": "Analysis", "synthesis": "Synthesis",
              "sink": "Files and figures"}
TYPES = {"number_map": "numbers by name", "text_map": "texts by name", "numbers": "list of numbers",
         "texts": "list of texts", "boolean": "true or false"}


def number(value):
    return f"{value:.15g}"


def value_text(value):
    if isinstance(value, float):
        return number(value)
    return json.dumps(value, ensure_ascii=False)


def cell(text):
    """Text in a table, in which a bar would end the column."""
    return text.replace("|", "\\|").replace("<", "&lt;").replace("\n", " ")


def wrapped(text):
    return "\n".join(textwrap.wrap(text.replace("<", "&lt;"), 120, break_long_words=False, break_on_hyphens=False))


def range_text(parameter):
    low, high = parameter.get("min"), parameter.get("max")
    if low is None and high is None:
        text = ""
    elif high is None:
        text = f"at least {number(low)}"
    elif low is None:
        text = f"at most {number(high)}"
    else:
        text = f"{number(low)} to {number(high)}"
    least, most = parameter.get("min_count"), parameter.get("max_count")
    if least is not None and least == most:
        count = f"{least} of them"
    elif least is not None and most is not None:
        count = f"{least} to {most} of them"
    elif least is not None:
        count = f"at least {least} of them"
    elif most is not None:
        count = f"at most {most} of them"
    else:
        count = ""
    unit = parameter.get("unit", "")
    return ", ".join(part for part in (f"{text} {unit}".strip(), count) if part)


def type_text(parameter):
    choices = parameter.get("choices")
    if not choices:
        return TYPES.get(parameter["type"], parameter["type"])
    listed = ", ".join(f"`{choice}`" for choice in choices)
    return listed if parameter["type"] == "choice" else f"{TYPES.get(parameter['type'], parameter['type'])}: {listed}"


def parameter_table(parameters):
    rows = ["| parameter | type | range | default | what it does |", "|---|---|---|---|---|"]
    for p in parameters:
        default = f"`{cell(value_text(p['default']))}`" if "default" in p else "must be given"
        rows.append(f"| `{p['name']}` | {cell(type_text(p))} | {cell(range_text(p))} | {default} | {cell(p['help'])} |")
    return "\n".join(rows)


def port_table(ports, title):
    rows = [f"| {title} | type | what it is |", "|---|---|---|"]
    for port in ports:
        kind = f"list of {port['type']}" if port["list"] else port["type"]
        rows.append(f"| `{port['name']}` | {kind}{', optional' if port['optional'] else ''} | {cell(port['help'])} |")
    return "\n".join(rows)


def example_command(name):
    if name not in READS:
        return f"build/terrazzo run examples/guide/nodes/{name}.json"
    writer, file = READS[name]
    return (f"build/terrazzo run examples/guide/nodes/{writer}.json\n"
            f"build/terrazzo run examples/guide/nodes/{name}.json --set from={MADE / writer / file}")


def example_summary(name):
    """What the example shows; --check complains if there is none."""
    path = GUIDE / "nodes" / f"{name}.json"
    return json.loads(path.read_text())["summary"] if path.exists() else ""


def page(node):
    name = node["name"]
    example = example_summary(name)
    parts = [f"# {name}", wrapped(node["summary"] + "."),
             f"![{example}](../pictures/nodes/{name}.jpg)",
             wrapped(f"{example}: [{name}.json]({name}.json).") + f"\n\n```sh\n{example_command(name)}\n"
             f"test -f {MADE / name / 'picture.jpg'}\n```",
             wrapped(node["help"])]
    for ports, title in ((node["inputs"], "input"), (node["outputs"], "output")):
        if ports:
            parts.append(port_table(ports, title))
    if node["parameters"]:
        parts.append(parameter_table(node["parameters"]))
    if node.get("steps"):
        rows = ["| step | when | what it does |", "|---|---|---|"]
        rows += [f"| `{s['name']}` | {cell(s['when'])} | {cell(s['help'])} |" for s in node["steps"]]
        parts += ["The steps of the synthesis, in their order; [how synthesis works](../how-synthesis-works.md) explains"
                  " them:", "\n".join(rows)]
    parts.append(f"Version {node['version']}. [All node types](../nodes.md)")
    return "\n\n".join(parts) + "\n"


def index(nodes):
    parts = ["# Nodes", wrapped(
        "Every node type, with its ports, its parameters, and a small graph that runs as it stands. `build/terrazzo nodes "
        "TYPE` prints the same. `examples/guide/nodes.py` writes these pages from what the program says, and with "
        "`--pictures` makes their pictures.")]
    for category, title in CATEGORIES.items():
        rows = ["| node | what it does |", "|---|---|"]
        rows += [f"| [{n['name']}](nodes/{n['name']}.md) | {cell(n['summary'])} |" for n in nodes
                 if n["category"] == category]
        parts += [f"## {title}", "\n".join(rows)]
    return "\n\n".join(parts) + "\n"


def make_picture(program, name):
    command = [program, "run", GUIDE / "nodes" / f"{name}.json", "--progress", "none", "--set", f"out={MADE / name}"]
    if name in READS:
        writer, file = READS[name]
        command += ["--set", f"from={MADE / writer / file}"]
    subprocess.run(command, check=True, cwd=ROOT)
    shutil.copy(ROOT / MADE / name / "picture.jpg", GUIDE / "pictures" / "nodes" / f"{name}.jpg")


def complaints(pages, nodes):
    for path, text in pages.items():
        if not path.exists():
            yield f"{path.relative_to(ROOT)} is missing"
        elif path.read_text() != text:
            yield f"{path.relative_to(ROOT)} is not current"
    for node in nodes:
        for path in (GUIDE / "nodes" / f"{node['name']}.json", GUIDE / "pictures" / "nodes" / f"{node['name']}.jpg"):
            if not path.exists():
                yield f"{path.relative_to(ROOT)} is missing"
    names = {node["name"] for node in nodes}
    for path in sorted([*(GUIDE / "nodes").iterdir(), *(GUIDE / "pictures" / "nodes").iterdir()]):
        if path.stem not in names:
            yield f"{path.relative_to(ROOT)} belongs to no node type"


def main():
    options = [a for a in sys.argv[1:] if a.startswith("-")]
    others = [a for a in sys.argv[1:] if not a.startswith("-")]
    if len(others) > 1 or len(options) > 1 or not set(options) <= {"--check", "--pictures"}:
        sys.exit(__doc__)
    program = pathlib.Path(others[0] if others else ROOT / "build" / "terrazzo").resolve()
    said = subprocess.run([program, "nodes", "--json"], check=True, capture_output=True, text=True).stdout
    nodes = json.loads(said)
    unknown = {node["category"] for node in nodes} - CATEGORIES.keys()
    if unknown:
        sys.exit(f"{__file__}: CATEGORIES lacks {', '.join(sorted(unknown))}")
    pages = {GUIDE / "nodes.md": index(nodes)}
    pages |= {GUIDE / "nodes" / f"{node['name']}.md": page(node) for node in nodes}

    if "--check" in options:
        found = list(complaints(pages, nodes))
        for line in found:
            print(line, file=sys.stderr)
        if found:
            print("run examples/guide/nodes.py, with --pictures where an example is new or another", file=sys.stderr)
        sys.exit(1 if found else 0)

    (GUIDE / "pictures" / "nodes").mkdir(parents=True, exist_ok=True)
    for path, text in pages.items():
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    if "--pictures" in options:
        for node in sorted(nodes, key=lambda n: n["name"] in READS):
            make_picture(program, node["name"])


if __name__ == "__main__":
    main()
