"""Bullet (PyBullet, double precision). One Python call a step: some 0.3 µs of each. 50 iterations, its default, and 200;
no contact margin, no sleeping, no damping; split impulse."""

import pybullet as bullet
import pybullet_utils.bullet_client as client

from .timing import best, steps_of

NAME = "pybullet"


def version():
    return str(bullet.getAPIVersion())


def methods(scene):
    if any(body.shape == "ellipsoid" for body in scene.bodies):
        return {}
    return {"50 iterations": 50, "200 iterations": 200}


def shape(world, body):
    if body.shape == "sphere":
        return world.createCollisionShape(bullet.GEOM_SPHERE, radius=body.size[0])
    if body.shape == "box":
        return world.createCollisionShape(bullet.GEOM_BOX, halfExtents=body.size)
    return -1


def run(scene, iterations, step, repeats):
    count, step = steps_of(scene, step)

    def make():
        world = client.BulletClient(bullet.DIRECT)
        world.setGravity(*scene.gravity)
        world.setPhysicsEngineParameter(
            fixedTimeStep=step, numSolverIterations=iterations, useSplitImpulse=1, restitutionVelocityThreshold=0,
            solverResidualThreshold=0, contactBreakingThreshold=1e-3,
        )
        for n in scene.planes:
            plane = world.createCollisionShape(bullet.GEOM_PLANE, planeNormal=n[:3])
            at = [x * n[3] for x in n[:3]]
            world.changeDynamics(world.createMultiBody(0, plane, basePosition=at), -1, lateralFriction=1, restitution=1)
        made = []
        for body in scene.bodies:
            w, x, y, z = body.quat
            i = world.createMultiBody(body.mass, shape(world, body), -1, body.pos, (x, y, z, w))
            # Pairs multiply: the planes have ones, and two bodies the root.
            root = 0.5 if len(scene.bodies) > 1 and not scene.planes else 1.0
            world.changeDynamics(
                i, -1, lateralFriction=scene.mu**root, restitution=scene.e**root, linearDamping=0, angularDamping=0,
                localInertiaDiagonal=body.inertia, collisionMargin=0, activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING,
            )
            world.resetBaseVelocity(i, body.v, body.w)
            made.append(i)
        return world, made

    def steps(made):
        step = made[0].stepSimulation
        for _ in range(count):
            step()

    seconds, (world, made) = best(repeats, make, steps)
    states = []
    for i in made:
        (place, (x, y, z, w)), (v, spin) = world.getBasePositionAndOrientation(i), world.getBaseVelocity(i)
        states.append([*place, w, x, y, z, *v, *spin])
    world.disconnect()
    return count, seconds, states
