// Exchange among the walls follows the closed forms of an empty box, and Beer's law between near plates.
#include "fit/correlation/wall_exchange.h"

#include <gtest/gtest.h>

#include "raytrace/exact.h"

namespace granrad {
namespace {

Enclosure channel() {
  Enclosure enclosure;
  const auto walls = box_walls({{0, 0, 0}, {0.010, 0.004, 0.050}});
  enclosure.walls.assign(walls.begin(), walls.end());
  return enclosure;
}

// Planted error: area of the source left out of the weight -> off by the ratio of the areas.
TEST(WallExchange, OfAnEmptyChannelEqualsTheClosedForms) {
  const auto enclosure = channel();
  const auto walls = wall_exchange(enclosure, SolidFractionField(0), 1);
  const double a[6] = {200e-6, 200e-6, 500e-6, 500e-6, 40e-6, 40e-6};
  const auto factor = [&](int v, int w) { return walls.value[v * 6 + w] / a[v]; };
  const auto exact = exact_empty_box({{0, 0, 0}, {0.010, 0.004, 0.050}});
  for (int v = 0; v < 6; ++v)
    for (int w = 0; w < 6; ++w) EXPECT_NEAR(factor(v, w), exact[v][w], 1e-3) << v << " " << w;
  for (int v = 0; v < 6; ++v) EXPECT_EQ(walls.opening[v], 0);
}

TEST(WallExchange, OfNearPlatesFollowsBeersLaw) {
  // Two plates 1 m wide 1e-3 m apart: exchange per area 2 E3(tau), E3 the exponential integral; 2 E3(1) =
  // 0.2193840.
  Enclosure plates;
  const auto walls = box_walls({{0, 0, 0}, {1, 1, 1e-3}});
  plates.walls = {walls[4], walls[5]};
  const auto exchange =
      wall_exchange(plates, SolidFractionField(0.4), 1e-3);  // extinction 1.5 phi / (1 - phi) / d = 1e3
  EXPECT_NEAR(exchange.value[1], 0.2193840, 1e-3);
  EXPECT_GT(exchange.opening[0], 0);  // the rim
  EXPECT_LT(exchange.opening[0], 0.01);
}

}  // namespace
}  // namespace granrad
