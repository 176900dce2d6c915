#include "dem/packing/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/packing/packing_relax.h"
#include "dem/packing/packing_shake.h"

namespace granrad {

namespace {

enum Stream : std::uint64_t { size_stream = 0x7061'636b'0000, cell_stream, start_stream, move_stream };

/// Where centres may be: the box less a radius at each wall.
Box centre_box(const PackingBox& where, double radius) {
  Box b = where.box;
  for (int k = 0; k < 3; ++k)
    if (!where.periodic[k]) b.min[k] += radius, b.max[k] -= radius;
  return b;
}

void require_fit(const PackingRequest& request) {
  const double largest = *std::max_element(request.radius_m.begin(), request.radius_m.end());
  const double smallest = *std::min_element(request.radius_m.begin(), request.radius_m.end());
  if (!(smallest > 0) || !std::isfinite(largest))
    throw InputError(fmt::format("packing: radius = {} m (must be positive and finite)", smallest));
  for (int k = 0; k < 3; ++k) {
    const double needed = request.where.periodic[k] ? 4 * largest : 2 * largest;
    if (request.where.box.size()[k] < needed)
      throw InputError(
          fmt::format("packing: box {} = {:g} m (a sphere of radius {:g} m needs {:g} m{}); use a larger box "
                      "or smaller spheres",
                      "xyz"[k], request.where.box.size()[k], largest, needed,
                      request.where.periodic[k] ? " in a periodic direction" : ""));
  }
}

double solid_fraction(const PackingRequest& request) {
  double volume = 0;
  for (const double r : request.radius_m) volume += sphere_volume(r);
  return volume / request.where.box.volume();
}

/// About what a random packing reaches: 0.64, less the loose layer of 0.14 d along each wall (measured
/// between walls 5 d and 12.5 d apart; between walls closer than 4 d packings differ too much to say, hence
/// the crystal's).
double random_close_packing(const PackingBox& where, double radius) {
  double loose = 0;
  for (int k = 0; k < 3; ++k) {
    if (where.periodic[k]) continue;
    const double diameters = where.box.size()[k] / (2 * radius);
    if (diameters < 4) return 0.7405;
    loose += 2 * 0.14 / diameters;
  }
  return 0.64 * (1 - loose);
}

InputError does_not_fit(double fraction, double reachable) {
  return InputError(fmt::format(
      "packing: solid fraction = {:.4g} (spheres still overlap when pushed apart; a random packing of "
      "equal spheres in this box ends near {:.2f}); ask for less than {:.2f}, or settle the spheres under "
      "gravity",
      fraction, reachable, reachable - 0.02));
}

/// 0 .. n-1 in random order (Fisher-Yates).
std::vector<int> shuffled(int n, std::uint64_t seed, std::uint64_t stream) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (int k = n - 1; k > 0; --k) {
    const double u = random_uniform2(seed, stream, k)[0];
    std::swap(order[k], order[static_cast<int>(u * (k + 1))]);
  }
  return order;
}

/// Cells per direction: near-cubic, the fewest that are at least n.
std::array<int, 3> near_cubic_cells(const Vec3& size, int n) {
  const double edge = std::cbrt(size.x * size.y * size.z / n);
  std::array<int, 3> count;
  for (int k = 0; k < 3; ++k) count[k] = std::max(1, static_cast<int>(std::lround(size[k] / edge)));
  const auto longest = std::max_element(&size.x, &size.x + 3) - &size.x;
  while (static_cast<long>(count[0]) * count[1] * count[2] < n) ++count[longest];
  return count;
}

/// One random point in each of n cells of the box, scaled to where centres may be. Neighbours in memory are
/// neighbours in space.
std::vector<Vec3> stratified_points(const PackingBox& where, double radius, int n, std::uint64_t seed) {
  const auto count = near_cubic_cells(where.box.size(), n);
  const Box centres = centre_box(where, radius);
  auto cells = shuffled(count[0] * count[1] * count[2], seed, cell_stream);
  cells.resize(n);
  std::sort(cells.begin(), cells.end());
  std::vector<Vec3> points(n);
  for (int i = 0; i < n; ++i) {
    const int at[3] = {cells[i] % count[0], cells[i] / count[0] % count[1], cells[i] / count[0] / count[1]};
    const auto xy = random_uniform2(seed, start_stream, 2 * i),
               z = random_uniform2(seed, start_stream, 2 * i + 1);
    const double u[3] = {xy[0], xy[1], z[0]};
    for (int k = 0; k < 3; ++k) points[i][k] = centres.min[k] + centres.size()[k] * (at[k] + u[k]) / count[k];
  }
  return points;
}

}  // namespace

std::vector<Vec3> pack_spheres(const PackingRequest& request) {
  const auto n = static_cast<int>(request.radius_m.size());
  if (n == 0) return {};
  require_fit(request);
  const double fraction = solid_fraction(request);
  const auto [smallest, largest] = std::minmax_element(request.radius_m.begin(), request.radius_m.end());
  const double reachable = random_close_packing(request.where, *largest);
  if (*smallest == *largest && fraction > reachable + 0.015) throw does_not_fit(fraction, reachable);

  // The sphere at place k is number which[k]: sizes are mixed, and memory follows space.
  const auto which = shuffled(n, request.seed, size_stream);
  std::vector<double> radius(n);
  for (int k = 0; k < n; ++k) radius[k] = request.radius_m[which[k]];
  auto position = stratified_points(request.where, *largest, n, request.seed);

  const double inflation = std::clamp(std::cbrt(0.98 * reachable / fraction), 1.001, 1.1);
  if (relax_overlaps(request.where, radius, inflation, position) > 0) throw does_not_fit(fraction, reachable);
  const double gap = std::max(1e-3, std::cbrt(reachable / fraction) - 1) * *largest;
  const Vec3 size = request.where.box.size();
  const double longest = 0.5 * std::min({size.x, size.y, size.z}), shortest = std::min(gap, longest);
  shake_spheres(request.where, radius, position,
                {{shortest, shortest, shortest}, {longest, longest, longest}}, request.equilibration_sweeps,
                request.seed, move_stream);

  std::vector<Vec3> result(n);
  for (int k = 0; k < n; ++k) result[which[k]] = position[k];
  return result;
}

std::vector<double> equal_radii(const Box& box, double solid_fraction, double radius_m) {
  return std::vector<double>(std::lround(solid_fraction * box.volume() / sphere_volume(radius_m)), radius_m);
}

}  // namespace granrad
