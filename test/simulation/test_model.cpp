#include <algorithm>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "simulation/model.h"
#include "simulation/sensor_model.h"

namespace donex::simulation {
namespace {

using Maker = Model (*)(Random&);
struct Kind {
  Maker make;
  std::uint32_t moving;
  double shortest, longest, highest;  // [m]
};

class Models : public testing::TestWithParam<Kind> {};

TEST_P(Models, HaveTheSizeOfTheirKindAndStandOnTheGround) {
  const Kind& kind = GetParam();
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const Model model = kind.make(random);
    EXPECT_EQ(model.object_class.moving, kind.moving);
    const Eigen::AlignedBox3d box = model.box();
    EXPECT_GT(box.sizes().x(), kind.shortest);
    EXPECT_LT(box.sizes().x(), kind.longest);
    EXPECT_LT(box.max().z(), kind.highest);
    EXPECT_NEAR(box.min().z(), 0.0, 0.1);
    for (const Part& part : model.posed(0.37)) {
      EXPECT_GT(part.shape.half.minCoeff(), 0.0f);
      EXPECT_NEAR(part.shape.axes.determinant(), 1.0f, 1e-4);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Models,
                         testing::Values(Kind{makeCar, 252, 3.5, 5.2, 2.0}, Kind{makeVan, 252, 4.8, 6.4, 2.8},
                                         Kind{makeLorry, 258, 7.0, 17.0, 4.2}, Kind{makeBus, 257, 11.0, 13.0, 3.4},
                                         Kind{makePerson, 254, 0.3, 1.3, 2.1}, Kind{makeCyclist, 253, 1.5, 2.2, 2.1}));

TEST(Models, ComeInSeveralShapes) {
  std::set<std::size_t> parts;
  std::set<int> lengths;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    const Model car = makeCar(random);
    parts.insert(car.parts.size());
    lengths.insert(static_cast<int>(10.0 * car.box().sizes().x()));
  }
  EXPECT_GE(*parts.begin(), 8U);  // no single boxes
  EXPECT_GE(lengths.size(), 4U);
}

TEST(Models, LegsSwingWithTheWayAndStayInTheBox) {
  Random random(3);
  const Model person = makePerson(random);
  const Eigen::AlignedBox3d box = person.box();
  const auto standing = person.posed(1.0);
  double moved = 0.0;
  for (double way = 0.0; way < 3.0; way += 0.05) {
    const auto posed = person.posed(way);
    ASSERT_EQ(posed.size(), standing.size());
    for (std::size_t i = 0; i < posed.size(); ++i) {
      const Eigen::Vector3f& center = posed[i].shape.center;
      EXPECT_TRUE(box.contains(center.cast<double>()));
      moved = std::max(moved, static_cast<double>((center - standing[i].shape.center).norm()));
    }
  }
  EXPECT_GT(moved, 0.15);
}

TEST(SensorModel, HasRisingBeamsAndEnoughRays) {
  for (const int beams : {16, 32, 64, 128}) {
    const SensorModel model = makeSensorModel(beams);
    EXPECT_EQ(model.beams(), beams);
    EXPECT_TRUE(std::is_sorted(model.slopes.begin(), model.slopes.end()));
    EXPECT_GT(model.beams() * model.columns(), beams >= 64 ? 150000 : 20000);
  }
  EXPECT_THROW(makeSensorModel(48), std::invalid_argument);
}

}  // namespace
}  // namespace donex::simulation
