// Bags of Livox' CustomMsg: labelled as the same clouds of the usual type are, or refused with the reason.
#include <gtest/gtest.h>

#include "bag/bags.h"
#include "ros/livox_message.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using sensor_msgs::PointCloud2;

class LivoxBag : public testing::Test {
 protected:
  void SetUp() override { test::writeDriveBag(directory_.path() / "drive", plain_, 12); }

  /// The plain bag with its clouds as CustomMsg; `cut` bytes are missing at the end of each.
  void convert(const std::string& datatype, const std::string& md5 = kLivoxMd5, std::size_t cut = 0) {
    rosbag::Bag in(plain_.string()), out(livox_.string(), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(in)) {
      const auto cloud = message.instantiate<PointCloud2>();
      if (!cloud) {
        out.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
        continue;
      }
      std::vector<Eigen::Vector3f> echoes;
      parseEchoes(*cloud, std::get<CloudLayout>(judgeLayout(*cloud)), echoes);
      auto bytes = test::livoxBytes(pointsOf(echoes), cloud->header);
      bytes.resize(bytes.size() - cut);
      out.write("/livox/lidar", message.getTime(), test::messageOf(bytes, datatype, md5));
    }
  }
  /// All measured at the stamp, as the plain ones.
  static std::vector<test::LivoxPoint> pointsOf(const std::vector<Eigen::Vector3f>& echoes) {
    auto points = test::livoxPoints(echoes);
    for (test::LivoxPoint& point : points) point.offset_time = 0;
    return points;
  }
  test::ScanLabels labelsOf(const fs::path& in) {
    const fs::path out = directory_.path() / ("labelled_" + in.filename().string());
    fs::remove(out);
    LabelBagOptions options;
    options.config = paperConfig(Method::kDonex3d);
    test::label(in, out, options);
    test::ScanLabels labels;
    for (const auto& cloud : test::readTopic<PointCloud2>(out, test::kLabeled)) {
      labels.push_back(test::dynamicOf(*cloud));
    }
    return labels;
  }
  std::string fault() {
    try {
      labelsOf(livox_);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  }

  test::TemporaryDirectory directory_;
  fs::path plain_ = directory_.path() / "plain.bag", livox_ = directory_.path() / "livox.bag";
};

TEST_F(LivoxBag, HasTheLabelsOfTheSameCloudsOfTheUsualType) {
  const auto expected = labelsOf(plain_);
  ASSERT_EQ(expected.size(), 12U);
  EXPECT_GT(test::countDynamic(expected), 100) << "equal labels say little";
  for (const char* driver : {"livox_ros_driver", "livox_ros_driver2"}) {
    convert(std::string(driver) + "/CustomMsg");
    EXPECT_EQ(labelsOf(livox_), expected) << driver;
  }
}

TEST_F(LivoxBag, OfAnotherDefinitionIsRefused) {
  convert("livox_ros_driver2/CustomMsg", "0123456789abcdef0123456789abcdef");
  const std::string error = fault();
  EXPECT_NE(error.find("of another definition (md5 0123456789abcdef0123456789abcdef, read is e4d6829b"),
            std::string::npos)
      << error;
}

TEST_F(LivoxBag, CutOffIsRefused) {
  convert("livox_ros_driver/CustomMsg", kLivoxMd5, 7);
  const std::string error = fault();
  EXPECT_NE(error.find("/livox/lidar at 50.0"), std::string::npos) << error;
  EXPECT_NE(error.find("cannot be read"), std::string::npos) << error;
}

}  // namespace
}  // namespace donex
