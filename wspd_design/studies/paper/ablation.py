"""The paper's law with its parts taken out one by one: what does the work?"""

from dataclasses import replace

from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy, AdaptiveFuzzyGains
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import DEFAULT_PLANT
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Run
from wspd_design.simulation.stop import simulate
from wspd_design.studies.paper.evidence import Ablation
from wspd_design.studies.paper.slip_history import slip_history

IDEAL_FILL_TIME = 0.01  # s, of the near-ideal actuator: a sixtieth of the real one
IDEAL_SAMPLE_TIME = 1e-3  # s
SIGN_LAYER = 1e-3  # in s, whose printed gain is 1800 per unit of slip: sat becomes sgn


def ablation(
    vehicle: Vehicle, law: AdaptiveFuzzy, scenario: Scenario, *, plant: str = DEFAULT_PLANT
) -> Ablation:
    """Simulate the printed law, its simplifications, and the printed law on a near-ideal actuator.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    law : AdaptiveFuzzy
        The law as printed, with its command in kN m.
    scenario : Scenario
        The stop.
    plant : str
        Name of the model.
    """
    share = replace(law.gains, torque_unit=law.max_torque)
    relay = replace(
        _unadapted(share),
        initial_weights=(0.0,) * len(share.initial_weights),
        initial_bound=1.0,
        boundary_layer=SIGN_LAYER,
    )

    def distance(gains: AdaptiveFuzzyGains) -> float:
        return simulate(vehicle, replace(law, gains=gains), scenario, plant=plant).totals.distance

    def ripple(run: Run) -> float:
        return slip_history(
            run, slip_reference=law.gains.slip_reference, max_torque=law.max_torque
        ).late_ripple

    printed = simulate(vehicle, law, scenario, plant=plant)
    fast = replace(vehicle.brake, fill_time=IDEAL_FILL_TIME, vent_time=IDEAL_FILL_TIME)
    ideal = simulate(
        replace(vehicle, brake=fast), replace(law, sample_time=IDEAL_SAMPLE_TIME), scenario, plant=plant
    )
    states = [sample.state for samples in printed.axle_samples for sample in samples]
    unit = law.gains.torque_unit / law.max_torque
    return Ablation(
        rail=scenario.rail.name,
        printed=printed.totals.distance,
        as_share=distance(share),
        unadapted=distance(_unadapted(share)),
        relay=distance(relay),
        unadapted_printed=distance(_unadapted(law.gains)),
        largest_weight=unit * max(abs(weight) for state in states for weight in state[1:-1]),
        bound_growth=max(state[-1] for state in states) / law.gains.initial_bound,
        ripple=ripple(printed),
        ideal_ripple=ripple(ideal),
    )


def _unadapted(gains: AdaptiveFuzzyGains) -> AdaptiveFuzzyGains:
    return replace(gains, weight_rate=0.0, bound_rate=0.0)
