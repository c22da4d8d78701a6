"""Drake: discrete, SAP with point contact, as stiff as it makes it. It has no restitution: no bounces."""

import numpy as np
from pydrake.common import eigen_geometry as eigen
from pydrake.geometry import AddContactMaterial, Box, Ellipsoid, HalfSpace, ProximityProperties, Sphere
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, CoulombFriction, DiscreteContactApproximation
from pydrake.multibody.tree import SpatialInertia, UnitInertia
from pydrake.multibody.math import SpatialVelocity
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from .timing import best, steps_of

NAME = "drake"


def version():
    import importlib.metadata

    return importlib.metadata.version("drake")


def methods(scene):
    return {} if scene.e > 0 else {"SAP": None}


def properties(scene):
    made = ProximityProperties()
    AddContactMaterial(friction=CoulombFriction(scene.mu, scene.mu), properties=made)
    return made


def shape(body):
    size = body.size
    if body.shape == "box":
        return Box(*(2 * x for x in size))
    return Sphere(*size) if body.shape == "sphere" else Ellipsoid(*size)


def run(scene, _, step, repeats):
    count, step = steps_of(scene, step)

    def make():
        builder = DiagramBuilder()
        plant, _ = AddMultibodyPlantSceneGraph(builder, time_step=step)
        plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)
        plant.mutable_gravity_field().set_gravity_vector(scene.gravity)
        for k, n in enumerate(scene.planes):
            at = HalfSpace.MakePose(np.array(n[:3]), np.array(n[:3]) * n[3])
            plant.RegisterCollisionGeometry(plant.world_body(), at, HalfSpace(), f"plane{k}", properties(scene))
        made = []
        for k, body in enumerate(scene.bodies):
            inertia = UnitInertia(*(x / body.mass for x in body.inertia))
            link = plant.AddRigidBody(f"body{k}", SpatialInertia(body.mass, np.zeros(3), inertia))
            if body.shape != "none":
                plant.RegisterCollisionGeometry(link, RigidTransform(), shape(body), f"shape{k}", properties(scene))
            made.append(link)
        plant.Finalize()
        diagram = builder.Build()
        simulator = Simulator(diagram)
        context = plant.GetMyContextFromRoot(simulator.get_mutable_context())
        for link, body in zip(made, scene.bodies):
            place = RigidTransform(RotationMatrix(eigen.Quaternion(np.array(body.quat) / np.linalg.norm(body.quat))), body.pos)
            plant.SetFreeBodyPose(context, link, place)
            plant.SetFreeBodySpatialVelocity(link, SpatialVelocity(body.w, body.v), context)
        simulator.Initialize()
        return simulator, diagram, plant, context, made

    seconds, (_, _, plant, context, made) = best(repeats, make, lambda world: world[0].AdvanceTo(scene.duration))
    states = []
    for link in made:
        place = plant.EvalBodyPoseInWorld(context, link)
        motion = plant.EvalBodySpatialVelocityInWorld(context, link)
        states.append([*place.translation(), *place.rotation().ToQuaternion().wxyz(), *motion.translational(), *motion.rotational()])
    return count, seconds, states
