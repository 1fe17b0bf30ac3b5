// Strict reading: every fault is named, all at once, and nothing is taken silently.
#include <gtest/gtest.h>

#include "ros/parameters.h"

namespace donex {
namespace {

using XmlRpc::XmlRpcValue;

struct BadParameter {
  const char* name;
  XmlRpcValue value;
  const char* words;
};

std::string faultsOf(const XmlRpcValue& values) {
  Config config;
  return joined(applyParameters(values, config));
}

TEST(Parameters, EmptyNamespaceIsTheDefault) { EXPECT_EQ(faultsOf(XmlRpcValue()), ""); }

TEST(Parameters, GoodValuesOfEveryType) {
  XmlRpcValue values;
  values["method"] = "donex_2d";
  values["voxel_size"] = 0.4;
  values["x_max"] = 30;  // an integer where a number is wanted
  values["queue_size"] = 3;
  values["deskew"] = false;
  values["base_frame"] = "chassis";
  values["odometry_source"] = "none";
  values["diagnostic_period"] = 0.5;
  Config config;
  EXPECT_EQ(joined(applyParameters(values, config)), "");
  EXPECT_EQ(config.method, Method::kDonex2d);
  EXPECT_EQ(config.voxel_size, 0.4);
  EXPECT_EQ(config.region.x_max, 30.0);
  EXPECT_EQ(config.node.queue_size, 3);
  EXPECT_FALSE(config.motion.deskew);
  EXPECT_EQ(config.motion.base_frame, "chassis");
  EXPECT_EQ(config.motion.source, OdometrySource::kNone);
}

TEST(Parameters, EachFaultIsNamed) {
  XmlRpcValue map, list;
  map["x"] = 1;
  list[0] = 1;
  const std::vector<BadParameter> bad{
      {"voxel_size", "0.2", "voxel_size is a string, must be a number"},
      {"voxel_size", true, "voxel_size is a boolean"},
      {"voxel_size", 0.001, "voxel_size is 0.001, must lie in"},
      {"voxel_size", list, "voxel_size is a list"},
      {"queue_size", 2.5, "queue_size is a number, must be an integer"},
      {"queue_size", 0, "queue_size is 0, must lie in [1, 1000]"},
      {"deskew", 1, "deskew is an integer, must be a boolean"},
      {"base_frame", 7, "base_frame is an integer, must be a string"},
      {"method", "donex_4d", "method is 'donex_4d', must be one of donex_3d, donex_2d"},
      {"method", 0, "method is an integer, must be one of donex_3d, donex_2d"},
      {"voxelsize", 0.2, "unknown parameter 'voxelsize'"},
      {"region", map, "unknown parameter 'region'"},
      {"x_min", 60.0, "x_min is 60 and x_max is 50"},
  };
  for (const BadParameter& parameter : bad) {
    XmlRpcValue values;
    values[parameter.name] = parameter.value;
    const std::string faults = faultsOf(values);
    EXPECT_NE(faults.find(parameter.words), std::string::npos) << parameter.name << ": " << faults;
  }
}

TEST(Parameters, AllFaultsAtOnce) {
  XmlRpcValue values;
  values["method"] = 1;
  values["voxel_size"] = 99.0;
  values["nonsense"] = 1;
  values["deskew"] = "yes";
  const std::string faults = faultsOf(values);
  for (const char* name : {"method", "voxel_size", "nonsense", "deskew"}) {
    EXPECT_NE(faults.find(name), std::string::npos) << faults;
  }
}

TEST(Parameters, NotAMap) { EXPECT_EQ(faultsOf(XmlRpcValue(3)), "the parameters are an integer, must be a map"); }

TEST(Messages, ARoundTripKeepsWhatIsReconfigurable) {
  Config config;
  config.method = Method::kDonex2d;
  config.voxel_size = 0.35;
  config.region.z_max = 3.0;
  config.node.marker_grid = false;
  Config read;
  EXPECT_EQ(joined(applyMessage(toMessage(config), read)), "");
  EXPECT_EQ(read.method, config.method);
  EXPECT_EQ(read.voxel_size, config.voxel_size);
  EXPECT_EQ(read.region.z_max, config.region.z_max);
  EXPECT_FALSE(read.node.marker_grid);
  EXPECT_TRUE(sameDetection(config, read));
}

TEST(Messages, WhatIsFixedAtStartIsNotInThem) {
  for (const auto& parameter : toMessage({}).strs) EXPECT_NE(parameter.name, "base_frame");
  EXPECT_FALSE(toMessage({}).strs.empty());
  dynamic_reconfigure::Config message;
  message.strs.resize(1);
  message.strs[0].name = "base_frame";
  message.strs[0].value = "elsewhere";
  Config config;
  applyMessage(message, config);
  EXPECT_EQ(config.motion.base_frame, "base_link");
}

TEST(Messages, BadValuesAreFaults) {
  Config config;
  dynamic_reconfigure::Config message = toMessage(config);
  for (auto& parameter : message.strs) {
    if (parameter.name == "method") parameter.value = "best";
  }
  for (auto& parameter : message.doubles) {
    if (parameter.name == "voxel_size") parameter.value = -1.0;
  }
  const std::string faults = joined(applyMessage(message, config));
  EXPECT_NE(faults.find("'best'"), std::string::npos) << faults;
  EXPECT_NE(faults.find("voxel_size is -1"), std::string::npos) << faults;
}

TEST(SameDetection, OnlySwitchesOfTheNodeAreFree) {
  Config config;
  config.node.markers = false;
  EXPECT_TRUE(sameDetection({}, config));
  config.region.z_min = -3.0;
  EXPECT_FALSE(sameDetection({}, config));
}

}  // namespace
}  // namespace donex
