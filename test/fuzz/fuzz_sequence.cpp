// Any bytes as the files of a sequence, divided by the line "====": read to the end, or a DataError.
#include <array>
#include <string>

#include "fuzz/input_file.h"
#include "io/sequence.h"

namespace {

namespace fs = std::filesystem;

void writeSequence(const fs::path& directory, const std::string& bytes) {
  const std::array<const char*, 7> files{"poses.txt",           "times.txt",           "calib.txt",
                                         "velodyne/000000.bin", "velodyne/000001.bin", "labels/000000.label",
                                         "labels/000001.label"};
  const std::string divider = "====\n";
  fs::remove_all(directory);
  fs::create_directories(directory / "velodyne");
  fs::create_directories(directory / "labels");
  std::size_t begin = 0;
  for (const char* file : files) {
    if (begin > bytes.size()) return;
    const std::size_t end = std::min(bytes.find(divider, begin), bytes.size());
    // An empty part is a file that is not there.
    if (end != begin) {
      donex::fuzz::writeFile(directory / file, reinterpret_cast<const std::uint8_t*>(bytes.data()) + begin,
                             end - begin);
    }
    begin = end + divider.size();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path directory = donex::fuzz::folder() / "sequence";
  writeSequence(directory, std::string(reinterpret_cast<const char*>(data), size));
  try {
    const donex::SequenceReader reader(directory);
    for (std::size_t i = 0; i < reader.size(); ++i) {
      donex::toScan(reader.scan(i));
      if (reader.hasLabels(i)) reader.labels(i);
    }
  } catch (const donex::DataError&) {
  }
  return 0;
}
