// Nothing half ever stands under a file's name.
#include <gtest/gtest.h>

#include "io/whole_file.h"
#include "support/temporary_directory.h"

namespace donex {
namespace {

namespace fs = std::filesystem;

class WholeFiles : public ::testing::Test {
 protected:
  std::vector<std::string> names() const { return test::filesIn(directory_.path()); }

  test::TemporaryDirectory directory_;
  const fs::path file_ = directory_.path() / "map.pcd";
};

TEST_F(WholeFiles, AppearWhenTheyAreDone) {
  WholeFile whole(file_);
  whole.stream() << "first" << std::flush;
  EXPECT_FALSE(fs::exists(file_));
  whole.stream() << " and last";
  whole.commit();
  EXPECT_EQ(test::readText(file_), "first and last");
  EXPECT_EQ(names(), std::vector<std::string>{"map.pcd"});
}

TEST_F(WholeFiles, LeaveWhatWasThereUnlessTheyAreDone) {
  test::writeText(file_, "what was there");
  {
    WholeFile whole(file_);
    whole.stream() << "half";
  }
  EXPECT_EQ(test::readText(file_), "what was there");
  EXPECT_EQ(names(), std::vector<std::string>{"map.pcd"});
  writeWhole(file_, "new");
  EXPECT_EQ(test::readText(file_), "new");
}

TEST_F(WholeFiles, NameWhatCannotBeWritten) {
  const fs::path file = directory_.path() / "none" / "map.pcd";
  try {
    writeWhole(file, "text");
    FAIL() << "written";
  } catch (const DataError& error) {
    EXPECT_EQ(error.what(), file.string() + ": cannot be written");
  }
  EXPECT_TRUE(names().empty());
}

TEST_F(WholeFiles, ThatStopInTheMiddleAreGone) {
  WholeFile whole(file_);
  whole.stream().setstate(std::ios::badbit);  // as a full disk does
  EXPECT_THROW(whole.commit(), DataError);
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(WholeFiles, DirectoriesAreMadeWithThoseAbove) {
  createDirectory(directory_.path() / "a" / "b");
  EXPECT_TRUE(fs::is_directory(directory_.path() / "a" / "b"));
  createDirectory(directory_.path() / "a" / "b");
  test::writeText(file_, "no directory");
  EXPECT_THROW(createDirectory(file_ / "c"), DataError);
}

}  // namespace
}  // namespace donex
