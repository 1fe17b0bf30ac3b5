// donex_bag itself: arguments that cannot be meant.
#include <gtest/gtest.h>

#include "bag/bags.h"
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
  const std::string arguments = " a/rec.bag b/rec.bag out";
  const test::Outcome outcome = test::runCommand("cd " + directory.path().string() + " && " + DONEX_BAG + arguments);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.text.find("rec.bag: two parts have this name, one would overwrite the other"), std::string::npos)
      << outcome.text;
  EXPECT_FALSE(fs::exists(directory.path() / "out"));
}

}  // namespace
}  // namespace donex
