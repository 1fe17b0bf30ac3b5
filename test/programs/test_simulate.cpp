// donex_simulate: its exit codes, what it prints and writes.
#include <gtest/gtest.h>

#include "io/sequence.h"
#include "programs/command.h"
#include "support/temporary_directory.h"

namespace donex {
namespace {

using test::Outcome;

class Simulate : public testing::Test {
 protected:
  std::filesystem::path path(const std::string& name) const { return directory_.path() / name; }

  Outcome expect(int code, const std::vector<std::string>& parts, const std::string& arguments) {
    Outcome outcome = test::runCommand("cd " + directory_.path().string() + " && " + DONEX_SIMULATE + " " + arguments);
    EXPECT_EQ(outcome.code, code) << outcome.text;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.text.find(part), std::string::npos) << "'" << part << "' is not in\n" << outcome.text;
    }
    return outcome;
  }

  test::TemporaryDirectory directory_;
};

TEST_F(Simulate, WritesALabelledSequence) {
  expect(0, {"6 scans", "moving"}, "intersection out --duration 0.6 --beams 16 --seed 4");
  const SequenceReader reader(path("out"));
  ASSERT_EQ(reader.size(), 6U);
  EXPECT_NEAR(reader.stamp(5), 0.6, 1e-9);
  std::size_t moving = 0;
  for (std::size_t i = 0; i < reader.size(); ++i) {
    const auto labels = reader.labels(i);
    EXPECT_EQ(labels.size(), reader.echoes(i));
    for (const std::uint32_t label : labels) moving += isMoving(label) ? 1 : 0;
  }
  EXPECT_GT(moving, 100U);
  EXPECT_EQ(reader.pose(0).position, reader.pose(5).position) << "this sensor is at rest";
}

TEST_F(Simulate, WritesTruePosesOrTheOdometrys) {
  const std::string drive = " --duration 1 --beams 16 --odometry-drift 0.1";
  expect(0, {}, "street exact" + drive);
  expect(0, {}, "street reported --poses odometry" + drive);
  const SequenceReader exact(path("exact"));
  const SequenceReader reported(path("reported"));
  const auto wayOf = [](const SequenceReader& reader) {
    return (reader.pose(9).position - reader.pose(0).position).norm();
  };
  EXPECT_NEAR(std::abs(wayOf(reported) / wayOf(exact) - 1.0), 0.1, 0.01);
}

TEST_F(Simulate, PosesOfAnyOdometryThatIsAllowed) {
  const std::string drive = " --poses odometry --duration 2 --beams 16 ";
  expect(0, {"14 scans"}, "empty_room a" + drive + "--odometry-stamp-offset -1 --scan-rate 7");
  expect(0, {"20 scans"}, "empty_room b" + drive + "--odometry-rate 1 --odometry-stamp-offset -0.5");
  expect(0, {"20 scans"}, "empty_room c" + drive + "--odometry-rate 1 --odometry-stamp-offset -1");
  expect(0, {"20 scans"}, "empty_room d" + drive + "--odometry-stamp-offset 1");
}

TEST_F(Simulate, SaysWhereABagBeginsLater) {
  const std::string drive = " --duration 0.2 --beams 16";
  const std::string remark = "start_stamp is 2 s, not 0.5 s: a bag knows no time before 0";
  expect(0, {remark}, "empty_room a.bag --start-stamp 0.5" + drive);
  const Outcome usual = expect(0, {"2 clouds"}, "empty_room b.bag" + drive);
  EXPECT_EQ(usual.text.find("start_stamp"), std::string::npos) << usual.text;
  expect(0, {"2 clouds"}, "empty_room c.bag --odometry-rate 1 --odometry-stamp-offset -1" + drive);
}

TEST_F(Simulate, WritesABag) {
  expect(0, {"5 clouds", "/points", "/odom"},
         "street out.bag --duration 0.5 --beams 16 --distortion --compression lz4");
  EXPECT_GT(std::filesystem::file_size(path("out.bag")), 100000U);
}

TEST_F(Simulate, WarnsThatASequenceCannotHoldTheTimes) {
  expect(0, {"has no time for each echo"}, "street out --duration 0.2 --beams 16 --distortion");
}

TEST_F(Simulate, WritesAScanPerPart) {
  expect(0, {"24 scans"}, "street parts --duration 0.6 --beams 16 --parts 4 --distortion");
  expect(0, {"6 scans"}, "street whole --duration 0.6 --beams 16 --distortion");
  const SequenceReader parts(path("parts")), whole(path("whole"));
  ASSERT_EQ(parts.size(), 24U);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    SequenceScan together;
    std::vector<std::uint32_t> labels;
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
      EXPECT_NEAR(parts.stamp(k), 0.025 * static_cast<double>(k + 1), 1e-6);
      const SequenceScan part = parts.scan(k);
      together.echoes.insert(together.echoes.end(), part.echoes.begin(), part.echoes.end());
      const auto labels_of_part = parts.labels(k);
      labels.insert(labels.end(), labels_of_part.begin(), labels_of_part.end());
    }
    EXPECT_EQ(together.echoes, whole.scan(i).echoes);
    EXPECT_EQ(labels, whole.labels(i));
  }
}

TEST_F(Simulate, WritesARigAsABagOnly) {
  expect(0, {"10 clouds", "base_link <- roof, bumper"}, "street out.bag --duration 0.5 --beams 16 --rig roof_bumper");
  expect(2, {"cannot tell which sensor a scan is of", "roof_bumper"}, "street out --duration 0.5 --rig roof_bumper");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Simulate, NamesEveryWrongArgumentAndWritesNothing) {
  expect(2, {"moon", "empty_room", "beams", "dropout"}, "moon out --beams 5 --dropout 7");
  expect(2, {"duration"}, "street out --duration 0");
  expect(2, {"parts is 0, must be between 1 and 1000"}, "street out --parts 0");
  expect(2, {"--rig", "roof_bumper"}, "street out --rig front_back");
  expect(2, {"sectors all around", "add distortion"}, "street out --parts 4 --pattern avia");
  expect(2, {"duration is 0.05 s, shorter than a scan"}, "street out --duration 0.05");
  expect(2, {"SCENE"}, "");
  expect(2, {"poses"}, "street out --poses none");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(Simulate, FailsWhereItCannotWrite) {
  expect(0, {}, "empty_room out --duration 0.2");
  expect(1, {"out/velodyne: is not empty"}, "empty_room out --duration 0.2");
  expect(1, {"nowhere/out.bag: cannot be written"}, "empty_room nowhere/out.bag --duration 0.2");
}

TEST_F(Simulate, OverwritesNothingOfAnotherSequence) {
  for (const std::string name : {"poses.txt", "times.txt", "calib.txt", "labels/000000.label"}) {
    const auto folder = path("of_" + name.substr(0, 5));
    std::filesystem::create_directories((folder / name).parent_path());
    test::writeText(folder / name, "somebody's");
    const std::string named = name.substr(0, name.find('/'));
    expect(1, {"/" + named + ": is "}, "empty_room " + folder.string() + " --duration 0.2");
    EXPECT_EQ(test::readText(folder / name), "somebody's");
    EXPECT_FALSE(std::filesystem::exists(folder / "velodyne"));
  }
}

TEST_F(Simulate, ReplacesASequenceWhenToldSo) {
  expect(0, {"6 scans"}, "empty_room out --duration 0.6 --beams 16");
  test::writeText(path("out/notes.txt"), "somebody's");
  expect(0, {"2 scans"}, "empty_room out --duration 0.2 --beams 16 --overwrite");
  EXPECT_FALSE(std::filesystem::exists(path("out/velodyne/000002.bin")));
  EXPECT_FALSE(std::filesystem::exists(path("out/labels/000002.label")));
  EXPECT_EQ(test::readText(path("out/notes.txt")), "somebody's");
  test::writeText(path("out/labels/notes.txt"), "somebody's");
  expect(1, {"out/labels: is not empty"}, "empty_room out --duration 0.2 --beams 16 --overwrite");
  EXPECT_EQ(test::readText(path("out/labels/notes.txt")), "somebody's");
}

TEST_F(Simulate, HelpNamesTheScenes) {
  expect(0, {"intersection", "lead_vehicle", "empty_room", "--odometry-drift"}, "--help");
}

}  // namespace
}  // namespace donex
