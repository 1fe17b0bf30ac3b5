#include <limits>

#include <gtest/gtest.h>

#include "support/sequences.h"
#include "support/temporary_directory.h"

namespace donex {
namespace {

using test::TemporaryDirectory;

TEST(Sequence, ComesBackAsItWasWritten) {
  const TemporaryDirectory directory;
  std::mt19937 random(7);
  std::vector<SequenceScan> scans;
  SequenceWriter writer(directory.path());
  for (std::size_t i = 0; i < 12; ++i) {
    scans.push_back(test::randomScan(random, i, 50 + i));
    const std::vector<std::uint32_t> labels(50 + i, kLabelMoving);
    i % 2 == 0 ? writer.add(scans.back(), labels) : writer.add(scans.back());
  }
  const SequenceReader reader(directory.path());
  ASSERT_EQ(reader.size(), scans.size());
  EXPECT_TRUE(reader.notes().empty());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const SequenceScan scan = reader.scan(i);
    EXPECT_EQ(scan.echoes, scans[i].echoes);
    EXPECT_EQ(scan.intensities, scans[i].intensities);
    EXPECT_NEAR(scan.stamp, scans[i].stamp, 1e-9);
    const Eigen::Matrix4d difference =
        scan.odom_from_sensor.isometry().matrix() - scans[i].odom_from_sensor.isometry().matrix();
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(reader.hasLabels(i), i % 2 == 0);
    if (i % 2 == 0) {
      EXPECT_EQ(reader.labels(i), std::vector<std::uint32_t>(50 + i, kLabelMoving));
    }
  }
}

TEST(Sequence, KeepsNonFiniteEchoesAndEmptyScans) {
  const TemporaryDirectory directory;
  SequenceScan scan;
  SequenceWriter writer(directory.path());
  writer.add(scan);
  scan.stamp = 0.1;
  scan.echoes = {{std::numeric_limits<float>::quiet_NaN(), 1.0F, std::numeric_limits<float>::infinity()}};
  scan.intensities = {0.25F};
  writer.add(scan);
  const SequenceReader reader(directory.path());
  EXPECT_TRUE(reader.scan(0).echoes.empty());
  const SequenceScan read = reader.scan(1);
  ASSERT_EQ(read.echoes.size(), 1U);
  EXPECT_TRUE(std::isnan(read.echoes[0].x()));
  EXPECT_EQ(read.echoes[0].y(), 1.0F);
  EXPECT_TRUE(std::isinf(read.echoes[0].z()));
}

TEST(Sequence, WithoutTimesTenScansASecondAreAssumedAndSaid) {
  const TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 4);
  std::filesystem::remove(directory.path() / "times.txt");
  const SequenceReader reader(directory.path());
  EXPECT_DOUBLE_EQ(reader.stamp(3), 0.3);
  ASSERT_EQ(reader.notes().size(), 1U);
  EXPECT_NE(reader.notes()[0].find("times.txt: is missing, 10 scans a second are assumed"), std::string::npos);
}

TEST(Sequence, MorePosesThanScansAreSaid) {
  const TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 2);
  std::ofstream(directory.path() / "poses.txt", std::ios::app) << "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const SequenceReader reader(directory.path());
  EXPECT_EQ(reader.size(), 2U);
  ASSERT_EQ(reader.notes().size(), 1U);
  EXPECT_NE(reader.notes()[0].find("3 lines for 2 scans"), std::string::npos);
}

TEST(Sequence, ReadsWindowsLineEndsAndTrailingBlankLines) {
  const TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 1);
  test::writeText(directory.path() / "poses.txt", "1 0 0 4 0 1 0 5 0 0 1 6\r\n\r\n\n");
  const SequenceReader reader(directory.path());
  EXPECT_EQ(reader.pose(0).position, Eigen::Vector3d(4, 5, 6));
}

TEST(Sequence, CalibrationTurnsCameraPosesIntoLidarPoses) {
  const TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 1);
  // The camera looks along the LiDAR's x: its z is x, its x is -y, its y is -z; it sits 0.5 m ahead.
  test::writeText(directory.path() / "calib.txt", "P0: 1 2\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.5\n");
  // The camera moves 2 m along its z and turns by -90 degrees about its y: the LiDAR turns left.
  test::writeText(directory.path() / "poses.txt", "0 0 -1 0 0 1 0 0 1 0 0 2\n");
  const Eigen::Isometry3d pose = SequenceReader(directory.path()).pose(0).isometry();
  // The LiDAR: where the camera is (2.5 ahead of the start), 0.5 m back along its new x, which is the old y.
  EXPECT_LT((pose.translation() - Eigen::Vector3d(2.5, -0.5, 0.0)).norm(), 1e-12);
  EXPECT_LT((pose.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(Sequence, StampsAreWholeNanoseconds) {
  const TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 2);
  test::writeText(directory.path() / "times.txt", "0.10400000049\n1317042272.349\n");
  const SequenceReader reader(directory.path());
  EXPECT_EQ(reader.stamp(0), 1e-9 * 104000000.0);
  EXPECT_EQ(reader.stamp(1), 1317042272.349);
}

TEST(Sequence, BecomesAScanOfTheCore) {
  std::mt19937 random(3);
  SequenceScan scan = test::randomScan(random, 4, 20);
  const SequenceScan copy = scan;
  const Scan core = toScan(std::move(scan));
  EXPECT_EQ(core.echoes, copy.echoes);
  EXPECT_EQ(core.stamp, copy.stamp);
  EXPECT_EQ(core.odomFromSensor().matrix(), copy.odom_from_sensor.isometry().matrix());
}

TEST(SequenceWriter, RefusesToMixTwoSequences) {
  const TemporaryDirectory directory;
  test::writeSoundSequence(directory.path(), 1);
  EXPECT_THROW(SequenceWriter{directory.path()}, DataError);
}

TEST(SequenceWriter, RefusesTimeThatStandsStillAndUnequalCounts) {
  const TemporaryDirectory directory;
  std::mt19937 random(5);
  SequenceWriter writer(directory.path());
  SequenceScan scan = test::randomScan(random, 1, 5);
  writer.add(scan);
  EXPECT_THROW(writer.add(scan), DataError);
  scan.stamp += 1.0;
  EXPECT_THROW(writer.add(scan, {kLabelStatic}), std::invalid_argument);
  scan.intensities.pop_back();
  EXPECT_THROW(writer.add(scan), std::invalid_argument);
  EXPECT_EQ(writer.size(), 1U);
  EXPECT_EQ(SequenceReader(directory.path()).size(), 1U);
}

TEST(Labels, ComeBackAndLeaveNothingHalf) {
  const TemporaryDirectory directory;
  const std::vector<std::uint32_t> labels{251, 9, 0xFFFF0009U};
  writeLabels(directory.path() / "000000.label", labels);
  EXPECT_EQ(readLabels(directory.path() / "000000.label"), labels);
  EXPECT_EQ(test::filesIn(directory.path()), std::vector<std::string>{"000000.label"});
  EXPECT_THROW(writeLabels(directory.path() / "missing" / "000000.label", labels), DataError);
  EXPECT_THROW(readLabels(directory.path() / "000001.label"), DataError);
}

}  // namespace
}  // namespace donex
