// Requirement: the packing generator returns non-overlapping spheres inside the box, as many as asked, the
// same for the same seed, periodic or walled, of one or several sizes, and refuses with advice what cannot be
// packed. Planted errors seen to fail here: nearest image left out of the minimisation (Periodic...), walls
// stiffened without the radius (Walled...), random numbers keyed without the seed (Seeded).
#include "dem/packing/packing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad {
namespace {

constexpr double r = 0.4e-3;

PackingRequest slab(double solid_fraction, std::array<bool, 3> periodic) {
  PackingRequest request;
  request.where = {{{-0.005, -0.002, 1}, {0.005, 0.002, 1.01}}, periodic};
  request.radius_m = equal_radii(request.where.box, solid_fraction, r);
  return request;
}

/// Smallest (distance / contact distance) over all pairs, by brute force over all images.
double closest_pair(const PackingRequest& request, const std::vector<Vec3>& position) {
  double closest = 1e9;
  const Vec3 size = request.where.box.size();
  for (std::size_t i = 0; i < position.size(); ++i)
    for (std::size_t j = i + 1; j < position.size(); ++j) {
      Vec3 d = position[j] - position[i];
      for (int k = 0; k < 3; ++k)
        if (request.where.periodic[k]) d[k] = std::remainder(d[k], size[k]);
      closest = std::min(closest, norm(d) / (request.radius_m[i] + request.radius_m[j]));
    }
  return closest;
}

void expect_inside(const PackingRequest& request, const std::vector<Vec3>& position) {
  const Box& box = request.where.box;
  for (std::size_t i = 0; i < position.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double reach = request.where.periodic[k] ? 0 : request.radius_m[i];
      EXPECT_GE(position[i][k], box.min[k] + reach);
      EXPECT_LE(position[i][k], box.max[k] - reach);
    }
}

void expect_packed(const PackingRequest& request) {
  const auto position = pack_spheres(request);
  ASSERT_EQ(position.size(), request.radius_m.size());
  EXPECT_GE(closest_pair(request, position), 1 - 1e-12);
  expect_inside(request, position);
}

TEST(Packing, PeriodicFromDiluteToDense) {
  for (const double phi : {0.02, 0.25, 0.48, 0.55, 0.58, 0.60}) {
    SCOPED_TRACE(phi);
    expect_packed(slab(phi, {true, true, true}));
  }
}

TEST(Packing, WalledFromDiluteToDense) {
  for (const double phi : {0.02, 0.25, 0.43, 0.48, 0.55}) {
    SCOPED_TRACE(phi);
    expect_packed(slab(phi, {false, false, true}));
    expect_packed(slab(phi, {false, false, false}));
  }
}

TEST(Packing, CountMatchesTheSolidFraction) {
  const Box box{{0, 0, 0}, {0.01, 0.004, 0.05}};
  for (const double phi : {0.02, 0.07, 0.48}) {
    const auto radii = equal_radii(box, phi, r);
    const double volume = radii.size() * 4.0 / 3.0 * pi * r * r * r;
    EXPECT_NEAR(volume / box.volume(), phi, 0.5001 * volume / radii.size() / box.volume());
  }
}

TEST(Packing, SeveralSizes) {
  PackingRequest request;
  request.where = {{{0, 0, 0}, {0.01, 0.008, 0.006}}, {true, false, true}};
  for (int i = 0; i < 400; ++i) request.radius_m.push_back(i % 4 == 0 ? 0.6e-3 : 0.25e-3);
  expect_packed(request);
}

TEST(Packing, SeededAndReproducible) {
  auto request = slab(0.3, {false, false, true});
  const auto first = pack_spheres(request);
  EXPECT_EQ(first, pack_spheres(request));
  request.seed = 2;
  const auto other = pack_spheres(request);
  double moved = 0;
  for (std::size_t i = 0; i < first.size(); ++i) moved += norm(other[i] - first[i]) / first.size();
  EXPECT_GT(moved, r);
}

TEST(Packing, EvenAlongTheBox) {
  // Each fifth of a 50 mm channel holds a fifth of the spheres: 8 sigma of Poisson numbers would be 25 %.
  PackingRequest request;
  request.where = {{{0, 0, 0}, {0.01, 0.004, 0.05}}, {false, false, true}};
  request.radius_m = equal_radii(request.where.box, 0.43, r);
  std::array<int, 5> count{};
  for (const Vec3& p : pack_spheres(request)) ++count[std::min(4, static_cast<int>(p.z / 0.01))];
  for (const int n : count)
    EXPECT_NEAR(n, request.radius_m.size() / 5.0, 0.02 * request.radius_m.size() / 5.0);
}

TEST(Packing, SmallCounts) {
  auto request = slab(0.3, {false, false, false});
  request.radius_m.clear();
  EXPECT_TRUE(pack_spheres(request).empty());
  request.radius_m = {r};
  expect_packed(request);
  request.where.box = {{0, 0, 0}, {2 * r, 2 * r, 5 * r}};
  request.radius_m = {r, r};
  expect_packed(request);
}

TEST(Packing, RefusesWhatCannotBePacked) {
  try {
    pack_spheres(slab(0.70, {true, true, true}));
    FAIL() << "packed 0.70 at random";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("solid fraction = 0.6997"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("ask for less"), std::string::npos) << error.what();
  }
  auto request = slab(0.3, {false, false, false});
  request.radius_m = {0.0021};
  EXPECT_THROW(pack_spheres(request), InputError);
  request.radius_m = {-1};
  EXPECT_THROW(pack_spheres(request), InputError);
}

}  // namespace
}  // namespace granrad
