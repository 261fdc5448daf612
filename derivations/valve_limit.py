"""What no law can do through a valve with a lag, and which laws that is true of.

Claims: the poles of the loop with the valve add up to p - 1/tau + (du/dT)/tau + trace(A_c), A_c the dynamics of the
law's own memory. A law that does not read the torque, with a memory of nothing but integrals of slip and speed,
has the last two zero. A lead filter on the slip error and an internal copy of the valve are not in this class: they
stabilize every pole p.
"""

import sympy as sp

from derivations.notation import symbols

p, tau, G = symbols("pole time_constant gain")
q, kappa, back = sp.symbols("q kappa K", real=True)

# --- the Jacobian: slip, torque, two memory states of any dynamics ------------------------------------------
_u_slip, _u_torque, *_u_memory = sp.symbols("u_slip u_T u_1 u_2", real=True)
own = sp.Matrix(2, 2, sp.symbols("A_11 A_12 A_21 A_22", real=True))  # A_c
_slip_drives, _torque_drives = (sp.Matrix(sp.symbols(f"{n}_1 {n}_2", real=True)) for n in ("h", "j"))
jacobian = sp.Matrix(
    sp.BlockMatrix(
        [
            [sp.Matrix([[p, G]]), sp.zeros(1, 2)],
            [sp.Matrix([[_u_slip, _u_torque - 1]]) / tau, sp.Matrix([_u_memory]) / tau],
            [sp.Matrix.hstack(_slip_drives, _torque_drives), own],
        ]
    )
)
trace_residual = sp.expand(jacobian.trace() - (p - 1 / tau + _u_torque / tau + own.trace()))
integral_residual = sp.expand(  # a memory of integrals of slip and speed
    jacobian.subs({_u_torque: 0} | dict.fromkeys(own, 0)).trace() - (p - 1 / tau)
)

# --- a lead filter z' = -(p + 12) z + e: u = u* + P e + Z z ---------------------------------------------------
_decay = p + 12
_gain = tau * (36 + p * _decay) / G  # P
_filter = _gain * (1 / tau - _decay)  # Z
lead = sp.Matrix([[p, -G, 0], [_gain / tau, -1 / tau, _filter / tau], [1, 0, -_decay]])  # e, T - T*, z
lead_residual = sp.expand((q * sp.eye(3) - lead).det() - (q + 1 / tau) * (q + 6) ** 2)
lead_trace_residual = sp.expand(lead.trace() - (p - 1 / tau - _decay))

# --- a copy of the valve: T_c follows the command u = u* + kappa e - K T_c as the valve does ------------------
copy = sp.Matrix(  # e, T - T*, T_c - T*
    [[p, -G, 0], [kappa / tau, -1 / tau, -back / tau], [kappa / tau, 0, -(1 + back) / tau]]
)
_two = tau * q**2 + (1 + back - p * tau) * q + G * kappa - (1 + back) * p
copy_residual = sp.expand(tau * (q * sp.eye(3) - copy).det() - (q + 1 / tau) * _two)
copy_trace_residual = sp.expand(copy.trace() - (p - 1 / tau - (1 + back) / tau))
