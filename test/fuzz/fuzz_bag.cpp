// Any bytes as a bag: labelled, or a DataError.
#include "bag/label_bag.h"
#include "fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto in = donex::fuzz::folder() / "in.bag", out = donex::fuzz::folder() / "out.bag";
  donex::fuzz::writeFile(in, data, size);
  donex::LabelBagOptions options;
  options.config.region = {-5.0, 5.0, -5.0, 5.0, -2.0, 2.0};
  options.config.motion.source = donex::OdometrySource::kNone;
  try {
    donex::labelBag({in}, {out}, options, [](std::size_t, std::size_t) {});
  } catch (const donex::DataError&) {
  }
  return 0;
}
