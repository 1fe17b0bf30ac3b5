"""Faults of odometry, as they happen: each makes faulty poses of a drive's own (4 by 4, scan by scan)."""
import numpy

BEGIN = 22  # scan in which a fault of some scans begins: later than the first window ends
FROZEN = 30  # scans


def about_z(degrees):
    turn = numpy.eye(4)
    angle = numpy.radians(degrees)
    turn[:2, :2] = [[numpy.cos(angle), -numpy.sin(angle)], [numpy.sin(angle), numpy.cos(angle)]]
    return turn


def mirrored(poses, position, turns):
    """`position` maps x and y of the position, `turns` of the axes."""
    changed = poses.copy()
    changed[:, :2, 3] = poses[:, :2, 3] @ position.T
    whole = numpy.eye(3)
    whole[:2, :2] = turns
    changed[:, :3, :3] = whole @ poses[:, :3, :3] @ whole.T
    return changed


def scaled(poses, factor):
    changed = poses.copy()
    changed[:, :3, 3] *= factor
    return changed


def begin_in(poses):
    """BEGIN, or half-way in a shorter drive."""
    return BEGIN if len(poses) > BEGIN else len(poses) // 2


def frozen(poses):
    changed, begin = poses.copy(), begin_in(poses)
    changed[begin:begin + FROZEN] = poses[begin]
    return changed


def jumped(poses):
    changed, begin = poses.copy(), begin_in(poses)
    changed[begin:, :2, 3] += poses[begin, :2, :2] @ (0.0, 0.5)
    return changed


def noisy(poses):
    changed = poses.copy()
    changed[:, :2, 3] += numpy.random.default_rng(1).normal(0.0, 0.03, (len(poses), 2))
    return changed


def noisy_yaw(poses):
    angles = numpy.random.default_rng(2).normal(0.0, 0.1, len(poses))
    return numpy.array([pose @ about_z(angle) for pose, angle in zip(poses, angles)])


SAME, FLIP_Y, SWAP = numpy.eye(2), numpy.diag([1.0, -1.0]), numpy.array([[0.0, 1.0], [1.0, 0.0]])
# Name, poses, words of the cause that is right; None where there shall be no alarm.
FAULTS = [
    ("none", lambda poses: poses, None),
    ("noise of 3 cm", noisy, None),
    ("noise of 0.1° of yaw", noisy_yaw, None),
    ("mounting turned by 0.5°", lambda poses: poses @ about_z(0.5), None),
    ("mounting turned by 2°", lambda poses: poses @ about_z(2.0), "mounting"),
    ("scale 1.05", lambda poses: scaled(poses, 1.05), "scale"),
    ("y of the position flipped", lambda poses: mirrored(poses, FLIP_Y, SAME), "axes"),
    ("x and y swapped", lambda poses: mirrored(poses, SWAP, SAME), "axes"),
    ("yaw flipped", lambda poses: mirrored(poses, SAME, FLIP_Y), "axes"),
    ("frozen for 30 scans", frozen, "stood still"),
    ("a jump of 0.5 m", jumped, "jumped"),
]
