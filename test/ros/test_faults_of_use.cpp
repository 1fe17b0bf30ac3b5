// What people do to it while it runs: reset and reconfigure storms, kill, interrupt, restart.
#include <csignal>

#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include "ros/faults_rig.h"

namespace donex {
namespace {

using test::FaultsTest;
using test::waitFor;

class FaultsOfUse : public FaultsTest {};

TEST_F(FaultsOfUse, ResetStorm) {
  load();
  driveWell();
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    send(now_);
    for (int call = 0; call < 10; ++call) {
      std_srvs::Trigger reset;
      ASSERT_TRUE(ros::service::call(nodeName() + "/reset", reset));
    }
  }
  ASSERT_TRUE(waitForLabeled(kGood + 10)) << status_;
  conclude("`~reset` 100 times in a second", "every scan labelled");
}

TEST_F(FaultsOfUse, ReconfigureStorm) {
  load();
  driveWell();
  dynamic_reconfigure::Reconfigure change;
  change.request.config.doubles.resize(1);
  change.request.config.doubles[0].name = "voxel_size";
  for (int scan = 0; scan < 10; ++scan) {
    advance();
    send(now_);
    for (int call = 0; call < 10; ++call) {
      change.request.config.doubles[0].value = call % 2 == 0 ? 0.3 : 0.25;
      ASSERT_TRUE(ros::service::call(nodeName() + "/set_parameters", change));
    }
  }
  ASSERT_TRUE(waitForLabeled(kGood + 10)) << status_;
  conclude("100 reconfigurations in a second, each builds the grid anew", "every scan labelled");
}

/// A process of its own with the classifier in it, under the rig's names.
class OtherProcess : public FaultsTest {
 protected:
  ~OtherProcess() override {
    if (process_ > 0) end(SIGKILL);
  }

  void start(const std::vector<std::string>& command) {
    process_ = fork();
    if (process_ != 0) return;
    std::vector<std::string> all = command;
    all.push_back("__ns:=" + nh_.getNamespace());
    all.push_back("__name:=donex");
    std::vector<char*> arguments;
    for (std::string& argument : all) arguments.push_back(argument.data());
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  void waitUntilConnected() {
    labeled_ = nh_.subscribe("donex/labeled_points", 200, &OtherProcess::onLabeledThere, this);
    ASSERT_TRUE(waitFor([this] {
      return clouds_.getNumSubscribers() == 1 && odometry_.getNumSubscribers() == 1 && labeled_.getNumPublishers() == 1;
    }));
  }
  /// Its exit status as waitpid has it.
  int end(int signal) {
    kill(process_, signal);
    int status = 0;
    EXPECT_TRUE(waitFor([&] { return waitpid(process_, &status, WNOHANG) == process_; })) << "it does not end";
    process_ = 0;
    return status;
  }
  /// What the process has used so far.
  long processorTicks() const {
    std::ifstream file("/proc/" + std::to_string(process_) + "/stat");
    std::string word;
    long user = 0, system = 0;
    constexpr int kBefore = 13;  // words before utime
    for (int i = 0; i < kBefore; ++i) file >> word;
    file >> user >> system;
    return user + system;
  }
  void waitUntilGone() {
    EXPECT_TRUE(waitFor([this] { return clouds_.getNumSubscribers() == 0; }));
  }

 private:
  void onLabeledThere(const sensor_msgs::PointCloud2ConstPtr& cloud) { received_.push_back(cloud); }
  pid_t process_ = 0;
};

TEST_F(OtherProcess, ManagerKilledAndRestarted) {
  const std::string preload = std::string("LD_PRELOAD=") + DONEX_PRELOAD;
  const std::vector<std::string> manager{"rosrun",  "--prefix",   "env " + preload,    "nodelet",
                                         "nodelet", "standalone", "donex/DonexNodelet"};
  start(manager);
  waitUntilConnected();
  driveWell();
  EXPECT_TRUE(WIFSIGNALED(end(SIGKILL)));
  waitUntilGone();
  drive(3);
  // Nothing that the first one said may count for the second.
  clouds_sent_ = 0;
  received_.clear();
  values_.clear();
  status_.clear();
  start(manager);
  waitUntilConnected();
  recover();
  conclude("the manager is killed and started again");
}

TEST_F(OtherProcess, InterruptedInTheMiddleOfAScan) {
  start({DONEX_NODE});
  waitUntilConnected();
  driveWell();
  advance();
  sendOdometry(now_);
  const long before = processorTicks();
  clouds_.publish(test::plainCloud(test::ring(3000000), now_));
  constexpr long kAtWork = 10;  // ticks of 10 ms
  EXPECT_TRUE(waitFor([&] { return processorTicks() > before + kAtWork; }));
  const int status = end(SIGINT);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  waitUntilGone();
  if (!HasFailure()) {
    test::FaultTable::instance().add("SIGINT in the middle of a scan, to the classifier as a node of its own",
                                     "not asked: the process is gone", "ends with exit code 0");
  }
}

/// The last test: rostest counts tests and ignores exit codes.
TEST(TableOfFaults, IsThatOfTheDocuments) {
  const testing::UnitTest& run = *testing::UnitTest::GetInstance();
  if (run.test_to_run_count() != run.total_test_count()) GTEST_SKIP() << "only with all rows";
  if (run.failed_test_count() != 0) GTEST_SKIP() << "only with all rows, and some test failed";
  const std::string table = test::FaultTable::instance().text();
  test::FaultTable::instance().write(DONEX_FAULT_TABLE);
  std::ifstream file(DONEX_FAULT_PAGE);
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(page.find(table), std::string::npos)
      << "docs/faults.md shows another table: scripts/fault_table " << DONEX_FAULT_TABLE << "\n"
      << table;
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "faults_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
