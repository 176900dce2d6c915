#include "tests/bench/trace_case.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numeric>
#include <optional>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/near_pairs.h"
#include "dem/packing/packing.h"

namespace granrad::trace_bench {

double peak_MiB(bool reset) {
  if (reset) std::ofstream("/proc/self/clear_refs") << "5";
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kB = 0;
      status >> kB;
      return kB / 1024;
    }
  return 0;
}

std::string Case::name() const {
  return fmt::format("trace/N{}/phi{:.2f}", count, solid_fraction);
}

namespace {

/// Spheres in a box 1 : 0.8 : 1.6 with walls. Small boxes cannot hold the densest packings: the fraction is
/// lowered until the spheres fit, and the one reached is reported.
std::optional<Enclosure> walled_bed(std::size_t count, double fraction) {
  const double volume = static_cast<double>(count) * 4.0 / 3 * pi * std::pow(radius, 3) / fraction;
  const double s = std::cbrt(volume / 1.28);
  PackingRequest request;
  request.where.box = {{0, 0, 0}, {s, 0.8 * s, 1.6 * s}};
  request.radius_m.assign(count, radius);
  request.equilibration_sweeps = 50;
  Enclosure bed;
  try {
    bed.centre_m = pack_spheres(request);
  } catch (const InputError&) {
    return {};
  }
  bed.box = request.where.box;
  return bed;
}

/// `copies`^3 copies of a periodic packing, in walls one radius away from its centres: quick to build.
Enclosure repeated_bed(std::size_t count, double fraction, int copies) {
  const std::size_t part = count / static_cast<std::size_t>(copies * copies * copies);
  const double volume = static_cast<double>(part) * 4.0 / 3 * pi * std::pow(radius, 3) / fraction;
  const double s = std::cbrt(volume / 1.28);
  PackingRequest request;
  request.where = {{{0, 0, 0}, {s, 0.8 * s, 1.6 * s}}, {true, true, true}};
  request.radius_m.assign(part, radius);
  request.equilibration_sweeps = 5;
  const Vec3 period = request.where.box.max, margin{radius, radius, radius};
  const std::vector<Vec3> centres = pack_spheres(request);
  Enclosure bed;
  for (int a = 0; a < copies; ++a)
    for (int b = 0; b < copies; ++b)
      for (int c = 0; c < copies; ++c)
        for (const Vec3& p : centres)
          bed.centre_m.push_back(p + Vec3{a * period.x, b * period.y, c * period.z});
  bed.box = {-margin, copies * period + margin};
  return bed;
}

}  // namespace

Case make_case(std::size_t count, double fraction) {
  constexpr std::size_t most_packed = 20000;
  Case c{count, fraction, {}, {}};
  if (count <= most_packed) {
    for (;; c.solid_fraction -= 0.02)
      if (auto bed = walled_bed(count, c.solid_fraction)) {
        c.bed = std::move(*bed);
        break;
      }
  } else {
    int copies = 2;
    while (count / static_cast<std::size_t>(copies * copies * copies) > most_packed) copies *= 2;
    c.bed = repeated_bed(count, fraction, copies);
    c.count = c.bed.centre_m.size();
  }
  c.bed.radius_m.assign(c.count, radius);
  for (std::size_t i = 0; i < c.count; ++i) c.bed.particle.push_back(static_cast<std::int32_t>(i));
  for (const Wall& w : box_walls(c.bed.box)) c.bed.walls.push_back(w);
  Bed bed;
  bed.materials.emplace_back();
  for (const Vec3& p : c.bed.centre_m) bed.add(p, {}, radius, 300);
  for (const NearPair& p : near_pairs(bed, 0.2 * radius).particles) c.near.emplace_back(p.i, p.j);
  return c;
}

namespace {

double rms_error(const std::vector<double>& a, const std::vector<double>& b, double scale) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]) / 2;
  return a.empty() || scale == 0 ? NAN : std::sqrt(sum / static_cast<double>(a.size())) / scale;
}

double rms(const std::vector<double>& a) {
  return a.empty() ? 0
                   : std::sqrt(std::inner_product(a.begin(), a.end(), a.begin(), 0.0) /
                               static_cast<double>(a.size()));
}

double mean(const std::vector<double>& a) {
  return a.empty() ? 0 : std::accumulate(a.begin(), a.end(), 0.0) / static_cast<double>(a.size());
}

}  // namespace

Errors compare(const Result& a, const Result& b) {
  const double total_a = mean(a.flux), total_b = mean(b.flux);
  return {rms_error(a.near, b.near, mean(a.near)), rms_error(a.wall_sum, b.wall_sum, mean(a.wall_sum)),
          rms_error(a.flux, b.flux, rms(a.flux)), std::abs(total_a - total_b) / std::sqrt(2.0) / total_a};
}

}  // namespace granrad::trace_bench
