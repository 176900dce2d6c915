#include "dem/feed/plug_feed.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/base/random.h"
#include "dem/bed/solid_fraction.h"
#include "dem/io/saved_state.h"
#include "dem/packing/packing_shake.h"

namespace granrad {

namespace {

enum Stream : std::uint64_t { velocity_stream = 0x706c'7567'0000, retry_stream, reshuffle_stream };

constexpr double insertion_diameters =
    2.5;  ///< height of the insertion zone: 2 mm for 0.8 mm, as in the paper
constexpr int reshuffle_sweeps = 30;

double section(const Box& box) {
  return box.size().x * box.size().y;
}

/// v = mass flow / (rho phi A); the given speed where no mass flow is.
double plug_speed(const Scene& scene) {
  const FeedSettings& f = scene.feed;
  const double per_speed = scene.materials.at(0).density_kg_m3 * f.solid_fraction * section(scene.box);
  const double speed = f.mass_flow_kg_s > 0 ? f.mass_flow_kg_s / per_speed : f.velocity_m_s;
  if (!(speed > 0))
    throw InputError(
        "feed.mass_flow_kg_s = 0 (a plug flow needs a speed); give mass_flow_kg_s or velocity_m_s");
  return speed;
}

/// Length of the section's outline that is wall.
double walled_perimeter(const Scene& scene) {
  const Vec3 size = scene.box.size();
  return 2 * (scene.periodic[0] ? 0 : size.y) + 2 * (scene.periodic[1] ? 0 : size.x);
}

/// One period of the tape: a whole number of spheres, and the length that gives them the solid fraction.
PackingBox one_period(const Scene& scene, std::size_t count) {
  const double radius = 0.5 * scene.particle_diameter_m;
  PackingBox period{scene.box, {scene.periodic[0], scene.periodic[1], true}};
  period.box.min.z = 0;
  period.box.max.z = count * sphere_volume(radius) / (scene.feed.solid_fraction * section(scene.box));
  return period;
}

}  // namespace

PlugFeed::PlugFeed(const Scene& scene)
    : settings_(scene.feed),
      channel_(scene.box),
      periodic_(scene.periodic),
      radius_(0.5 * scene.particle_diameter_m),
      temperature_(scene.particle_temperature_K),
      frozen_(scene.engine == EngineKind::none) {
  if (!(radius_ > 0))
    throw InputError("particles.diameter_m = 0 (a plug feed makes its particles); give a diameter");
  const auto radii = equal_radii(channel_, settings_.solid_fraction, radius_);
  if (radii.empty())
    throw InputError(
        fmt::format("feed.solid_fraction = {:g} (less than one particle in the box); ask for more",
                    settings_.solid_fraction));
  tape_ = frozen_ ? PackingBox{channel_, periodic_} : one_period(scene, radii.size());
  if (!frozen_) {
    speed_ = plug_speed(scene);
    friction_ = plug_friction({settings_.solid_fraction, settings_.transverse_velocity_std_m_s, 2 * radius_,
                               scene.materials[0].restitution, scene.materials[0].friction,
                               walled_perimeter(scene) / section(channel_)});
    faster_ = friction_.mean_loss_m_s(channel_.size().z / speed_) / speed_;
  }
  column_ = pack_spheres({tape_, radii, settings_.seed});
}

double PlugFeed::insertion_plane_m() const {
  return channel_.max.z + insertion_diameters * 2 * radius_;
}

double PlugFeed::leaves_below_m() const {
  return channel_.min.z - radius_;
}

void PlugFeed::add(Bed& bed, const Vec3& position, double age_s) const {
  const auto transverse = random_normal2(settings_.seed, velocity_stream, bed.next_id);
  const double std =
      settings_.transverse_velocity_std_m_s / (1 + age_s / friction_.cooling_time_s);  // Haff's law
  const double down = speed_ * (1 + faster_) - friction_.loss_m_s(age_s);
  bed.add(position, {std * transverse[0], std * transverse[1], -down}, radius_, temperature_);
}

void PlugFeed::start(Bed& bed) {
  start_s_ = bed.time_s;
  if (bed.size() > 0) return;
  if (frozen_) {
    for (const Vec3& p : column_) bed.add(p, {}, radius_, temperature_);
    return;
  }
  if (!settings_.start_filled) return;
  const double period = tape_.box.max.z, top = insertion_plane_m();
  std::vector<Vec3> filling;
  for (double below = period; below - period < top - leaves_below_m(); below += period)
    for (const Vec3& p : column_)
      if (const double z = top + p.z - below; z >= leaves_below_m()) filling.push_back({p.x, p.y, z});
  for (const Vec3& p : filling) add(bed, p, (top - p.z) / speed_);
}

/// The spheres on the stretch of tape after `used_m_` up to `tape_m` (at most half a period), in order.
std::vector<PlugFeed::Coming> PlugFeed::coming_until(double tape_m) const {
  std::vector<Coming> due;
  const double period = tape_.box.max.z;
  for (const Vec3& p : column_) {
    double tape = p.z + period * std::floor((used_m_ - p.z) / period);
    if (tape < used_m_) tape += period;
    if (tape < tape_m) due.push_back({tape, p.x, p.y});
  }
  std::sort(due.begin(), due.end(), [](const Coming& a, const Coming& b) { return a.tape_m < b.tape_m; });
  return due;
}

/// Shakes the tape except near its used end, where the spheres that have entered touch those to come.
void PlugFeed::reshuffle() {
  const double period = tape_.box.max.z, held = 2.2 * radius_;
  const double end = half_periods_ % 2 == 0 ? 0 : 0.5 * period;
  const auto away_from_end = [&](const Vec3& p) {
    return std::abs(std::remainder(p.z - end, period)) > held;
  };
  const std::vector<double> radii(column_.size(), radius_);
  // Long moves across, short ones along: the number of spheres in a channel's height of tape stays what it
  // is.
  const double gap = 2 * radius_ * std::max(0.01, std::cbrt(0.6 / settings_.solid_fraction) - 1);
  const double along = std::min(gap, 0.2 * radius_);
  const Vec3 half = tape_.box.size() * 0.5;
  const MoveLength length{{std::min(gap, half.x), std::min(gap, half.y), along}, {half.x, half.y, along}};
  shake_spheres(tape_, radii, column_, length, reshuffle_sweeps, settings_.seed,
                reshuffle_stream + half_periods_, away_from_end);
}

/// Adds to the mean of this half period, once the channel has been filled.
void PlugFeed::measure_solid_fraction(const Bed& bed) {
  if (!settings_.start_filled && used_m_ < insertion_plane_m() - leaves_below_m()) return;
  measured_sum_ += solid_fraction(bed, channel_);
  ++measured_;
}

/// Integral control, one correction per half period: newcomers answer over a whole period, which is stable up
/// to a gain of 0.77 (an integrator with a delay of one and a half samples).
void PlugFeed::correct_speed() {
  constexpr double gain = 0.4, most = 0.1;
  if (measured_ > 0) {
    const double excess = measured_sum_ / static_cast<double>(measured_) / settings_.solid_fraction - 1;
    const double one_particle = 1.0 / static_cast<double>(column_.size());
    if (std::abs(excess) > one_particle) faster_ = std::clamp(faster_ + gain * excess, -most, most);
  }
  measured_sum_ = 0, measured_ = 0;
}

void PlugFeed::insert_due(Bed& bed, FeedTotals& totals) {
  reflect_above_channel(bed);
  const double moved = speed_ * (bed.time_s - start_s_), half_period = 0.5 * tape_.box.max.z;
  measure_solid_fraction(bed);
  auto near = particles_near_inlet(bed, moved - used_m_);
  place_waiting(bed, near, totals);
  while (used_m_ < moved) {
    const double next_half = (half_periods_ + 1) * half_period;
    const double until = std::min(moved, next_half);
    for (const Coming& c : coming_until(until))
      place(bed, {c.x, c.y, insertion_plane_m() - (moved - c.tape_m)}, near, totals);
    used_m_ = until;
    if (until == next_half) {
      ++half_periods_;
      correct_speed();
      reshuffle();
    }
  }
}

std::vector<std::size_t> PlugFeed::particles_near_inlet(const Bed& bed, double moved_m) const {
  const double lowest = std::min(channel_.max.z, insertion_plane_m() - moved_m) - 4 * radius_;
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (bed.position_m[i].z > lowest) near.push_back(i);
  return near;
}

void PlugFeed::place(Bed& bed, Vec3 scheduled, std::vector<std::size_t>& near, FeedTotals& totals) {
  Vec3 at = scheduled;
  if (!push_clear(bed, near, at)) {
    ++totals.waiting;
    return;
  }
  if (!(at == scheduled)) ++totals.nudged;
  near.push_back(bed.size());
  add(bed, at, 0);
}

void PlugFeed::place_waiting(Bed& bed, std::vector<std::size_t>& near, FeedTotals& totals) {
  constexpr int tries_per_sphere = 20;
  for (auto left = totals.waiting * tries_per_sphere; left > 0 && totals.waiting > 0; --left) {
    const auto xy = random_uniform2(settings_.seed, retry_stream, 2 * tries_);
    const auto z = random_uniform2(settings_.seed, retry_stream, 2 * tries_ + 1);
    ++tries_;
    const Vec3 size = channel_.size();
    Vec3 at{channel_.min.x + size.x * xy[0], channel_.min.y + size.y * xy[1], 0};
    at.z = insertion_plane_m() - (insertion_plane_m() - channel_.max.z - radius_) * z[0];
    if (!push_clear(bed, near, at)) continue;
    --totals.waiting;
    ++totals.nudged;
    near.push_back(bed.size());
    add(bed, at, 0);
  }
}

/// Moves a sphere out of its neighbours, by their overlaps, until it is free; false when it is not free after
/// a while or would have to move by more than a diameter.
bool PlugFeed::push_clear(const Bed& bed, const std::vector<std::size_t>& near, Vec3& position) const {
  constexpr int most_pushes = 200;
  const double clearance = 1e-6 * radius_;
  const Vec3 wanted = position, period = channel_.size();
  keep_inside(position);
  for (int k = 0; k < most_pushes; ++k) {
    Vec3 push;
    for (const auto j : near) {
      Vec3 d = position - bed.position_m[j];
      for (int axis = 0; axis < 2; ++axis)
        if (periodic_[axis]) d[axis] = std::remainder(d[axis], period[axis]);
      const double touching = radius_ + bed.radius_m[j], distance2 = dot(d, d);
      if (distance2 >= touching * touching) continue;
      const double distance = std::sqrt(distance2);
      const Vec3 away = distance > 0 ? d * (1 / distance) : Vec3{0, 0, 1};
      push += away * (touching - distance + clearance);
    }
    if (push == Vec3{}) return norm(position - wanted) <= 2 * radius_;
    position += push;
    keep_inside(position);
  }
  return false;
}

void PlugFeed::keep_inside(Vec3& p) const {
  for (int k = 0; k < 2; ++k)
    if (!periodic_[k]) p[k] = std::clamp(p[k], channel_.min[k] + radius_, channel_.max[k] - radius_);
  p.z = std::max(p.z, channel_.max.z);
}

void PlugFeed::reflect_above_channel(Bed& bed) const {
  for (std::size_t i = 0; i < bed.size(); ++i) {
    Vec3 &p = bed.position_m[i], &v = bed.velocity_m_s[i];
    if (p.z <= channel_.max.z) continue;
    for (int k = 0; k < 2; ++k) {
      if (periodic_[k]) continue;
      const double low = channel_.min[k] + bed.radius_m[i], high = channel_.max[k] - bed.radius_m[i];
      if (p[k] < low) p[k] = low, v[k] = std::abs(v[k]);
      if (p[k] > high) p[k] = high, v[k] = -std::abs(v[k]);
    }
  }
}

void PlugFeed::save(StateBlock& state) const {
  state.integers["half_periods"] = {half_periods_};
  state.integers["tries"] = {tries_};
  state.integers["measured"] = {measured_};
  state.reals["tape_start_s"] = {start_s_};
  state.reals["tape_used_m"] = {used_m_};
  state.reals["faster"] = {faster_};
  state.reals["measured_sum"] = {measured_sum_};
  auto& column = state.reals["tape_m"];
  for (const Vec3& p : column_) column.insert(column.end(), {p.x, p.y, p.z});
}

void PlugFeed::load(const StateBlock& state) {
  half_periods_ = saved_integer(state, "half_periods");
  tries_ = saved_integer(state, "tries");
  measured_ = saved_integer(state, "measured");
  start_s_ = saved_real(state, "tape_start_s");
  used_m_ = saved_real(state, "tape_used_m");
  faster_ = saved_real(state, "faster");
  measured_sum_ = saved_real(state, "measured_sum");
  const auto& column = saved_reals(state, "tape_m");
  if (column.size() != 3 * column_.size())
    throw InputError(
        advised("checkpoint: plug feed state of another scene (number of particles on the tape differs)",
                "start a new case"));
  for (std::size_t i = 0; i < column_.size(); ++i)
    column_[i] = {column[3 * i], column[3 * i + 1], column[3 * i + 2]};
}

}  // namespace granrad
