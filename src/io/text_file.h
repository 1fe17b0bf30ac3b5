// Lines of numbers: poses.txt, times.txt, calib.txt.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/data_error.h"
#include "io/pose.h"

namespace donex {

/// The lines of a text file without their ends; empty lines at the end of the file are dropped. Adds a fault
/// and returns no lines when it cannot be read.
std::optional<std::vector<std::string>> readLines(const std::filesystem::path& file, Faults& faults);

/// "file:line".
std::string place(const std::filesystem::path& file, std::size_t line);

/// As many numbers as `count`, separated by white space; else empty, and a fault at `where`. Infinity and NaN
/// are numbers here.
std::optional<std::vector<double>> parseNumbers(const std::string& text, std::size_t count, const std::string& where,
                                                Faults& faults);

/// Twelve numbers that form a rigid pose; else empty, and a fault at `where`.
std::optional<PoseMatrix> parsePose(const std::string& text, const std::string& where, Faults& faults);

}  // namespace donex
