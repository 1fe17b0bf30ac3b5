#!/usr/bin/python3
"""donex_archive on a small folder: corrupt bags, a split recording, a run that is killed; results as of single runs.

Usage: test_archive.py DONEX_ARCHIVE DIRECTORY_OF_PROGRAMS [--page]
"""
import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import rosbag

HERE = pathlib.Path(__file__).resolve().parent


def run(*command, code=0):
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True)
    if result.returncode != code:
        sys.exit(f"{' '.join(map(str, command))} ended with {result.returncode}, not {code}:\n{result.stdout}")
    return result.stdout


def expect(truth, what):
    if not truth:
        sys.exit(f"not so: {what}")


def split(source, folder):
    """As rosbag record --split writes: each part has the date at which it begins, /tf_static is in the first."""
    names = ["drive_2024-05-06-07-08-09_0.bag", "drive_2024-05-06-07-09-10_1.bag"]
    with rosbag.Bag(str(source)) as bag, rosbag.Bag(str(folder / names[0]), "w") as first, \
            rosbag.Bag(str(folder / names[1]), "w") as second:
        middle = (bag.get_start_time() + bag.get_end_time()) / 2
        for topic, message, stamp, header in bag.read_messages(return_connection_header=True):
            part = first if stamp.to_sec() < middle else second
            part.write(topic, message, stamp, connection_header=header)
    return names


def labels_of(*bags):
    result = []
    for name in bags:
        with rosbag.Bag(str(name)) as bag:
            result += [message.data for _, message, _ in bag.read_messages("/donex/labeled_points")]
    return result


def make_bags(programs, folder):
    (folder / "day").mkdir(parents=True)
    bags = {"one.bag": ("street", 1), "two.bag": ("intersection", 2), "day/long.bag": ("bend", 3)}
    for name, (scene, seed) in bags.items():
        run(programs / "donex_simulate", scene, folder / name, "--beams", 16, "--seed", seed, "--duration",
            8 if "long" in name else 1, "--compression", "lz4" if seed == 2 else "none")
    (folder / "bad.bag").write_bytes((folder / "one.bag").read_bytes()[:-3000])
    (folder / "broken.bag").write_text("no bag")
    return split(folder / "two.bag", folder)


def check_page(page, rows):
    """The page has every recording that was scored, the worst first, with the figures of summary.csv."""
    text = page.read_text()
    begin = text.index("const data = ") + len("const data = ")
    data, _ = json.JSONDecoder().raw_decode(text[begin:])
    done = {name: float(row["iou"]) for name, row in rows.items() if row["state"] == "done"}
    names = [sequence["name"] for sequence in data["sequences"]]
    expect(names == sorted(done, key=done.get) and len(names) > 1, "the worst recording comes first, none is missing")
    for sequence in data["sequences"]:
        total = sequence["predictions"][0]["total"]
        found = total["tp"] / (total["tp"] + total["fp"] + total["fn"])
        expect(abs(found - done[sequence["name"]]) < 1e-6, f"the page's score of {sequence['name']} is the summary's")
    if "--page" in sys.argv:
        print(run(sys.executable, HERE / "check_page.py", page), end="")


def check_many_parts(archive, folder):
    """Numbers are numbers: the eleventh part follows the tenth, and what has no first part stands alone."""
    folder.mkdir()
    for name in [f"drive_{part}" for part in range(12)] + ["alone_3"]:
        (folder / f"{name}.bag").touch()
    listed = json.loads(run(archive, folder, folder / "out", "--list", "--join"))
    expect(listed == {"drive_0": [str(folder / f"drive_{part}.bag") for part in range(12)],
                      "alone_3": [str(folder / "alone_3.bag")]}, "twelve parts are one recording, in their order")


def kill_in_the_middle(archive, folder, out):
    """Ends the whole archive while it writes the long bag."""
    work = subprocess.Popen([str(archive), str(folder), str(out), "--jobs", "1"], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL, start_new_session=True)
    deadline = time.monotonic() + 120
    while not list(out.rglob("long.bag.*.part")):
        expect(time.monotonic() < deadline and work.poll() is None, "the long bag is written")
        time.sleep(0.01)
    os.killpg(work.pid, signal.SIGKILL)  # the process group that this test has made
    work.wait()
    expect(not (out / "day/long.bag").exists(), "a killed run leaves no half bag under the bag's name")


def main():
    archive, programs = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    os.environ["DONEX_BAG"] = str(programs / "donex_bag")
    with tempfile.TemporaryDirectory() as name:
        folder, out, single = (pathlib.Path(name) / part for part in ("in", "out", "single"))
        check_many_parts(archive, pathlib.Path(name) / "many")
        parts = make_bags(programs, folder)
        kill_in_the_middle(archive, folder, out)
        text = run(archive, folder, out, code=1)
        expect("bad: " in text and "broken: " in text, "both faulty bags are named")
        expect(not list(out.rglob("*.part")), "what the killed run left is gone")
        (single / "day").mkdir(parents=True)
        for bag in ("one.bag", "two.bag", "day/long.bag"):
            run(os.environ["DONEX_BAG"], folder / bag, single / bag)
            expect((single / bag).read_bytes() == (out / bag).read_bytes(), f"{bag} is that of a single run")
        recording = parts[0][:-len(".bag")]
        expect(labels_of(*(out / recording / part for part in parts)) == labels_of(single / "two.bag"),
               "the parts have the labels of the whole")
        rows = {row["recording"]: row for row in csv.DictReader(open(out / "summary.csv"))}
        expect(set(rows) == {"one", "two", "day/long", "bad", "broken", recording}, "the summary has all recordings")
        expect(rows["bad"]["state"] == "missing" and rows["one"]["labeled"] == "10", "the summary tells what was done")
        expect(0.0 < float(rows["day/long"]["recall"]) <= 1.0, "simulated bags are scored by their own truth")
        check_page(out / "report.html", rows)
        before = (out / "one.bag").stat().st_mtime_ns
        (folder / "bad.bag").unlink()
        (folder / "broken.bag").unlink()
        text = run(archive, folder, out)
        expect("4 of 4 recordings are done already" in text, "nothing is done twice")
        expect((out / "one.bag").stat().st_mtime_ns == before, "a finished bag stays as it is")
        text = run(archive, folder, out, "--", "--method", "donex_2d", code=1)
        expect("was begun with the options" in text, "one archive has one configuration")
        listed = json.loads(run(archive, folder, out, "--list"))
        expect(len(listed[recording]) == 2 and len(listed) == 4, "parts belong together")
    print("an archive with two faulty bags, killed and resumed: every result equal to a single run")


if __name__ == "__main__":
    main()
