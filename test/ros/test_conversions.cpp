// Echoes out of clouds of every layout, and labels into them, against a slow reading of the PointCloud2 definition.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "ros/cloud_builder.h"
#include "ros/conversions.h"

namespace donex {
namespace {

using test::CloudBuilder;
using test::PointCloud2;
using test::PointField;

CloudLayout layoutOf(const PointCloud2& cloud) { return std::get<CloudLayout>(judgeLayout(cloud)); }

std::vector<Eigen::Vector3f> echoesOf(const PointCloud2& cloud) {
  std::vector<Eigen::Vector3f> echoes{{9.0F, 9.0F, 9.0F}};  // of an earlier scan
  parseEchoes(cloud, layoutOf(cloud), echoes);
  return echoes;
}

const std::uint8_t* pointOf(const PointCloud2& cloud, std::size_t echo) {
  return cloud.data.data() + echo / cloud.width * cloud.row_step + echo % cloud.width * cloud.point_step;
}

EchoLabels randomLabels(std::size_t echoes, std::uint32_t seed) {
  std::mt19937 random(seed);
  EchoLabels labels;
  labels.assign(echoes);
  for (std::size_t i = 0; i < echoes; ++i) {
    labels.dynamic[i] = random() % 3 == 0;
    labels.observed[i] = random() % 2 == 0;
  }
  return labels;
}

struct Form {
  const char* name;
  CloudBuilder builder;  // fields chosen, size not
  std::uint32_t width, height;
};

std::vector<Form> forms() {
  CloudBuilder reversed, mixed, apart;
  reversed.field("z", PointField::FLOAT32).field("y", PointField::FLOAT32).field("x", PointField::FLOAT32);
  mixed.field("x", PointField::FLOAT32).field("y", PointField::FLOAT64).field("z", PointField::FLOAT32);
  apart.fieldAt("x", PointField::FLOAT32, 1).fieldAt("y", PointField::FLOAT32, 9).fieldAt("z", PointField::FLOAT32, 17);
  return {
      {"plain", CloudBuilder().xyz(), 60, 1},
      {"intensity and ring",
       CloudBuilder().xyz().field("intensity", PointField::FLOAT32).field("ring", PointField::UINT16), 60, 1},
      {"organised", CloudBuilder().xyz().padding(4), 15, 4},
      {"row padding", CloudBuilder().xyz().rowPadding(5), 15, 4},
      {"unaligned", CloudBuilder().padding(3).xyz().padding(2), 60, 1},
      {"doubles", CloudBuilder().xyz(PointField::FLOAT64), 60, 1},
      {"big-endian", CloudBuilder().bigEndian().xyz(), 60, 1},
      {"big-endian doubles, organised", CloudBuilder().bigEndian().xyz(PointField::FLOAT64).rowPadding(3), 12, 5},
      {"reversed", reversed, 60, 1},
      {"mixed", mixed, 60, 1},
      {"apart", apart, 60, 1},
  };
}

TEST(ParseEchoes, EveryLayoutGivesTheSameEchoes) {
  for (Form& form : forms()) {
    form.builder.size(form.width, form.height);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> metres(-100.0F, 100.0F);
    std::vector<Eigen::Vector3f> expected;
    for (std::size_t i = 0; i < 60; ++i) {
      expected.emplace_back(metres(random), metres(random), metres(random));
      form.builder.at(i, static_cast<double>(expected[i].x()), static_cast<double>(expected[i].y()),
                      static_cast<double>(expected[i].z()));
    }
    EXPECT_EQ(echoesOf(*form.builder.build()), expected) << form.name;
  }
}

TEST(ParseEchoes, NonFiniteEchoesKeepTheirPlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CloudBuilder builder;
  builder.xyz(PointField::FLOAT64).size(4).at(0, nan, 1, 2).at(1, 1, 2, 3).at(2, 4, 1e300, 5).at(3, -1e300, 0, 0);
  const auto echoes = echoesOf(*builder.build());
  ASSERT_EQ(echoes.size(), 4U);
  EXPECT_TRUE(std::isnan(echoes[0].x()));
  EXPECT_EQ(echoes[1], Eigen::Vector3f(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(echoes[2].y(), std::numeric_limits<float>::infinity()) << "beyond float's range";
  EXPECT_EQ(echoes[3].x(), -std::numeric_limits<float>::infinity());
}

TEST(ParseEchoes, EmptyAndOneEcho) {
  EXPECT_TRUE(echoesOf(*CloudBuilder().xyz().size(0).build()).empty());
  EXPECT_EQ(echoesOf(*CloudBuilder().xyz().size(1).at(0, 1, 2, 3).build()).size(), 1U);
}

TEST(ParseRings, ReadsWholeNumbersOfAnySize) {
  for (const std::uint8_t datatype : {PointField::INT8, PointField::UINT8, PointField::INT16, PointField::UINT16,
                                      PointField::INT32, PointField::UINT32}) {
    for (const bool is_big : {false, true}) {
      CloudBuilder builder;
      if (is_big) builder.bigEndian();
      builder.xyz().field("ring", datatype).padding(3).size(5);
      for (std::size_t i = 0; i < 5; ++i) builder.at(i, 1, 2, 3).set(i, "ring", static_cast<double>(20 * i));
      const auto cloud = builder.build();
      const auto layout = std::get<CloudLayout>(judgeLayout(*cloud));
      ASSERT_TRUE(layout.ring) << int{datatype};
      std::vector<std::uint32_t> rings;
      parseRings(*cloud, layout, rings);
      EXPECT_EQ(rings, (std::vector<std::uint32_t>{0, 20, 40, 60, 80})) << int{datatype} << is_big;
    }
  }
}

TEST(ParseRings, OtherFieldsAreNoRings) {
  const auto ringOf = [](CloudBuilder& builder) { return std::get<CloudLayout>(judgeLayout(*builder.build())).ring; };
  EXPECT_FALSE(ringOf(CloudBuilder().xyz().size(1)));
  EXPECT_FALSE(ringOf(CloudBuilder().xyz().field("ring", PointField::FLOAT32).size(1)));
  EXPECT_FALSE(ringOf(CloudBuilder().xyz().fieldAt("ring", PointField::UINT16, 14).pointStep(15).size(1)))
      << "ends behind its point";
}

/// A cloud of billions of empty rows needs no byte; this many would take for ever.
TEST(ParseEchoes, RowsWithoutEchoesAreNotWalked) {
  const auto cloud = CloudBuilder().xyz().field("time", PointField::FLOAT32).size(0).build();
  CloudLayout layout = std::get<CloudLayout>(judgeLayout(*cloud));
  layout.height = std::size_t{1} << 60U;
  std::vector<Eigen::Vector3f> echoes(3);
  parseEchoes(*cloud, layout, echoes);
  EXPECT_TRUE(echoes.empty());
  EchoTimes times;
  parseEchoes(*cloud, layout, echoes, times);
  EXPECT_TRUE(times.after_stamp.empty());
}

TEST(ParseEchoes, NothingCameBack) {
  const auto echoes = echoesOf(*CloudBuilder().xyz().size(2).at(0, 0, 0, 0).at(1, 0, 0, 1e-6).build());
  EXPECT_TRUE(echoes[0].array().isNaN().all());
  EXPECT_EQ(echoes[1], Eigen::Vector3f(0.0F, 0.0F, 1e-6F));
}

class EchoTime : public testing::Test {
 protected:
  EchoTimes timesOf(const PointCloud2& cloud) {
    std::vector<Eigen::Vector3f> echoes, alone;
    EchoTimes times;
    times.after_stamp = {7.0F};  // of an earlier scan
    times.problem = "an earlier one";
    parseEchoes(cloud, layoutOf(cloud), echoes, times);
    parseEchoes(cloud, layoutOf(cloud), alone);
    const std::size_t bytes = alone.size() * sizeof(Eigen::Vector3f);
    EXPECT_EQ(echoes.size(), alone.size());
    EXPECT_EQ(std::memcmp(echoes.data(), alone.data(), bytes), 0) << "with times or without: the same echoes";
    problem_ = times.problem;
    return times;
  }

  /// Three echoes 0, 50 and 100 ms after the stamp, written as `unit` times that plus `start`.
  EchoTimes threeTimes(const std::string& name, std::uint8_t datatype, double unit, double start, bool big = false) {
    CloudBuilder builder;
    if (big) builder.bigEndian();
    builder.xyz().field(name, datatype).size(3).stamp(kStamp);
    for (std::size_t i = 0; i < 3; ++i) {
      builder.at(i, 1, 2, 3).set(i, name, start + unit * 0.05 * static_cast<double>(i));
    }
    return timesOf(*builder.build());
  }

  void expectThreeTimes(const EchoTimes& times) {
    ASSERT_EQ(times.after_stamp.size(), 3U) << problem_;
    EXPECT_TRUE(problem_.empty()) << problem_;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(times.after_stamp[i], 0.05F * static_cast<float>(i), 1e-6F);
    EXPECT_NEAR(times.first, 0.0, 1e-6);
    EXPECT_NEAR(times.last, 0.1, 1e-6);
  }

  static constexpr double kStamp = 1700000000.25;
  std::string problem_;
};

TEST_F(EchoTime, DriversOwnFields) {
  expectThreeTimes(threeTimes("time", PointField::FLOAT32, 1.0, 0.0));
  expectThreeTimes(threeTimes("t", PointField::UINT32, 1e9, 0.0));
  expectThreeTimes(threeTimes("offset_time", PointField::UINT32, 1e9, 0.0));
  expectThreeTimes(threeTimes("timestamp", PointField::FLOAT64, 1.0, kStamp));
  expectThreeTimes(threeTimes("timestamp", PointField::FLOAT64, 1e9, kStamp * 1e9));
}

TEST_F(EchoTime, BigEndian) {
  expectThreeTimes(threeTimes("time", PointField::FLOAT32, 1.0, 0.0, true));
  expectThreeTimes(threeTimes("t", PointField::UINT32, 1e9, 0.0, true));
  expectThreeTimes(threeTimes("timestamp", PointField::FLOAT64, 1.0, kStamp, true));
}

TEST_F(EchoTime, OtherClocksAreRefusedWithAReason) {
  EXPECT_TRUE(threeTimes("timestamp", PointField::FLOAT64, 1.0, 5000.0).empty());
  EXPECT_NE(problem_.find("not de-skewed"), std::string::npos) << problem_;
  EXPECT_TRUE(threeTimes("time", PointField::FLOAT32, 1.0, std::nan("")).empty());
  EXPECT_FALSE(problem_.empty());
}

TEST_F(EchoTime, WithoutAFieldThereIsNoProblem) {
  EXPECT_TRUE(timesOf(*CloudBuilder().xyz().size(3).build()).empty());
  EXPECT_TRUE(problem_.empty()) << problem_;
}

TEST_F(EchoTime, OnlyFiniteEchoesCount) {
  CloudBuilder builder;
  builder.xyz().field("time", PointField::FLOAT32).size(3);
  builder.at(0, std::nan(""), 0, 0).set(0, "time", 77.0);
  builder.at(1, 1, 1, 1).set(1, "time", -0.02).at(2, 1, 1, 1).set(2, "time", 0.03);
  const EchoTimes times = timesOf(*builder.build());
  ASSERT_EQ(times.after_stamp.size(), 3U) << problem_;
  EXPECT_NEAR(times.first, -0.02, 1e-6);
  EXPECT_NEAR(times.last, 0.03, 1e-6);
}

TEST(LabelCloud, KeepsEveryByteAndAddsTheLabels) {
  for (Form& form : forms()) {
    SCOPED_TRACE(form.name);
    const auto cloud = form.builder.size(form.width, form.height).build();
    const CloudLayout layout = layoutOf(*cloud);
    const EchoLabels labels = randomLabels(60, 3);
    const auto out = labelCloud(*cloud, layout, labels);

    EXPECT_EQ(out->header, cloud->header);
    EXPECT_EQ(out->width, cloud->width);
    EXPECT_EQ(out->height, cloud->height);
    EXPECT_EQ(out->is_bigendian, cloud->is_bigendian);
    ASSERT_EQ(out->fields.size(), cloud->fields.size() + 2);
    for (std::size_t i = 0; i < cloud->fields.size(); ++i) EXPECT_EQ(out->fields[i], cloud->fields[i]);
    const PointField& dynamic = out->fields[out->fields.size() - 2];
    const PointField& observed = out->fields.back();
    EXPECT_EQ(dynamic.name, "dynamic");
    EXPECT_EQ(observed.name, "observed");
    EXPECT_EQ(dynamic.datatype, PointField::UINT8);
    ASSERT_EQ(out->row_step, out->point_step * out->width);
    ASSERT_EQ(out->data.size(), std::size_t{out->row_step} * out->height);
    for (std::size_t i = 0; i < 60; ++i) {
      ASSERT_EQ(std::memcmp(pointOf(*out, i), pointOf(*cloud, i), cloud->point_step), 0) << "echo " << i;
      ASSERT_EQ(pointOf(*out, i)[dynamic.offset], labels.dynamic[i]);
      ASSERT_EQ(pointOf(*out, i)[observed.offset], labels.observed[i]);
    }
    EXPECT_TRUE(std::holds_alternative<CloudLayout>(judgeLayout(*out))) << "can be classified again";
  }
}

TEST(LabelCloud, OverwritesEarlierLabels) {
  auto cloud =
      CloudBuilder().xyz().field("dynamic", PointField::UINT8).field("observed", PointField::UINT8).size(60).build();
  const EchoLabels labels = randomLabels(60, 4);
  const auto out = labelCloud(*cloud, layoutOf(*cloud), labels);
  EXPECT_EQ(out->fields, cloud->fields);
  EXPECT_EQ(out->point_step, cloud->point_step);
  for (std::size_t i = 0; i < 60; ++i) {
    ASSERT_EQ(std::memcmp(pointOf(*out, i), pointOf(*cloud, i), 12), 0);
    ASSERT_EQ(pointOf(*out, i)[12], labels.dynamic[i]);
    ASSERT_EQ(pointOf(*out, i)[13], labels.observed[i]);
  }
}

TEST(SelectPart, ThePartsDivideTheCloud) {
  for (Form& form : forms()) {
    SCOPED_TRACE(form.name);
    const auto cloud = form.builder.size(form.width, form.height).build();
    const EchoLabels labels = randomLabels(60, 5);
    const auto moving = selectPart(*cloud, layoutOf(*cloud), labels, CloudPart::kDynamic);
    const auto still = selectPart(*cloud, layoutOf(*cloud), labels, CloudPart::kStatic);
    ASSERT_EQ(moving->width + still->width, 60U);
    EXPECT_EQ(moving->fields, cloud->fields);
    EXPECT_EQ(moving->height, 1U);
    std::size_t next_moving = 0, next_still = 0;
    for (std::size_t i = 0; i < 60; ++i) {
      const std::uint8_t* point =
          labels.dynamic[i] != 0 ? pointOf(*moving, next_moving++) : pointOf(*still, next_still++);
      ASSERT_EQ(std::memcmp(point, pointOf(*cloud, i), cloud->point_step), 0) << "echo " << i;
    }
    EXPECT_EQ(next_moving, moving->width);
  }
}

}  // namespace
}  // namespace donex
