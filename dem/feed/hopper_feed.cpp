#include "dem/feed/hopper_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/feed/columns.h"
#include "dem/io/saved_state.h"
#include "dem/packing/packing.h"

namespace granrad {

namespace {

constexpr std::uint64_t drop_stream = 0x686f'7070'0000;
constexpr double default_start_fraction = 0.5, loosest_start_fraction = 0.05;
constexpr double thinnest_layer = 0.02;  ///< of a full layer; fewer spheres are set down one by one
constexpr double most_at_once = 1e8;     ///< spheres; a kilobyte each

}  // namespace

HopperFeed::HopperFeed(const Scene& scene)
    : settings_(scene.feed),
      radius_(0.5 * scene.particle_diameter_m),
      temperature_(scene.particle_temperature_K),
      density_(scene.materials.at(0).density_kg_m3) {
  if (!(radius_ > 0))
    throw InputError(
        advised("particles.diameter_m = 0 (a hopper feed makes its particles)", "give a diameter"));
  const Vec3 size = settings_.fill_region.size();
  if (std::min({size.x, size.y, size.z}) < 4 * radius_)
    throw InputError(
        advised(fmt::format("feed.fill_region = {:g} x {:g} x {:g} m (smaller than two particle diameters)",
                            size.x, size.y, size.z),
                "give the inside of the chute above the bed"));
  const double room = size.x * size.y * size.z / sphere_volume(radius_);
  if (settings_.rate_1_s == 0 && std::min(room, static_cast<double>(settings_.particle_count)) > most_at_once)
    throw InputError(advised(fmt::format("feed.particle_count = {} (more than {:g} spheres at once)",
                                         settings_.particle_count, most_at_once),
                             "give fewer, or pour them at a rate"));
  if (settings_.solid_fraction == 0) settings_.solid_fraction = default_start_fraction;
}

void HopperFeed::add(Bed& bed, const Vec3& position) const {
  bed.add(position, {0, 0, -settings_.velocity_m_s}, radius_, temperature_);
}

void HopperFeed::start(Bed& bed) {
  start_s_ = bed.time_s;
  if (bed.size() > 0 || settings_.rate_1_s > 0) return;
  // A thin layer, or a few spheres, cannot be packed as densely as a bed: then looser, at last one by one.
  for (double fraction = settings_.solid_fraction; fraction > loosest_start_fraction; fraction *= 0.75)
    if (pack(bed, fraction)) return;
  Columns columns(bed, settings_.fill_region, radius_);
  while (static_cast<std::int64_t>(bed.size()) < settings_.particle_count && drop_one(bed, columns)) {
  }
}

/// Fills the region from the bottom up to this solid fraction; false, and nothing is done, when it cannot be reached.
bool HopperFeed::pack(Bed& bed, double solid_fraction) const {
  constexpr double slack = 1.001;  // a single layer has room to breathe
  Box block = settings_.fill_region;
  const double section = block.size().x * block.size().y;
  const double wanted = settings_.particle_count * sphere_volume(radius_) / (solid_fraction * section);
  if (wanted < thinnest_layer * 2 * radius_) return false;
  block.max.z = std::clamp(block.min.z + wanted, block.min.z + 2 * slack * radius_, block.max.z);
  auto radii = equal_radii(block, solid_fraction, radius_);
  radii.resize(std::min<std::size_t>(radii.size(), settings_.particle_count), radius_);
  if (radii.empty()) return false;
  try {
    for (const Vec3& p : pack_spheres({{block, {}}, radii, settings_.seed})) add(bed, p);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

/// Spheres that should come now.
std::int64_t HopperFeed::due(const Bed& bed, const FeedTotals& totals) const {
  const bool poured = settings_.rate_1_s > 0;
  const std::int64_t have = settings_.refill ? static_cast<std::int64_t>(bed.size())
                            : poured         ? totals.inserted
                                             : bed.next_id - 1;
  const std::int64_t missing = std::max<std::int64_t>(0, settings_.particle_count - have);
  if (!poured && settings_.mass_flow_kg_s <= 0) return missing;
  const double per_second =
      poured ? settings_.rate_1_s : settings_.mass_flow_kg_s / (density_ * sphere_volume(radius_));
  // Rounded up by a billionth: a time that is a whole number of intervals may lie just below it.
  const double by_now = per_second * (bed.time_s - start_s_) * (1 + 1e-9);
  const auto allowed = static_cast<std::int64_t>(std::min(by_now, 9e15));
  return std::min(missing, std::max<std::int64_t>(0, allowed - totals.inserted));
}

void HopperFeed::insert_due(Bed& bed, FeedTotals& totals) {
  totals.waiting = due(bed, totals);
  if (totals.waiting == 0) return;
  Columns columns(bed, settings_.fill_region, radius_);
  while (totals.waiting > 0 && drop_one(bed, columns)) --totals.waiting;
}

/// False when none of the places it tries has room.
bool HopperFeed::drop_one(Bed& bed, Columns& columns) const {
  constexpr int places = 20;
  const Box& region = settings_.fill_region;
  const Vec3 free = region.size() - Vec3{2 * radius_, 2 * radius_, 0};
  for (int k = 0; k < places; ++k) {
    const auto u = random_uniform2(settings_.seed, drop_stream, bed.next_id * places + k);
    const double x = region.min.x + radius_ + free.x * u[0], y = region.min.y + radius_ + free.y * u[1];
    const double z = columns.floor_m(bed, x, y) + 1e-3 * radius_;
    if (z > region.max.z - radius_) continue;
    add(bed, {x, y, z});
    columns.add(bed, bed.size() - 1);
    return true;
  }
  return false;
}

void HopperFeed::save(StateBlock& state) const {
  state.reals["hopper_start_s"] = {start_s_};
}

void HopperFeed::load(const StateBlock& state) {
  start_s_ = saved_real(state, "hopper_start_s");
}

}  // namespace granrad
