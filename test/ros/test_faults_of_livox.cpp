// Livox' own messages: of another definition, with numbers of points that lie, and cut off on the way.
#include <cstring>

#include "ros/faults_rig.h"
#include "ros/livox_message.h"

namespace donex {
namespace {

using test::FaultsTest;

class FaultsOfLivox : public FaultsTest {
 protected:
  static constexpr const char* kType = "livox_ros_driver2/CustomMsg";

  std::vector<std::uint8_t> bytes() const { return test::livoxBytes(test::livoxPoints(test::ring()), now_); }
  ros::Publisher advertise(const std::string& md5 = kLivoxMd5) {
    return test::messageOf(bytes(), kType, md5).advertise(nh_, "livox", 50);
  }
  void sendLivox(const std::vector<std::uint8_t>& bytes, const std::string& md5 = kLivoxMd5) {
    ++clouds_sent_;
    livox_.publish(test::messageOf(bytes, kType, md5));
  }
  /// As many as the number of points in the message itself is changed to.
  std::vector<std::uint8_t> claiming(std::uint32_t points) const {
    auto changed = bytes();
    std::memcpy(changed.data() + changed.size() - 19 * test::ring().size() - sizeof points, &points, sizeof points);
    return changed;
  }
  void driveWellAgain() {
    const std::size_t before = received_.size();
    for (std::size_t scan = 1; scan <= 3; ++scan) {
      advance();
      sendOdometry(now_);
      sendOdometry(now_ + 0.05);  // its last echo comes after its stamp
      sendLivox(bytes());
      ASSERT_TRUE(waitForLabeled(before + scan)) << diagnostic("last drop");
    }
  }

  ros::Publisher livox_;
};

TEST_F(FaultsOfLivox, AnotherDefinition) {
  const std::string other(32, 'a');
  livox_ = advertise(other);
  loadOn(livox_);
  for (int message = 0; message < 3; ++message) sendLivox(bytes(), other);
  ASSERT_TRUE(waitForDiagnostic("dropped: unreadable cloud", "3"));
  EXPECT_NE(diagnostic("last drop").find("md5 " + other), std::string::npos) << diagnostic("last drop");
  livox_.shutdown();
  livox_ = advertise();
  ASSERT_TRUE(test::waitFor([&] { return livox_.getNumSubscribers() > 0; })) << "subscribed to anew";
  driveWellAgain();
  conclude("Livox messages of another definition (md5); `last drop` names it",
           "labels 5 s after their publisher has gone: the topic is subscribed to anew");
}

TEST_F(FaultsOfLivox, NumbersOfPointsThatLie) {
  livox_ = advertise();
  loadOn(livox_);
  for (const std::uint32_t points : {4000000000U, 37U, 35U, 0U}) sendLivox(claiming(points));
  auto half = bytes();
  half.resize(half.size() / 2);
  sendLivox(half);
  ASSERT_TRUE(waitForDiagnostic("dropped: unreadable cloud", "5"));
  driveWellAgain();
  conclude("Livox messages that claim 4 billion points, one too many or too few, none; one cut off");
}

}  // namespace
}  // namespace donex
