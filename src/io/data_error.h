// What the readers throw.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace donex {

/// Data that cannot be used. what() says of every fault which file (which line where it has lines) and why,
/// one line each.
class DataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Gathers faults, so that all of them are told at once.
class Faults {
 public:
  void add(std::string fault) { faults_.push_back(std::move(fault)); }
  bool empty() const { return faults_.empty(); }
  const std::vector<std::string>& list() const { return faults_; }
  /// One line each; after the first twenty only how many more.
  std::string text() const;
  /// Throws DataError with text(), unless empty.
  void throwIfAny() const;

 private:
  std::vector<std::string> faults_;
};

}  // namespace donex
