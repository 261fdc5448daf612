"""Keys and words that several forms share."""

from wspd_design.certificates.records import Status
from wspd_design.exchange.forms import Key
from wspd_design.plants.names import PLANTS
from wspd_design.simulation.runs import Ending

ANY, PAIR = (0, None), (2, 2)
STATUSES = tuple(status.name for status in Status)
ENDINGS = tuple(ending.name.lower() for ending in Ending)

SCHEMA_KEY = Key(name="schema", kind="text", meaning="name of this form")
VERSION_KEY = Key(name="version", kind="text", meaning="of the program")
CONTROLLER_KEY = Key(name="controller", kind="text", meaning="name of the controller or of the design")
VEHICLE_KEY = Key(name="vehicle", kind="text", meaning="name of the vehicle")
RAIL_KEY = Key(name="rail", kind="text", meaning="name of the rail")
PLANT_KEY = Key(name="plant", kind="text", meaning="model of the vehicle", words=PLANTS)
SAMPLE_TIME_KEY = Key(name="sample_time_s", kind="number", meaning="of the controller")
SPEED_KEY = Key(name="initial_speed_m_s", kind="number", meaning="of the train")
CASE_KEYS = (SCHEMA_KEY, CONTROLLER_KEY, VEHICLE_KEY, RAIL_KEY, PLANT_KEY, SAMPLE_TIME_KEY, SPEED_KEY)
"""How every object about stops of one law begins."""
REFERENCE_KEY = Key(name="slip_reference", kind="number", meaning="slip that the controller is asked to hold")
SEED_KEY = Key(name="seed", kind="integer", meaning="of all random numbers")


def nullable(name: str, meaning: str) -> Key:
    """Return the key of a number that does not always exist."""
    return Key(name=name, kind="number", nullable=True, meaning=meaning)
