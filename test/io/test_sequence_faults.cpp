// Everything that can be wrong with a sequence on disk: each is named with its file (and line).
#include <functional>

#include <gtest/gtest.h>

#include "support/sequences.h"
#include "support/temporary_directory.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPose = "1 0 0 0 0 1 0 0 0 0 1 0\n";

struct Spoiled {
  const char* name;
  std::function<void(const fs::path&)> spoil;  ///< a sound sequence of three scans
  std::string message;
};

void PrintTo(const Spoiled& spoiled, std::ostream* out) { *out << spoiled.name; }

void replacePoses(const fs::path& directory, const std::string& second_line) {
  test::writeText(directory / "poses.txt", kPose + second_line + "\n" + kPose);
}

std::vector<Spoiled> spoiledSequences() {
  return {
      {"NoVelodyne", [](const fs::path& d) { fs::remove_all(d / "velodyne"); }, "velodyne: is missing"},
      {"EmptyVelodyne",
       [](const fs::path& d) {
         fs::remove_all(d / "velodyne");
         fs::create_directory(d / "velodyne");
       },
       "velodyne: holds no scan NNNNNN.bin"},
      {"OddCloud", [](const fs::path& d) { fs::resize_file(d / "velodyne/000001.bin", 150); },
       "velodyne/000001.bin: 150 bytes, no multiple of 16"},
      {"CloudOfTera", [](const fs::path& d) { fs::resize_file(d / "velodyne/000001.bin", 1ULL << 40U); },
       "velodyne/000001.bin: 1099511627776 bytes, of more than 100000000 echoes"},
      {"Gap", [](const fs::path& d) { fs::remove(d / "velodyne/000001.bin"); }, "velodyne: 000001.bin is missing"},
      {"LateStart",
       [](const fs::path& d) {
         fs::remove(d / "velodyne/000000.bin");
         fs::remove(d / "velodyne/000001.bin");
       },
       "velodyne: 000000.bin to 000001.bin are missing"},
      {"OddName", [](const fs::path& d) { test::writeText(d / "velodyne/12.bin", ""); },
       "velodyne/12.bin: the name is not six digits"},
      {"NoPoses", [](const fs::path& d) { fs::remove(d / "poses.txt"); }, "poses.txt: cannot be read"},
      {"FewPoses", [](const fs::path& d) { test::writeText(d / "poses.txt", kPose); },
       "poses.txt: 1 lines for 3 scans"},
      {"PoseNotNumeric", [](const fs::path& d) { replacePoses(d, "1 0 0 0 0 one 0 0 0 0 1 0"); },
       "poses.txt:2: 'one' is not a number"},
      {"PoseTooShort", [](const fs::path& d) { replacePoses(d, "1 0 0 0 0 1 0 0 0 0 1"); },
       "poses.txt:2: has 11 numbers, must have 12"},
      {"PoseBlank", [](const fs::path& d) { replacePoses(d, ""); }, "poses.txt:2: has 0 numbers, must have 12"},
      {"PoseNotFinite", [](const fs::path& d) { replacePoses(d, "1 0 0 nan 0 1 0 0 0 0 1 0"); },
       "poses.txt:2: the pose is not finite"},
      {"PoseNotRigid", [](const fs::path& d) { replacePoses(d, "2 0 0 0 0 1 0 0 0 0 1 0"); },
       "poses.txt:2: the pose is not rigid"},
      {"PoseMirrors", [](const fs::path& d) { replacePoses(d, "1 0 0 0 0 -1 0 0 0 0 1 0"); },
       "poses.txt:2: the pose is not rigid: its rotation part mirrors"},
      {"FewTimes", [](const fs::path& d) { test::writeText(d / "times.txt", "0.1\n0.2\n"); },
       "times.txt: 2 lines for 3 scans"},
      {"TimesBackwards", [](const fs::path& d) { test::writeText(d / "times.txt", "0.1\n0.3\n0.2\n"); },
       "times.txt:3: the time 0.2 is not later than the one before"},
      {"TimesStandStill", [](const fs::path& d) { test::writeText(d / "times.txt", "0.1\n0.1\n0.2\n"); },
       "times.txt:2: the time 0.1 is not later"},
      {"TimeNotNumeric", [](const fs::path& d) { test::writeText(d / "times.txt", "0.1\nnoon\n0.2\n"); },
       "times.txt:2: 'noon' is not a number"},
      {"TimeNotFinite", [](const fs::path& d) { test::writeText(d / "times.txt", "0.1\ninf\n0.2\n"); },
       "times.txt:2: the time is not finite"},
      {"LabelCount", [](const fs::path& d) { fs::resize_file(d / "labels/000002.label", 36); },
       "labels/000002.label: 9 labels for 10 echoes"},
      {"OddLabels", [](const fs::path& d) { fs::resize_file(d / "labels/000002.label", 41); },
       "labels/000002.label: 41 bytes, no multiple of 4"},
      {"LabelsOfNoScan", [](const fs::path& d) { test::writeText(d / "labels/000003.label", ""); },
       "labels/000003.label: there is no scan 000003"},
      {"NoTr", [](const fs::path& d) { test::writeText(d / "calib.txt", "P0: 1\n"); }, "calib.txt: has no line 'Tr:'"},
      {"OddTr", [](const fs::path& d) { test::writeText(d / "calib.txt", "P0: 1\nTr: 1 2\n"); },
       "calib.txt:2: has 2 numbers, must have 12"},
      {"TrNotRigid", [](const fs::path& d) { test::writeText(d / "calib.txt", "Tr: 0 0 0 0 0 0 0 0 0 0 0 0\n"); },
       "calib.txt:1: the pose is not rigid"},
  };
}

std::string messageOf(const std::function<void()>& read) {
  try {
    read();
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

std::string messageOf(const fs::path& directory) {
  return messageOf([&] { SequenceReader reader(directory); });
}

class SpoiledSequence : public testing::TestWithParam<Spoiled> {};

TEST_P(SpoiledSequence, IsNamed) {
  const test::TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 3);
  ASSERT_EQ(messageOf(directory.path()), "no error");
  GetParam().spoil(directory.path());
  const std::string message = messageOf(directory.path());
  EXPECT_NE(message.find((directory.path() / "").string() + GetParam().message), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(Each, SpoiledSequence, testing::ValuesIn(spoiledSequences()),
                         [](const auto& spoiled) { return std::string(spoiled.param.name); });

TEST(SequenceFaults, NoDirectory) {
  const test::TemporaryDirectory directory;
  EXPECT_NE(messageOf(directory.path() / "none").find("none: is not a directory"), std::string::npos);
}

TEST(SequenceFaults, AllAtOnce) {
  const test::TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 3);
  test::writeText(directory.path() / "poses.txt", "x\ny\n");
  test::writeText(directory.path() / "times.txt", "1\n0\n2\n");
  fs::resize_file(directory.path() / "labels/000000.label", 4);
  const std::string message = messageOf(directory.path());
  for (const char* part : {"poses.txt:1:", "poses.txt:2:", "2 lines for 3 scans", "times.txt:2:", "000000.label"}) {
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in\n" << message;
  }
}

TEST(SequenceFaults, ALongListIsCutAndCounted) {
  Faults faults;
  for (int i = 0; i < 25; ++i) faults.add("fault " + std::to_string(i));
  EXPECT_NE(faults.text().find("fault 19\n... and 5 more"), std::string::npos);
  EXPECT_EQ(faults.text().find("fault 20"), std::string::npos);
}

TEST(SequenceFaults, LabelsWithoutEndAreNotRead) {
  const test::TemporaryDirectory directory;
  const fs::path file = directory.path() / "000000.label";
  test::writeText(file, "");
  fs::resize_file(file, 1ULL << 40U);  // a sparse file: it takes no room
  try {
    readLabels(file);
    FAIL() << "they were read";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("000000.label: 1099511627776 bytes"), std::string::npos) << error.what();
  }
}

TEST(SequenceFaults, AFileThatShrinksLaterIsNamed) {
  const test::TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 3);
  const SequenceReader reader(directory.path());
  fs::resize_file(directory.path() / "velodyne/000001.bin", 16);
  fs::resize_file(directory.path() / "labels/000001.label", 4);
  EXPECT_EQ(messageOf([&] { reader.scan(1); }), (directory.path() / "velodyne/000001.bin: cannot be read").string());
  EXPECT_EQ(messageOf([&] { reader.labels(1); }),
            (directory.path() / "labels/000001.label: has changed while it was read").string());
}

}  // namespace
}  // namespace donex
