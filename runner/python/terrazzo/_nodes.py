"""Node types in Python."""

from __future__ import annotations

import ast
import collections
import inspect
import os
import pathlib
import textwrap
import threading
import traceback
import types
import typing
from typing import Any, Callable, Iterable, TypeVar, Union

from . import _terrazzo
from ._errors import Error, Failure

Function = TypeVar("Function", bound=Callable[..., Any])

_waiting: list[tuple[dict[str, Any], Callable[..., Any], tuple[Any, ...]]] = []
_lock = threading.Lock()
_version = 0
_owners: dict[str, tuple[str, str]] = {}
#: the last exceptions that nodes raised, with their messages
_raised: collections.deque[tuple[str, BaseException]] = collections.deque(maxlen=4)

_VALUES = {
    _terrazzo.Image: "image",
    _terrazzo.Material: "material",
    _terrazzo.UvMap: "uv_map",
    _terrazzo.Report: "report",
}
_PARAMS = {bool: "boolean", int: "integer", float: "number", str: "text", pathlib.Path: "path"}


def registered() -> int:
    """Registers the declared nodes. Their code is read only now, when everything that they call exists. Returns a
    number that grows with every new node."""
    global _version
    with _lock:
        while _waiting:
            description, function, uses = _waiting.pop(0)
            call = _with_paths(description, function)
            try:
                description["source"] = "\n".join(_sources(function, uses))
            except Error as e:
                # Graphs that do not use the node must still run.
                description["source"], call = "", _raises(e)
            _terrazzo.register_node(description, call)
            _version += 1
        return _version


def node(*, version: int = 1, name: str | None = None, uses: Iterable[Any] = ()) -> Callable[[Function], Function]:
    """Makes a function a node type. Arguments of type Image, Material, UvMap or Report are inputs: `Image | None` is
    optional, `list[Image]` takes several wires. All other arguments are parameters: bool, int, float, str, Path (a file
    or folder whose content counts; `Path | None` if it is optional), Literal["a", "b"], tuple[int, int] (a size),
    list[float] and list[str]. The function returns the output, and is annotated with its type.

    Results are cached. The key covers `version`, the source code of the function, the functions of its module that it
    calls, and the plain values around it that it uses; `uses` names more functions and values. The result must not
    depend on anything else; if it does, raise `version` when that changes."""

    def declare(function: Function) -> Function:
        description = _description(function, function.__name__ if name is None else name, version)
        _check(function, description)
        module = function.__module__
        owner = ("__main__" if module == "__mp_main__" else module, function.__qualname__)
        _sources(function, uses)  # raises if the function cannot be a node
        with _lock:
            taken = _owners.get(description["name"])
            if taken is None and description["name"] in _terrazzo.node_type_names():
                raise _fail(function, f'terrazzo or a plug-in has a node "{description["name"]}"')
            if taken is not None and taken != owner:
                raise _fail(function, f'there is a node "{description["name"]}" in {taken[0]} already')
            _owners[description["name"]] = owner
            _waiting.append((description, function, tuple(uses)))
        return function

    return declare


def _check(function: Callable[..., Any], description: dict[str, Any]) -> None:
    """Raises if it cannot be a node, at its declaration rather than in the next run."""
    version, name = description["version"], description["name"]
    if isinstance(version, bool) or not isinstance(version, int) or not 0 < version < 2**31:
        raise _fail(function, f"expected a version of 1 or more, found {version!r}")
    if not isinstance(name, str):
        raise _fail(function, f"expected a text for its name, found {name!r}")
    try:
        _terrazzo.check_node(description)
    except (Error, RuntimeError, TypeError, ValueError) as e:
        raise _fail(function, str(e)) from e


def _raises(error: Error) -> Callable[..., Any]:
    def call(**_: Any) -> Any:
        raise error

    return call


def _with_paths(description: dict[str, Any], function: Callable[..., Any]) -> Callable[..., Any]:
    """Converts texts to paths, and an empty text to None."""
    paths = [p["name"] for p in description["params"] if p["type"] == "path"]
    if not paths:
        return function

    def call(**arguments: Any) -> Any:
        for p in paths:
            arguments[p] = pathlib.Path(arguments[p]) if arguments[p] else None
        return function(**arguments)

    return call


def _fail(function: Callable[..., Any], what: str) -> Error:
    return Error(f'"{function.__name__}" cannot be a node: {what}')


def _description(function: Callable[..., Any], name: str, version: int) -> dict[str, Any]:
    try:
        hints = typing.get_type_hints(function)
    except NameError as e:
        raise _fail(function, f"an annotation has no meaning: {e}") from e
    output = _VALUES.get(hints.get("return", None))
    if output is None:
        raise _fail(function, "it must be annotated to return an Image, a Material, a UvMap or a Report")
    inputs, params = [], []
    for p in inspect.signature(function).parameters.values():
        if p.kind not in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY):
            raise _fail(function, f"its argument {p.name} is not one that has a name")
        if p.name not in hints:
            raise _fail(function, f"its argument {p.name} has no annotation")
        given = _input(p, hints[p.name])
        if given is not None:
            inputs.append(given)
        else:
            params.append(_param(function, p, hints[p.name]))
    doc = inspect.getdoc(function) or ""
    summary, _, rest = doc.partition("\n")
    return {
        "name": name,
        "version": version,
        "summary": summary or f"The Python function {name}",
        "help": rest.strip(),
        "inputs": inputs,
        "output": output,
        "params": params,
    }


def _input(p: inspect.Parameter, hint: Any) -> dict[str, Any] | None:
    optional = is_list = False
    if typing.get_origin(hint) in (Union, types.UnionType):
        rest = [a for a in typing.get_args(hint) if a is not type(None)]
        if len(rest) == 1 and p.default is None:
            hint, optional = rest[0], True
    if typing.get_origin(hint) is list and typing.get_args(hint)[0] in _VALUES:
        hint, is_list = typing.get_args(hint)[0], True
    if hint not in _VALUES:
        return None
    return {"name": p.name, "type": _VALUES[hint], "optional": optional, "list": is_list}


def _param(function: Callable[..., Any], p: inspect.Parameter, hint: Any) -> dict[str, Any]:
    out: dict[str, Any] = {"name": p.name, "help": "", "choices": []}
    if typing.get_origin(hint) in (Union, types.UnionType) and set(typing.get_args(hint)) == {pathlib.Path, type(None)}:
        hint = pathlib.Path
    args = typing.get_args(hint)
    origin = typing.get_origin(hint)
    if hint in _PARAMS:
        out["type"] = _PARAMS[hint]
    elif origin is typing.Literal and all(isinstance(a, str) for a in args):
        out["type"], out["choices"] = "choice", list(args)
    elif origin is tuple and args == (int, int):
        out["type"] = "size"
    elif origin is list and args in ((float,), (str,)):
        out["type"] = "numbers" if args == (float,) else "texts"
    else:
        raise _fail(function, f"nodes have no parameters such as {p.name}: {hint}")
    if p.default is not p.empty:
        out["default"] = "" if p.default is None and out["type"] == "path" else p.default
        if out["choices"] and p.default not in out["choices"]:
            raise _fail(function, f"{p.default!r} is none of the choices of {p.name}")
    return out


def _source_of(function: Callable[..., Any]) -> str:
    """The source without decorators, which may hold versions; for code typed into a prompt, the compiled code."""
    try:
        text = textwrap.dedent(inspect.getsource(function))
        tree = ast.parse(text).body[0]
        return "\n".join(text.splitlines()[tree.lineno - 1 :])
    except (OSError, TypeError, SyntaxError, IndexError):
        return _code_text(function.__code__)


def _code_text(code: types.CodeType) -> str:
    consts = [_code_text(c) if isinstance(c, types.CodeType) else repr(c) for c in code.co_consts]
    return repr((code.co_code.hex(), consts, code.co_names, code.co_varnames))


def _names_in(code: types.CodeType) -> Iterable[str]:
    yield from code.co_names
    for c in code.co_consts:
        if isinstance(c, types.CodeType):
            yield from _names_in(c)


_PLAIN = (bool, int, float, complex, str, bytes, type(None))


def _is_plain(value: Any) -> bool:
    return isinstance(value, _PLAIN) or (isinstance(value, (tuple, frozenset)) and all(map(_is_plain, value)))


def _sources(function: Callable[..., Any], uses: Iterable[Any]) -> list[str]:
    """The source code and plain values that the results of a function depend on."""
    out: list[str] = []
    seen: set[int] = set()
    module = function.__module__

    def add(what: str, value: Any) -> None:
        if isinstance(value, types.FunctionType):
            if value.__module__ == module or what == "use":
                add_function(value)
        elif _is_plain(value):
            out.append(f"{what} = {value!r}")
        elif what == "use":
            raise _fail(function, f"`uses` takes functions and plain values, not {value!r}")

    def add_function(f: types.FunctionType) -> None:
        if id(f) in seen:
            return
        seen.add(id(f))
        out.append(_source_of(f))
        for name in sorted(set(_names_in(f.__code__))):
            if name in f.__globals__:
                add(name, f.__globals__[name])
        for name, cell in zip(f.__code__.co_freevars, f.__closure__ or ()):
            try:
                value = cell.cell_contents
            except ValueError:
                continue
            if not isinstance(value, (types.FunctionType, types.ModuleType, type)) and not _is_plain(value):
                raise _fail(
                    function, f"its results depend on {name}, whose value no key can hold; make it a parameter or an input"
                )
            add(name, value)

    add_function(typing.cast(types.FunctionType, inspect.unwrap(function)))
    for use in uses:
        add("use", use)
    return out


def _describe(error: BaseException, trace: Any) -> str:
    """The last line of a traceback, with function, file and line."""
    text = traceback.format_exception_only(type(error), error)[-1].strip()
    frames = traceback.extract_tb(trace)
    if frames:
        last = frames[-1]
        text += f" ({last.name}, {os.path.basename(last.filename)}:{last.lineno})"
    text = text.encode("utf-8", "backslashreplace").decode()  # lone surrogates have no UTF-8 form
    if trace is not None:
        error = error.with_traceback(trace)
    _raised.append((text, error))
    return text


def _cause_of(failures: Iterable[Failure]) -> BaseException | None:
    """The exception that a node raised, for its traceback."""
    for failure in failures:
        for entry in list(_raised):
            if entry[0] in failure.message:
                try:
                    _raised.remove(entry)
                except ValueError:
                    pass
                return entry[1]
    return None
