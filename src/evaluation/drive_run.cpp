#include "evaluation/drive_run.h"

#include "core/timing.h"

namespace donex {

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

}  // namespace donex
