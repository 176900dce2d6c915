#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/bed/near_pairs.h"
#include "raytrace/facets.h"
#include "raytrace/rays/view_factors.h"

namespace granrad {

namespace {

double cap_volume(double r, double height) {
  return pi * height * height * (r - height / 3);
}

/// Common volume of two spheres whose centres are d apart.
double lens_volume(double a, double b, double d) {
  if (d >= a + b) return 0;
  if (d <= std::abs(a - b)) return sphere_volume(std::min(a, b));
  const double from_a = (d * d + a * a - b * b) / (2 * d);
  return cap_volume(a, a - from_a) + cap_volume(b, b - (d - from_a));
}

/// Volume between spheres and walls; 0 when the walls do not close. Triple overlaps are neglected.
double void_volume(const Enclosure& enclosure) {
  double volume = 0;
  if (enclosure.periodic == std::array<bool, 3>{true, true, true}) {
    volume = enclosure.box.volume();
  } else {
    if (enclosure.walls.empty() || enclosure.walls[0].vertices.empty()) return 0;
    Facets facets(0);
    for (std::size_t w = 0; w < enclosure.walls.size(); ++w)
      facets.add(enclosure.walls[w], static_cast<std::int32_t>(w), enclosure.walls[0].vertices[0], 1);
    const auto enclosed = facets.enclosed_volume(enclosure.periodic);
    if (!enclosed) return 0;
    volume = *enclosed;
  }
  Bed bed;
  bed.materials.emplace_back();
  bed.periodic = enclosure.periodic;
  bed.box = enclosure.box;
  bed.walls = enclosure.walls;
  for (Wall& wall : bed.walls) wall.contact = true;
  for (std::size_t i = 0; i < enclosure.sphere_count(); ++i) {
    volume -= sphere_volume(enclosure.radius_m[i]);
    bed.add(enclosure.centre_m[i], {}, enclosure.radius_m[i], 0);
  }
  if (bed.size() == 0) return volume;
  const NearPairs near = near_pairs(bed, 0);
  for (const NearPair& p : near.particles)
    volume += lens_volume(bed.radius_m[static_cast<std::size_t>(p.i)],
                          bed.radius_m[static_cast<std::size_t>(p.j)], p.distance_m);
  for (const NearWall& w : near.walls) {
    const double r = bed.radius_m[static_cast<std::size_t>(w.i)];
    volume += cap_volume(r, std::max(0.0, r - w.distance_m));
  }
  return volume;
}

double hits_in_row(const HitCounts& counts, std::size_t i) {
  return static_cast<double>(std::accumulate(counts.hits.begin() + counts.pattern.row_begin[i],
                                             counts.hits.begin() + counts.pattern.row_begin[i + 1],
                                             std::int64_t{0}));
}

std::int64_t open_hits(const HitCounts& counts) {
  const auto open = static_cast<std::int32_t>(counts.launched.size()) - 1;
  std::int64_t hits = 0;
  for (std::size_t k = 0; k < counts.hits.size(); ++k)
    if (counts.pattern.column[k] == open) hits += counts.hits[k];
  return hits;
}

/// Pairs compared for reciprocity: both ends sent rays, and one of them hit.
std::int64_t compared_pairs(const HitCounts& counts) {
  std::int64_t entries = 0;
  for (std::size_t i = 0; i < counts.launched.size(); ++i)
    for (std::int64_t k = counts.pattern.row_begin[i]; k < counts.pattern.row_begin[i + 1]; ++k)
      entries +=
          counts.launched[static_cast<std::size_t>(counts.pattern.column[static_cast<std::size_t>(k)])] > 0;
  return std::max<std::int64_t>(1, entries / 2);
}

}  // namespace

SelfCheck self_check(const Enclosure& enclosure, const HitCounts& counts, double tolerated_leaks) {
  SelfCheck check;
  check.leaked = counts.leaked;
  double lost = 0, launched = 0;
  for (std::size_t i = 0; i < counts.launched.size(); ++i) {
    launched += static_cast<double>(counts.launched[i]);
    lost += static_cast<double>(counts.launched[i]) - hits_in_row(counts, i);
  }
  check.closure_defect = launched > 0 ? std::abs(lost) / launched : 0;
  check.reciprocity_chi2 = reciprocity_chi2(one_way_estimate(counts));
  const auto area = surface_areas(enclosure);
  const bool known = counts.area_m2 == area && open_hits(counts) == 0 && counts.mean_chord_m > 0;
  const double volume = known ? void_volume(enclosure) : 0;
  double chord_error = 0;
  if (volume > 0) {
    const double expected = 4 * volume / std::accumulate(area.begin(), area.end(), 0.0);
    check.mean_chord_ratio = counts.mean_chord_m / expected;
    chord_error = counts.mean_chord_error_m / expected;
  }

  constexpr double sigmas = 6,
                   model_error = 2e-3;  // triple overlaps and caps of meshes are not in the volume
  const auto fail = [&](const std::string& what) {
    check.failed += (check.failed.empty() ? "" : "; ") + what;
  };
  if (static_cast<double>(counts.leaked) > tolerated_leaks * launched)
    fail(fmt::format(
        "{} rays leaked through walls (they met the back of one: normals must point to the particles)",
        counts.leaked));
  if (counts.thinning_unit == 1 && counts.leaked == 0 && check.closure_defect > 0)
    fail(fmt::format("a fraction {:.2e} of the rays was lost", check.closure_defect));
  const double pairs = static_cast<double>(compared_pairs(counts));
  // Wilson and Hilferty: the cube root of chi^2 over n is normal, about 1 - 2 / 9 n with variance 2 / 9 n.
  const double root = 1 - 2 / (9 * pairs) + sigmas * std::sqrt(2 / (9 * pairs));
  constexpr double counts_are_few = 0.2;  // beside a normal law
  if (check.reciprocity_chi2 > counts_are_few + root * root * root)
    fail(fmt::format("reciprocity chi^2 = {:.3f} over {:.0f} pairs", check.reciprocity_chi2, pairs));
  if (volume > 0 && std::abs(check.mean_chord_ratio - 1) > sigmas * chord_error + model_error)
    fail(fmt::format("mean free path is {:.5f} of 4 V / S", check.mean_chord_ratio));
  return check;
}

}  // namespace granrad
