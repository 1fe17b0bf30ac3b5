// donex_write_parameters PACKAGE: writes PACKAGE/config/default.yaml and PACKAGE/cfg/Donex.cfg anew.
#include <fstream>
#include <iostream>

#include "donex/ros/parameter_files.h"

namespace {

bool write(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) std::cerr << "cannot write " << file << '\n';
  return static_cast<bool>(out);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: donex_write_parameters PACKAGE_DIRECTORY\n";
    return 2;
  }
  const std::string package = argv[1];
  const bool yaml = write(package + "/config/default.yaml", donex::defaultYaml());
  const bool cfg = write(package + "/cfg/Donex.cfg", donex::reconfigureCfg());
  return yaml && cfg ? 0 : 1;
}
