// What was tried and what came of it, as docs/faults.md shows it: written by the tests themselves.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace donex::test {

class FaultTable {
 public:
  static FaultTable& instance() {
    static FaultTable table;
    return table;
  }

  void add(const std::string& fault, const std::string& outcome, const std::string& after) {
    rows_.push_back("| " + fault + " | " + outcome + " | " + after + " |\n");
  }
  std::string text() const {
    std::string all = "| fault | what `/diagnostics` counts | afterwards |\n|---|---|---|\n";
    for (const std::string& row : rows_) all += row;
    return all;
  }
  std::size_t size() const { return rows_.size(); }
  void write(const std::string& file) const { std::ofstream(file) << text(); }

 private:
  std::vector<std::string> rows_;
};

}  // namespace donex::test
