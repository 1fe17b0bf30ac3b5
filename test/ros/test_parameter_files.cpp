// Code, config/*.yaml and cfg/Donex.cfg say the same.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <type_traits>

#include <donex/DonexConfig.h>
#include <gtest/gtest.h>

#include "donex/parameters.h"
#include "io/config_file.h"
#include "ros/parameter_files.h"
#include "ros/parameters.h"

namespace donex {
namespace {

const std::string kPackage = DONEX_SOURCE_DIR;

std::string contentOf(const std::string& file) {
  std::ifstream in(file);
  EXPECT_TRUE(in) << file;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

const char* kAdvice = "run donex_write_parameters with the package's directory";

using Values = std::map<std::string, decltype(Parameter::value)>;

Values valuesOf(const Config& config) {
  Values values;
  for (const Parameter& parameter : parametersOf(config)) values[parameter.info.name] = parameter.value;
  return values;
}

TEST(ParameterFiles, AreWrittenFromTheCode) {
  EXPECT_EQ(contentOf(kPackage + "/config/default.yaml"), defaultYaml()) << kAdvice;
  EXPECT_EQ(contentOf(kPackage + "/cfg/Donex.cfg"), reconfigureCfg()) << kAdvice;
  EXPECT_EQ(contentOf(kPackage + "/config/paper_3d.yaml"), paperYaml(Method::kDonex3d)) << kAdvice;
  EXPECT_EQ(contentOf(kPackage + "/config/paper_2d.yaml"), paperYaml(Method::kDonex2d)) << kAdvice;
}

TEST(ParameterFiles, DefaultYamlReadsBackAsTheDefaults) {
  const Config config = readConfigFile(kPackage + "/config/default.yaml");
  EXPECT_TRUE(config == Config());
  for (const auto& [name, value] : valuesOf({})) {
    EXPECT_NE(defaultYaml().find("\n" + name + ": "), std::string::npos) << name;
  }
}

TEST(ParameterFiles, PaperFilesSwitchEveryStepOff) {
  for (const std::string name : {"paper_3d", "paper_2d"}) {
    const Config config = readConfigFile(kPackage + "/config/" + name + ".yaml");
    EXPECT_TRUE(config.isPaper()) << name;
    EXPECT_EQ(nameOf(config.method), "donex_" + name.substr(6));
    EXPECT_TRUE(config == paperConfig(config.method, Compensation::kResample)) << name;
  }
}

/// The names that a file sets, line by line.
std::vector<std::string> namesIn(const std::filesystem::path& file) {
  std::vector<std::string> names;
  std::istringstream lines(contentOf(file));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find_first_not_of("abcdefghijklmnopqrstuvwxyz_0123456789");
    if (end != 0 && end != std::string::npos && line[end] == ':') names.push_back(line.substr(0, end));
  }
  return names;
}

/// Whatever a file for one sensor or one use repeats of default.yaml would stay behind when a default changes.
TEST(ParameterFiles, FilesForOneUseNameOnlyWhatDiffersFromTheDefaults) {
  std::vector<std::filesystem::path> files{kPackage + "/config/at_rest.yaml"};
  for (const auto& entry : std::filesystem::directory_iterator(kPackage + "/config/sensors")) files.push_back(entry);
  ASSERT_GT(files.size(), 10U);
  const auto defaults = valuesOf({});
  for (const std::filesystem::path& file : files) {
    const auto values = valuesOf(readConfigFile(file));
    const auto names = namesIn(file);
    EXPECT_FALSE(names.empty()) << file;
    for (const std::string& name : names) EXPECT_NE(values.at(name), defaults.at(name)) << file << ": " << name;
    const auto differs = [&](const auto& value) { return value.second != defaults.at(value.first); };
    EXPECT_EQ(static_cast<std::size_t>(std::count_if(values.begin(), values.end(), differs)), names.size()) << file;
  }
}

/// The generated class speaks for cfg: its defaults and ranges are the code's.
struct CfgComparison {
  dynamic_reconfigure::Config defaults, min, max;
  std::size_t compared = 0;

  template <class Values>
  auto find(const Values& values, const std::string& name) -> decltype(&values[0]) {
    for (const auto& value : values) {
      if (value.name == name) return &value;
    }
    ADD_FAILURE() << name << " is not in cfg";
    return nullptr;
  }
  template <class Values, class Value>
  void expect(const Values& values, const ParameterInfo& info, const Value& value) {
    const auto* entry = find(values, info.name);
    if (entry == nullptr) return;
    EXPECT_EQ(entry->value, value) << info.name;
  }

  void operator()(const ParameterInfo& info, double& value, double from, double to) {
    if (!info.reconfigurable) return;
    expect(defaults.doubles, info, value);
    expect(min.doubles, info, from);
    expect(max.doubles, info, to);
    ++compared;
  }
  void operator()(const ParameterInfo& info, int& value, int from, int to) {
    if (!info.reconfigurable) return;
    expect(defaults.ints, info, value);
    expect(min.ints, info, from);
    expect(max.ints, info, to);
    ++compared;
  }
  void operator()(const ParameterInfo& info, bool& value) {
    if (!info.reconfigurable) return;
    expect(defaults.bools, info, value ? 1 : 0);
    ++compared;
  }
  void operator()(const ParameterInfo& info, std::string& value) {
    if (!info.reconfigurable) return;
    expect(defaults.strs, info, value);
    ++compared;
  }
  template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
  void operator()(const ParameterInfo& info, Enum& value) {
    if (!info.reconfigurable) return;
    expect(defaults.strs, info, nameOf(value));
    ++compared;
  }
};

TEST(ParameterFiles, CfgHasTheCodesDefaultsAndRanges) {
  CfgComparison comparison;
  DonexConfig::__getDefault__().__toMessage__(comparison.defaults);
  DonexConfig::__getMin__().__toMessage__(comparison.min);
  DonexConfig::__getMax__().__toMessage__(comparison.max);
  Config config;
  visitParameters(config, comparison);
  EXPECT_GT(comparison.compared, 10U);
  const auto& message = comparison.defaults;
  EXPECT_EQ(message.bools.size() + message.ints.size() + message.doubles.size() + message.strs.size(),
            comparison.compared)
      << "cfg has parameters that the code has not";
}

TEST(ParameterFiles, LevelsTellSwitchesFromRebuilds) {
  std::map<std::string, std::uint32_t> levels;
  for (const auto& [info, value] : parametersOf(Config())) levels[info.name] = levelOf(info);
  EXPECT_EQ(levels.at("voxel_size"), kRebuildsGrid);
  EXPECT_EQ(levels.at("z_max"), kRebuildsGrid);
  EXPECT_EQ(levels.at("marker_grid"), kSwitch);
  for (const auto& description : DonexConfig::__getParamDescriptions__()) {
    EXPECT_EQ(description->level, levels.at(description->name)) << description->name;
  }
}

}  // namespace
}  // namespace donex
