#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "evaluation/evaluation.h"
#include "evaluation/phantoms.h"
#include "support/sequences.h"

namespace donex {
namespace {

using Labels = std::vector<std::uint32_t>;

TEST(Evaluation, HandWorkedExample) {
  // Ten echoes: 2 found, 1 missed, 1 invented, 2 rightly static; 4 not scored (labels 0 and 1, 60 m away, NaN).
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> echoes{{5, 0, 0},  {0, 15, 0}, {3, 4, 90}, {0, -25, 0}, {30, 40, 0},
                                            {12, 0, 0}, {1, 0, 0},  {2, 0, 0},  {60, 0, 0},  {nan, 0, 0}};
  const Labels truth{251, 252, 254, 9, 40, (3U << 16U) | 9U, 0, 1, 251, 251};
  const Labels prediction{251, (7U << 16U) | 252U, 9, 251, 0, 1, 251, 251, 9, 9};
  Evaluation evaluation;
  for (std::size_t scan = 0; scan < 6; ++scan) evaluation.add(scan, echoes, truth, prediction);  // only scan 5 counts
  const Counts& total = evaluation.total();
  EXPECT_EQ(evaluation.scans(), 1U);
  EXPECT_EQ(total.true_positives, 2U);
  EXPECT_EQ(total.false_negatives, 1U);
  EXPECT_EQ(total.false_positives, 1U);
  EXPECT_EQ(total.true_negatives, 2U);
  EXPECT_DOUBLE_EQ(total.iou(), 0.5);
  EXPECT_DOUBLE_EQ(total.precision(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(total.recall(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(total.falsePositiveRate(), 1.0 / 3.0);
  EXPECT_EQ(evaluation.byClass().at(252).true_positives, 1U);
  EXPECT_EQ(evaluation.byClass().at(254).false_negatives, 1U);
  EXPECT_EQ(evaluation.byClass().at(9).total(), 2U);  // the upper 16 bits are the instance
  EXPECT_EQ(evaluation.byClass().count(0), 0U);
  ASSERT_EQ(evaluation.byRange().size(), 5U);
  EXPECT_EQ(evaluation.byRange()[0].total(), 2U);  // 5 m, and 5 m below 90 m: range is in x, y
  EXPECT_EQ(evaluation.byRange()[1].total(), 2U);
  EXPECT_EQ(evaluation.byRange()[2].false_positives, 1U);
  EXPECT_EQ(evaluation.byRange()[4].true_negatives, 1U);  // 50 m exactly is within
}

/// The scoring rules read once more, plainly: sets of echoes instead of counters.
struct PlainScore {
  double iou, precision, recall;
};
PlainScore plainScore(const std::vector<SequenceScan>& scans, const std::vector<Labels>& truth,
                      const std::vector<Labels>& prediction) {
  std::vector<std::pair<bool, bool>> scored;  // moving in truth, in prediction
  for (std::size_t k = 5; k < scans.size(); ++k) {
    for (std::size_t i = 0; i < scans[k].echoes.size(); ++i) {
      const auto& echo = scans[k].echoes[i];
      const std::uint32_t label = truth[k][i] % 65536;
      if (std::hypot(double{echo.x()}, double{echo.y()}) > 50.0 || label < 2) continue;
      scored.emplace_back(label > 250, prediction[k][i] % 65536 > 250);
    }
  }
  const auto count = [&](bool moving, bool said) {
    return static_cast<double>(std::count(scored.begin(), scored.end(), std::make_pair(moving, said)));
  };
  const double hits = count(true, true);
  const double said = hits + count(false, true);
  const double moving = hits + count(true, false);
  return {hits / (said + moving - hits), hits / said, hits / moving};
}

TEST(Evaluation, EqualsASecondComputation) {
  std::mt19937 random(11);
  const Labels labels{0, 1, 9, 40, 250, 251, 252, 259, 0x10000U + 251U, 0x20000U + 9U};
  const auto draw = [&](std::size_t size) {
    Labels drawn(size);
    for (auto& label : drawn) label = labels[random() % labels.size()];
    return drawn;
  };
  for (int round = 0; round < 20; ++round) {
    std::vector<SequenceScan> scans;
    std::vector<Labels> truth, prediction;
    Evaluation evaluation;
    for (std::size_t k = 0; k < 9; ++k) {
      scans.push_back(test::randomScan(random, k, 200));
      truth.push_back(draw(200));
      prediction.push_back(draw(200));
      evaluation.add(k, scans[k].echoes, truth[k], prediction[k]);
    }
    const PlainScore plain = plainScore(scans, truth, prediction);
    EXPECT_DOUBLE_EQ(evaluation.total().iou(), plain.iou);
    EXPECT_DOUBLE_EQ(evaluation.total().precision(), plain.precision);
    EXPECT_DOUBLE_EQ(evaluation.total().recall(), plain.recall);
  }
}

/// The rule once more, plainly: clusters grow echo by echo until nothing is near enough any more.
std::size_t plainPhantoms(std::vector<Eigen::Vector3f> left, const std::vector<Eigen::Vector3f>& moving) {
  std::size_t phantoms = 0;
  while (!left.empty()) {
    std::vector<Eigen::Vector3f> cluster{left.back()};
    left.pop_back();
    for (std::size_t i = 0; i < cluster.size(); ++i) {
      for (std::size_t k = left.size(); k-- > 0;) {
        if ((left[k] - cluster[i]).cast<double>().norm() > 0.8) continue;
        cluster.push_back(left[k]);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      }
    }
    bool is_clear = true;
    for (const auto& echo : cluster) {
      for (const auto& other : moving) is_clear = is_clear && (other - echo).cast<double>().norm() > 1.5;
    }
    phantoms += cluster.size() >= 5 && is_clear ? 1 : 0;
  }
  return phantoms;
}

TEST(Phantoms, EqualThePlainRule) {
  std::mt19937 random(21);
  std::size_t all = 0;
  for (int round = 0; round < 40; ++round) {
    std::uniform_real_distribution<float> place(-6.0F, 6.0F);
    const auto draw = [&](std::size_t size) {
      std::vector<Eigen::Vector3f> echoes(size);
      for (auto& echo : echoes) echo = {place(random), place(random), 0.2F * place(random)};
      return echoes;
    };
    const auto false_echoes = draw(10 + 6 * static_cast<std::size_t>(round));
    const auto moving = draw(static_cast<std::size_t>(round % 4));
    EXPECT_EQ(countPhantoms(false_echoes, moving), plainPhantoms(false_echoes, moving));
    all += countPhantoms(false_echoes, moving);
  }
  EXPECT_GT(all, 50U);
}

TEST(Phantoms, AreCountedOfWhatIsJudged) {
  std::vector<Eigen::Vector3f> echoes;
  const auto row = [&](float x) {
    for (int i = 0; i < 5; ++i) echoes.emplace_back(x, 0.7F * static_cast<float>(i), 0.0F);
  };
  for (const float x : {10.0F, 20.0F, 30.0F, 60.0F}) row(x);
  echoes.emplace_back(31.4F, 0.0F, 0.0F);  // truly moving, near the third row
  Labels truth(echoes.size(), 9), prediction(echoes.size(), 251);
  truth.back() = 251;
  for (std::size_t i = 5; i < 10; ++i) truth[i] = 0;  // the second row is not judged; the fourth lies beyond 50 m
  Evaluation evaluation;
  EXPECT_TRUE(std::isnan(evaluation.phantomsPerScan()));
  evaluation.add(4, echoes, truth, prediction);  // warm-up
  evaluation.add(5, echoes, truth, prediction);
  prediction[0] = 9;  // four false echoes are too few
  evaluation.add(6, echoes, truth, prediction);
  EXPECT_EQ(evaluation.phantoms(), 1U);
  EXPECT_DOUBLE_EQ(evaluation.phantomsPerScan(), 0.5);
}

TEST(Evaluation, ClassesAndBandsAddUp) {
  std::mt19937 random(12);
  Evaluation evaluation;
  for (std::size_t k = 5; k < 8; ++k) {
    Labels truth(300), prediction(300);
    for (auto& label : truth) label = 245 + static_cast<std::uint32_t>(random() % 12);
    for (auto& label : prediction) label = random() % 2 == 0 ? kLabelMoving : kLabelStatic;
    evaluation.add(k, test::randomScan(random, k, 300).echoes, truth, prediction);
  }
  std::uint64_t by_class = 0, by_range = 0;
  for (const auto& [label, counts] : evaluation.byClass()) by_class += counts.total();
  for (const auto& counts : evaluation.byRange()) by_range += counts.total();
  EXPECT_GT(evaluation.total().total(), 300U);
  EXPECT_EQ(by_class, evaluation.total().total());
  EXPECT_EQ(by_range, evaluation.total().total());
}

TEST(Evaluation, UnequalCountsAreNeverGuessed) {
  Evaluation evaluation;
  const std::vector<Eigen::Vector3f> echoes(3, Eigen::Vector3f::Zero());
  EXPECT_THROW(evaluation.add(7, echoes, Labels(2, 9), Labels(3, 9)), std::invalid_argument);
  EXPECT_THROW(evaluation.add(7, echoes, Labels(3, 9), Labels(4, 9)), std::invalid_argument);
  EXPECT_EQ(evaluation.scans(), 0U);
}

TEST(Evaluation, ARatioOfNothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(Counts().iou()));
  EXPECT_TRUE(std::isnan(Counts().precision()));
  EXPECT_TRUE(std::isnan(Counts().recall()));
  EXPECT_TRUE(std::isnan(Counts().falsePositiveRate()));
}

TEST(Evaluation, TablesShowPredictionsSideBySide) {
  const std::vector<Eigen::Vector3f> echoes{{1, 0, 0}, {2, 0, 0}, {25, 0, 0}};
  Evaluation good, blind;
  good.add(5, echoes, {251, 9, 252}, {251, 9, 251});
  blind.add(5, echoes, {251, 9, 252}, {9, 9, 9});
  const std::string text = formatEvaluations({{"good", &good}, {"blind", &blind}});
  EXPECT_NE(text.find("good        1.0000  1.0000  1.0000      1       3       2"), std::string::npos) << text;
  EXPECT_NE(text.find("blind       0.0000       -  0.0000      1       3       2"), std::string::npos) << text;
  EXPECT_NE(text.find("moving car"), std::string::npos) << text;
  EXPECT_NE(text.find("20 to 30 m"), std::string::npos) << text;
}

TEST(ClassNames, UnknownOnesHaveTheirNumber) {
  EXPECT_EQ(className(254), "moving person");
  EXPECT_EQ(className((5U << 16U) | 10U), "car");
  EXPECT_EQ(className(1234), "class 1234");
}

}  // namespace
}  // namespace donex
