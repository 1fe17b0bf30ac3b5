// What the rosbag library trusts, checked before it reads a bag of unknown origin.
#pragma once

#include <filesystem>

#include "io/data_error.h"

namespace donex {

/// Reads the records of a bag that can be read once, without its messages: every length, count and position must be
/// sound, compressed chunks be as large as they claim. The library follows them wherever they lead, beyond its buffers
/// and into gigabytes. Memory: a chunk as it is stored and its content, each at most 1 GiB, and half of the content's
/// size for where its records begin. A bag without an index passes: the library refuses it by itself. Throws DataError
/// that says what is wrong, and where.
void checkBag(const std::filesystem::path& file);

}  // namespace donex
