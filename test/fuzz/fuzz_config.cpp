// Any bytes as a configuration file: a configuration without faults, or a DataError.
#include <cstdlib>

#include "donex/memory_bound.h"
#include "fuzz/input_file.h"
#include "io/config_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = donex::fuzz::folder() / "config.yaml";
  donex::fuzz::writeFile(file, data, size);
  try {
    if (!donex::faultsOf(donex::readConfigFile(file)).empty()) std::abort();
  } catch (const donex::DataError&) {
  }
  return 0;
}
