// main() for tests that have none. In a static library it gives way to a test's own, and it does without
// libgtest_main, which catkin finds under other names on Debian 12 than on Ubuntu 20.04.
#include <gtest/gtest.h>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
