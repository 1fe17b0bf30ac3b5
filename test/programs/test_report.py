#!/usr/bin/python3
"""donex_evaluate against a second computation of its figures, and its page in a browser.

Usage: test_report.py DONEX_EVALUATE [--page]
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent


def write_drive(directory, random):
    """Twelve scans from a vehicle at 5 m/s: ground, walls, a few moving objects with instances, unknown echoes."""
    for folder in ("velodyne", "labels"):
        (directory / folder).mkdir(parents=True)
    poses = []
    for k in range(12):
        fixed = np.column_stack([random.uniform(-70, 70, (3000, 2)), random.uniform(-2, 3, 3000)])
        kinds = random.choice([0, 1, 9, 40, 50, 70], 3000).astype(np.uint32)
        points, labels = [fixed], [kinds]
        for instance, (kind, pace) in enumerate([(252, 12.0), (253, 4.0), (254, 1.5), (252, 20.0), (9, 0.0)], 1):
            count = random.integers(4, 60)
            centre = np.array([10.0 + (pace - 5.0) * 0.1 * k, 6.0 * instance - 15.0, 0.0])
            points.append(centre + random.normal(0, 0.3, (count, 3)))
            labels.append(np.full(count, kind | instance << 16, np.uint32))
        points = np.concatenate(points)
        points[::97] = np.nan
        np.column_stack([points, np.zeros(len(points))]).astype("<f4").tofile(directory / f"velodyne/{k:06d}.bin")
        if k != 7:  # not every scan need be labelled
            np.concatenate(labels).astype("<u4").tofile(directory / f"labels/{k:06d}.label")
        poses.append(f"1 0 0 {0.5 * k} 0 1 0 0 0 0 1 0\n")
    (directory / "poses.txt").write_text("".join(poses))
    (directory / "times.txt").write_text("".join(f"{0.1 * k:.1f}\n" for k in range(12)))


def write_prediction(drive, directory, random, error):
    directory.mkdir()
    for k in range(12):
        count = (drive / f"velodyne/{k:06d}.bin").stat().st_size // 16
        file = drive / f"labels/{k:06d}.label"
        truth = np.fromfile(file, "<u4") & 0xFFFF if file.exists() else np.full(count, 9)
        moving = (truth > 250) != (random.uniform(0, 1, count) < error)
        np.where(moving, 251, 9).astype("<u4").tofile(directory / f"{k:06d}.label")


def run(*command):
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True)
    if result.returncode != 0:
        sys.exit(f"{command[0]} ended with {result.returncode}:\n{result.stdout}")
    return result.stdout


def main():
    random = np.random.default_rng(7)
    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        drive = directory / "drive"
        write_drive(drive, random)
        predictions = []
        for error in (0.0, 0.1, 0.4, 1.0):
            predictions.append(directory / f"errors_{error}")
            write_prediction(drive, predictions[-1], random, error)
        report = directory / "report"
        run(sys.argv[1], drive, *predictions, "--json", f"{report}.json", "--html", f"{report}.html")
        print(run(sys.executable, HERE / "check_metrics.py", drive, f"{report}.json", *predictions), end="")
        if "--page" in sys.argv:
            print(run(sys.executable, HERE / "check_page.py", f"{report}.html"), end="")


if __name__ == "__main__":
    main()
