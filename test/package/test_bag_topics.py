#!/usr/bin/python3
"""What scripts/bag_topics says of bags, and that replay.launch takes it: test_bag_topics.py PACKAGE; starts nothing."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import rosbag
import roslaunch.config
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, PointCloud2
from tf2_msgs.msg import TFMessage

PACKAGE = pathlib.Path(sys.argv.pop()).resolve()
ODOMETRY, TF = ("/odom", Odometry()), ("/tf", TFMessage())


def cloud(frame, topic="/points"):
    message = PointCloud2()
    message.header.frame_id = frame
    return topic, message


def said_of(*messages):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "drive.bag"
        with rosbag.Bag(str(path), "w") as bag:
            for i, (topic, message) in enumerate(messages):
                bag.write(topic, message, rospy.Time(1 + i))
        return subprocess.run([str(PACKAGE / "scripts" / "bag_topics"), str(path)], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, check=False)


def arguments_of(*messages):
    run = said_of(*messages)
    assert run.returncode == 0, run.stderr
    return run.stdout.splitlines()


class BagTopics(unittest.TestCase):
    def test_odometry_is_taken_where_there_is_some(self):
        self.assertEqual(arguments_of(cloud("velodyne"), ODOMETRY), ["points:=/points", "odom:=/odom"])

    def test_topics_with_most_messages_win(self):
        arguments = arguments_of(cloud("a", "/few"), cloud("a", "/many"), cloud("a", "/many"), ODOMETRY)
        self.assertEqual(arguments, ["points:=/many", "odom:=/odom"])

    def test_tf_of_the_bag_stays_alone(self):
        self.assertEqual(arguments_of(cloud("velodyne"), TF), ["points:=/points"])

    def test_clouds_alone_are_placed_by_the_motion_found_in_them(self):
        placed = ["points:=/points", "publish_tf:=true"]
        self.assertEqual(arguments_of(cloud("/velodyne")), placed + ["base_frame:=velodyne"])
        self.assertEqual(arguments_of(cloud("")), placed)

    def test_replay_launch_takes_what_is_said(self):
        arguments = arguments_of(cloud("velodyne")) + ["bag:=/drive.bag", "rviz:=false"]
        launch = str(PACKAGE / "launch" / "replay.launch")
        config = roslaunch.config.load_config_default([(launch, arguments)], None)
        self.assertIs(config.params["/donex/publish_tf"].value, True)
        self.assertEqual(config.params["/donex/odometry_source"].value, "auto")
        self.assertEqual(config.params["/donex/base_frame"].value, "velodyne")

    def test_a_bag_without_clouds_is_refused_with_what_it_holds(self):
        run = said_of(ODOMETRY, ("/imu", Imu()))
        self.assertEqual(run.returncode, 1)
        self.assertIn("holds no sensor_msgs/PointCloud2", run.stderr)
        self.assertIn("sensor_msgs/Imu", run.stderr)


if __name__ == "__main__":
    unittest.main()
