// Opening bags and writing them whole or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <rosbag/bag.h>

#include "io/data_error.h"

namespace donex {

/// Opens a bag for reading, once checkBag found it sound. Throws DataError that says what is wrong: missing, not a bag,
/// cut off.
void openBag(const std::filesystem::path& file, rosbag::Bag& bag);

/// How the chunks of a bag are compressed (the first one speaks for all); not at all where there is no chunk.
/// The rosbag library does not tell this of a bag that it reads. `file` must be a bag.
rosbag::CompressionType compressionOf(const std::filesystem::path& file);

/// "none", "lz4" or "bz2"; throws std::invalid_argument for another text.
rosbag::CompressionType parseCompression(const std::string& name);

/// The connection header for /tf_static: a player publishes a topic of such a connection latched, so that also late
/// listeners learn the mounting.
boost::shared_ptr<ros::M_string> latchedTransforms();

/// Writes a bag under a temporary name beside its own; commit() gives it its own name. Never half a bag. Errors
/// name the file.
class BagWriter {
 public:
  /// A new bag. Throws DataError when the file cannot be created.
  BagWriter(std::filesystem::path file, rosbag::CompressionType compression);

  /// A copy of the bag `original`, which openBag opens, byte for byte; messages can be added, compressed as its own.
  /// Throws DataError, also for the rare bag that the rosbag library cannot append to soundly.
  BagWriter(std::filesystem::path file, const std::filesystem::path& original);

  /// Without commit() nothing remains.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// A message, and what its connection says of itself where that is more than its type. Throws DataError.
  template <class Message>
  void write(const std::string& topic, const ros::Time& time, const Message& message,
             const boost::shared_ptr<ros::M_string>& connection = {}) {
    try {
      bag_->write(topic, time, message, connection);
    } catch (const std::exception& error) {
      fail(error);
    }
  }

  /// Throws DataError when it cannot be written to the end.
  void commit();

 private:
  explicit BagWriter(std::filesystem::path file);
  [[noreturn]] void fail(const std::exception& error) const;

  std::filesystem::path file_;
  std::filesystem::path temporary_;
  std::unique_ptr<rosbag::Bag> bag_ = std::make_unique<rosbag::Bag>();
};

}  // namespace donex
