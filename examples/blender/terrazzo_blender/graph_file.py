# Reads the exposed parameters and presets of a graph file: JSON with comments and trailing commas. Plain Python.
import json
import os
import re

TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/|,(?=(?:\s|//[^\n]*|/\*.*?\*/)*[\]}])', re.DOTALL)
OUTPUT_NAMES = ("out", "output", "result")
SOURCE_NAMES = ("material", "image")


class GraphError(Exception):
    pass


def without_comments(text):
    return TOKEN.sub(lambda m: m.group(0) if m.group(0).startswith('"') else " ", text)


def read(path):
    """The document. Raises GraphError with a sentence."""
    try:
        with open(path, encoding="utf-8") as file:
            document = json.loads(without_comments(file.read()))
    except OSError as e:
        raise GraphError(f"The graph {path} cannot be read: {e.strerror}.")
    except ValueError as e:
        raise GraphError(f"{path} is no graph file: {e}.")
    if not isinstance(document, dict) or "terrazzo" not in document:
        raise GraphError(f"{path} is no graph file: it has no \"terrazzo\".")
    return document


def parameters(document):
    """[(name, declaration)] in the file's order."""
    return [(n, p) for n, p in document.get("parameters", {}).items() if isinstance(p, dict)]


def role(name, declaration):
    """"out": the folder of results, "source": the exemplar, which the add-on sets; or nothing."""
    if declaration.get("type") == "path" and name in OUTPUT_NAMES:
        return "out"
    return "source" if declaration.get("type") == "path" and name in SOURCE_NAMES else ""


def presets(path, document):
    """Names of presets in the document and in the file beside it."""
    names = list(document.get("presets", {}))
    beside = os.path.splitext(path)[0] + ".presets.json"
    if os.path.isfile(beside):
        try:
            with open(beside, encoding="utf-8") as file:
                names += [n for n in json.loads(without_comments(file.read())) if n not in names]
        except (OSError, ValueError):
            pass
    return names


def typed(value, kind):
    """A field's text as a value of a parameter of this type."""
    if isinstance(value, str) and kind not in ("text", "path", "choice"):
        try:
            return json.loads(value)
        except ValueError:
            pass  # an expression, or a size such as 64x32
    return value


def text_of(value):
    """A default as a field shows it, and as --set takes it; expressions stay."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return value if isinstance(value, str) else json.dumps(value)
