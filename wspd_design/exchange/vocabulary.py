"""All objects that the program writes: one vocabulary, from which schemas and documentation follow."""

from wspd_design.exchange.campaign_forms import CAMPAIGN, CAMPAIGNS
from wspd_design.exchange.certificate_forms import CERTIFICATE
from wspd_design.exchange.check_forms import VERIFICATION
from wspd_design.exchange.design_forms import DESIGN_FILE
from wspd_design.exchange.ladder_forms import LADDER
from wspd_design.exchange.modes_forms import MODES
from wspd_design.exchange.search_forms import SEARCH
from wspd_design.exchange.stop_forms import COMPARISON, STOP
from wspd_design.exchange.study_forms import BRAKE, LINEARIZATION, REPORT

STANDING_ALONE = (
    STOP,
    CAMPAIGN,
    CAMPAIGNS,
    COMPARISON,
    VERIFICATION,
    LADDER,
    LINEARIZATION,
    MODES,
    BRAKE,
    SEARCH,
    REPORT,
    CERTIFICATE,
)
"""Forms of the JSON objects that stand alone, each with a schema file."""
WITH_SCHEMA = (*STANDING_ALONE, DESIGN_FILE)
"""Those and the design file, which is TOML with keys of its own."""
