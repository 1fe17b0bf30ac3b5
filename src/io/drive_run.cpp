#include "donex/io/drive_run.h"

#include <chrono>
#include <ctime>

namespace donex {
namespace {

double cpuTime() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double wallTime() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

DriveRun::DriveRun(const Config& config) {
  if (needsWholeDrive(config.method)) {
    whole_ = makeWholeDriveDetector(config);
  } else {
    live_ = makeDetector(config);
  }
}

void DriveRun::judge(const Scan& scan, std::size_t index) {
  const double wall = wallTime();
  const double cpu = cpuTime();
  detector().process(scan, labels_);
  cpu_times_[index] += cpuTime() - cpu;
  times_[index] += wallTime() - wall;
}

void DriveRun::run(const SequenceReader& sequence, std::size_t scans, const Sink& sink,
                   const std::function<void()>& progress) {
  times_.assign(scans, 0.0);
  cpu_times_.assign(scans, 0.0);
  do {
    const bool counts = whole_ == nullptr || whole_->isLastPass();
    for (std::size_t i = 0; i < scans; ++i) {
      const Scan scan = toScan(sequence.scan(i));
      judge(scan, i);
      if (counts) sink(i, scan, labels_);
      progress();
    }
  } while (whole_ != nullptr && whole_->nextPass());
}

std::vector<std::uint32_t> asSemanticKitti(const EchoLabels& labels) {
  std::vector<std::uint32_t> result(labels.dynamic.size(), kLabelStatic);
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (labels.dynamic[i] != 0) result[i] = kLabelMoving;
  }
  return result;
}

}  // namespace donex
