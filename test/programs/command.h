// Running the real executables.
#pragma once

#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace donex::test {

struct Outcome {
  int code = -1;
  std::string text;  ///< stdout and stderr
};

/// As a shell runs it.
inline Outcome runCommand(const std::string& command) {
  Outcome outcome;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  char buffer[4096];
  for (std::size_t n; (n = fread(buffer, 1, sizeof(buffer), pipe)) > 0;) outcome.text.append(buffer, n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.code = WEXITSTATUS(status);
  return outcome;
}

}  // namespace donex::test
