"""One module an engine: NAME, version(), methods(scene) -> {label: settings}, run(scene, settings, step, repeats) ->
(steps, seconds of the best repeat, states). A state is 13 numbers a body: position, quaternion (w, x, y, z), velocity,
angular velocity, world frame, centre of mass. Only stepping is timed."""
