#!/usr/bin/env python3
"""Non-negative basis pursuit by scikit-learn's coordinate descent and SciPy's L-BFGS-B, on the matrices that
basis_pursuit_benchmark wrote: seconds until P(x) is within 1e-3 and 1e-5 of the least, ours beside.

    pursuit_peers.py FOLDER      needs: pip install numpy scipy scikit-learn

Forming the matrix is not counted, and the peers are told nothing of how far they are: each run has a tolerance, and the
fastest that came near enough counts.
"""
import json
import pathlib
import sys
import time
import warnings

import numpy as np
from scipy.optimize import minimize
from sklearn.linear_model import Lasso

WANTED = (1e-3, 1e-5)  # of P, relative


def coordinate_descent(a, s, penalty, tolerance):
    model = Lasso(alpha=penalty / s.size, positive=True, fit_intercept=False, tol=tolerance, max_iter=100_000)
    return model.fit(a, s).coef_


def quasi_newton(a, s, penalty, tolerance):
    def objective(x):
        r = a @ x - s
        return 0.5 * r @ r + penalty * x.sum(), a.T @ r + penalty
    return minimize(objective, np.zeros(a.shape[1]), jac=True, method="L-BFGS-B", bounds=[(0, None)] * a.shape[1],
                    options={"ftol": tolerance, "gtol": 0, "maxiter": 20_000, "maxfun": 20_000}).x


def seconds_to(solve, a, s, penalty, least):
    """Of each wanted precision: seconds of the first run, in order of tolerance, that reached it; None where none did."""
    seconds = dict.fromkeys(WANTED)
    for tolerance in 10.0 ** -np.arange(2, 13):
        start = time.perf_counter()
        x = solve(a, s, penalty, tolerance)
        taken = time.perf_counter() - start
        r = a @ x - s
        excess = (0.5 * r @ r + penalty * x.sum()) / least - 1
        for wanted in WANTED:
            if excess <= wanted and seconds[wanted] is None:
                seconds[wanted] = taken
        if None not in seconds.values() or taken > 120:
            break
    return seconds


def ours(problem):
    return {w: next((h["seconds"] for h in problem["history"] if h["relative_gap"] <= w), None) for w in WANTED}


def main():
    warnings.simplefilter("ignore")
    for path in sorted(pathlib.Path(sys.argv[1]).glob("*.json")):
        problem = json.loads(path.read_text())
        s = np.fromfile(path.with_suffix(".target"))
        a = np.asfortranarray(np.fromfile(path.with_suffix(".matrix")).reshape(problem["columns"], problem["rows"]).T)
        least = problem["primal"] * (1 - problem["relative_gap"])  # the certificate's lower bound
        rows = {"ours": ours(problem)}
        for name, solve in (("scikit-learn", coordinate_descent), ("SciPy L-BFGS-B", quasi_newton)):
            rows[name] = seconds_to(solve, a, s, problem["penalty"], least)
        print(f"{path.stem}: {a.shape[0]} x {a.shape[1]}")
        for name, seconds in rows.items():
            cells = (f"{w:.0e}: {t:8.3f} s, {t / rows['ours'][w]:7.1f} x" if t else f"{w:.0e}: not reached" for w, t in seconds.items())
            print(f"  {name:15}", "  ".join(cells), flush=True)


if __name__ == "__main__":
    main()
