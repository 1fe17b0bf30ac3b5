#include "bag/bag_file.h"

#include <cstdint>
#include <fstream>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include <boost/make_shared.hpp>
#include <fmt/format.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>
#include <unistd.h>

#include "bag/bag_check.h"
#include "bag/bag_record.h"

namespace donex {
namespace fs = std::filesystem;
namespace {

/// Of a bag that checkBag found sound.
void openChecked(const fs::path& file, rosbag::Bag& bag) {
  const std::string name = file.string();
  try {
    bag.open(name, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw DataError(name + ": has no index, its recording was cut off ('rosbag reindex' may save it)");
  } catch (const std::exception& error) {
    throw DataError(fmt::format("{}: is not a bag or is cut off ({})", name, error.what()));
  }
}

/// The library numbers a new connection by the count of those that are there: where numbers were left out, it
/// would take one that is in use, and mix two topics.
void requireFreeConnection(const fs::path& file) {
  rosbag::Bag bag;
  openChecked(file, bag);
  rosbag::View view(bag);
  std::set<std::uint32_t> ids;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) ids.insert(connection->id);
  const bool is_free = ids.empty() || *ids.rbegin() < ids.size();
  if (is_free) return;
  throw DataError(file.string() +
                  ": its connections are not numbered 0, 1, 2, ...; 'rosbag filter IN OUT True' does that");
}

/// Closes a bag that cannot be written to its end: a full disk, most likely. Its destructor would try that again, and
/// end the process by what it throws: then it is never called.
void giveUp(std::unique_ptr<rosbag::Bag> bag) {
  try {
    bag->close();
  } catch (const std::exception&) {
    static auto* const never_destroyed = new std::vector<rosbag::Bag*>;
    never_destroyed->push_back(bag.release());
  }
}

}  // namespace

void openBag(const fs::path& file, rosbag::Bag& bag) {
  const std::string name = file.string();
  if (!fs::exists(file)) throw DataError(name + ": does not exist");
  if (!fs::is_regular_file(file)) throw DataError(name + ": is not a file");
  if (!std::ifstream(file)) throw DataError(name + ": cannot be read");
  checkBag(file);
  openChecked(file, bag);
}

rosbag::CompressionType compressionOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const auto read = [&](std::uint64_t at, char* to, std::size_t count) {
    stream.seekg(static_cast<std::streamoff>(at)).read(to, static_cast<std::streamsize>(count));
  };
  const bag::RecordSource source{fs::file_size(file), read};
  std::string version;
  std::getline(stream, version);
  // The chunks come first.
  for (auto record = bag::readRecord(source, version.size() + 1); record;
       record = bag::readRecord(source, record->end())) {
    const bool is_chunk = record->kind() == bag::kChunk;
    if (is_chunk) return parseCompression(record->text("compression"));
    if (record->kind() != bag::kBagHeader) break;
  }
  return rosbag::compression::Uncompressed;
}

rosbag::CompressionType parseCompression(const std::string& name) {
  if (name == "none") return rosbag::compression::Uncompressed;
  if (name == "lz4") return rosbag::compression::LZ4;
  if (name == "bz2") return rosbag::compression::BZ2;
  throw std::invalid_argument("compression is " + name + ", must be one of none, lz4, bz2");
}

boost::shared_ptr<ros::M_string> latchedTransforms() {
  namespace traits = ros::message_traits;
  auto header = boost::make_shared<ros::M_string>();
  (*header)["type"] = traits::DataType<tf2_msgs::TFMessage>::value();
  (*header)["md5sum"] = traits::MD5Sum<tf2_msgs::TFMessage>::value();
  (*header)["message_definition"] = traits::Definition<tf2_msgs::TFMessage>::value();
  (*header)["topic"] = "/tf_static";
  (*header)["latching"] = "1";
  return header;
}

// The process's number: two runs that write the same file don't write into each other.
BagWriter::BagWriter(fs::path file)
    : file_(std::move(file)), temporary_(fmt::format("{}.{}.part", file_.string(), getpid())) {}

BagWriter::BagWriter(fs::path file, rosbag::CompressionType compression) : BagWriter(std::move(file)) {
  try {
    bag_->open(temporary_.string(), rosbag::bagmode::Write);
    bag_->setCompression(compression);
  } catch (const std::exception& error) {
    fail(error);
  }
}

BagWriter::BagWriter(fs::path file, const fs::path& original) : BagWriter(std::move(file)) {
  requireFreeConnection(original);
  try {
    // A run that was killed may have left one of that name, of the same process number.
    fs::copy_file(original, temporary_, fs::copy_options::overwrite_existing);
    fs::permissions(temporary_, fs::perms::owner_write, fs::perm_options::add);
    bag_->open(temporary_.string(), rosbag::bagmode::Append);
    bag_->setCompression(compressionOf(original));
  } catch (const std::exception& error) {
    throw DataError(
        fmt::format("{}: cannot be written as a copy of {} ({})", file_.string(), original.string(), error.what()));
  }
}

BagWriter::~BagWriter() {
  if (temporary_.empty()) return;
  giveUp(std::move(bag_));
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void BagWriter::fail(const std::exception& error) const {
  throw DataError(fmt::format("{}: cannot be written ({})", file_.string(), error.what()));
}

void BagWriter::commit() {
  try {
    bag_->close();
    fs::rename(temporary_, file_);
  } catch (const std::exception& error) {
    fail(error);
  }
  temporary_.clear();
}

}  // namespace donex
