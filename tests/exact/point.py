"""References for tests/exact/point.rs, 40 digits; used by hand (a minute).

    pip install mpmath gmpy2
    python tests/exact/point.py > tests/exact/point.json

`taylor` integrates the differential equations by power series, term by term. Rows beyond its reach are the limits at
late times, which need one constant each; it is said where.
"""

import json
import sys

from mpmath import cos, mp, mpf, sin, sqrt

mp.dps = 50


def taylor(step, state, t, h, order=40):
    """Power series of `order` terms, restarted after h(state) at most."""
    now = mpf(0)
    while now != t:
        left = t - now
        length = left if abs(left) <= h(state) else h(state) * (1 if left > 0 else -1)
        state = [sum(c * length**n for n, c in enumerate(s)) for s in step(state, order)]
        now = t if length == left else now + length
    return state


def quadratic(g, k):
    def step(state, order):
        p, v = [state[0]], [state[1]]
        sign = 1 if v[0] >= 0 else -1
        for n in range(order):
            square = sum(v[i] * v[n - i] for i in range(n + 1))
            p.append(v[n] / (n + 1))
            v.append(((g if n == 0 else 0) - sign * k * square) / (n + 1))
        return p, v

    return step


def along(g, k, v0, t):
    """(s, v) on the line; from the turning point on with the other sign of drag."""
    state, now = [mpf(0), v0], mpf(0)

    def h(state):
        return 1 / (8 * (sqrt(g * k) + k * abs(state[1])) + mpf(10) ** -6)

    if v0 < 0 < g:
        # v = 0, by Newton's method on the integrated motion.
        turn = -v0 / (g + k * v0 * v0)
        for _ in range(60):
            v = taylor(quadratic(g, k), state, turn, h)[1]
            if abs(v) < mpf(10) ** -45:
                break
            turn -= v / (g + k * v * v)
        if t > turn:
            s, _ = taylor(quadratic(g, k), state, turn, h)
            state, now = [s, mpf(0)], turn
    return taylor(quadratic(g, k), state, t - now, h)


def late(g, k, v0, t):
    """Falling for so long that v = v_t: s = v_t t + c, where c is that of the motion at τ = 60."""
    terminal = sqrt(g / k)
    tau = 60 / sqrt(g * k)
    assert t > tau
    s, v = along(g, k, v0, tau)
    assert abs(v / terminal - 1) < mpf(10) ** -40
    return s + terminal * (t - tau), terminal


def linear(a, rate):
    def step(state, order):
        p, v = [state[0]], [state[1]]
        for n in range(order):
            p.append(v[n] / (n + 1))
            v.append(((a if n == 0 else 0) - rate * v[n]) / (n + 1))
        return p, v

    return step


def harmonic(g, waves):
    """State: p, v, then cos and sin of each phase."""

    def step(state, order):
        series = [[x] for x in state]
        for n in range(order):
            a = g if n == 0 else mpf(0)
            for i, (A, w, _) in enumerate(waves):
                c, s = series[2 + 2 * i], series[3 + 2 * i]
                a += A * c[n]
                c.append(-w * s[n] / (n + 1))
                s.append(w * c[n] / (n + 1))
            series[0].append(series[1][n] / (n + 1))
            series[1].append(a / (n + 1))
        return series

    return step


QUADRATIC = [
    # name, g, k, v0, times
    ("from rest", 9.81, 0.03, 0.0, [1e-9, 1e-3, 0.5, 3.0, 20.0]),
    ("thrown down", 9.81, 0.03, 5.0, [1e-9, 1e-3, 0.5, 3.0, 20.0]),
    ("faster than the terminal speed", 9.81, 0.03, 100.0, [1e-9, 1e-3, 0.5, 3.0, 20.0]),
    ("far faster", 9.81, 2.0, 1e6, [1e-9, 1e-3, 0.5]),
    ("thrown up", 9.81, 0.03, -30.0, [1e-9, 0.5, 1.5, 1.8, 2.0, 3.0, 20.0]),
    ("thrown up fast", 9.81, 0.5, -3000.0, [1e-9, 1e-3, 0.1, 0.7, 1.0, 3.0]),
    ("nearly without drag", 9.81, 1e-13, -5.0, [1e-3, 0.5, 3.0]),
    ("nearly without gravity", 1e-9, 0.3, 4.0, [1e-3, 0.5, 30.0]),
    ("without drag", 9.81, 0.0, -5.0, [1e-3, 3.0]),
    ("without gravity", 0.0, 0.3, 4.0, [1e-9, 0.5, 30.0]),
]
LATE = [("from rest", 9.81, 0.03, 0.0, [300.0, 1e9]), ("faster than the terminal speed", 9.81, 0.03, 100.0, [300.0, 1e9])]
LINEAR = [
    # name, acceleration, c/m, v0, times
    ("decay", 0.0, 1.0, 1.0, [1e-9, 0.5, 1.0, 3.0, 40.0]),
    ("falling", 9.81, 0.7, -4.0, [1e-9, 1e-3, 0.9, 1.5, 30.0]),
    ("nearly without drag", 9.81, 1e-12, -4.0, [1e-3, 1.5, 30.0]),
    ("without drag", 9.81, 0.0, -4.0, [1e-3, 1.5, 30.0]),
    ("backwards", 9.81, 0.7, -4.0, [-1e-3, -1.2, -2.5]),
]
HARMONIC = [
    # name, g, (A, ω, φ), v0, times
    ("shaken", -9.81, [(3.0, 7.0, 0.4), (-2.0, 11.0, -1.3)], 1.5, [1e-6, 1e-3, 0.1, 0.7, 5.0]),
    ("slowly", 0.0, [(3.0, 1e-9, 1.1), (2.0, 1e-3, 3.0)], 0.0, [1e-3, 0.7, 50.0]),
    ("constant", 1.0, [(3.0, 0.0, 1.1)], 0.5, [1e-3, 0.7, 50.0]),
    ("long", 0.0, [(3.0, 7.0, 0.4)], 0.0, [1000.0]),
]


def rows(times, at):
    return [{"t_s": t, "p_m": float(p), "v_m_s": float(v)} for t in times for p, v in [at(mpf(t))[:2]]]


out = {"quadratic": [], "linear": [], "harmonic": []}
for name, g, k, v0, times in QUADRATIC:
    print(name, file=sys.stderr)
    found = rows(times, lambda t: along(mpf(g), mpf(k), mpf(v0), t))
    for other, G, K, V, more in LATE:
        if other == name:
            found += rows(more, lambda t: late(mpf(G), mpf(K), mpf(V), t))
    out["quadratic"].append({"name": name, "g": g, "k": k, "v": v0, "rows": found})
for name, a, rate, v0, times in LINEAR:
    state = [mpf(0), mpf(v0)]
    found = rows(times, lambda t: taylor(linear(mpf(a), mpf(rate)), state, t, lambda _: mpf(1) / 4))
    out["linear"].append({"name": name, "a": a, "rate": rate, "v": v0, "rows": found})
for name, g, waves, v0, times in HARMONIC:
    exact = [tuple(map(mpf, w)) for w in waves]
    state = [mpf(0), mpf(v0)] + [x for _, _, phase in exact for x in (cos(phase), sin(phase))]
    found = rows(times, lambda t: taylor(harmonic(mpf(g), exact), state, t, lambda _: mpf(1) / 10))
    out["harmonic"].append({"name": name, "g": g, "waves": waves, "v": v0, "rows": found})
print("{")
print(",\n".join(f' "{key}": [\n' + ",\n".join("  " + json.dumps(c) for c in cases) + "\n ]" for key, cases in out.items()))
print("}")
