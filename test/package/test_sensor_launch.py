#!/usr/bin/python3
"""What donex.launch sets for every sensor: the defaults, config/sparse.yaml for few beams, the sensor's own file on top.

Usage: test_sensor_launch.py PACKAGE     in a sourced workspace; starts nothing
"""
import pathlib
import re
import sys
import xml.etree.ElementTree

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
    argument = xml.etree.ElementTree.parse(LAUNCH).getroot().find("arg[@name='sparse']").get("default")
    sparse = set(re.findall(r"'(\w+)'", argument))
    faults = [f"{name} is sparse, but no file of config/sensors" for name in sparse - set(sensors)]
    if not sparse or len(sensors) < 10:
        faults.append(f"{len(sensors)} sensors, {len(sparse)} of them sparse: too few")
    for sensor in sensors:
        expected = {**read("default"), **(read("sparse") if sensor in sparse else {}), **read(f"sensors/{sensor}")}
        if launched(f"sensor:={sensor}") != expected:
            faults.append(f"sensor:={sensor}: other parameters than its files say")
        if sensor == min(sparse) and launched(f"sensor:={sensor}", "nodelet:=false") != expected:
            faults.append(f"sensor:={sensor} nodelet:=false: other parameters than as a nodelet")
    if launched() != read("default"):
        faults.append("without arguments: other parameters than the defaults")
    if launched("sparse:=true") != {**read("default"), **read("sparse")}:
        faults.append("sparse:=true: other parameters than config/sparse.yaml")
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{len(sensors)} sensors, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
