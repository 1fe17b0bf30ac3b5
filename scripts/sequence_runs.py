"""Runs donex_sequence and reads what it prints; for the scripts that make tables of it."""
import dataclasses
import itertools
import pathlib
import re
import shutil
import subprocess
import sys

BUILT = pathlib.Path(__file__).resolve().parents[1] / "build/.workspace/devel/lib/donex"


@dataclasses.dataclass
class Figures:
    iou: str
    precision: str
    recall: str
    milliseconds: str
    phantoms: str = "nan"  # a scan
    odometry: str = ""  # against the scans: agrees, disagrees with the likely cause, or cannot tell

    def __post_init__(self):
        # A ratio of nothing is printed as a dash: where nothing moves there is no recall.
        for name in ("iou", "precision", "recall"):
            if getattr(self, name) == "-":
                setattr(self, name, "nan")

    def __str__(self):
        values = " / ".join(f"{float(value):.3f}" for value in (self.iou, self.precision, self.recall))
        return f"{values}, {float(self.milliseconds):.0f} ms"


def program(name="donex_sequence"):
    """The one on the path first (a sourced workspace or install space), then what the scripts built here."""
    beside = BUILT / name
    found = shutil.which(name) or (str(beside) if beside.exists() else None)
    if found is None:
        sys.exit(f"{name} is neither on the path nor in {BUILT}: run scripts/demo or scripts/test first")
    return found


def simulated(folder, scenes, seeds, beams=("0",)):
    """Simulated drives of 5 s, written where they are missing; 0 beams: as many as suit the scene."""
    for scene, seed, count in itertools.product(scenes, seeds, beams):
        drive = folder / (f"{scene}_{seed}" + (f", {count} beams" if count != "0" else ""))
        if not (drive / "times.txt").exists():
            subprocess.run([program("donex_simulate"), scene, drive, "--seed", seed, "--beams", count, "--duration", "5"],
                           check=True, stdout=subprocess.DEVNULL)
        yield drive


def label(sequence, arguments=(), settings=()):
    """Figures of one run; `settings` are name=value. Ends the script where the run failed or had no labels."""
    command = [program(), str(sequence), *arguments]
    for setting in settings:
        command += ["--set", setting]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    scores = re.search(r"^this run +([\d.]+|-) +([\d.]+|-) +([\d.]+|-)", run.stdout, re.MULTILINE)
    phantoms = re.search(r"([\d.]+|nan) a scan", run.stdout)
    odometry = re.search(r"^odometry (agrees|disagrees|against).*?(?:likely cause(: .*))?$", run.stdout, re.MULTILINE)
    time = re.search(r"CPU: median ([\d.]+) ms", run.stdout)
    if run.returncode != 0 or scores is None or time is None or phantoms is None:
        sys.exit(f"{' '.join(command)}\n{run.stdout}{run.stderr}")
    return Figures(*scores.groups(), time.group(1), phantoms.group(1), said(odometry))


def said(odometry):
    """What the check of odometry says, from its line; empty where there was no check."""
    if odometry is None:
        return ""
    return "cannot tell" if odometry.group(1) == "against" else odometry.group(1) + (odometry.group(2) or "")


def progress(text):
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)
