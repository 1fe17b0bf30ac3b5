"""Sequences made of others: with other poses, or with fewer beams; for the scripts that make tables of them."""
import numpy

BEAMS = 64


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


def with_fewer_beams(sequence, folder, every):
    """Echoes by the elevation of their beam; those of the beams that stay, and their labels."""
    linked(sequence, folder)
    for name in ("velodyne", "labels"):
        (folder / name).unlink()
        (folder / name).mkdir()
    for file in sorted((sequence / "velodyne").iterdir()):
        echoes = numpy.fromfile(file, numpy.float32).reshape(-1, 4)
        elevation = numpy.arctan2(echoes[:, 2], numpy.hypot(echoes[:, 0], echoes[:, 1]))
        low, high = numpy.percentile(elevation, [0.5, 99.9])
        beam = numpy.round((elevation - low) / (high - low) * (BEAMS - 1)).astype(int)
        kept = beam % every == 0
        echoes[kept].tofile(folder / "velodyne" / file.name)
        labels = sequence / "labels" / (file.stem + ".label")
        if labels.exists():
            numpy.fromfile(labels, numpy.uint32)[kept].tofile(folder / "labels" / labels.name)
