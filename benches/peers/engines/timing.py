import time


def best(repeats, make, steps):
    """Seconds of the best repeat, at least `repeats` and up to ten while they are short, and the last world."""
    least, spent, count = float("inf"), 0.0, 0
    while count < repeats or (spent < 0.2 and count < 10):
        world = make()
        began = time.perf_counter()
        steps(world)
        took = time.perf_counter() - began
        least, spent, count = min(least, took), spent + took, count + 1
    return least, world


def steps_of(scene, step):
    """Number and length of equal steps that end at the scene's end."""
    count = max(1, round(scene.duration / step))
    return count, scene.duration / count
