// donex_bag with less memory than the bag is large.
#include <gtest/gtest.h>

#include "bag/bags.h"
#include "programs/command.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

TEST(BagMemory, ABagLargerThanMemoryPasses) {
  const test::TemporaryDirectory directory;
  const fs::path in = directory.path() / "in.bag", out = directory.path() / "out.bag";
  test::writeDriveBag(directory.path() / "drive", in, 30);
  constexpr int kMessages = 150, kBytes = 4 << 20, kLimit = 450;  // 630 MB in all; the limit is of address space [MB]
  test::change(in, [](rosbag::Bag& bag) {
    for (int i = 0; i < kMessages; ++i) {
      const std::string image(kBytes, static_cast<char>('a' + i % 26));
      bag.write("/camera", ros::Time(50.0 + 0.02 * i), test::text(image));
    }
  });
  ASSERT_GT(fs::file_size(in), std::uintmax_t{kLimit} * 1300000U);
  const std::string limited = "ulimit -v " + std::to_string(kLimit * 1000) + "; " + DONEX_BAG;
  const std::string arguments = " " + in.string() + " " + out.string() + " --set x_min=-20 --set x_max=20";
  const test::Outcome outcome = test::runCommand("bash -c '" + limited + arguments + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("30 of 30 clouds labelled"), std::string::npos) << outcome.text;
  EXPECT_GT(fs::file_size(out), fs::file_size(in));
  EXPECT_NE(test::runCommand("bash -c 'ulimit -v 30000; " + std::string(DONEX_BAG) + " --help'").code, 0)
      << "the limit limits nothing";
}

}  // namespace
}  // namespace donex
