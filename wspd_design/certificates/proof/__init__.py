"""Proofs of inequalities on boxes: a fast prover that nobody has to trust and a small checker that one can read.

>>> claim = Claim(name=..., variables=(variable("slip", (0.02, 0.6), "-"), ...), expression=f, relation="<=",
...               bound=Fraction(30), unit="m/s2", form=g)
>>> finding = settle(claim, tolerance=1e-3)

``claim.py`` says what is claimed, ``tape.py`` and ``prover.py`` search, ``engine.py`` brings both sides together;
``checker.py`` with ``balls.py`` and ``identity.py`` decides.
"""
