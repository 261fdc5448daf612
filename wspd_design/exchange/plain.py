"""Plain data that JSON can hold."""

import math
from typing import Any


def finite(value: Any) -> Any:
    """Return plain data with null for every number that is not finite, which JSON does not have."""
    match value:
        case float() if not math.isfinite(value):
            return None
        case dict():
            return {key: finite(item) for key, item in value.items()}
        case list() | tuple():
            return [finite(item) for item in value]
    return value
