"""References for tests/exact/heavy_top.rs, 40 digits; used by hand (some minutes).

    pip install mpmath gmpy2
    python tests/exact/heavy_top.py > tests/exact/heavy_top.json

`taylor` integrates Euler's equations with the torque of gravity, the direction of gravity in the body and the quaternion
by power series. `euler` is Euler's angles with Legendre's integrals, for the rows of 10⁴ nutations, after meeting the
former at short times.
"""

import json
import sys

from mpmath import asin, cos, ellipf, ellipfun, ellipk, ellippi, floor, mp, mpf, polyroots, sin, sqrt

mp.dps = 45


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def times(a, b):
    v = cross(a[1:], b[1:])
    return [a[0] * b[0] - dot(a[1:], b[1:])] + [a[0] * b[i + 1] + b[0] * a[i + 1] + v[i] for i in range(3)]


def turn(q, v):
    return times(times(q, [mpf(0)] + list(v)), [q[0]] + [-x for x in q[1:]])[1:]


def unit(v):
    return [x / sqrt(dot(v, v)) for x in v]


def back(q, v):
    return turn([q[0]] + [-x for x in q[1:]], v)


def taylor(I1, I3, axis, ml, g, q, w_W, moments, order=28, step=mpf(1) / 4):
    """Rows (q, w_W); moments are times."""
    e, q = unit(axis), unit(q)
    state, now, rows = [q, back(q, w_W), back(q, g)], mpf(0), []
    rate = sqrt(dot(w_W, w_W)) + sqrt(abs(ml) * sqrt(dot(g, g)) / I1)
    for t in moments:
        count = max(1, int(abs(t - now) * rate / step))
        h = (t - now) / count
        for _ in range(count):
            Q, W, G = [state[0]], [state[1]], [state[2]]
            for n in range(order):
                dq, dw, dg = [mpf(0)] * 4, [ml * x / I1 for x in cross(e, G[n])], [mpf(0)] * 3
                for i in range(n + 1):
                    w = W[i]
                    dq = [x + y / 2 for x, y in zip(dq, times(Q[n - i], [mpf(0)] + w))]
                    dg = [x + y for x, y in zip(dg, cross(G[n - i], w))]
                    # I ω = I₁ ω + (I₃ − I₁)(ω·e) e.
                    c = (I3 - I1) / I1 * dot(W[n - i], e)
                    dw = [x + c * y for x, y in zip(dw, cross(e, w))]
                Q.append([x / (n + 1) for x in dq])
                W.append([x / (n + 1) for x in dw])
                G.append([x / (n + 1) for x in dg])
            state = [[sum(c[k] * h**n for n, c in enumerate(s)) for k in range(len(s[0]))] for s in (Q, W, G)]
        now = t
        rows.append((unit(state[0]), turn(unit(state[0]), state[1])))
    return rows


def nutation(I1, I3, axis, ml, g, q, w_W):
    """Constants of Euler's angles z-x-z between up and the axis."""
    q, e, up = unit(q), unit(axis), unit([-x for x in g])
    n = turn(q, e)
    w3 = dot(w_W, n)
    a, u0 = I3 * w3 / I1, dot(n, up)
    b = dot(w_W, up) - w3 * u0 + a * u0
    beta = 2 * ml * sqrt(dot(g, g)) / I1
    across = [x - w3 * y for x, y in zip(w_W, n)]
    alpha = dot(across, across) + beta * u0
    u_dot = dot(up, cross(w_W, n))
    roots = sorted(r.real for r in polyroots([beta, -alpha - a * a, 2 * a * b - beta, alpha - b * b], maxsteps=500, extraprec=200))
    return q, e, up, n, w3, a, b, beta, u0, u_dot, roots


def euler(I1, I3, axis, ml, g, q, w_W, moments):
    """Rows (q, w_W), ml > 0, off u = ±1."""
    q, e, up, n, w3, a, b, beta, u0, u_dot, (u1, u2, u3) = nutation(I1, I3, axis, ml, g, q, w_W)
    lam, m = sqrt(beta * (u3 - u1)) / 2, (u2 - u1) / (u3 - u1)
    K = ellipk(m)
    x0 = ellipf(asin(sqrt(max(mpf(0), min(mpf(1), (u0 - u1) / (u2 - u1))))), m) * (1 if u_dot > 0 else -1)

    def third(N, x):
        count = floor(x / (2 * K) + mpf(1) / 2)
        x -= 2 * K * count
        return 2 * count * ellippi(N, m) + ellippi(N, asin(ellipfun("sn", x, m=m)), m)

    def integrals(x):
        below = (b + a) / (1 + u1) / lam * third(-(u2 - u1) / (1 + u1), x)
        above = (b - a) / (1 - u1) / lam * third((u2 - u1) / (1 - u1), x)
        return (below + above) / 2, (below - above) / 2

    rows = []
    for t in moments:
        x = x0 + lam * t
        start, end = integrals(x0), integrals(x)
        phi, psi = end[0] - start[0], (w3 - a) * t + end[1] - start[1]
        sn, cn, dn = (ellipfun(f, x - 2 * K * floor(x / (2 * K) + mpf(1) / 2), m=m) for f in ("sn", "cn", "dn"))
        u, udot = u1 + (u2 - u1) * sn**2, 2 * (u2 - u1) * lam * sn * cn * dn
        # Turn by ψ about the axis, by θ − θ₀ about the line of nodes, by φ about up.
        nodes = unit(cross(up, n))
        c, s = u * u0 + sqrt((1 - u * u) * (1 - u0 * u0)), sqrt(1 - u * u) * u0 - u * sqrt(1 - u0 * u0)
        tilt = unit([1 + c] + [s * x for x in nodes])
        about = lambda v, angle: [cos(angle / 2)] + [sin(angle / 2) * x for x in v]
        Q = times(about(up, phi), times(tilt, times(about(n, psi), q)))
        N = turn(Q, e)
        # ω = [(b − au)(up − uN) + u̇ N × up]/(1 − u²) + ω₃ N.
        side = cross(N, up)
        w = [((b - a * u) * (p - u * k) + udot * s) / (1 - u * u) + w3 * k for p, k, s in zip(up, N, side)]
        rows.append((Q, w))
    return rows


def period(*case):
    *_, beta, _, _, (u1, u2, u3) = nutation(*case)
    return 2 * ellipk((u2 - u1) / (u3 - u1)) / (sqrt(beta * (u3 - u1)) / 2)


TILTED = [0.7977693643100509, 0.29916351161626903, -0.3988846821550254, 0.3390519798317716]
LEVEL = [1.0, 0.0, 0.0, 0.0]
# 30° from the vertical about e₃; the axis is e₂, up too.
LEANING = [0.9659258262890683, 0.0, 0.0, 0.25881904510252074]
Y, SKEW, DOWN, ASKEW = [0.0, 1.0, 0.0], [1.0, 2.0, -2.0], [0.0, -9.81, 0.0], [3.0, -7.0, 5.5]
SHORT = [0.3, 1.1, 2.3]
# name, I₁, I₃, axis, m l, g, q_WB, ω in body axes (turned to the world and rounded), times, whether 10⁴ nutations too
CASES = [
    ("generic", 1.0, 0.4, SKEW, 0.3, ASKEW, TILTED, [1.5, 3.0, -4.0], SHORT, True),
    ("centre of mass below", 1.0, 0.4, SKEW, -0.3, ASKEW, TILTED, [1.5, 3.0, -4.0], SHORT, False),
    ("flat", 0.6, 1.1, Y, 0.3, DOWN, TILTED, [0.5, 7.0, -1.0], SHORT + [-2.0], True),
    ("released at rest", 1.0, 0.4, Y, 0.3, DOWN, LEANING, [0.0, 12.0, 0.0], SHORT, True),
    ("released at rest, fast", 1.0, 0.4, Y, 0.003, DOWN, LEANING, [0.0, 60.0, 0.0], [0.3], True),
    ("looping", 1.0, 0.4, Y, 0.3, DOWN, LEANING, [-1.5, 14.0, 0.1], SHORT, True),
    ("spherical pendulum", 1.0, 0.0, Y, 0.3, DOWN, TILTED, [0.7, 2.0, 0.4], SHORT, True),
    ("spherical pendulum, spinning rod", 1.0, 0.2, Y, -0.3, DOWN, LEANING, [0.7, 0.0, 0.4], SHORT, False),
    ("plane pendulum", 1.0, 0.2, Y, -0.3, DOWN, LEANING, [0.0, 0.0, 0.4], SHORT, False),
    ("plane pendulum from the bottom", 1.0, 0.2, Y, -0.3, DOWN, LEVEL, [1.0, 0.0, 0.4], SHORT, False),
    ("plane pendulum over the top", 1.0, 0.2, Y, 0.3, DOWN, LEANING, [0.0, 0.0, 5.0], SHORT, False),
    ("from the top with spin", 1.0, 0.4, Y, 0.3, DOWN, LEVEL, [1.0, 6.0, 0.4], SHORT, False),
    ("from the bottom with spin", 1.0, 0.4, Y, -0.3, DOWN, LEVEL, [1.0, 6.0, 0.4], SHORT, False),
    ("nearly over the top", 1.0, 0.2, Y, 0.3, DOWN, LEANING, [1e-9, 1e-8, 5.0], SHORT, False),
    ("nearly asleep", 1.0, 0.4, Y, 0.3, DOWN, LEVEL, [1e-7, 20.0, 0.0], SHORT, False),
    ("asleep", 1.0, 0.4, Y, 0.3, DOWN, LEVEL, [0.0, 20.0, 0.0], SHORT, False),
    ("asleep, to wake", 1.0, 0.4, Y, 0.3, DOWN, LEVEL, [1e-9, 3.0, 0.0], SHORT + [12.0], False),
    ("hanging", 1.0, 0.4, Y, -0.3, DOWN, LEVEL, [0.0, 2.0, 0.0], SHORT, False),
    ("nearly hanging", 1.0, 0.4, Y, -0.3, DOWN, LEVEL, [1e-8, 2.0, 0.0], SHORT, False),
    ("nearly weightless", 1.0, 0.4, Y, 1e-18, DOWN, TILTED, [1.5, 3.0, -4.0], SHORT, False),
    ("weightless", 1.0, 0.4, SKEW, 0.0, DOWN, TILTED, [1.5, 3.0, -4.0], SHORT, False),
    ("sphere", 1.0, 1.0, SKEW, 0.3, ASKEW, TILTED, [1.5, 3.0, -4.0], SHORT, True),
]


def row(t, q, w):
    return {"t_s": float(t), "q_WB": [float(x) for x in q], "w_WB": [float(x) for x in w]}


cases = []
for name, I1, I3, axis, ml, g, q, w_B, moments, long in CASES:
    exact = [mpf(I1), mpf(I3), [mpf(x) for x in axis], mpf(ml), [mpf(x) for x in g], [mpf(x) for x in q]]
    w = [float(x) for x in turn(unit(exact[5]), [mpf(x) for x in w_B])]
    exact.append([mpf(x) for x in w])
    rows = [row(t, *r) for t, r in zip(moments, taylor(*exact, [mpf(t) for t in moments]))]
    if long:
        found = euler(*exact, [mpf(t) for t in moments])
        away = [max(abs(x - y) for x, y in zip(r["w_WB"], f[1])) for r, f in zip(rows, found)]
        away += [1 - abs(dot([mpf(x) for x in r["q_WB"]], f[0])) for r, f in zip(rows, found)]
        print(f"{name}: Euler's angles are off by {mp.nstr(max(away), 2)}", file=sys.stderr)
        assert max(away) < 1e-13
        end = float(10000 * period(*exact) * mpf("1.000037"))
        rows += [row(end, *euler(*exact, [mpf(end)])[0])]
    else:
        print(name, file=sys.stderr)
    keys = ["name", "transverse", "axial", "axis_B", "first_moment", "gravity", "q_WB", "w_WB", "rows"]
    cases.append(dict(zip(keys, [name, I1, I3, axis, ml, g, q, w, rows])))
print("[\n" + ",\n".join("  " + json.dumps(c) for c in cases) + "\n]")
