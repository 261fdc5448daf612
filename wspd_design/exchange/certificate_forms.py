"""The form of a certificate file, which ``wspd certify`` writes and ``wspd check`` decides about."""

from wspd_design.certificates.kernel.file import SCHEMA
from wspd_design.exchange.check_forms import GROUNDS
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
        *GROUNDS,
        Key(name="varied", kind="text", many=ANY, meaning="numbers with bounds that the claim varies"),
        Key(name="held", kind="text", many=ANY, meaning="numbers with bounds that the claim holds"),
        Key(name="method", kind="text", meaning="how the verdict was found"),
        Key(name="reference", kind="text", meaning="where the argument stands"),
        Key(name="model_sha256", kind="text", meaning="fingerprint of all that the verdict rests on"),
        Key(
            name="formulas",
            kind="value",
            meaning="formulas of several statements in the findings, which name them by their place from 0",
        ),
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
