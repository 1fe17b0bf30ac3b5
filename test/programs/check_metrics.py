#!/usr/bin/python3
"""Scores a directory of labels once more, with numpy and from the files alone, and compares with donex_evaluate's JSON.

Usage: check_metrics.py SEQ_DIR REPORT.json PRED_DIR...    (the predictions in the order of the report)
"""
import json
import pathlib
import sys

import numpy as np

BANDS = [1.0, 3.0, 8.0, 15.0]  # [m/s]


def read(sequence, index, name, dtype):
    folder = {"bin": "velodyne", "label": "labels"}[name]
    return np.fromfile(sequence / folder / f"{index:06d}.{name}", dtype)


def centers(sequence, scans, poses):
    """(instance, scan) -> centre of its echoes over ground."""
    result = {}
    for k in scans:
        points = read(sequence, k, "bin", "<f4").reshape(-1, 4)[:, :3].astype(float)
        label = read(sequence, k, "label", "<u4")
        finite = np.isfinite(points).all(axis=1)
        for instance in np.unique(label >> 16):
            chosen = finite & (label >> 16 == instance)
            if instance != 0 and chosen.any():
                result[int(instance), k] = poses[k][:, :3] @ points[chosen].mean(axis=0) + poses[k][:, 3]
    return result


def speed(centre, times, instance, k):
    near = [j for (i, j) in centre if i == instance and abs(times[j] - times[k]) < 0.55]
    if len(near) < 2:
        return None
    first, last = min(near), max(near)
    return np.linalg.norm(centre[instance, last] - centre[instance, first]) / (times[last] - times[first])


def score(sequence, prediction_directory):
    scans = sorted(int(p.stem) for p in (sequence / "labels").glob("*.label"))
    poses = np.loadtxt(sequence / "poses.txt").reshape(-1, 3, 4)
    times = np.loadtxt(sequence / "times.txt")
    centre = centers(sequence, scans, poses)
    rows, objects, speeds = [], [], np.zeros((len(BANDS) + 1, 2), int)
    for k in (k for k in scans if k >= 5):
        points = read(sequence, k, "bin", "<f4").reshape(-1, 4).astype(float)
        label = read(sequence, k, "label", "<u4")
        said = (np.fromfile(prediction_directory / f"{k:06d}.label", "<u4") & 0xFFFF) > 250
        distance = np.hypot(points[:, 0], points[:, 1])
        kind = label & 0xFFFF
        scored = (distance <= 50.0) & (kind > 1)
        rows.append(np.stack([kind, np.minimum(distance // 10, 4), said], axis=1)[scored])
        for value in np.unique(label[scored & (kind > 250) & (label >> 16 > 0)]):
            hits = said[scored & (label == value)]
            if len(hits) >= 10:
                objects.append(2 * hits.sum() >= len(hits))
            pace = speed(centre, times, int(value >> 16), k)
            if pace is not None:
                speeds[np.searchsorted(BANDS, pace, side="right")] += [hits.sum(), (~hits).sum()]
    return np.concatenate(rows), objects, speeds


def counts(rows):
    moving, said = rows[:, 0] > 250, rows[:, 2] > 0
    return {"tp": int((moving & said).sum()), "fp": int((~moving & said).sum()),
            "fn": int((moving & ~said).sum()), "tn": int((~moving & ~said).sum())}


def expect(what, ours, theirs):
    if ours != theirs:
        sys.exit(f"{what}: numpy says {ours}, donex_evaluate {theirs}")


def picked(entry):
    return {key: entry[key] for key in ("tp", "fp", "fn", "tn")}


def main():
    sequence, report = pathlib.Path(sys.argv[1]), json.load(open(sys.argv[2]))
    checked = 0
    predictions = report["sequences"][0]["predictions"]
    expect("number of predictions", len(sys.argv) - 3, len(predictions))
    for directory, theirs in zip(sys.argv[3:], predictions):
        rows, objects, speeds = score(sequence, pathlib.Path(directory))
        total = counts(rows)
        expect("total", total, picked(theirs["total"]))
        union = total["tp"] + total["fp"] + total["fn"]
        if union:
            expect("IoU", round(total["tp"] / union, 12), round(theirs["total"]["iou"], 12))
        expect("objects", [int(sum(objects)), len(objects)], [theirs["objects"]["found"], theirs["objects"]["all"]])
        for entry in theirs["class"]:
            expect(entry["name"], counts(rows[rows[:, 0] == int(entry["name"].split()[0])]), picked(entry))
        for band, entry in enumerate(theirs["range"]):
            expect(entry["name"], counts(rows[rows[:, 1] == band]), picked(entry))
        for band, entry in enumerate(theirs["speed"]):
            expect(entry["name"], [int(n) for n in speeds[band]], [entry["tp"], entry["fn"]])
        checked += len(rows)
    if checked == 0 or len(sys.argv) < 4:
        sys.exit("nothing was compared")
    print(f"{len(sys.argv) - 3} predictions, {checked} scored echoes: the same figures")


if __name__ == "__main__":
    main()
