#!/usr/bin/python3
"""What the README tells to type exists: programs and their options, launch files and their arguments, files.

Usage: test_readme.py PACKAGE DIRECTORY_OF_PROGRAMS
"""
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree

PACKAGE, PROGRAMS = (pathlib.Path(argument) for argument in sys.argv[1:3])
FOLDERS = "scripts|config|test|docs|rviz|workflow|launch"


def program_of(name):
    """A built program, or a script that is installed beside them."""
    return next((place / name for place in (PROGRAMS, PACKAGE / "scripts") if (place / name).is_file()), None)


def options_of(program):
    run = subprocess.run([str(program), "--help"], stdout=subprocess.PIPE, text=True, timeout=60, check=True)
    return set(re.findall(r"--[a-z0-9-]+", run.stdout))


def arguments_of(launch_file):
    tree = xml.etree.ElementTree.parse(PACKAGE / "launch" / launch_file)
    return {node.get("name") for node in tree.getroot().findall("arg")}


class Check:
    def __init__(self):
        self.faults, self.known, self.checked = [], {}, 0

    def expect(self, truth, fault):
        self.checked += 1
        if not truth:
            self.faults.append(fault)

    def program(self, name, words):
        if name not in self.known:
            path = program_of(name)
            self.known[name] = options_of(path) if path else None
        self.expect(self.known[name] is not None, f"there is no program {name}")
        for option in re.findall(r"(?<!\S)\[?(--[a-z][a-z0-9-]*)", " ".join(words)):
            self.expect(option in (self.known[name] or ()), f"{name} has no option {option}")

    def launch(self, words):
        file = next(word for word in words if word.endswith(".launch"))
        is_ours = (PACKAGE / "launch" / file).is_file()
        self.expect(is_ours, f"there is no launch file {file}")
        for word in words if is_ours else ():
            name, assigned, _ = word.partition(":=")
            if assigned:
                self.expect(name in arguments_of(file), f"{file} has no argument {name}")

    def command(self, line):
        """As typed in a shell; what stands alone after -- are options of donex_bag."""
        words = line.partition(" # ")[0].replace("rosrun donex ", "").split()
        if words[:1] == ["roslaunch"] and "donex" in words:
            self.launch(words)
        elif len(words) > 1 and words[0].startswith("donex_"):
            end = words.index("--") if "--" in words else len(words)
            self.program(words[0], words[1:end])
            self.program("donex_bag", words[end + 1:])

    def row(self, line):
        """Options that the second cell of a table explains belong to the program of the first."""
        found = re.match(r"\| `(donex_\w+) [^|`]*(?:\\\|[^|`]*)?` \| (.*)", line)
        if found:
            self.program(found[1], re.findall(r"`(--[a-z-]+)`", found[2]))


def main():
    text = (PACKAGE / "README.md").read_text()
    check = Check()
    for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL):
        for line in block.splitlines():
            check.command(line)
    prose = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    for span in re.findall(r"`([^`]+)`", prose):
        check.command(" ".join(span.split()))
    for line in prose.splitlines():
        check.row(line)
    for path in re.findall(rf"(?<![\w/.-])(?:\./)?((?:{FOLDERS})/[\w./-]*\w)", text):
        check.expect((PACKAGE / path).exists(), f"there is no {path}")
    if check.checked < 50:
        sys.exit(f"only {check.checked} things were found in the README: it is not read as it is written")
    if check.faults:
        sys.exit("README.md: " + "\n".join(check.faults))
    print(f"{check.checked} programs, options, arguments and files of the README: all there")


if __name__ == "__main__":
    main()
