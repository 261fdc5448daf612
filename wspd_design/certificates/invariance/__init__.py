"""Invariant sets of sampled laws in slip and torque, found on cells and checked again on balls.

``one_sample.py`` encloses where a cell can be one sample later, with the law from ``duals.py``; ``search.py`` finds
the largest sets of ``cells.py`` that it keeps; ``document.py`` writes them down. ``checker.py`` decides, with
``runs.py``, ``ball_plant.py`` and ``ball_slopes.py``. Where nothing is found, ``escape.py`` simulates whether anything
could be. ``certificate.py`` is the verdict.
"""
