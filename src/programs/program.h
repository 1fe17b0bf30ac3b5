// What all programs share: exit codes, messages, progress, figures.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "donex/config.h"
#include "evaluation/drive_run.h"
#include "evaluation/evaluation.h"
#include "io/sequence.h"

namespace donex {

/// Arguments that are well-formed but cannot be meant.
class ArgumentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses the arguments and runs `body`. The exit code: 0 done, 1 failed on the data, 2 wrong arguments. Every error
/// goes to stderr after the program's name.
int runProgram(CLI::App& app, int argc, char** argv, const std::function<void()>& body);

/// A line on stderr after the program's name, for what a user should know and need not stop for.
void warn(const CLI::App& app, const std::string& text);

/// The option --overwrite: without it no program writes over what is there (io/outputs.h).
void addOverwrite(CLI::App& app, bool& overwrite);

/// Opens a sequence and warns of what was assumed. Throws DataError.
SequenceReader openSequence(const CLI::App& app, const std::string& directory);

/// Throws DataError where the sequence has no labels at all.
void requireTruth(const SequenceReader& sequence);

/// How many scans --frames asks for; `frames` 0 is all.
std::size_t scansOf(const SequenceReader& sequence, std::size_t frames);

/// The options --config, --method, --voxel-size and --set; the later of these wins over the earlier.
class ConfigOptions {
 public:
  explicit ConfigOptions(CLI::App& app);

  /// On top of `base`. Throws DataError for the file, SettingError for the other options.
  Config config(const Config& base = Config()) const;

 private:
  std::string files_;  ///< one line each
  std::string method_;
  std::string voxel_size_;
  std::string settings_;  ///< one line each
};

/// A bar on stderr; says nothing where that is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void advance();

 private:
  std::size_t total_;
  std::size_t done_ = 0;
  int drawn_percent_ = -1;
  bool on_terminal_;
};

/// The most memory the process ever had resident [bytes].
std::size_t peakMemory();

/// What judging scans took, of this process; `times` are a scan's [s].
RunFigures figuresOf(const std::vector<double>& times, const Config& config);
/// The same with the CPU times and the method's own memory.
RunFigures figuresOf(const DriveRun& drive, const Config& config);

/// "12.3 MB".
std::string megabytes(std::size_t bytes);

}  // namespace donex
