"""The form of a certificate file, which ``wspd certify`` writes and ``wspd check`` decides about."""

from wspd_design.certificates.kernel.file import SCHEMA
from wspd_design.exchange.check_forms import HYPOTHESIS, POINT, RANGE
from wspd_design.exchange.common_keys import ANY, SCHEMA_KEY, STATUSES
from wspd_design.exchange.forms import Form, Key

CERTIFICATE = Form(
    name="certificate",
    schema=SCHEMA,
    keys=(
        SCHEMA_KEY,
        Key(name="check", kind="text", meaning="name of the check"),
        Key(name="title", kind="text", meaning="what is checked"),
        Key(name="status", kind="text", words=STATUSES, meaning="verdict on the claim"),
        Key(name="claim", kind="text", meaning="what is claimed"),
        Key(name="explanation", kind="text", meaning="why the verdict is so"),
        Key(name="margin", kind=RANGE, nullable=True, meaning="positive when the claim holds"),
        Key(name="worst_point", kind=POINT, many=ANY, meaning="coordinates of the tightest point"),
        Key(name="witness", kind=POINT, many=ANY, meaning="coordinates of a point where the claim fails"),
        Key(name="hypotheses", kind=HYPOTHESIS, many=ANY, meaning="conditions of the theorem"),
        Key(name="assumptions", kind="text", many=ANY, meaning="what is taken for granted"),
        Key(name="varied", kind="text", many=ANY, meaning="numbers with bounds that the claim varies"),
        Key(name="held", kind="text", many=ANY, meaning="numbers with bounds that the claim holds"),
        Key(name="method", kind="text", meaning="how the verdict was found"),
        Key(name="reference", kind="text", meaning="where the argument stands"),
        Key(name="model_sha256", kind="text", meaning="fingerprint of all that the verdict rests on"),
        Key(
            name="findings",
            kind="value",
            meaning="object with a finding for each obligation of the theorem, see docs/certificates.md",
        ),
        Key(
            name="made_by",
            kind="value",
            meaning="object with the versions of what searched; no verdict rests on it",
        ),
    ),
)
