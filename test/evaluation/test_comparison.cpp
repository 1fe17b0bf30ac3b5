// Side by side scores and their reports: hand-worked pictures, objects and speeds.
#include <cmath>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/comparison.h"
#include "evaluation/object_speeds.h"
#include "support/sequences.h"
#include "support/temporary_directory.h"

namespace donex {
namespace {

namespace fs = std::filesystem;
using Labels = std::vector<std::uint32_t>;
using nlohmann::json;

constexpr std::uint32_t label(std::uint32_t kind, std::uint32_t instance) { return instance << 16U | kind; }

TEST(ObjectSpeeds, AreThoseOfTheCentresOverGround) {
  ObjectSpeeds speeds;
  for (int k = 0; k <= 10; ++k) {
    const float x = static_cast<float>(k);  // the vehicle does 10 m/s, the object stays 10 m ahead of it
    const Pose pose{{x, 0.0, 0.0}, Eigen::Quaterniond::Identity()};
    const Eigen::Vector3f left_behind(20.0F - x, 5.0F, 0.0F);
    speeds.add(0.1 * k, pose, {{9, 0, 0}, {11, 0, 0}, left_behind, {1, 1, 1}},
               {label(252, 1), label(252, 1), label(254, 1), label(9, 0)});
  }
  EXPECT_NEAR(*speeds.at(label(252, 1), 0.5), 10.0, 1e-6);
  EXPECT_NEAR(*speeds.at(label(252, 1), 0.0), 10.0, 1e-6);     // one-sided at the ends
  EXPECT_NEAR(*speeds.at(label(254, 1), 0.1 * 3), 0.0, 1e-5);  // the first person is not the first car
  EXPECT_FALSE(speeds.at(label(9, 0), 0.5));
  EXPECT_FALSE(speeds.at(label(252, 1), 0.55));  // no scan then
  EXPECT_FALSE(speeds.at(label(252, 3), 0.5));
}

TEST(SpeedBands, AreClosedBelow) {
  EXPECT_EQ(speedBand(0.0), 0U);
  EXPECT_EQ(speedBand(1.0), 1U);
  EXPECT_EQ(speedBand(14.9), 3U);
  EXPECT_EQ(speedBand(15.0), 4U);
  EXPECT_EQ(speedBandName(0), "below 1 m/s");
  EXPECT_EQ(speedBandName(2), "3 to 8 m/s");
  EXPECT_EQ(speedBandName(4), "15 m/s and more");
}

TEST(Objects, AreFoundByHalfOfTheirEchoes) {
  // Instance 1: 5 of 10 found; 2: 4 of 10; 3: too few echoes to count; 4: static; 5: beyond 50 m.
  std::vector<Eigen::Vector3f> echoes;
  Labels truth, prediction;
  const auto put = [&](int count, std::uint32_t kind, std::uint32_t instance, int said_moving, float x) {
    for (int i = 0; i < count; ++i) {
      echoes.emplace_back(x, 0.0F, 0.0F);
      truth.push_back(label(kind, instance));
      prediction.push_back(i < said_moving ? 251 : 9);
    }
  };
  put(10, 252, 1, 5, 5.0F);
  put(10, 254, 2, 4, 5.0F);
  put(9, 252, 3, 9, 5.0F);
  put(20, 10, 4, 20, 5.0F);
  put(20, 252, 5, 20, 60.0F);
  Evaluation evaluation;
  const auto speed_of = [](std::uint32_t one) {
    const bool is_car = one == label(252, 1), is_person = one == label(254, 2);
    return is_car ? std::optional<double>(5.0) : is_person ? std::optional<double>(0.5) : std::nullopt;
  };
  evaluation.add(5, echoes, truth, prediction, speed_of);
  EXPECT_EQ(evaluation.objects().all, 2U);
  EXPECT_EQ(evaluation.objects().found, 1U);
  EXPECT_DOUBLE_EQ(evaluation.objects().recall(), 0.5);
  EXPECT_EQ(evaluation.objectsByClass().at(252).found, 1U);
  EXPECT_EQ(evaluation.objectsByClass().at(254).found, 0U);
  EXPECT_EQ(evaluation.bySpeed()[0].true_positives, 4U);
  EXPECT_EQ(evaluation.bySpeed()[0].false_negatives, 6U);
  EXPECT_EQ(evaluation.bySpeed()[2].true_positives, 5U);
  EXPECT_EQ(evaluation.bySpeed()[2].total(), 10U);
}

TEST(BirdView, ShowsTheWorstOutcomeOfACell) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> echoes{{0.1F, 0.1F, 0},   {0.15F, 0.1F, 1}, {-0.1F, 0.1F, 0}, {10.1F, -5.1F, 0},
                                            {49.9F, 49.9F, 0}, {80, 0, 0},       {nan, 0, 0}};
  const Labels truth{9, 251, 251, 9, 0, 251, 251}, prediction{9, 9, 251, 251, 251, 9, 9};
  const BirdView view = makeBirdView(7, echoes, truth, {prediction, {}});
  EXPECT_EQ(view.scan, 7U);
  EXPECT_EQ(view.cells, (std::vector<std::uint16_t>{300, 224, 249, 250, 250, 250, 499, 499}));
  ASSERT_EQ(view.outcomes.size(), 2U);
  const auto outcome = [](EchoOutcome v) { return static_cast<std::uint8_t>(v); };
  EXPECT_EQ(view.outcomes[0],
            (std::vector<std::uint8_t>{outcome(EchoOutcome::kFalseAlarm), outcome(EchoOutcome::kFound),
                                       outcome(EchoOutcome::kMissed), outcome(EchoOutcome::kUnjudged)}));
  EXPECT_EQ(view.outcomes[1], std::vector<std::uint8_t>(4, 0));
}

/// A sequence with truth, and three predictions: perfect, one with a broken scan, one that is blind.
class Reports : public ::testing::Test {
 protected:
  Reports() {
    std::mt19937 random(4);
    SequenceWriter writer(directory_.path() / "drive");
    for (std::size_t i = 0; i < 9; ++i) {
      Labels truth(60);
      for (std::size_t e = 0; e < truth.size(); ++e) truth[e] = e < 20 ? label(252, 1) : 9;
      writer.add(test::randomScan(random, i, truth.size()), truth);
      write("perfect", i, truth);
      write("blind", i, Labels(truth.size(), 9));
      write("a \"broken\", one", i, i == 6 ? Labels(3, 9) : truth);
    }
    writeRunFigures(directory_.path() / "perfect", {"donex_3d, 0.2 m", 9, 0.02, 0.05, 0.018, 0.019, 80000000, 1000});
  }

  void write(const std::string& name, std::size_t scan, const Labels& labels) {
    fs::create_directories(directory_.path() / name);
    writeLabels(directory_.path() / name / (scanName(scan) + ".label"), labels);
  }

  Comparison compare() {
    const SequenceReader sequence(directory_.path() / "drive");
    std::vector<std::pair<std::string, fs::path>> predictions;
    for (const char* name : {"perfect", "a \"broken\", one", "blind"}) {
      predictions.emplace_back(name, directory_.path() / name);
    }
    Comparison comparison;
    comparison.title = "A </script> title";
    comparison.sequences.push_back(compareOnSequence(sequence, 9, predictions, [] {}));
    comparison.methods = {{"perfect", "knows", "itself", true}};
    comparison.table_1 = {{0.3, "8-9 ms", "175-185 ms", 0.004, 0.015, 0.012}};
    return comparison;
  }

  test::TemporaryDirectory directory_;
};

TEST_F(Reports, LeaveOutWhatDoesNotFitAndSaySo) {
  const Comparison comparison = compare();
  const auto& predictions = comparison.sequences.front().predictions;
  EXPECT_EQ(comparison.sequences.front().name, "drive");
  EXPECT_EQ(predictions[0].evaluation.scans(), 4U);
  EXPECT_EQ(predictions[1].evaluation.scans(), 3U);
  ASSERT_EQ(predictions[1].faults.list().size(), 1U);
  EXPECT_NE(predictions[1].faults.text().find("3 labels for 60 echoes, not scored"), std::string::npos);
  EXPECT_DOUBLE_EQ(predictions[0].evaluation.total().iou(), 1.0);
  EXPECT_DOUBLE_EQ(predictions[2].evaluation.total().recall(), 0.0);
  EXPECT_DOUBLE_EQ(predictions[0].figures->median_time, 0.02);
  EXPECT_FALSE(predictions[2].figures);
}

TEST(SequenceComparison, ShowsAScanInWhichSomethingMoves) {
  for (const std::size_t moving : {6U, 12U}) {  // in the first half, in the second
    const test::TemporaryDirectory directory;
    std::mt19937 random(5);
    SequenceWriter writer(directory.path());
    for (std::size_t i = 0; i < 16; ++i) writer.add(test::randomScan(random, i, 20), Labels(20, i == moving ? 252 : 9));
    const auto comparison = compareOnSequence(SequenceReader(directory.path()), 16, {}, [] {});
    ASSERT_TRUE(comparison.view);
    EXPECT_EQ(comparison.view->scan, moving);
  }
}

TEST_F(Reports, JsonHoldsEveryCount) {
  const json document = json::parse(toJson(compare()));
  const json& perfect = document["sequences"][0]["predictions"][0];
  EXPECT_EQ(perfect["total"]["iou"], 1.0);
  EXPECT_EQ(perfect["figures"]["peak_memory"], 80000000);
  EXPECT_EQ(document["sequences"][0]["predictions"][2]["total"]["precision"], nullptr);  // 0 of 0
  EXPECT_EQ(document["sequences"][0]["predictions"][2]["figures"], nullptr);
  EXPECT_EQ(document["table_1"]["rows"][0]["measured_3d"], 0.015);
  EXPECT_EQ(document["sequences"][0].count("view"), 0U);
}

TEST_F(Reports, NamesNeedNotBeUtf8) {
  Comparison comparison = compare();
  comparison.sequences[0].name = "f\xfcr";
  const json document = json::parse(toJson(comparison));
  EXPECT_EQ(document["sequences"][0]["name"], "f\xef\xbf\xbdr");
  EXPECT_NE(toHtml(comparison).find("f\xef\xbf\xbdr"), std::string::npos);
}

TEST_F(Reports, WhatWasNotMeasuredIsNotZero) {
  Comparison comparison = compare();
  comparison.sequences[0].predictions[0].figures->mean_cpu_time = 0.0;
  const json document = json::parse(toJson(comparison));
  EXPECT_EQ(document["sequences"][0]["predictions"][0]["figures"]["mean_cpu_time"], nullptr);
}

TEST_F(Reports, CsvHasAsManyFieldsInEveryLine) {
  std::istringstream lines(toCsv(compare()));
  std::string line;
  std::getline(lines, line);
  const auto columns = std::count(line.begin(), line.end(), ',');
  int quoted = 0, all = 0;
  for (; std::getline(lines, line); ++all) {
    const std::string broken = "drive,\"a \"\"broken\"\", one\",";
    const bool is_quoted = line.compare(0, broken.size(), broken) == 0;
    quoted += is_quoted ? 1 : 0;
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns + (is_quoted ? 1 : 0)) << line;
  }
  EXPECT_GT(quoted, 5);
  EXPECT_GT(all, 15);
}

TEST_F(Reports, ThePageHoldsAllItShows) {
  const std::string page = toHtml(compare());
  EXPECT_EQ(page.find("/*DATA*/null"), std::string::npos);
  EXPECT_NE(page.find("A \\u003c/script> title"), std::string::npos) << "the data ends the script";
  std::size_t ends = 0;
  for (std::size_t at = 0; (at = page.find("</script>", at)) != std::string::npos; ++at) ++ends;
  EXPECT_EQ(ends, 1U);
  for (const char* foreign : {"https://", "src=\"", "<link rel=\"stylesheet\"", "@import", "fetch("}) {
    EXPECT_EQ(page.find(foreign), std::string::npos) << foreign;
  }
}

TEST_F(Reports, FiguresThatCannotBeUnderstoodAreNamed) {
  std::ofstream(directory_.path() / "blind" / "run.json") << "{\"method\": 3}";
  try {
    compare();
    FAIL() << "they were taken";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("run.json: "), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace donex
