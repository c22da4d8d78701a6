"""References for tests/exact/free_rotation.rs, 40 digits; used by hand (some minutes).

    pip install mpmath gmpy2
    python tests/exact/free_rotation.py > tests/exact/free_rotation.json

`taylor` integrates Euler's equations and the quaternion; `closed` is Euler's angles z-x-z with Legendre's elliptic
integrals. The latter gives the rows of 10⁴ revolutions, after meeting the former at short times.
"""

import json
import sys

from mpmath import acos, atan2, cos, eigsy, ellipf, ellipfun, ellipk, ellippi, floor, matrix, mp, mpf, norm, sin, sqrt

mp.dps = 40


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rotation(q):
    w, x, y, z = [c / sqrt(sum(c * c for c in q)) for c in q]
    return matrix([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def quaternion(R):
    """Of the largest component, which is positive."""
    K = matrix([
        [R[0, 0] + R[1, 1] + R[2, 2], R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]],
        [R[2, 1] - R[1, 2], R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0]],
        [R[0, 2] - R[2, 0], R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1]],
        [R[1, 0] - R[0, 1], R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1]],
    ])
    i = max(range(4), key=lambda i: K[i, i])
    column = [K[j, i] + (1 if i == j else 0) for j in range(4)]
    length = sqrt(sum(c * c for c in column))
    return [c / length for c in column]


def taylor(I, q, w_W, times, order=30, turn=0.4):
    """Rows (t, R, w_W): power series of L_B, ω_B and q, term by term."""
    inverse = I**-1
    q = [c / sqrt(sum(c * c for c in q)) for c in q]
    L = list(I * (rotation(q).T * matrix(w_W)))
    now, rows = mpf(0), []
    for t in times:
        steps = max(1, int(abs(t - now) * norm(matrix(w_W)) * 2 / turn))
        h = (t - now) / steps
        for _ in range(steps):
            Ls, qs, ws = [L], [q], []
            for n in range(order):
                ws.append(list(inverse * matrix(Ls[n])))
                dL, dq = [mpf(0)] * 3, [mpf(0)] * 4
                for i in range(n + 1):
                    a, w = qs[n - i], ws[i]
                    dL = [x + y for x, y in zip(dL, cross(Ls[n - i], w))]
                    v = cross(a[1:], w)
                    dq[0] -= sum(a[k + 1] * w[k] for k in range(3)) / 2
                    for k in range(3):
                        dq[k + 1] += (a[0] * w[k] + v[k]) / 2
                Ls.append([x / (n + 1) for x in dL])
                qs.append([x / (n + 1) for x in dq])
            L = [sum(c[k] * h**n for n, c in enumerate(Ls)) for k in range(3)]
            q = [sum(c[k] * h**n for n, c in enumerate(qs)) for k in range(4)]
        now = t
        R = rotation(q)
        rows.append((t, R, R * (inverse * matrix(L))))
    return rows


def about(axis, angle):
    c, s = cos(angle), sin(angle)
    return matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]]) if axis == 3 else matrix([[1, 0, 0], [0, c, -s], [0, s, c]])


def closed(I, q, w_W, times):
    """Rows (t, R, w_W) of an asymmetric body off the separatrix."""
    moments, V = eigsy(I)
    R0 = rotation(q)
    L = [moments[i] * (V.T * R0.T * matrix(w_W))[i] for i in range(3)]
    LL = sum(x * x for x in L)
    twice_E = sum(L[i] ** 2 / moments[i] for i in range(3))
    order = [2, 1, 0] if LL < twice_E * moments[1] else [0, 1, 2]
    V = matrix([[V[r, i] for i in order] for r in range(3)])
    A, L = [moments[i] for i in order], [L[i] for i in order]

    def flip(i):
        L[i] = -L[i]
        for r in range(3):
            V[r, i] = -V[r, i]

    if L[2] < 0:
        flip(2)
    if mp.det(V) < 0:
        flip(0)
    # L₁ = p₁ cn, L₂ = p₂ sn, L₃ = p₃ dn.
    p1 = sqrt((LL - twice_E * A[2]) / (1 - A[2] / A[0]))
    p2 = sqrt((LL - twice_E * A[2]) / (1 - A[2] / A[1]))
    p3 = sqrt((LL - twice_E * A[0]) / (1 - A[0] / A[2]))
    p2 *= -1 if A[2] < A[1] else 1
    rate = (1 / A[1] - 1 / A[2]) * p2 * p3 / p1
    least = (twice_E - LL / A[1]) / (1 / A[2] - 1 / A[1])
    m = 1 - least / p3**2
    K = ellipk(m)
    n = -(p3**2) * m / (LL - p3**2)

    def periods(x):
        count = floor(x / (2 * K) + mpf(1) / 2)
        return count, x - count * 2 * K

    def integral(x):
        """∫ dx/(L² − L₃²)."""
        count, x = periods(x)
        phi = atan2(ellipfun("sn", x, m=m), ellipfun("cn", x, m=m))
        return (count * 2 * ellippi(n, m) + ellippi(n, phi, m)) / (LL - p3**2)

    def state(x):
        count, x = periods(x)
        sign = -1 if int(count) % 2 else 1
        return [sign * p1 * ellipfun("cn", x, m=m), sign * p2 * ellipfun("sn", x, m=m), p3 * ellipfun("dn", x, m=m)]

    start = ellipf(atan2(L[1] / p2, L[0] / p1), m)
    assert max(abs(a - b) for a, b in zip(state(start), L)) < mpf(10) ** -30 * sqrt(LL)

    def euler(L_P, psi):
        """World (with L along z) from P: z-x-z with L = |L| R₃ᵀ e₃."""
        theta, phi = acos(L_P[2] / sqrt(LL)), atan2(L_P[0], L_P[1])
        return about(3, psi) * about(1, theta) * about(3, phi)

    length = sqrt(LL)
    W = R0 * V * euler(L, mpf(0)).T
    rows = []
    for t in times:
        x = start + rate * t
        L_P = state(x)
        psi = length * t / A[2] + length * (twice_E - LL / A[2]) * (integral(x) - integral(start)) / rate
        R = W * euler(L_P, psi) * V.T
        rows.append((t, R, R * V * matrix([L_P[i] / A[i] for i in range(3)])))
    return rows


TILTED = [0.7977693643100509, 0.29916351161626903, -0.3988846821550254, 0.3390519798317716]
LEVEL = [1.0, 0.0, 0.0, 0.0]
FULL = [[2.0, 0.3, -0.2], [0.3, 1.5, 0.1], [-0.2, 0.1, 1.1]]


def of(*moments):
    return [[moments[i] if i == j else 0.0 for j in range(3)] for i in range(3)]


SHORT = [0.5, 2.0, 7.5]
# name, inertia, q_WB, ω in body axes (turned to the world and rounded), times, times of 10⁴ revolutions
CASES = [
    ("dzhanibekov", of(1.0, 2.0, 3.0), LEVEL, [0.01, 5.0, 0.01], [0.5, 7.5, 10.0], [12600.0]),
    ("dzhanibekov, small", of(1.0, 2.0, 3.0), TILTED, [1e-6, 5.0, -2e-7], [7.5, 10.0], [12600.0]),
    ("generic, low energy", of(1.0, 2.0, 2.5), TILTED, [0.4, -1.1, 1.9], SHORT, [28000.0]),
    ("generic, high energy", of(1.0, 2.0, 2.5), TILTED, [-1.7, 0.6, -0.5], SHORT, [34000.0]),
    ("off-diagonal", FULL, TILTED, [0.7, -1.3, 0.9], SHORT + [-3.0], [36000.0]),
    ("near the separatrix", of(4.0, 3.0, 1.5), TILTED, [3.0, 0.5, 4.0000001], SHORT, [12600.0]),
    ("on the separatrix", of(4.0, 3.0, 1.5), LEVEL, [3.0, 0.5, 4.0], SHORT + [-5.0], []),
    ("flat", of(1.0, 2.5, 3.5), TILTED, [0.2, 1.5, 1.0], SHORT, [34000.0]),
    ("prolate", of(1.0, 3.0, 3.0), TILTED, [2.0, 1.0, -0.7], SHORT, []),
    ("oblate", of(2.0, 3.0, 2.0), TILTED, [2.0, 1.0, -0.7], SHORT, []),
    ("oblate, spin in the equator", of(2.0, 3.0, 2.0), TILTED, [2.0, 0.0, -0.7], SHORT, []),
    ("prolate, spin in the equator", of(1.0, 3.0, 3.0), TILTED, [0.0, 1.0, -0.7], SHORT, []),
    ("isotropic", of(2.0, 2.0, 2.0), TILTED, [2.0, 1.0, -0.7], SHORT, []),
    ("nearly symmetric", of(2.0, 2.0000000001, 1.0), TILTED, [2.0, 1.0, -0.7], SHORT, [26000.0]),
    ("nearly isotropic", of(2.0, 2.0000000001, 1.9999999999), TILTED, [2.0, 1.0, -0.7], SHORT, [26000.0]),
    ("spin about the least axis", of(1.0, 2.0, 3.0), TILTED, [3.0, 1e-9, -2e-9], SHORT, [21000.0]),
    ("spin about the middle axis", of(1.0, 2.0, 3.0), LEVEL, [0.0, 3.0, 0.0], SHORT, []),
    ("spin about the greatest axis", of(1.0, 2.0, 3.0), TILTED, [1e-9, -2e-9, -3.0], SHORT, [21000.0]),
    ("exactly about the greatest axis", of(1.0, 2.0, 3.0), LEVEL, [0.0, 0.0, -3.0], SHORT, []),
    ("pencil", of(1.0, 1.0, 1e-9), TILTED, [0.5, 1.0, 2.0], SHORT, []),
]


def row(t, R, w):
    return {"t_s": float(t), "q_WB": [float(x) for x in quaternion(R)], "w_WB": [float(x) for x in w]}


cases = []
for name, I, q, w_B, times, long in CASES:
    exact_I, exact_q = matrix(I), [mpf(x) for x in q]
    w_W = [float(x) for x in rotation(exact_q) * matrix(w_B)]
    rows = taylor(exact_I, exact_q, [mpf(x) for x in w_W], [mpf(t) for t in times])
    if long:
        found = closed(exact_I, exact_q, [mpf(x) for x in w_W], [mpf(t) for t in times])
        off = max(mp.mnorm(a[1] - b[1], "f") + norm(a[2] - b[2]) for a, b in zip(rows, found))
        print(f"{name}: the closed form is off by {mp.nstr(off, 2)}", file=sys.stderr)
        assert off < mpf(10) ** -20
        rows += closed(exact_I, exact_q, [mpf(x) for x in w_W], [mpf(t) for t in long])
    else:
        print(name, file=sys.stderr)
    cases.append({"name": name, "I_B": I, "q_WB": q, "w_WB": w_W, "rows": [row(*r) for r in rows]})
lines = ",\n".join("  " + json.dumps(c) for c in cases)
print(f"[\n{lines}\n]")
