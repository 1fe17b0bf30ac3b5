#include "io/text_file.h"

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

namespace donex {
namespace {

bool isBlank(const std::string& line) { return line.find_first_not_of(" \t\r") == std::string::npos; }

std::optional<double> parseNumber(const std::string& word) {
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  if (*end != '\0') return std::nullopt;
  return number;
}

}  // namespace

std::optional<std::vector<std::string>> readLines(const std::filesystem::path& file, Faults& faults) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    faults.add(file.string() + ": cannot be read");
    return std::nullopt;
  }
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  while (!lines.empty() && isBlank(lines.back())) lines.pop_back();
  return lines;
}

std::string place(const std::filesystem::path& file, std::size_t line) {
  return fmt::format("{}:{}", file.string(), line);
}

std::optional<std::vector<double>> parseNumbers(const std::string& text, std::size_t count, const std::string& where,
                                                Faults& faults) {
  std::vector<double> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto number = parseNumber(word);
    if (!number) {
      faults.add(fmt::format("{}: '{}' is not a number", where, word.substr(0, 40)));
      return std::nullopt;
    }
    numbers.push_back(*number);
  }
  if (numbers.size() == count) return numbers;
  faults.add(fmt::format("{}: has {} numbers, must have {}", where, numbers.size(), count));
  return std::nullopt;
}

std::optional<PoseMatrix> parsePose(const std::string& text, const std::string& where, Faults& faults) {
  const auto numbers = parseNumbers(text, 12, where, faults);
  if (!numbers) return std::nullopt;
  using RowMajor = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  const PoseMatrix matrix = Eigen::Map<const RowMajor>(numbers->data());
  const auto fault = faultOfPose(matrix);
  if (!fault) return matrix;
  faults.add(fmt::format("{}: {}", where, *fault));
  return std::nullopt;
}

}  // namespace donex
