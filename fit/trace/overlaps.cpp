#include "fit/trace/overlaps.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "dem/bed/cell_grid.h"

namespace granrad {

namespace {

constexpr std::size_t shown = 10;
constexpr std::int64_t most_pairs = 1000000;  // a wrong unit of length makes everything overlap
constexpr double deep = 0.5;                  // of the smaller radius; beds under load have a few 1e-2
constexpr double same = 1e-6;                 // of the smaller radius: what single precision resolves

void add(Overlaps::Found& found, std::int32_t i, std::int32_t j) {
  if (found.first.size() < shown) found.first.emplace_back(std::min(i, j), std::max(i, j));
  ++found.count;
}

}  // namespace

/// Each particle looks among those of its own binary order of radius and of larger ones, so that cells never
/// hold many.
Overlaps find_overlaps(const Bed& bed, const std::vector<std::int32_t>& particles) {
  std::vector<Vec3> points(bed.size());
  double largest = 0;
  for (const auto i : particles) {
    points[i] = wrapped_into_box(bed, bed.position_m[i]);
    largest = std::max(largest, bed.radius_m[i]);
  }
  const auto order = [&](std::int32_t i) { return std::ilogb(largest / bed.radius_m[i]); };
  std::map<int, std::vector<std::int32_t>> members;
  for (const auto i : particles) members[order(i)].push_back(i);
  Overlaps overlaps;
  for (const auto& [its_order, of_order] : members) {
    const int k = its_order;  // captured below
    const double reach = 2 * std::ldexp(largest, -k);
    const CellGrid grid(points, of_order, reach, bed.box, bed.periodic);
    for (const auto i : particles) {
      if (order(i) < k) continue;
      grid.visit_around(points[i], [&](std::int32_t j, const Vec3& at) {
        if (order(i) == k && j <= i) return;
        const double distance = norm(nearest_image(bed, at - points[i]));
        const double smaller = std::min(bed.radius_m[i], bed.radius_m[j]);
        if (distance <= same * smaller)
          add(overlaps.same_place, i, j);
        else if (distance < bed.radius_m[i] + bed.radius_m[j] - deep * smaller)
          add(overlaps.deep, i, j);
      });
      overlaps.all = overlaps.deep.count + overlaps.same_place.count < most_pairs;
      if (!overlaps.all) return overlaps;
    }
  }
  return overlaps;
}

std::string describe(const Bed& bed, const Overlaps::Found& found, bool all) {
  std::string ids;
  for (const auto& [i, j] : found.first)
    ids += fmt::format("{}{}-{}", ids.empty() ? "" : ", ", bed.id[i], bed.id[j]);
  return fmt::format("{}{} pair{} of particles, ids {}{}", all ? "" : "at least ", found.count,
                     found.count == 1 ? "" : "s", ids, found.count > std::int64_t(shown) ? ", ..." : "");
}

}  // namespace granrad
