// Requirement: meshes whose triangles face this way and that face one side, that of the most; what has no two sides or
// is meant to have both stays.
// Planted, seen to fail: neighbours taken to face alike when they run along their edge in one direction.
#include "dem/mesh/winding.h"

#include <gtest/gtest.h>

#include <map>

namespace granrad {
namespace {

using Meshes = std::vector<std::vector<Triangle>>;

/// A tetrahedron in two meshes.
const Meshes tetrahedron{{{0, 2, 1}, {0, 1, 3}}, {{1, 2, 3}, {0, 3, 2}}};

/// Every edge once in each direction.
bool faces_one_side(const Meshes& meshes) {
  std::map<std::pair<int, int>, int> runs;
  for (const auto& mesh : meshes)
    for (const auto& t : mesh)
      for (int c = 0; c < 3; ++c) ++runs[{t[c], t[(c + 1) % 3]}];
  for (const auto& [run, count] : runs)
    if (count != 1 || !runs.count({run.second, run.first})) return false;
  return true;
}

TEST(Winding, TheSideOfTheMostIsKept) {
  for (int k = 0; k < 4; ++k) {
    Meshes meshes = tetrahedron;
    auto& t = meshes[k / 2][k % 2];
    std::swap(t[1], t[2]);
    EXPECT_FALSE(faces_one_side(meshes));
    EXPECT_EQ(wind_alike(meshes), 1u);
    EXPECT_TRUE(faces_one_side(meshes)) << k;
    const auto& other = meshes[0][k == 0 ? 1 : 0];
    EXPECT_EQ(other, tetrahedron[0][k == 0 ? 1 : 0]) << "the others were turned";
  }
}

TEST(Winding, WhatFacesOneSideStays) {
  Meshes meshes = tetrahedron;
  EXPECT_EQ(wind_alike(meshes), 0u);
  EXPECT_EQ(meshes, tetrahedron);
}

TEST(Winding, SheetsOfTwoSidesAndStripsOfOneStay) {
  const Meshes sheet{{{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}}};
  Meshes meshes = sheet;
  EXPECT_EQ(wind_alike(meshes), 0u);
  EXPECT_EQ(meshes, sheet);
  // Five triangles about a pentagon close to a Moebius strip.
  const Meshes strip{{{0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 0}, {4, 0, 1}}};
  meshes = strip;
  EXPECT_EQ(wind_alike(meshes), 0u);
  EXPECT_EQ(meshes, strip);
}

}  // namespace
}  // namespace granrad
