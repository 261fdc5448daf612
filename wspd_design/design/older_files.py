"""Design files of the version before: read as the present one, as far as they say the same."""

from typing import Any

from wspd_design.design.records import rail_hash, vehicle_hash
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.versions import DESIGN_1, tell_outdated

OLDER = "wspd-design/1"


def as_present(document: dict[str, Any], where: str) -> dict[str, Any]:
    """Return a design file of ``wspd-design/1`` with what the present version states beyond it.

    Its fingerprint of the vehicle was made in another way and it has none of the rail, so that nobody can tell whether
    either has changed since: both become those of the shipped files as they are now.

    Parameters
    ----------
    document : dict
        As TOML gives it.
    where : str
        The file, in sentences.

    Raises
    ------
    UserError
        If it was made for a vehicle or a rail of one's own, of which the file does not say where it is.
    """
    vehicle, rail = document.get("vehicle"), document.get("rail")
    for kind, name in (("vehicle", vehicle), ("rail", rail)):
        if name not in available("vehicle" if kind == "vehicle" else "rail"):
            raise UserError(
                f'{where} is not a design of this version: schema = "{OLDER}" does not say where its {kind} '
                f"{name} is; re-run wspd design"
            )
    tell_outdated(DESIGN_1, where, stacklevel=4)
    return document | {
        "vehicle_hash": vehicle_hash(load_vehicle(str(vehicle))),
        "rail_hash": rail_hash(load_rail(str(rail))),
    }
