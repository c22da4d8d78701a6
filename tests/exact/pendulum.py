"""References for tests/exact/pendulum.rs, 40 digits: power series of θ, sin θ, cos θ; used by hand (a minute).
Late rows are brought back by whole periods (mpmath's K).

    pip install mpmath gmpy2
    python tests/exact/pendulum.py > tests/exact/pendulum.json
"""

import json

from mpmath import cos, ellipk, floor, mp, mpf, pi, sin, sqrt

mp.dps = 45


def taylor(ratio, theta, rate, t, order=36, step=mpf(1) / 4):
    count = max(1, int(abs(t) * (sqrt(ratio) + abs(rate)) / step))
    h = t / count
    for _ in range(count):
        T, W, S, C = [theta], [rate], [sin(theta)], [cos(theta)]
        for n in range(order):
            T.append(W[n] / (n + 1))
            W.append(-ratio * S[n] / (n + 1))
            S.append(sum(C[i] * W[n - i] for i in range(n + 1)) / (n + 1))
            C.append(-sum(S[i] * W[n - i] for i in range(n + 1)) / (n + 1))
        theta, rate = (sum(c * h**n for n, c in enumerate(s)) for s in (T, W))
    return theta, rate


def late(ratio, theta, rate, t):
    """After whole periods, of start velocity ≥ 0."""
    kk = rate**2 / (4 * ratio) + sin(theta / 2) ** 2
    period = (4 * ellipk(kk) if kk < 1 else 2 * ellipk(1 / kk) / sqrt(kk)) / sqrt(ratio)
    count = floor(t / period)
    end, end_rate = taylor(ratio, theta, rate, t - count * period)
    return end + (0 if kk < 1 else 2 * pi * count), end_rate


TIMES = [-1.3, 1e-3, 0.7, 3.0, 20.0]
# name, m g l, I, θ₀, θ̇₀, times
CASES = [
    ("librating", 3.0, 0.7, 1.0, -0.5, TIMES),
    ("released at rest", 3.0, 0.7, -2.5, 0.0, TIMES),
    ("small", 3.0, 0.7, 1e-8, 1e-9, TIMES),
    ("from the bottom", 3.0, 0.7, 0.0, 1.0, TIMES),
    ("rotating", 3.0, 0.7, 1.0, 6.0, TIMES),
    ("rotating back, other turn", 3.0, 0.7, 15.0, -6.0, TIMES),
    ("rotating fast", 3.0, 0.7, 2.0, 300.0, [-0.1, 1e-3, 0.7]),
    ("nearly over the top", 2.0, 0.5, 0.0, 3.9999999, TIMES),
    ("just over the top", 2.0, 0.5, 0.0, 4.0000001, TIMES),
    ("separatrix", 2.0, 0.5, 0.0, 4.0, [-1.3, 1e-3, 0.7, 3.0]),
    ("balanced, to fall", 2.0, 0.5, 3.1415, 0.0, TIMES),
    ("long", 3.0, 0.7, 2.0, 0.0, [40000.0]),
    ("long, rotating", 3.0, 0.7, 2.0, 4.0, [20000.0]),
]

cases = []
for name, moment, inertia, theta, rate, times in CASES:
    ratio = mpf(moment) / mpf(inertia)
    rows = [[t] + [float(x) for x in (late if t > 100 else taylor)(ratio, mpf(theta), mpf(rate), mpf(t))] for t in times]
    cases.append({"name": name, "moment": moment, "inertia": inertia, "theta": theta, "rate": rate, "rows": rows})
print("[\n" + ",\n".join("  " + json.dumps(c) for c in cases) + "\n]")
