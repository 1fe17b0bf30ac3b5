#!/usr/bin/python3
"""Opens a report in headless Chromium, from disk: every figure must be drawn, and the console must be silent.

Usage: check_page.py REPORT.html [SCREENSHOT.png]
"""
import html.parser
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile


class Figures(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.marks, self.ready, self.cells = {}, None, 0

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        if tag == "figure":
            self.marks[values["data-figure"]] = int(values["data-marks"])
        if tag == "body":
            self.ready = values.get("data-ready")
        self.cells += tag == "td"


def browse(page, *options):
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    with tempfile.TemporaryDirectory() as profile:
        # No name is resolved: what the page would fetch from elsewhere fails, and says so on the console.
        return subprocess.run(
            [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars",
             "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr", f"--user-data-dir={profile}",
             "--virtual-time-budget=20000", *options, page.resolve().as_uri()],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, timeout=600, check=True)


def main():
    page = pathlib.Path(sys.argv[1])
    run = browse(page, "--dump-dom")
    console = re.findall(r".*:CONSOLE.*", run.stderr)
    if console:
        sys.exit("the console is not silent:\n" + "\n".join(console))
    figures = Figures()
    figures.feed(run.stdout)
    if figures.ready is None or int(figures.ready) != len(figures.marks) or not figures.marks:
        sys.exit(f"the page was not drawn to its end: {figures.ready} figures announced, {len(figures.marks)} there")
    empty = [name for name, marks in figures.marks.items() if marks == 0]
    if empty:
        sys.exit("empty figures: " + ", ".join(empty))
    if len(sys.argv) > 2:
        browse(page, f"--screenshot={pathlib.Path(sys.argv[2]).resolve()}", "--window-size=1240,6000")
    print(f"{len(figures.marks)} figures drawn, {figures.cells} cells of tables, no message on the console")


if __name__ == "__main__":
    main()
