"""Forms of one stop and of several side by side."""

from wspd_design.exchange.common_keys import (
    ANY,
    CASE_KEYS,
    ENDINGS,
    REFERENCE_KEY,
    SCHEMA_KEY,
    SEED_KEY,
    STATUSES,
    VERSION_KEY,
    nullable,
)
from wspd_design.exchange.forms import Form, Key
from wspd_design.simulation.records import FAULT_KINDS, IRREGULARITIES

START = Form(
    name="start",
    keys=(
        Key(name="slip", kind="number", meaning="share by which the rims are slower than the train"),
        Key(name="torque_Nm", kind="number", meaning="per wheelset, of the cylinder pressure"),
        Key(
            name="braking_time_s",
            kind="number",
            meaning="since the brake was applied: supply, vibration of the pads and damping are as far on",
        ),
    ),
)
PATCH = Form(
    name="patch",
    keys=(
        Key(name="from_m", kind="number", meaning="where the rail changes"),
        Key(name="rail", kind="text", meaning="name of the rail from there on"),
    ),
)
FAULT = Form(
    name="fault",
    keys=(
        Key(name="axle", kind="integer", meaning="from 1 at the front"),
        Key(name="kind", kind="text", words=FAULT_KINDS, meaning="what fails for the rest of the stop"),
        Key(name="since_s", kind="number", meaning="from the start of the stop"),
    ),
)
SCENARIO = Form(
    name="scenario",
    keys=(
        Key(name="start", kind=START, meaning="state of all wheelsets at the start"),
        Key(
            name="axle_rails",
            kind="text",
            many=ANY,
            nullable=True,
            meaning="rails below the axles, front first, in place of rail; null for one rail",
        ),
        Key(name="patches", kind=PATCH, many=ANY, meaning="changes of rail along the track"),
        Key(name="grade", kind="number", meaning="rise over run, positive uphill"),
        Key(name="pad_vibration", kind="flag", meaning="T_d of Section 7"),
        Key(
            name="load_spread",
            kind="number",
            meaning="root mean square of what the relative wheel loads differ from 1 by, along the table",
        ),
        Key(
            name="irregularities",
            kind="text",
            meaning="level of the irregularities of the track, ERRI B 176, that the seed draws",
            words=IRREGULARITIES,
        ),
        Key(name="speed_noise_m_s", kind="number", meaning="rms, of the measured rim speed"),
        Key(
            name="pulses_per_turn",
            kind="integer",
            meaning="of the pulse wheel; 0 for a wheel speed that is known at each instant",
        ),
        Key(
            name="period_timing",
            kind="flag",
            meaning="whether the time between pulses gives the wheel speed, in place of their count over a sample",
        ),
        Key(
            name="reference_error",
            kind="number",
            meaning="relative error of the train speed that the controller knows",
        ),
        Key(
            name="reference_drift_m_s2",
            kind="number",
            meaning="by which that speed moves away from the true one",
        ),
        Key(name="reference_noise_m_s", kind="number", meaning="rms, of that speed"),
        Key(
            name="torque_error",
            kind="number",
            meaning="relative error of the torque that the controller computes from the pressure",
        ),
        Key(name="accelerometer_bias_m_s2", kind="number", meaning="of the accelerometer of the vehicle"),
        Key(name="accelerometer_noise_m_s2", kind="number", meaning="rms, of the accelerometer"),
        Key(
            name="radius_errors",
            kind="number",
            many=ANY,
            meaning="relative error of the speed read from each wheel, front first; empty for none",
        ),
        Key(name="faults", kind=FAULT, many=ANY, meaning="what fails at single wheelsets"),
        Key(name="dead_time_s", kind="number", meaning="from the command to the valve, by option or vehicle"),
        Key(
            name="shortest_pulse_s",
            kind="number",
            meaning="shorter ones do not open a valve; by option or vehicle",
        ),
    ),
)
WITNESS = Form(
    name="witness",
    keys=(
        Key(name="check", kind="text", meaning="name of the check"),
        Key(name="status", kind="text", words=STATUSES, meaning="what the certificate says it is"),
        Key(
            name="same_problem",
            kind="flag",
            meaning="whether the certificate is about the numbers of this design, vehicle and rail",
        ),
        Key(name="mass_kg", kind="number", meaning="of the simulated plant; the controller keeps its own"),
        Key(name="wheelset_inertia_kg_m2", kind="number", meaning="of the simulated plant"),
        Key(name="mu0", kind="number", meaning="friction without sliding of the simulated plant"),
        Key(
            name="holding_torque_Nm",
            kind="number",
            meaning="torque per wheelset that holds the slip at the start, whether the brake has it or not",
        ),
        Key(
            name="left_after_s",
            kind="number",
            nullable=True,
            meaning="until the slip is 0.05 away from where it began; null if never, and for many stops",
        ),
    ),
)
STEP_CHECK = Form(
    name="step_check",
    keys=(
        Key(name="distance_change", kind="number", meaning="of the distance with half steps, relative"),
        Key(
            name="slip_change",
            kind="number",
            meaning="largest change of a slip above 0.3 m/s with half steps",
        ),
        Key(
            name="refinement",
            kind="integer",
            meaning="by which the steps were divided until they were short enough",
        ),
        Key(
            name="sensitive",
            kind="flag",
            meaning="the closed loop amplifies: runs from slightly different initial speeds diverge",
        ),
        Key(
            name="unresolved",
            kind="flag",
            meaning="no step is short enough: half of the shortest steps still change the stop",
        ),
        Key(
            name="spread_m",
            kind="number",
            meaning="range of the distance over slightly different initial speeds; 0 unless sensitive",
        ),
    ),
)

STOP = Form(
    name="stop",
    schema="wspd-stop/2",
    keys=(
        *CASE_KEYS,
        Key(name="scenario", kind=SCENARIO, meaning="where the stop starts and what disturbs it"),
        Key(name="witness", kind=WITNESS, nullable=True, meaning="the witness that the stop starts at"),
        Key(
            name="drawn",
            kind="number",
            by_name=True,
            nullable=True,
            meaning="numbers that --only-run drew from their bounds, in SI units; null for a stop with nominal ones",
        ),
        REFERENCE_KEY,
        Key(
            name="ending",
            kind="text",
            words=ENDINGS,
            meaning="stopped; time_limit for a train that was still moving; runaway for one that no brake can stop",
        ),
        Key(name="distance_m", kind="number", meaning="to standstill or to the time limit"),
        Key(name="stopping_time_s", kind="number", meaning="to standstill or to the time limit"),
        Key(
            name="torque_integral_Nms",
            kind="number",
            meaning="transmitted braking torque over time, sum over the wheelsets",
        ),
        nullable(
            "ideal_stop_m",
            "distance of the ideal stop, a simulation of a brake that holds the best slip; nothing is proved by it. "
            "null where ideal_ending is not stopped",
        ),
        Key(
            name="ideal_ending",
            kind="text",
            words=ENDINGS,
            nullable=True,
            meaning="of the ideal stop; time_limit for a train that no brake of this vehicle stops in time, "
            "runaway for one that none can stop. null where "
            "it is not known: changes of rail along the track, starts from a witness",
        ),
        nullable("efficiency", "ideal stop over distance"),
        nullable(
            "released_below_m_s",
            "speed from which on the wheelsets transmit less than a tenth of what brake and rail give until the end, "
            "for a second or more; null where the brake was not released",
        ),
        nullable("adhesion_utilization", "impulse of the creep forces over that of the adhesion peak"),
        nullable(
            "build_up_s", "until the torque of all wheelsets first reaches 90 % of its median above 10 km/h"
        ),
        nullable("build_up_distance_m", "distance until then"),
        nullable(
            "lag_s",
            "2 d/v0 - t: distance and time of a stop in another form, negative where the deceleration falls",
        ),
        nullable("lag_distance_m", "initial speed times lag"),
        nullable("plateau_m_s2", "v0/(2 (t - d/v0)): deceleration after the build-up"),
        nullable(
            "slip_rms",
            "above 10 km/h, about the reference, or about the slips that the law tells; the build-up counts",
        ),
        nullable(
            "slip_reached_s", "until the first wheelset has 90 % of its slip reference; null if none has"
        ),
        nullable("held_slip_rms", "as slip_rms, each wheelset from that moment on"),
        nullable("slip_overshoot", "likewise, largest excess over the reference"),
        nullable("slip_undershoot", "likewise, largest shortfall"),
        nullable(
            "perfect_slip_rms",
            "held_slip_rms of a brake that fills and then holds the reference; null for a law with its own references",
        ),
        Key(
            name="slips_held",
            kind="number",
            many=(2, 2),
            nullable=True,
            meaning="least and largest slip that the law held above 10 km/h; null for a law that does not tell",
        ),
        nullable(
            "slip_band",
            "largest distance of the slip from the one that the law holds, at samples above 10 km/h once it was "
            "reached; null for a law that does not tell it",
        ),
        nullable(
            "speed_error",
            "largest relative error above 20 km/h of the train speed that the law goes by; null for one that does "
            "not tell it",
        ),
        nullable(
            "distance_error",
            "largest error of the distance that follows from that speed, over 5 m + 5 % of the distance; null likewise",
        ),
        nullable("slip_mean", "above 10 km/h"),
        nullable("slip_max", "above 10 km/h"),
        Key(name="lock_time_s", kind="number", meaning="of the wheelset that is locked longest"),
        Key(
            name="longest_lock_s",
            kind="number",
            meaning="longest lock of a wheelset without a break, above 10 km/h",
        ),
        Key(
            name="valve_switches",
            kind="integer",
            meaning="changes of the valve state, mean of the wheelsets with a brake",
        ),
        Key(
            name="vented_air",
            kind="number",
            meaning="full brake cylinders let out, mean of the wheelsets with a brake",
        ),
        nullable(
            "air_used_Nl",
            "normal litres that all brake cylinders took from the reservoir; null where the vehicle states no "
            "cylinder volume",
        ),
        nullable(
            "lowest_reservoir_Pa",
            "pressure of the reservoir above the atmosphere at the end, which nothing refills; null where the vehicle "
            "states no volume of its reservoir",
        ),
        Key(
            name="watchdog_fills",
            kind="integer",
            nullable=True,
            meaning="times that the watchdog of a wheelset filled, all wheelsets; null without watchdogs",
        ),
        nullable("saturated_share", "share of the samples that fill or vent all the time"),
        Key(
            name="momentum_residual",
            kind="number",
            meaning="what is missing in the balance, relative to the initial value; on a vehicle with all degrees "
            "of freedom also what its other bodies, springs and dampers have",
        ),
        Key(
            name="energy_residual",
            kind="number",
            meaning="what is missing in the balance, relative to the initial value; on a vehicle with all degrees "
            "of freedom also what its other bodies, springs and dampers have",
        ),
        Key(name="step_check", kind=STEP_CHECK, meaning="what half the integration steps change"),
        Key(
            name="engine",
            kind="text",
            meaning="what computed it: compiled, compiled plant with the law in CasADi's virtual machine or in Python, "
            "or CasADi virtual machine",
        ),
        SEED_KEY,
        VERSION_KEY,
    ),
)
COMPARISON = Form(
    name="comparison",
    schema="wspd-comparison/2",
    keys=(
        SCHEMA_KEY,
        Key(name="stops", kind=STOP, many=(1, None), meaning="in the order of the command line"),
        VERSION_KEY,
    ),
)
