// donex_write_parameters PACKAGE: writes anew what PACKAGE/config and PACKAGE/cfg hold of the code's parameters.
#include <fstream>
#include <iostream>

#include "ros/parameter_files.h"

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
  const bool all_written = write(package + "/config/default.yaml", donex::defaultYaml()) &&
                           write(package + "/config/paper_2d.yaml", donex::paperYaml(donex::Method::kDonex2d)) &&
                           write(package + "/config/paper_3d.yaml", donex::paperYaml(donex::Method::kDonex3d)) &&
                           write(package + "/cfg/Donex.cfg", donex::reconfigureCfg());
  return all_written ? 0 : 1;
}
