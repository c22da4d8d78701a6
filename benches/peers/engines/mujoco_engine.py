"""MuJoCo. One call makes all steps. Contacts are soft: `default` keeps its solref, `stiff` uses the stiffest that a step
allows (time constant of two steps, impedance 0.9999, impratio 100: less slip). It has no restitution: no bounces."""

import mujoco
import numpy as np

from .timing import best, steps_of

NAME = "mujoco"
INTEGRATORS = {
    "Euler": mujoco.mjtIntegrator.mjINT_EULER,
    "RK4": mujoco.mjtIntegrator.mjINT_RK4,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
}


def version():
    return mujoco.__version__


def methods(scene):
    if scene.e > 0:
        return {}
    contact = any(body.shape != "none" for body in scene.bodies)
    stiff = ("default", "stiff") if contact else ("",)
    return {f"{name} {kind}".strip(): (name, kind == "stiff") for name in INTEGRATORS for kind in stiff}


def world(scene, stiff, step):
    numbers = lambda xs: " ".join(repr(float(x)) for x in xs)
    soft = f'solref="{2 * step!r} 1" solimp="0.999 0.9999 0.001"' if stiff else ""
    touch = f'friction="{scene.mu!r} 0 0" condim="{3 if scene.mu > 0 else 1}" {soft}'
    parts = []
    for n in scene.planes:
        at = np.array(n[:3]) * n[3]
        parts.append(f'<geom type="plane" size="0 0 1" pos="{numbers(at)}" zaxis="{numbers(n[:3])}" {touch}/>')
    for body in scene.bodies:
        geom = "" if body.shape == "none" else f'<geom type="{body.shape}" size="{numbers(body.size)}" {touch}/>'
        parts.append(
            f'<body pos="{numbers(body.pos)}" quat="{numbers(body.quat)}"><freejoint/><inertial pos="0 0 0" '
            f'mass="{body.mass!r}" diaginertia="{numbers(body.inertia)}"/>{geom}</body>'
        )
    return f"""<mujoco><compiler boundmass="0"/><option timestep="{step!r}" gravity="{numbers(scene.gravity)}"
        cone="elliptic" iterations="200" tolerance="1e-12" impratio="{100 if stiff else 1}"/>
        <worldbody>{"".join(parts)}</worldbody></mujoco>"""


def rotation(quat):
    R = np.zeros(9)
    mujoco.mju_quat2Mat(R, np.array(quat, dtype=float))
    return R.reshape(3, 3)


def run(scene, settings, step, repeats):
    integrator, stiff = settings
    count, step = steps_of(scene, step)
    model = mujoco.MjModel.from_xml_string(world(scene, stiff, step))
    model.opt.integrator = INTEGRATORS[integrator]

    def make():
        data = mujoco.MjData(model)
        for i, body in enumerate(scene.bodies):
            # Angular velocities are in body axes.
            data.qvel[6 * i : 6 * i + 6] = (*body.v, *(rotation(body.quat).T @ np.array(body.w)))
        mujoco.mj_forward(model, data)
        return data

    seconds, data = best(repeats, make, lambda data: mujoco.mj_step(model, data, nstep=count))
    if abs(data.time - scene.duration) > 1e-6:
        raise RuntimeError("it has reset itself")
    states = []
    for i in range(len(scene.bodies)):
        place, motion = data.qpos[7 * i : 7 * i + 7], data.qvel[6 * i : 6 * i + 6]
        states.append([*place, *motion[:3], *(rotation(place[3:]) @ motion[3:])])
    return count, seconds, states
