"""Sequences made of others: with other poses, or with fewer beams; for the scripts that make tables of them."""
import numpy

BEAMS = 64
RING_GAP = 0.4  # deg; elevations of beams farther apart than this are told apart one by one


def read_poses(sequence):
    rows = numpy.loadtxt(sequence / "poses.txt").reshape(-1, 3, 4)
    return numpy.concatenate([rows, numpy.tile([[[0.0, 0.0, 0.0, 1.0]]], (len(rows), 1, 1))], axis=1)


def linked(sequence, folder):
    for name in ("velodyne", "labels", "times.txt", "poses.txt"):
        (folder / name).symlink_to((sequence / name).resolve())


def shifted(poses, offset):
    """The same drive elsewhere in the world: voxel borders lie elsewhere in it."""
    moved = poses.copy()
    moved[:, :3, 3] += offset
    return moved


def planar(poses):
    """x, y and yaw of them, as wheels tell it."""
    flat = numpy.tile(numpy.eye(4), (len(poses), 1, 1))
    flat[:, :2, 3] = poses[:, :2, 3]
    yaw = numpy.arctan2(poses[:, 1, 0], poses[:, 0, 0])
    flat[:, 0, 0] = flat[:, 1, 1] = numpy.cos(yaw)
    flat[:, 1, 0], flat[:, 0, 1] = numpy.sin(yaw), -numpy.sin(yaw)
    return flat


def with_poses(sequence, folder, poses):
    linked(sequence, folder)
    (folder / "poses.txt").unlink()
    numpy.savetxt(folder / "poses.txt", poses[:, :3].reshape(-1, 12), fmt="%.9g")


def beam_of(elevation):
    """Number of each echo's beam, from the lowest on; where rings lie too close to be told apart, of 64 even bands."""
    ordered = numpy.sort(elevation)
    gaps = numpy.flatnonzero(numpy.diff(ordered) > numpy.radians(RING_GAP))
    if len(gaps) >= BEAMS // 4:
        return numpy.searchsorted(0.5 * (ordered[gaps] + ordered[gaps + 1]), elevation)
    low, high = numpy.percentile(elevation, [0.5, 99.9])
    return numpy.round((elevation - low) / (high - low) * (BEAMS - 1)).astype(int)


def with_fewer_beams(sequence, folder, every):
    """Echoes by the elevation of their beam; those of the beams that stay, and their labels."""
    linked(sequence, folder)
    for name in ("velodyne", "labels"):
        (folder / name).unlink()
        (folder / name).mkdir()
    for file in sorted((sequence / "velodyne").iterdir()):
        echoes = numpy.fromfile(file, numpy.float32).reshape(-1, 4)
        elevation = numpy.arctan2(echoes[:, 2], numpy.hypot(echoes[:, 0], echoes[:, 1]))
        kept = beam_of(elevation) % every == 0
        echoes[kept].tofile(folder / "velodyne" / file.name)
        labels = sequence / "labels" / (file.stem + ".label")
        if labels.exists():
            numpy.fromfile(labels, numpy.uint32)[kept].tofile(folder / "labels" / labels.name)
