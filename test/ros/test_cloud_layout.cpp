// What judgeLayout accepts, and how it names what it does not.
#include <limits>

#include <gtest/gtest.h>

#include "ros/cloud_builder.h"
#include "ros/cloud_layout.h"
#include "ros/pipeline_rig.h"
#include "support/counted_allocations.h"

namespace donex {
namespace {

using test::CloudBuilder;
using test::PointCloud2;
using test::PointField;

void expectFault(const PointCloud2& cloud, LayoutFault fault, const std::string& words) {
  const LayoutVerdict verdict = judgeLayout(cloud);
  const auto* error = std::get_if<LayoutError>(&verdict);
  ASSERT_NE(error, nullptr) << "accepted, expected: " << words;
  EXPECT_EQ(error->fault, fault) << error->text;
  EXPECT_NE(error->text.find(words), std::string::npos) << error->text;
}

CloudLayout layoutOf(const PointCloud2& cloud) {
  const LayoutVerdict verdict = judgeLayout(cloud);
  if (const auto* error = std::get_if<LayoutError>(&verdict)) throw std::runtime_error(error->text);
  return std::get<CloudLayout>(verdict);
}

boost::shared_ptr<PointCloud2> good() { return CloudBuilder().xyz().size(10).build(); }

TEST(CloudLayout, MissingCoordinateIsNamed) {
  for (const std::string missing : {"x", "y", "z"}) {
    CloudBuilder builder;
    for (const std::string name : {"x", "y", "z"}) builder.field(name == missing ? "w" : name, PointField::FLOAT32);
    expectFault(*builder.size(4).build(), LayoutFault::kMissingField, "'" + missing + "'");
  }
}

TEST(CloudLayout, CoordinatesMustBeFloats) {
  for (const std::uint8_t datatype : {PointField::INT8, PointField::UINT8, PointField::INT16, PointField::UINT16,
                                      PointField::INT32, PointField::UINT32}) {
    expectFault(*CloudBuilder().xyz(datatype).size(4).build(), LayoutFault::kWrongDatatype, "FLOAT32");
  }
  auto unknown = good();
  unknown->fields[1].datatype = 99;
  expectFault(*unknown, LayoutFault::kWrongDatatype, "'y' has datatype 99");
}

TEST(CloudLayout, ZeroPointStep) {
  auto cloud = good();
  cloud->point_step = 0;
  expectFault(*cloud, LayoutFault::kZeroPointStep, "point_step is 0");
}

TEST(CloudLayout, FieldBehindItsPoint) {
  auto cloud = good();
  cloud->fields[2].offset = 10;
  expectFault(*cloud, LayoutFault::kFieldBeyondPoint, "'z'");
  cloud->fields[2].offset = std::numeric_limits<std::uint32_t>::max();
  expectFault(*cloud, LayoutFault::kFieldBeyondPoint, "'z'");
}

TEST(CloudLayout, RowStepMustHoldARow) {
  auto cloud = good();
  cloud->row_step -= 1;
  expectFault(*cloud, LayoutFault::kRowTooShort, "row_step is 119");
  cloud->row_step = 0;
  expectFault(*cloud, LayoutFault::kRowTooShort, "row_step is 0");
}

TEST(CloudLayout, TruncatedData) {
  auto cloud = good();
  cloud->data.pop_back();
  expectFault(*cloud, LayoutFault::kTruncatedData, "119 bytes");
  cloud->data.clear();
  expectFault(*cloud, LayoutFault::kTruncatedData, "0 bytes");
}

TEST(CloudLayout, ClaimsOfBillionsAreRefusedWithoutAllocating) {
  constexpr std::uint32_t kMax = std::numeric_limits<std::uint32_t>::max();
  testing::takeLargest();
  auto wide = good();
  wide->width = kMax;
  expectFault(*wide, LayoutFault::kRowTooShort, "4294967295");
  auto high = good();
  high->height = kMax;
  expectFault(*high, LayoutFault::kTruncatedData, "4294967295 rows");
  // Every product wraps around in 32 bits: 2^16 x 2^16 echoes, and 2^30 points of 4 bytes in a row.
  auto wrapping = good();
  wrapping->width = wrapping->height = 1U << 16;
  wrapping->row_step = (1U << 16) * wrapping->point_step;
  expectFault(*wrapping, LayoutFault::kTruncatedData, "65536 rows");
  auto wrapping_row = good();
  wrapping_row->width = 1U << 30;
  wrapping_row->row_step = 0;
  expectFault(*wrapping_row, LayoutFault::kRowTooShort, "1073741824 points");
  EXPECT_LT(testing::takeLargest(), 10000U);
  test::PipelineRig rig;
  testing::takeLargest();
  for (const auto& cloud : {wide, high, wrapping, wrapping_row}) rig.pipeline.addCloud(cloud, 0.0);
  EXPECT_EQ(rig.pipeline.counts().dropped.of(DropReason::kBadLayout), 4U);
  EXPECT_LT(testing::takeLargest(), 10000U);
}

TEST(CloudLayout, LabelledCloudMustFitToo) {
  // No echoes, but a point that cannot grow by two bytes.
  auto cloud = good();
  cloud->width = 0;
  cloud->data.clear();
  cloud->point_step = std::numeric_limits<std::uint32_t>::max();
  expectFault(*cloud, LayoutFault::kTooLarge, "row_step");
}

TEST(CloudLayout, EmptyCloudIsReadable) {
  auto cloud = good();
  cloud->width = 0;
  cloud->row_step = 0;
  cloud->data.clear();
  EXPECT_EQ(layoutOf(*cloud).echoes(), 0U);
  cloud->point_step = 0;
  EXPECT_EQ(layoutOf(*cloud).echoes(), 0U);
  cloud->fields.clear();
  expectFault(*cloud, LayoutFault::kMissingField, "'x'");
}

TEST(CloudLayout, OrganisedPaddedAndSwapped) {
  auto cloud = CloudBuilder().bigEndian().padding(3).xyz().padding(5).rowPadding(7).size(4, 3).build();
  const CloudLayout layout = layoutOf(*cloud);
  EXPECT_EQ(layout.echoes(), 12U);
  EXPECT_EQ(layout.point_step, 20U);
  EXPECT_EQ(layout.row_step, 87U);
  EXPECT_EQ(layout.x.offset, 3U);
  EXPECT_TRUE(layout.swap_bytes);
}

TEST(CloudLayout, TimesByNameAndDatatype) {
  const auto timeOf = [](const std::string& name, std::uint8_t datatype) {
    return layoutOf(*CloudBuilder().xyz().field(name, datatype).size(2).build()).time;
  };
  EXPECT_EQ(timeOf("time", PointField::FLOAT32)->encoding, TimeEncoding::kRelativeSeconds);
  EXPECT_EQ(timeOf("t", PointField::UINT32)->encoding, TimeEncoding::kRelativeNanoseconds);
  EXPECT_EQ(timeOf("offset_time", PointField::UINT32)->encoding, TimeEncoding::kRelativeNanoseconds);
  EXPECT_EQ(timeOf("timestamp", PointField::FLOAT64)->encoding, TimeEncoding::kAuto);
  EXPECT_FALSE(timeOf("time", PointField::FLOAT32)->is_guess);
  EXPECT_FALSE(timeOf("intensity", PointField::FLOAT32));
}

TEST(CloudLayout, FieldsThatLookLikeTimesAreGuesses) {
  const auto timeOf = [](const std::string& name, std::uint8_t datatype) {
    return layoutOf(*CloudBuilder().xyz().field(name, datatype).size(2).build()).time;
  };
  for (const char* name : {"time", "ts", "time_stamp", "time_offset_ns", "TimeOffset", "point_stamp"}) {
    ASSERT_TRUE(timeOf(name, PointField::UINT32)) << name;
    EXPECT_TRUE(timeOf(name, PointField::UINT32)->is_guess) << name;
    EXPECT_EQ(timeOf(name, PointField::UINT32)->name, name);
    EXPECT_FALSE(timeOf(name, PointField::UINT16)) << name;
  }
  for (const char* name : {"ring", "tag", "return_type", "intensity"}) {
    EXPECT_FALSE(timeOf(name, PointField::UINT32)) << name;
  }
}

TEST(CloudLayout, TimesOfAConfiguredField) {
  const auto timeOf = [](std::uint8_t datatype, const CloudConfig& config) {
    const auto cloud =
        CloudBuilder().xyz().field("stamp_of_echo", datatype).field("t", PointField::UINT32).size(2).build();
    return std::get<CloudLayout>(judgeLayout(*cloud, config)).time;
  };
  CloudConfig config;
  EXPECT_EQ(timeOf(PointField::FLOAT64, config)->position.datatype, PointField::UINT32) << "found by its name";
  config.time_field = "stamp_of_echo";
  EXPECT_EQ(timeOf(PointField::FLOAT32, config)->encoding, TimeEncoding::kRelativeSeconds);
  EXPECT_EQ(timeOf(PointField::UINT32, config)->encoding, TimeEncoding::kRelativeNanoseconds);
  EXPECT_EQ(timeOf(PointField::FLOAT64, config)->encoding, TimeEncoding::kAuto);
  EXPECT_FALSE(timeOf(PointField::UINT16, config));
  config.time_encoding = TimeEncoding::kRelativeMicroseconds;
  EXPECT_EQ(timeOf(PointField::FLOAT64, config)->encoding, TimeEncoding::kRelativeMicroseconds);
  EXPECT_EQ(timeOf(PointField::FLOAT64, config)->position.offset, 12U);
  config.time_field = "not_there";
  EXPECT_FALSE(timeOf(PointField::FLOAT64, config));
}

TEST(CloudLayout, LabelsComeBehindThePoint) {
  const CloudLayout packed = layoutOf(*CloudBuilder().xyz().field("ring", PointField::UINT16).size(2).build());
  EXPECT_EQ(packed.dynamic_offset, 14U);
  EXPECT_EQ(packed.observed_offset, 15U);
  EXPECT_EQ(packed.labeled_point_step, 16U);
  const CloudLayout aligned = layoutOf(*CloudBuilder().xyz().padding(4).size(2).build());
  EXPECT_EQ(aligned.labeled_point_step, 20U) << "floats stay aligned";
  const CloudLayout doubles = layoutOf(*CloudBuilder().xyz(PointField::FLOAT64).size(2).build());
  EXPECT_EQ(doubles.labeled_point_step, 32U) << "doubles stay aligned";
}

TEST(CloudLayout, LabelsThatAreThereAlreadyAreReused) {
  auto cloud = CloudBuilder().xyz().field("observed", PointField::UINT8).padding(3).size(2).build();
  const CloudLayout layout = layoutOf(*cloud);
  EXPECT_EQ(layout.observed_offset, 12U);
  EXPECT_EQ(layout.dynamic_offset, 16U);
  cloud->fields.back().datatype = PointField::FLOAT32;
  expectFault(*cloud, LayoutFault::kWrongDatatype, "'observed' already");
  cloud->fields.back().datatype = PointField::UINT8;
  cloud->fields.back().count = 4;
  expectFault(*cloud, LayoutFault::kWrongDatatype, "count 4");
  cloud->fields.back().count = 1;
  cloud->fields.back().offset = 16;
  expectFault(*cloud, LayoutFault::kFieldBeyondPoint, "'observed'");
}

}  // namespace
}  // namespace donex
