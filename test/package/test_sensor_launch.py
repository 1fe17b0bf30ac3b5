#!/usr/bin/python3
"""What donex.launch sets for every sensor: the defaults, and the sensor's own file on top.

Usage: test_sensor_launch.py PACKAGE     in a sourced workspace; starts nothing
"""
import pathlib
import sys

import roslaunch.config
import yaml

PACKAGE = pathlib.Path(sys.argv[1])
LAUNCH = PACKAGE / "launch" / "donex.launch"


def read(name):
    return yaml.safe_load((PACKAGE / "config" / f"{name}.yaml").read_text()) or {}


def launched(*arguments):
    config = roslaunch.config.load_config_default([(str(LAUNCH), list(arguments))], None)
    prefix = "/donex/"
    return {key[len(prefix):]: param.value for key, param in config.params.items() if key.startswith(prefix)}


def main():
    sensors = sorted(file.stem for file in (PACKAGE / "config" / "sensors").glob("*.yaml"))
    faults = [] if len(sensors) >= 10 else [f"{len(sensors)} sensors: too few"]
    for sensor in sensors:
        expected = {**read("default"), **read(f"sensors/{sensor}")}
        if launched(f"sensor:={sensor}") != expected:
            faults.append(f"sensor:={sensor}: other parameters than its files say")
        if sensor == sensors[0] and launched(f"sensor:={sensor}", "nodelet:=false") != expected:
            faults.append(f"sensor:={sensor} nodelet:=false: other parameters than as a nodelet")
    if launched() != read("default"):
        faults.append("without arguments: other parameters than the defaults")
    if read("sparse") or launched("sparse:=true") != read("default"):
        faults.append("config/sparse.yaml, sparse:=true: kept for old launch files, and without effect")
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{len(sensors)} sensors, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
