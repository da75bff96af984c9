"""What is wrong with a file's keys, in one sentence."""

from pydantic import ValidationError

_TAGS = {"baseline_angle", "plane", "fan", "flat", "dome", "layers"}
"""Values of `kind`, which pydantic puts into the place of an error but users did not write."""


def explain(error: ValidationError) -> str:
    """Say one thing that is wrong: the key, what it must be, and what it is."""
    # A misspelt key is unknown and missing at once: the unknown one says more.
    errors = sorted(
        error.errors(include_url=False), key=lambda item: item["type"] != "extra_forbidden"
    )
    first = errors[0]
    key = ".".join(str(part) for part in first["loc"] if part not in _TAGS)
    if first["type"] == "extra_forbidden":
        return f"the key {key} is unknown; remove it or mend its spelling."
    if first["type"] == "missing":
        return f"the key {key} is missing; add it."
    if first["type"] == "list_type":
        return f"{key} is a list of tables; write [[{key}]]."
    if first["type"] == "union_tag_not_found":
        return f"the key {key}.kind is missing; add it."
    if first["type"] == "union_tag_invalid":
        return f"{key}.kind must be one of {first['ctx']['expected_tags']}."
    return f"{key}: {first['msg'].lower()}, got {first['input']!r}."
