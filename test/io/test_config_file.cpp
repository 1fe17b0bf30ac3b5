#include <gtest/gtest.h>

#include "donex/parameters.h"
#include "io/config_file.h"
#include "support/temporary_directory.h"

namespace donex {
namespace {

/// What readConfigFile says to a file of this text, its directory left out; "" when it is content.
std::string faultsOf(const std::string& text) {
  const test::TemporaryDirectory directory;
  const std::string file = (directory.path() / "config.yaml").string();
  test::writeText(file, text);
  try {
    readConfigFile(file);
  } catch (const DataError& error) {
    std::string message = error.what();
    const std::string prefix = (directory.path() / "").string();
    for (std::size_t at; (at = message.find(prefix)) != std::string::npos;) message.erase(at, prefix.size());
    return message;
  }
  return "";
}

Config read(const std::string& text) {
  const test::TemporaryDirectory directory;
  test::writeText(directory.path() / "config.yaml", text);
  return readConfigFile(directory.path() / "config.yaml");
}

TEST(ConfigFile, SetsWhatItNamesAndLeavesTheRest) {
  const Config config = read(
      "# a comment\n"
      "method: donex_2d\n"
      "voxel_size: 0.3\n"
      "x_max: 75\n"
      "fixed_frame: map\n"
      "markers: off\n"
      "queue_size: 7\n");
  EXPECT_EQ(config.method, Method::kDonex2d);
  EXPECT_EQ(config.voxel_size, 0.3);
  EXPECT_EQ(config.region.x_max, 75.0);
  EXPECT_EQ(config.motion.fixed_frame, "map");
  EXPECT_FALSE(config.node.markers);
  EXPECT_EQ(config.node.queue_size, 7);
  EXPECT_EQ(config.region.x_min, Config().region.x_min);
  EXPECT_EQ(config.compensation, Config().compensation);
}

TEST(ConfigFile, EmptyFileSetsNothing) {
  EXPECT_EQ(read("").voxel_size, Config().voxel_size);
  EXPECT_EQ(read("# only a comment\n---\n").voxel_size, Config().voxel_size);
}

/// Writes every parameter as YAML text.
struct Printer {
  std::string& text;
  void line(const ParameterInfo& info, const std::string& value) {
    text += std::string(info.name) + ": " + value + "\n";
  }
  void operator()(const ParameterInfo& info, double& value, double, double) { line(info, std::to_string(value)); }
  void operator()(const ParameterInfo& info, int& value, int, int) { line(info, std::to_string(value)); }
  void operator()(const ParameterInfo& info, bool& value) { line(info, value ? "true" : "false"); }
  void operator()(const ParameterInfo& info, std::string& value) { line(info, '"' + value + '"'); }
  template <class Enum>
  std::enable_if_t<std::is_enum_v<Enum>> operator()(const ParameterInfo& info, Enum& value) {
    line(info, nameOf(value));
  }
};

std::string printed(Config config) {
  std::string text;
  visitParameters(config, Printer{text});
  return text;
}

TEST(ConfigFile, EveryParameterCanBeGiven) {
  Config config;
  config.method = Method::kDonex2d;
  config.voxel_size = 0.25;
  config.node.queue_size = 3;
  config.node.marker_cells = !config.node.marker_cells;
  config.motion.source = OdometrySource::kTwist;
  config.motion.base_frame = "vehicle";
  EXPECT_TRUE(read(printed(config)) == config);
  EXPECT_TRUE(config != Config());
}

TEST(ConfigFile, TheFilesOfThePackageAreSound) {
  const std::filesystem::path directory = DONEX_CONFIG_DIR;
  EXPECT_TRUE(readConfigFile(directory / "default.yaml") == Config());
  EXPECT_EQ(readConfigFile(directory / "paper_2d.yaml").method, Method::kDonex2d);
  EXPECT_EQ(readConfigFile(directory / "paper_3d.yaml").method, Method::kDonex3d);
  EXPECT_EQ(readConfigFile(directory / "at_rest.yaml").motion.source, OdometrySource::kNone);
}

struct Bad {
  const char* text;
  const char* message;
};

TEST(ConfigFile, NamesEachFault) {
  const std::vector<Bad> table{
      {"voxel_size: fine", "config.yaml:1: voxel_size is fine, must be a number"},
      {"voxel_size: '0.2'", "config.yaml:1: voxel_size is \"0.2\", must be a number"},
      {"\nvoxel_size: 1e-1", "config.yaml:2: voxel_size is 1e-1, must be a number (written as 0.5 or 1.0e-3)"},
      {"voxel_size:", "config.yaml:1: voxel_size is nothing, must be a number"},
      {"voxel_size: true", "config.yaml:1: voxel_size is true, must be a number"},
      {"voxel_size: [0.2]", "config.yaml:1: voxel_size is a list, must be a number"},
      {"voxel_size: {x: 1}", "config.yaml:1: voxel_size is a map, must be a number"},
      {"voxel_size: 0.001", "config.yaml:1: voxel_size is 0.001, must lie in [0.02, 2] m"},
      {"voxel_size: .nan", "config.yaml:1: voxel_size is .nan, must be a number"},
      {"queue_size: 2.5", "config.yaml:1: queue_size is 2.5, must be a whole number"},
      {"queue_size: 010", "config.yaml:1: queue_size is 010, must be a whole number"},
      {"queue_size: +", "config.yaml:1: queue_size is +, must be a whole number"},
      {"voxel_size: .", "config.yaml:1: voxel_size is ., must be a number (written as 0.5 or 1.0e-3)"},
      {"voxel_size: 1.0e-", "config.yaml:1: voxel_size is 1.0e-, must be a number (written as 0.5 or 1.0e-3)"},
      {"voxel_size: 1.0e3", "config.yaml:1: voxel_size is 1.0e3, must be a number (written as 0.5 or 1.0e-3)"},
      {"queue_size: 99999999999999", "config.yaml:1: queue_size is 99999999999999, is too large"},
      {"queue_size: 0", "config.yaml:1: queue_size is 0, must lie in [1, 1000] clouds"},
      {"markers: 1", "config.yaml:1: markers is 1, must be true or false"},
      {"markers: 'true'", "config.yaml:1: markers is \"true\", must be true or false"},
      {"fixed_frame: 7", "config.yaml:1: fixed_frame is 7, must be text"},
      {"fixed_frame: yes", "config.yaml:1: fixed_frame is yes, must be text"},
      {"fixed_frame: [odom]", "config.yaml:1: fixed_frame is a list, must be text"},
      {"method: donex", "config.yaml:1: method is donex, must be one of donex_3d, donex_2d"},
      {"method: {donex_3d: 1}", "config.yaml:1: method is a map, must be one of"},
      {"voxelsize: 0.2", "config.yaml:1: there is no parameter voxelsize"},
      {"donex:\n  voxel_size: 0.2", "config.yaml:1: there is no parameter donex"},
      {"voxel_size: 0.2\nvoxel_size: 0.3", "config.yaml:2: voxel_size is set a second time, first at config.yaml:1"},
      {"[1, 2]: 3", "config.yaml:1: the name of a parameter must be plain text"},
      {"- voxel_size", "config.yaml:1: must be a map of parameter names to values"},
      {"just text", "config.yaml:1: must be a map of parameter names to values"},
      {"voxel_size: [1", "is not YAML"},
      {"a: b: c", "config.yaml:1: is not YAML"},
      {",%t $e", "config.yaml: holds more than one YAML document"},
      {"voxel_size: 0.2\n---\nvoxel_size: 0.3", "config.yaml: holds more than one YAML document"},
      {"# nothing here\nx_min: 10\nx_max: 5", "config.yaml:3: x_min is 10 and x_max is 5"},
  };
  for (const Bad& bad : table) {
    const std::string message = faultsOf(bad.text);
    EXPECT_NE(message.find(bad.message), std::string::npos) << bad.text << "\ngives\n" << message;
  }
}

TEST(ConfigFile, ANumberMayBeLongerThanAnyStack) {
  const std::string digits(1000000, '1');
  EXPECT_EQ(faultsOf("queue_size: " + digits),
            "config.yaml:1: queue_size is " + digits.substr(0, 80) + "..., is too large");
  EXPECT_EQ(faultsOf("time_field: " + digits),
            "config.yaml:1: time_field is " + digits.substr(0, 80) + "..., must be text");
  EXPECT_EQ(read("voxel_size: 0.3" + std::string(1000000, '0')).voxel_size, 0.3);
}

TEST(ConfigFile, NamesAllFaultsAtOnce) {
  const std::string message = faultsOf("voxel_size: big\nqueue_size: -1\nmethod: 3d\nnonsense: 1\nmarkers: maybe\n");
  for (const char* where : {"config.yaml:1:", "config.yaml:2:", "config.yaml:3:", "config.yaml:4:", "config.yaml:5:"}) {
    EXPECT_NE(message.find(where), std::string::npos) << where << " is not in\n" << message;
  }
}

TEST(ConfigFile, WhatIsNoFileIsNamed) {
  const test::TemporaryDirectory directory;
  for (const auto& file : {directory.path() / "config.yaml", directory.path()}) {
    try {
      readConfigFile(file);
      FAIL() << file << " was read";
    } catch (const DataError& error) {
      EXPECT_EQ(error.what(), file.string() + ": cannot be read");
    }
  }
}

TEST(Settings, OverrideTheLaterTheStronger) {
  Config config = read("voxel_size: 0.5\nqueue_size: 3\n");
  applySettings(config, {"voxel_size=0.3", "method=donex_2d", "voxel_size=0.1"});
  EXPECT_EQ(config.voxel_size, 0.1);
  EXPECT_EQ(config.method, Method::kDonex2d);
  EXPECT_EQ(config.node.queue_size, 3);
}

TEST(Settings, FaultsAreNamedAtOnceAndChangeNothing) {
  Config config;
  try {
    applySettings(config, {"voxel_size=0", "method", "=3", "nonsense=1", "markers=", "x_max=-80", "queue_size=["});
    FAIL() << "accepted";
  } catch (const SettingError& error) {
    const std::string message = error.what();
    for (const char* part :
         {"'voxel_size=0': voxel_size is 0, must lie in", "'method': must be name=value", "'=3': must be name=value",
          "'nonsense=1': there is no parameter nonsense", "'markers=': markers is nothing",
          "'queue_size=[': is not YAML", "'x_max=-80': x_min is -50 and x_max is -80"}) {
      EXPECT_NE(message.find(part), std::string::npos) << part << " is not in\n" << message;
    }
  }
  EXPECT_EQ(printed(config), printed(Config()));
}

}  // namespace
}  // namespace donex
