#!/usr/bin/python3
"""What the documents name exists: programs and their options, launch files and their arguments, files, links; and the
headings that comments cite.

Usage: test_documents.py PACKAGE DIRECTORY_OF_PROGRAMS
"""
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree

PACKAGE, PROGRAMS = (pathlib.Path(argument) for argument in sys.argv[1:3])
FOLDERS = "scripts|config|test|docs|rviz|workflow|launch|src|include"
LONGEST_README = 180  # lines


def program_of(name):
    """A built program, or a script that is installed beside them."""
    return next((place / name for place in (PROGRAMS, PACKAGE / "scripts") if (place / name).is_file()), None)


def options_of(program):
    run = subprocess.run([str(program), "--help"], stdout=subprocess.PIPE, text=True, timeout=600, check=True)
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


    def page(self, text):
        for block in re.findall(r"```sh\n(.*?)```", text, re.DOTALL):
            for line in block.splitlines():
                self.command(line)
        prose = without_code(text)
        for span in re.findall(r"`([^`]+)`", prose):
            self.command(" ".join(span.split()))
        for line in prose.splitlines():
            self.row(line)
        for path in re.findall(rf"(?<![\w/.-])(?:\./)?((?:{FOLDERS})/[\w./-]*\w)", text):
            self.expect((PACKAGE / path).exists(), f"there is no {path}")

    def links(self, page, text):
        for target in re.findall(r"\]\(([^)\s]+)\)", without_code(text)):
            if re.match(r"https?:", target):
                continue
            name, _, anchor = target.partition("#")
            file = (page.parent / name) if name else page
            self.expect(file.exists(), f"the link {target} leads nowhere")
            if anchor and file.exists():
                self.expect(anchor in anchors(file.read_text()), f"{name or page.name} has no heading #{anchor}")

    def citations(self):
        """Comments cite docs/algorithm.md by heading: (algorithm: "Free evidence", "Careful sight")."""
        titles = set(headings((PACKAGE / "docs" / "algorithm.md").read_text()))
        for folder in ("include", "src", "test"):
            for file in sorted((PACKAGE / folder).rglob("*.[hc]*")):
                text = re.sub(r"\n\s*//[/!]?<?\s*", " ", file.read_text(errors="replace"))
                for cited in re.findall(r"algorithm(?:\.md)?(?:: | ?\(|, )((?:\"[^\"\n]+\"(?:, )?)+)", text):
                    for title in re.findall(r"\"([^\"]+)\"", cited):
                        self.expect(title in titles, f"{file.relative_to(PACKAGE)} cites a heading {title}")


def headings(text):
    return re.findall(r"^#+ (.*)$", without_code(text), re.MULTILINE)


def without_code(text):
    return re.sub(r"```.*?```", "", text, flags=re.DOTALL)


def anchors(text):
    """Of all headings, as GitHub makes them."""
    return {re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-") for title in headings(text)}


def main():
    check = Check()
    for page in [PACKAGE / "README.md", PACKAGE / "CONTRIBUTING.md", *sorted((PACKAGE / "docs").glob("*.md"))]:
        text = page.read_text()
        before = len(check.faults)
        check.page(text)
        check.links(page, text)
        check.faults[before:] = [f"{page.relative_to(PACKAGE)}: {fault}" for fault in check.faults[before:]]
    check.citations()
    length = len((PACKAGE / "README.md").read_text().splitlines())
    check.expect(length <= LONGEST_README, f"README.md has {length} lines, more than {LONGEST_README}")
    if check.checked < 100:
        sys.exit(f"only {check.checked} names and links were found: the documents are not read as they are written")
    if check.faults:
        sys.exit("\n".join(check.faults))
    print(f"{check.checked} programs, options, arguments, files and links of the documents: all there")


if __name__ == "__main__":
    main()
