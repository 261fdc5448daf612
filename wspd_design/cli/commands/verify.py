"""``wspd verify``: what can be said about the stability of a closed loop."""

import typer

from wspd_design.certificates.kernel.file import file_name
from wspd_design.certificates.records import Certificate
from wspd_design.cli import options
from wspd_design.cli.arguments import check_quarter, chosen
from wspd_design.cli.console import print_json
from wspd_design.cli.exit_codes import GOOD, REFUTED, UNDECIDED
from wspd_design.cli.json_objects import verification_object
from wspd_design.cli.option_records import takes_records
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.cli.verification import (
    exit_code,
    interrupted_checks,
    run_checks,
    show_claims,
    show_not_varied,
    show_verdicts,
)
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.design.catalog import is_design_file
from wspd_design.design.certification import (
    folder_beside,
    problem_of_case,
    stored_beside,
    write_certificates,
)

_VERDICTS = {GOOD: "good", REFUTED: "refuted", UNDECIDED: "undecided"}


@takes_records
def verify(
    *,
    name: options.ControllerArgument = None,
    controller: options.ControllerOption = None,
    vehicle: options.VehicleOption = None,
    plant: options.QuarterOption = options.QUARTER,
    rail: options.RailOption = None,
    slip: options.SlipOption = None,
    speeds: options.SpeedsOption = None,
    sample_time: options.SampleTimeOption = None,
    sensors: SensorOptions,
    seed: options.SeedOption = 0,
    only: options.OnlyOption = None,
    effort: options.EffortOption = 1.0,
    as_json: options.JsonOption = False,
) -> None:
    """Check the stability of a closed loop, claim by claim.

    Exit code 1 when a claim is refuted or a limitation is proved, else 3 when one is undecided, else 0. With --only a
    check that is not proved counts as undecided. What lies beside a design and is accepted again is not searched again.
    Ctrl-C shows what is finished and keeps it beside the design.
    """
    check_quarter(plant, "verify")
    case = load_case(
        chosen(name, controller),
        CaseOptions(
            vehicle=vehicle,
            rail=rail,
            slip=slip,
            speeds=speeds,
            sample_time=sample_time,
            sensors=sensors.words,
        ),
    )
    problem = problem_of_case(case, seed=seed)
    written = chosen(name, controller)
    ran = run_checks(problem, only, effort, stored_beside(written))
    certificates = ran.certificates
    if not ran.complete:
        if certificates and not as_json:
            show_claims(problem, certificates)
            show_verdicts(certificates)
        own_case = is_design_file(written) and not (vehicle or rail or seed)
        raise interrupted_checks(ran, only, _kept(written, certificates) if own_case else "")
    code = exit_code(certificates, asked=bool(only))
    if as_json:
        print_json(verification_object(problem, certificates, plant=plant, verdict=_VERDICTS[code]))
    else:
        show_claims(problem, certificates)
        show_verdicts(certificates)
        show_not_varied(problem, certificates)
    raise typer.Exit(code)


def _kept(design: str, certificates: tuple[Certificate, ...]) -> str:
    """Keep what is finished beside the design, where the next run looks; files that are there stay."""
    folder = folder_beside(design)
    missing = [each for each in certificates if not (folder / file_name(each)).exists()]
    if not write_certificates(missing, folder):
        return ""
    return f"; what a checker can decide is kept in {folder}, and the same command goes on from there"
