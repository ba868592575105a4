"""Validates lines of JSON by their JSON Schema, with PyPI's `jsonschema`.

Usage: check_lines.py SCHEMA LINES [SCHEMA LINES]...
"""

import json
import sys

import jsonschema

for schema_file, lines_file in zip(sys.argv[1::2], sys.argv[2::2]):
    with open(schema_file, encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    with open(lines_file, encoding="utf-8") as file:
        for line in file:
            error = jsonschema.exceptions.best_match(validator.iter_errors(json.loads(line)))
            if error is not None:
                sys.exit(f"{schema_file}: {error.json_path}: {error.message}\n{line}")
