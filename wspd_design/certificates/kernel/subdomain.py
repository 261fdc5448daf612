"""The part of a domain on which something was proved, as it stands beside the proof.

A search chooses the part; the checker takes its ends from the certificate, makes the claim for this part from the
design, and says on which part it holds. A part that is smaller than need be shows less, but nothing false.
"""

import json
from collections.abc import Mapping
from dataclasses import replace
from math import isfinite
from typing import Any

from wspd_design.certificates.kernel.enclosures import Refused
from wspd_design.certificates.records import Proof

KEY = "part"
MOST_DIGITS = 40  # of a number

Ends = tuple[float, float]


def with_part(proof: Proof, quantity: str, ends: Ends) -> Proof:
    """Add to the certificate of a proof on which range of a quantity [SI units] it stands."""
    content = json.loads(proof.certificate) | {KEY: {quantity: [repr(end) for end in ends]}}
    return replace(proof, certificate=json.dumps(content, indent=1))


def stated_part(content: Mapping[str, Any], quantity: str, within: Ends) -> Ends:
    """Read the range of a quantity from a certificate.

    Parameters
    ----------
    content : mapping
        The certificate; nothing in it is believed.
    quantity : str
        The only one that the part may restrict.
    within : tuple of float
        Its range on the domain [SI units].

    Raises
    ------
    Refused
        If no two numbers are stated, the first is larger than the second, or they leave the domain.
    """
    part = content.get(KEY)
    written = part.get(quantity) if isinstance(part, dict) and len(part) == 1 else None
    if not isinstance(written, list) or len(written) != 2:
        raise Refused(f"the proof states no range of {quantity}")
    low, high = (_number(each, quantity) for each in written)
    if not within[0] <= low <= high <= within[1]:
        raise Refused(
            f"{quantity} from {low:g} to {high:g} is no part of the domain, {within[0]:g} to {within[1]:g}"
        )
    return low, high


def _number(written: object, quantity: str) -> float:
    """Read a double as Python writes it."""
    try:
        found = float(written) if isinstance(written, str) and len(written) <= MOST_DIGITS else None
    except ValueError:
        found = None
    if found is None or not isfinite(found):
        raise Refused(f"the proof states no range of {quantity}")
    return found
