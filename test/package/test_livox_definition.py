#!/usr/bin/python3
"""The md5 by which a message of Livox' drivers is known, computed from their definition as ROS does.

Usage: test_livox_definition.py PACKAGE
"""
import pathlib
import re
import sys
import unittest

from genmsg import MsgContext, gentools
from genmsg.msg_loader import load_msg_from_string

PACKAGE = pathlib.Path(sys.argv.pop(1))
HEADER = "uint32 seq\ntime stamp\nstring frame_id\n"
POINT = "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"
MESSAGE = ("std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
           "CustomPoint[] points\n")


def md5_of(driver):
    context = MsgContext.create_default()
    load_msg_from_string(context, HEADER, "std_msgs/Header")
    load_msg_from_string(context, POINT, f"{driver}/CustomPoint")
    message = load_msg_from_string(context, MESSAGE, f"{driver}/CustomMsg")
    return gentools.compute_md5(context, message)


class LivoxDefinition(unittest.TestCase):
    def test_of_both_drivers(self):
        text = (PACKAGE / "src" / "ros" / "livox_cloud.h").read_text()
        known = re.search(r'kLivoxMd5 = "(\w+)"', text)[1]
        for driver in ["livox_ros_driver", "livox_ros_driver2"]:
            self.assertEqual(md5_of(driver), known)


if __name__ == "__main__":
    unittest.main()
