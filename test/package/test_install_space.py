#!/usr/bin/python3
"""The installed package alone runs the demo: test_install_space.py INSTALL_SPACE, in that space's environment."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client

import rosgraph
import rospkg
import rospy
from sensor_msgs.msg import PointCloud2

INSTALL_SPACE = pathlib.Path(sys.argv.pop()).resolve()
PROGRAMS = ["donex_sequence", "donex_evaluate", "donex_compare", "donex_map", "donex_bag", "donex_archive",
            "donex_sequence_to_bag", "donex_simulate", "donex_disturb"]
CLOUDS = 20
DEADLINE = 300.0  # for the first clouds on a slow machine [s]


def run(program, *arguments):
    result = subprocess.run([str(INSTALL_SPACE / "lib" / "donex" / program), *map(str, arguments)],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=600)
    if result.returncode != 0:
        raise AssertionError(f"{program} ended with {result.returncode}: {result.stdout}")
    return result.stdout


class InstallSpace(unittest.TestCase):
    def test_package_is_the_installed_one(self):
        path = pathlib.Path(rospkg.RosPack().get_path("donex")).resolve()
        self.assertEqual(path, INSTALL_SPACE / "share" / "donex")

    def test_no_link_leads_nowhere(self):
        dangling = [str(path) for path in INSTALL_SPACE.rglob("*") if path.is_symlink() and not path.exists()]
        self.assertEqual(dangling, [])

    def test_libraries_can_be_loaded(self):
        libraries = sorted(map(str, (INSTALL_SPACE / "lib").glob("*.so")))
        self.assertTrue(libraries)
        # In a process of its own: what they register there concerns nobody.
        subprocess.run([sys.executable, "-c", "import ctypes, sys\nfor path in sys.argv[1:]: ctypes.CDLL(path)",
                        *libraries], check=True, timeout=600)

    def test_programs_explain_themselves(self):
        for program in PROGRAMS:
            self.assertIn(program, run(program, "--help"))

    def test_an_archive_finds_its_program_and_its_page(self):
        with tempfile.TemporaryDirectory() as folder:
            bags, out = pathlib.Path(folder) / "in", pathlib.Path(folder) / "out"
            bags.mkdir()
            run("donex_simulate", "street", bags / "drive.bag", "--duration", 1, "--beams", 16)
            run("donex_archive", bags, out)
            self.assertIn('"name": "drive"', (out / "report.html").read_text())

    def test_launch_files_load(self):
        launch = INSTALL_SPACE / "share" / "donex" / "launch"
        for name, arguments in [("donex.launch", []), ("donex.launch", ["nodelet:=false", "rviz:=true"]),
                                ("donex.launch", ["manager:=somebody"]), ("donex.launch", ["sensor:=vlp16"]),
                                ("map.launch", []), ("demo.launch", []),
                                ("replay.launch", ["bag:=/drive.bag", "loop:=true", "mounting:=0 0 1 0 0 0 a b"])]:
            subprocess.run(["roslaunch", "--nodes", str(launch / name)] + arguments, check=True, timeout=600,
                           stdout=subprocess.DEVNULL)


class Demo(unittest.TestCase):
    """Simulated LiDAR and classifier as nodelets of one manager."""

    @classmethod
    def setUpClass(cls):
        port = os.environ["ROS_MASTER_URI"].rsplit(":", 1)[1]
        cls.launch = subprocess.Popen(["roslaunch", "-p", port, "donex", "demo.launch", "rviz:=false"])
        cls.clouds = []
        rospy.init_node("test_install_space", disable_signals=True)
        rospy.Subscriber("/donex/labeled_points", PointCloud2, cls.on_cloud, buff_size=1 << 26)
        end = time.monotonic() + DEADLINE
        while len(cls.clouds) < CLOUDS and time.monotonic() < end and cls.launch.poll() is None:
            time.sleep(0.1)  # until what the tests ask for is there; they say what is missing

    @classmethod
    def tearDownClass(cls):
        cls.launch.send_signal(signal.SIGINT)
        cls.launch.wait(timeout=600)

    @classmethod
    def on_cloud(cls, cloud):
        cls.clouds.append((cloud.header, [field.name for field in cloud.fields], cloud.width * cloud.height))

    def test_labelled_clouds_come(self):
        self.assertGreaterEqual(len(self.clouds), CLOUDS)
        for header, fields, echoes in self.clouds:
            self.assertEqual(fields[:3], ["x", "y", "z"])
            self.assertIn("dynamic", fields)
            self.assertIn("observed", fields)
            self.assertGreater(echoes, 50000)
        stamps = [header.stamp for header, _, _ in self.clouds]
        self.assertEqual(stamps, sorted(stamps))

    def test_nodelets_come_from_the_install_space(self):
        address = rosgraph.Master("/test_install_space").lookupNode("/donex_manager")
        _, _, process = xmlrpc.client.ServerProxy(address).getPid("/test_install_space")
        maps = pathlib.Path(f"/proc/{process}/maps").read_text().splitlines()
        libraries = {line.split()[-1] for line in maps if "libdonex" in line}
        self.assertTrue(libraries)
        for library in libraries:
            self.assertTrue(library.startswith(str(INSTALL_SPACE)), library)


if __name__ == "__main__":
    unittest.main()
