// donex_bag itself: arguments that cannot be meant.
#include <gtest/gtest.h>

#include "bag/bags.h"
#include "bag/simulation_bag.h"
#include "programs/command.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

TEST(BagProgram, TwoPartsOfOneNameAreRefused) {
  const test::TemporaryDirectory directory;
  for (const char* folder : {"a", "b"}) {
    fs::create_directory(directory.path() / folder);
    test::writeText(directory.path() / folder / "rec.bag", "never opened");
  }
  const std::string arguments = " a/rec.bag b/rec.bag --out out";
  const test::Outcome outcome = test::runCommand("cd " + directory.path().string() + " && " + DONEX_BAG + arguments);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.text.find("rec.bag: two parts have this name, one would overwrite the other"), std::string::npos)
      << outcome.text;
  EXPECT_FALSE(fs::exists(directory.path() / "out"));
}

TEST(BagProgram, aForgottenOutputFolderReplacesNoRecording) {
  const test::TemporaryDirectory directory;
  for (const char* part : {"p_0.bag", "p_1.bag", "p_2.bag"}) test::writeText(directory.path() / part, part);
  const std::string donex_bag = "cd " + directory.path().string() + " && " + DONEX_BAG;
  const auto expectRefused = [&](const std::string& arguments, const std::string& sentence) {
    const test::Outcome outcome = test::runCommand(donex_bag + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.text, "donex_bag: " + sentence + "\n") << arguments;
    for (const char* part : {"p_0.bag", "p_1.bag", "p_2.bag"}) {
      EXPECT_EQ(test::readText(directory.path() / part), part) << arguments;
    }
  };
  expectRefused(" p_0.bag p_1.bag", "p_1.bag: is there already; --overwrite replaces it");
  expectRefused(" p_0.bag p_1.bag p_2.bag",
                "3 bags and no --out DIR: IN.bag OUT.bag, or the parts of a recording and --out");
  expectRefused(" p_0.bag p_1.bag p_2.bag --overwrite",
                "3 bags and no --out DIR: IN.bag OUT.bag, or the parts of a recording and --out");
  expectRefused(" p_0.bag p_1.bag --out . --overwrite", "./p_0.bag: is an input, which would be overwritten");
  expectRefused(" p_0.bag new.bag --summary p_1.bag", "p_1.bag: is there already; --overwrite replaces it");
  expectRefused(" p_0.bag new.bag --summary new.bag",
                "new.bag: two outputs have this name, one would overwrite the other");
}

TEST(BagProgram, ChecksTheOdometryAndWritesNothing) {
  const test::TemporaryDirectory directory;
  simulation::SimulatorOptions options;
  options.beams = 16;
  options.duration = 3.0;
  options.start_stamp = 5.0;
  options.odometry.drift = 0.08;
  simulation::Simulator simulator("street", options);
  const auto file = directory.path() / "drive.bag";
  writeSimulationBag(simulator, file, rosbag::compression::Uncompressed, [] {});
  const std::string before = test::readText(file);
  const std::string program = std::string(DONEX_BAG) + " " + file.string() + " --check-odometry";
  const test::Outcome outcome = test::runCommand(program);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  for (const char* words :
       {"odometry disagrees with the scans in", "likely cause: its scale", "\nmounting: ", "\nscale: ", "\nstamps: "}) {
    EXPECT_NE(outcome.text.find(words), std::string::npos) << words << "\n" << outcome.text;
  }
  const auto files = std::distance(fs::directory_iterator(directory.path()), fs::directory_iterator());
  EXPECT_EQ(files, 1);
  EXPECT_EQ(test::readText(file), before);
  const test::Outcome clouds_alone = test::runCommand(program + " --set odometry_source=lidar");
  EXPECT_EQ(clouds_alone.code, 1) << clouds_alone.text;
  EXPECT_NE(clouds_alone.text.find("neither odometry nor tf to check"), std::string::npos) << clouds_alone.text;
}

}  // namespace
}  // namespace donex
