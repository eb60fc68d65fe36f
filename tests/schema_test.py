#!/usr/bin/env python3
"""The JSON Schema of graph files against a public validator: every graph that is right passes, and of the wrong ones in
tests/errors all are found but those that no schema can find.

Usage: schema_test.py SOURCE_FOLDER PROGRAM TEST_PROGRAM
The wrong graphs are of made-up node types, whose schema the test program prints.
"""
import json
import pathlib
import re
import subprocess
import sys

import jsonschema

# What these get wrong lies between parts of a document, on the command line, or in the text as such.
BEYOND_A_SCHEMA = {
    "cycle", "duplicate-names", "override-spelling", "override-unknown", "override-values", "override-wires",
    "override-without-parameters", "parameter-not-set", "parameters-that-disagree", "reference-of-wrong-type",
    "unknown-reference", "wire-from-sink", "wire-of-wrong-type"}


def read(text):
    """Graph files have comments, and a comma may follow the last entry."""
    text = re.sub(r'("(?:[^"\\]|\\.)*")|//[^\n]*', lambda m: m.group(1) or "", text)
    text = re.sub(r'("(?:[^"\\]|\\.)*")|,(\s*[}\]])', lambda m: m.group(1) or m.group(2), text)
    return json.loads(text)


def validator_from(command):
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    schema = json.loads(text[text.index("{"):text.rindex("}") + 1])
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def main():
    source, program, test_program = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    wrong = []
    validator = validator_from([program, "schema"])

    right = sorted(source.glob("graphs/*.json")) + sorted(source.glob("examples/**/*.json"))
    right = [path for path in right if path.parent.name != "plugin"]  # their node types are in no schema without it
    right = [path for path in right if not path.name.endswith((".presets.json", ".schema.json"))]
    for path in right:
        error = jsonschema.exceptions.best_match(validator.iter_errors(read(path.read_text())))
        if error:
            wrong.append(f"{path}: {error.json_path}: {error.message[:300]}")

    validator = validator_from([test_program, "--no-skip", "-tc=prints the schema of the made-up types"])
    found = unread = 0
    errors = sorted(source.glob("tests/errors/*.json"))
    for path in errors:
        try:
            document = read(path.read_text())
        except ValueError:
            unread += 1
            continue
        is_found = not validator.is_valid(document)
        found += is_found
        if is_found == (path.stem in BEYOND_A_SCHEMA):
            wrong.append(f"{path}: the schema {'finds it, so it belongs no longer to those beyond it' if is_found else 'does not find it'}")
    print(f"{len(right)} right graphs; of {len(errors)} wrong ones {unread} are no JSON, {found} are found by the schema, "
          f"{len(errors) - unread - found} are beyond it")
    print("\n".join(wrong))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
