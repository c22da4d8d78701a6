"""Scenes of the comparison, each with its answer.

A scene is plain numbers in SI units: gravity, duration, one Coulomb coefficient and one Newton restitution for every
pair, half-spaces n.x >= d, and bodies. Quaternions are (w, x, y, z), body to world; v and w are the velocity of the
centre of mass and the angular velocity, world frame. z is up.

Answers: closed forms where there are some; of the scenes marked ODE the equation of the one angle that moves is derived
here by hand (energy and the constraint) and integrated by SciPy's DOP853 to 1e-13: no engine, ours neither, has a part in
them. `python scenes.py` checks the answers against each other and prints them.
"""

from dataclasses import dataclass, field
from math import atan2, cos, hypot, pi, radians, sin, sqrt

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ellipk

G = 9.81


@dataclass
class Body:
    shape: str  # none | sphere | box | ellipsoid
    size: tuple  # () | (radius,) | half extents | semi-axes
    mass: float
    inertia: tuple  # principal, about the centre of mass, body axes
    pos: tuple
    quat: tuple = (1.0, 0.0, 0.0, 0.0)
    v: tuple = (0.0, 0.0, 0.0)
    w: tuple = (0.0, 0.0, 0.0)


@dataclass
class Scene:
    name: str
    duration: float
    bodies: list
    errors: object  # states -> {kind: error}
    gravity: tuple = (0.0, 0.0, -G)
    planes: list = field(default_factory=lambda: [(0.0, 0.0, 1.0, 0.0)])
    mu: float = 0.0
    e: float = 0.0

    def text(self):
        """The scene as `benches/peer.rs`, or any other program, reads it."""
        numbers = lambda xs: " ".join(repr(float(x)) for x in xs)
        lines = [f"scene {self.name}", f"duration {self.duration!r}", f"gravity {numbers(self.gravity)}"]
        lines += [f"mu {self.mu!r}", f"restitution {self.e!r}"]
        lines += [f"plane {numbers(plane)}" for plane in self.planes]
        for b in self.bodies:
            size = tuple(b.size) + (0.0,) * (3 - len(b.size))
            lines.append(f"body {b.shape} {numbers((*size, b.mass, *b.inertia, *b.pos, *b.quat, *b.v, *b.w))}")
        return "\n".join(lines) + "\n"


def box_inertia(m, half):
    x, y, z = (h * h for h in half)
    return (m / 3 * (y + z), m / 3 * (x + z), m / 3 * (x + y))


def ball_inertia(m, r):
    return (0.4 * m * r * r,) * 3


def about_y(angle):
    return (cos(angle / 2), 0.0, sin(angle / 2), 0.0)


def distance(states, body, place):
    return float(np.linalg.norm(states[body][:3] - np.array(place)))


def angle_between(q, p):
    q, p = np.array(q) / np.linalg.norm(q), np.array(p) / np.linalg.norm(p)
    v = p[0] * q[1:] - q[0] * p[1:] - np.cross(p[1:], q[1:])
    return 2 * atan2(np.linalg.norm(v), abs(q @ p))


def solved(rate, start, end):
    """The state of an equation of motion at `end`."""
    found = solve_ivp(rate, (0, end), start, method="DOP853", rtol=3e-14, atol=1e-15)
    return found.y[:, -1]


# Without contact.


def projectile():
    v, t, g = (10.0, 0.0, 10.0), 4.0, 9.8
    end = (v[0] * t, 0.0, 100 + v[2] * t - g * t * t / 2)
    body = Body("none", (), 0.1, ball_inertia(0.1, 0.1), (0.0, 0.0, 100.0), v=v)
    return Scene("projectile", t, [body], lambda s: {"position_m": distance(s, 0, end)}, (0.0, 0.0, -g), [])


def free_top(name="free_top", t=10.0):
    """Spun about its middle axis; at 10 s it has flipped twice and is nearly back, at 7.5 s it is in mid-flip."""
    inertia, w0 = np.array([1.0, 2.0, 3.0]), np.array([0.01, 5.0, 0.01])

    def rate(_, y):
        q, w = y[:4], y[4:]
        turn = 0.5 * np.array([-q[1:] @ w, *(q[0] * w + np.cross(q[1:], w))])
        return np.concatenate([turn, np.cross(inertia * w, w) / inertia])

    q = solved(rate, [1, 0, 0, 0, *w0], t)[:4]
    body = Body("none", (), 1.0, tuple(inertia), (0.0, 0.0, 0.0), w=tuple(w0))
    return Scene(name, t, [body], lambda s: {"angle_rad": angle_between(s[0][3:7], q)}, (0.0, 0.0, 0.0), [])


def cut_shot():
    """A ball with spin cuts another one, without gravity: the impact is Coulomb's, sticking or slipping."""
    r, m, e, mu, t = 0.5, 1.0, 0.9, 0.2, 2.0
    n = np.array([cos(radians(30)), sin(radians(30)), 0.0])
    v, w = np.array([3.0, 0.0, 0.0]), np.array([0.0, 0.0, 4.0])
    hit = 0.5
    there = -2 * r * n - hit * v
    slip = v - (v @ n) * n + np.cross(w, r * n)
    normal = (1 + e) * (v @ n) * m / 2
    tangent = min(mu * normal, np.linalg.norm(slip) * m / 7)
    push = normal * n + tangent * slip / np.linalg.norm(slip)
    v_a, v_b = v - push / m, push / m
    ends = [-2 * r * n + v_a * (t - hit), v_b * (t - hit)]
    balls = [
        Body("sphere", (r,), m, ball_inertia(m, r), tuple(there), v=tuple(v), w=tuple(w)),
        Body("sphere", (r,), m, ball_inertia(m, r), (0.0, 0.0, 0.0)),
    ]
    errors = lambda s: {"position_m": max(distance(s, i, ends[i]) for i in range(2))}
    return Scene("cut_shot", t, balls, errors, (0.0, 0.0, 0.0), [], mu, e)


# Balls.


def bounce():
    r, e, t = 0.1, 0.8, 2.0
    v, left, height = sqrt(2 * G), t - sqrt(2 / G), None
    while True:
        v *= e
        if left < 2 * v / G:
            height = r + v * left - G * left * left / 2
            break
        left -= 2 * v / G
    body = Body("sphere", (r,), 1.0, ball_inertia(1.0, r), (0.0, 0.0, 1 + r))
    return Scene("bounce", t, [body], lambda s: {"position_m": distance(s, 0, (0, 0, height))}, e=e)


def slip_roll():
    r, v, mu, t = 0.5, 5.0, 0.3, 3.0
    rolls = 2 * v / (7 * mu * G)
    x = 12 * v * v / (49 * mu * G) + 5 * v / 7 * (t - rolls)
    body = Body("sphere", (r,), 1.0, ball_inertia(1.0, r), (0.0, 0.0, r), v=(v, 0.0, 0.0))
    return Scene("sphere_slip_roll", t, [body], lambda s: {"position_m": distance(s, 0, (x, 0, r))}, mu=mu)


# Boxes.

SLAB = (0.5, 0.5, 0.1)


def slide_stop():
    v, mu = 5.0, 0.3
    x = v * v / (2 * mu * G)
    body = Body("box", SLAB, 1.0, box_inertia(1.0, SLAB), (0.0, 0.0, 0.1), v=(v, 0.0, 0.0))
    return Scene("slide_stop", 3.0, [body], lambda s: {"position_m": distance(s, 0, (x, 0, 0.1))}, mu=mu)


def incline(name, mu, t):
    slope = radians(30)
    n, down = np.array([sin(slope), 0, cos(slope)]), np.array([cos(slope), 0, -sin(slope)])
    a = max(0.0, G * (sin(slope) - mu * cos(slope)))
    end = 0.1 * n + down * a * t * t / 2
    body = Body("box", SLAB, 1.0, box_inertia(1.0, SLAB), tuple(0.1 * n), about_y(slope))
    return Scene(name, t, [body], lambda s: {"position_m": distance(s, 0, end)}, planes=[(*n, 0.0)], mu=mu)


def stack(name, top):
    half = (0.5, 0.5, 0.5)
    masses = [1.0] * 9 + [top]
    places = [(0.0, 0.0, 0.5 + i) for i in range(10)]
    bodies = [Body("box", half, m, box_inertia(m, half), p) for m, p in zip(masses, places)]
    errors = lambda s: {"position_m": max(distance(s, i, p) for i, p in enumerate(places))}
    return Scene(name, 5.0, bodies, errors, mu=0.5)


def knife_edge():
    """ODE. A box on its edge on a smooth floor falls over: the centre comes straight down. φ from balance, R to the
    edge, (I + m R² sin²φ) φ'' + m R² sin φ cos φ φ'² = m g R sin φ."""
    half, m, start, t = (0.3, 0.5, 0.3), 1.0, 0.1, 0.3
    reach, inertia = hypot(half[0], half[2]), box_inertia(1.0, half)[1]

    def rate(_, y):
        p, w = y
        mass = inertia + m * (reach * sin(p)) ** 2
        return [w, (m * G * reach * sin(p) - m * reach**2 * sin(p) * cos(p) * w * w) / mass]

    p, w = solved(rate, [start, 0.0], t)
    assert p < pi / 4, "it is flat before the end"
    place = lambda p: (0.0, 0.0, reach * cos(p))
    body = Body("box", half, m, box_inertia(m, half), place(start), about_y(pi / 4 + start))
    end = about_y(pi / 4 + p)
    errors = lambda s: {"position_m": distance(s, 0, place(p)), "angle_rad": angle_between(s[0][3:7], end)}
    return Scene("knife_edge", t, [body], errors)


def egg(name, mu, t=2.0):
    """ODE. An egg (semi-axes a, b, c) rocks in the plane of a and c, without slip or on a smooth floor. Height of the
    centre h = √(a² sin² + c² cos²), the point of contact h' beside it: M(θ) θ'' + M' θ'²/2 + m g h' = 0 with
    M = I + m h'² (+ m h² without slip), and then x' = h θ'."""
    (a, b, c), m, start = (0.3, 0.2, 0.2), 1.0, 0.4
    inertia = tuple(m / 5 * x for x in (b * b + c * c, a * a + c * c, a * a + b * b))
    rolls = 1.0 if mu > 0 else 0.0

    def shape(p):
        h = hypot(a * sin(p), c * cos(p))
        h1 = (a * a - c * c) * sin(p) * cos(p) / h
        h2 = (a * a - c * c) * cos(2 * p) / h - h1 * h1 / h
        return h, h1, h2

    def rate(_, y):
        p, w, _ = y
        h, h1, h2 = shape(p)
        mass = inertia[1] + m * (h1 * h1 + rolls * h * h)
        slope = 2 * m * h1 * (h2 + rolls * h)
        return [w, -(slope * w * w / 2 + m * G * h1) / mass, rolls * h * w]

    p, w, x = solved(rate, [start, 0.0, 0.0], t)
    end = (x, 0.0, shape(p)[0])
    body = Body("ellipsoid", (a, b, c), m, inertia, (0.0, 0.0, shape(start)[0]), about_y(start))
    turned = about_y(p)
    errors = lambda s: {"position_m": distance(s, 0, end), "angle_rad": angle_between(s[0][3:7], turned)}
    return Scene(name, t, [body], errors, mu=mu)


SCENES = {
    scene.name: scene
    for scene in [
        projectile(),
        free_top(),
        free_top("free_top_flip", 7.5),
        bounce(),
        slide_stop(),
        incline("incline_slide", 0.3, 2.0),
        incline("incline_stick", 0.7, 5.0),
        slip_roll(),
        stack("stack", 1.0),
        stack("stack_heavy", 1000.0),
        cut_shot(),
        knife_edge(),
        egg("egg", 1.0),
        egg("egg_smooth", 0.0),
    ]
}


def check():
    """Answers against others of another origin."""
    # The period of the top between flips is 4 K / p of Jacobi's functions.
    inertia, w = np.array([1.0, 2.0, 3.0]), np.array([0.01, 5.0, 0.01])
    energy2, momentum2 = inertia @ (w * w), (inertia * w) @ (inertia * w)
    i1, i2, i3 = inertia
    # With L² < 2 E I₂ or above it the axes change their roles.
    if momentum2 < energy2 * i2:
        i1, i3 = i3, i1
    rate = sqrt((i3 - i2) * (momentum2 - energy2 * i1) / (i1 * i2 * i3))
    m = (i2 - i1) * (energy2 * i3 - momentum2) / ((i3 - i2) * (momentum2 - energy2 * i1))
    print(f"free_top: period of ω {4 * ellipk(m) / rate:.6f} s")
    for name in ("knife_edge", "egg", "egg_smooth"):
        scene = SCENES[name]
        print(f"{name}: {scene.errors([np.array([*b.pos, *b.quat, *b.v, *b.w]) for b in scene.bodies])} from its start")


if __name__ == "__main__":
    check()
