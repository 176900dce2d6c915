#include "dem/feed/hopper_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/io/saved_state.h"
#include "dem/packing/packing.h"

namespace granrad {

namespace {

constexpr std::uint64_t drop_stream = 0x686f'7070'0000;
constexpr double default_start_fraction = 0.5;

}  // namespace

HopperFeed::HopperFeed(const Scene& scene)
    : settings_(scene.feed),
      radius_(0.5 * scene.particle_diameter_m),
      temperature_(scene.particle_temperature_K),
      density_(scene.materials.at(0).density_kg_m3) {
  if (!(radius_ > 0))
    throw InputError("particles.diameter_m = 0 (a hopper feed makes its particles); give a diameter");
  const Vec3 size = settings_.fill_region.size();
  if (std::min({size.x, size.y, size.z}) < 4 * radius_)
    throw InputError(
        fmt::format("feed.fill_region = {:g} x {:g} x {:g} m (smaller than two particle diameters); give "
                    "the inside of the chute above the bed",
                    size.x, size.y, size.z));
  if (settings_.solid_fraction == 0) settings_.solid_fraction = default_start_fraction;
}

void HopperFeed::add(Bed& bed, const Vec3& position) const {
  bed.add(position, {0, 0, -settings_.velocity_m_s}, radius_, temperature_);
}

void HopperFeed::start(Bed& bed) {
  start_s_ = bed.time_s;
  if (bed.size() > 0) return;
  Box block = settings_.fill_region;
  const double section = block.size().x * block.size().y;
  const double wanted =
      settings_.particle_count * sphere_volume(radius_) / (settings_.solid_fraction * section);
  block.max.z = std::clamp(block.min.z + wanted, block.min.z + 2 * radius_, block.max.z);
  auto radii = equal_radii(block, settings_.solid_fraction, radius_);
  radii.resize(std::min<std::size_t>(radii.size(), settings_.particle_count), radius_);
  for (const Vec3& p : pack_spheres({{block, {}}, radii, settings_.seed})) add(bed, p);
}

/// Spheres that should come now.
std::int64_t HopperFeed::due(const Bed& bed, const FeedTotals& totals) const {
  const std::int64_t have = settings_.refill ? static_cast<std::int64_t>(bed.size()) : bed.next_id - 1;
  const std::int64_t missing = std::max<std::int64_t>(0, settings_.particle_count - have);
  if (settings_.mass_flow_kg_s <= 0) return missing;
  const double allowed =
      settings_.mass_flow_kg_s * (bed.time_s - start_s_) / (density_ * sphere_volume(radius_));
  return std::min(missing, std::max<std::int64_t>(0, static_cast<std::int64_t>(allowed) - totals.inserted));
}

void HopperFeed::insert_due(Bed& bed, FeedTotals& totals) {
  totals.waiting = due(bed, totals);
  if (totals.waiting == 0) return;
  std::vector<std::size_t> in_region;
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (bed.position_m[i].z > settings_.fill_region.min.z - bed.radius_m[i]) in_region.push_back(i);
  while (totals.waiting > 0 && drop_one(bed, in_region)) --totals.waiting;
}

/// False when none of the places it tries has room.
bool HopperFeed::drop_one(Bed& bed, std::vector<std::size_t>& in_region) const {
  constexpr int places = 20;
  const Box& region = settings_.fill_region;
  const Vec3 room = region.size() - Vec3{2 * radius_, 2 * radius_, 0};
  for (int k = 0; k < places; ++k) {
    const auto u = random_uniform2(settings_.seed, drop_stream, bed.next_id * places + k);
    const double x = region.min.x + radius_ + room.x * u[0], y = region.min.y + radius_ + room.y * u[1];
    const double z = floor_at(bed, in_region, x, y) + 1e-3 * radius_;
    if (z > region.max.z - radius_) continue;
    in_region.push_back(bed.size());
    add(bed, {x, y, z});
    return true;
  }
  return false;
}

/// Lowest height from which a sphere at (x, y) sees no other above or beside it.
double HopperFeed::floor_at(const Bed& bed, const std::vector<std::size_t>& in_region, double x,
                            double y) const {
  double floor = settings_.fill_region.min.z + radius_;
  for (const auto j : in_region) {
    const double dx = bed.position_m[j].x - x, dy = bed.position_m[j].y - y,
                 touching = radius_ + bed.radius_m[j];
    const double below = touching * touching - dx * dx - dy * dy;
    if (below > 0) floor = std::max(floor, bed.position_m[j].z + std::sqrt(below));
  }
  return floor;
}

void HopperFeed::save(StateBlock& state) const {
  state.reals["hopper_start_s"] = {start_s_};
}

void HopperFeed::load(const StateBlock& state) {
  start_s_ = saved_real(state, "hopper_start_s");
}

}  // namespace granrad
