"""P0 of eq 39 by SciPy, for the observers of lyapunov.csv: P0 A0 + A0' P0 = -I.

    python3 lyapunov.py > lyapunov.csv        needs numpy and scipy
"""
import sys
import numpy as np
from scipy.linalg import solve_continuous_lyapunov

CASES = [((2, 2), (1, 1)), ((0.7, 3), (2.5, 0.4)), ((1, 1), (4, 0.25)), ((10, 0.1), (20, 0.02)), ((1.4, 1.8), (1, 0.9))]

names = [f"p{i}{j}" for i in range(4) for j in range(4)]
print(",".join(["alpha1_1", "alpha1_2", "alpha2_1", "alpha2_2", *names, "least", "norm"]))
for a1, a2 in CASES:
    a0 = np.block([[-np.diag(a1), np.eye(2)], [-np.diag(a2), np.zeros((2, 2))]])
    p = solve_continuous_lyapunov(a0.T, -np.eye(4))
    values = np.linalg.eigvalsh(p)
    row = [*a1, *a2, *p.ravel(), values[0], values[-1]]
    print(",".join(repr(float(x)) for x in row))
print(f"scipy {__import__('scipy').__version__}", file=sys.stderr)
