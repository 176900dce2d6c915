#include "dem/native/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad::native {
namespace {

double power_of_two_below(double x) {
  return std::exp2(std::floor(std::log2(x)));
}

/// Contacts that fit around a sphere, each with the force of its smaller body: those of its own size, or more and
/// weaker ones of smaller spheres (force ~ radius^2 or less, number ~ 1/radius^2).
constexpr double contacts_around = 16;

/// A weight worth fewer units than this would be rounded by a thousandth in every contact that bears it.
constexpr double least_weight_units = 500;

/// The fixed-point scales of spheres of one radius. Their largest force is that of a contact at the deepest
/// overlap between bodies that move through each other as fast as such a sphere may move at all.
FixedScales scales_of(const Bed& bed, double radius, double step_s, Precision precision) {
  double wall_speed = 0;
  for (const auto& w : bed.walls) wall_speed = std::max(wall_speed, norm(w.velocity_m_s));
  const double speed = 2 * std::sqrt(3.0) * fastest_step * radius / step_s + wall_speed;
  double force = 0, moment_ratio = 1;
  for (const auto& material : bed.materials) {
    if (material.youngs_modulus_Pa <= 0) continue;  // a material no particle uses
    const double mass = 4.0 / 3.0 * pi * std::pow(radius, 3) * material.density_kg_m3;
    const ContactBody body{&material, radius, mass};
    const auto law = ContactLaw::coefficients(BodiesInContact::with_wall(body));
    force = std::max(force, ContactLaw::force_bound(law, deepest_overlap * radius, speed));
    moment_ratio = std::max(moment_ratio, ContactLaw::moment_ratio(material));
  }
  double units = 0x1p62 / (force * contacts_around);
  if (precision == Precision::mixed) units = std::min(units, 0x1p50 / force);
  FixedScales scales;
  scales.force = power_of_two_below(units);
  scales.torque = power_of_two_below(scales.force / (2 * moment_ratio * radius));
  return scales;
}

void fill_scales(const Bed& bed, Rows& rows, double gravity, double step_s, Precision precision) {
  std::map<double, FixedScales> known;
  rows.scales.resize(rows.radius.size());
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const auto [at, added] = known.try_emplace(rows.radius[i]);
    if (added) at->second = scales_of(bed, rows.radius[i], step_s, precision);
    rows.scales[i] = at->second;
    const double units = rows.mass[i] * gravity * rows.scales[i].force;
    if (gravity == 0 || units >= least_weight_units) continue;
    throw InputError(advised(
        fmt::format(
            "particle {}: its weight of {:.3g} N is below {:.1g} of its largest contact force, too small "
            "to be summed beside it",
            bed.id[rows.bed_index[i]], rows.mass[i] * gravity, least_weight_units / 0x1p58),
        precision == Precision::mixed ? "use dem.precision = \"double\", or a lower Young's modulus"
                                      : "use a lower Young's modulus or a larger step"));
  }
}

void fill_kicks(Rows& rows, double step_s, Model& m) {
  const auto kick_of = [&](std::int64_t i) {
    const double push = step_s / rows.mass[i] / rows.scales[i].force;
    const double turn =
        step_s / (0.4 * rows.mass[i] * rows.radius[i] * rows.radius[i]) / rows.scales[i].torque;
    return std::array<double, 8>{push, push, push, 0, turn, turn, turn, 0};
  };
  m.kick_row = kick_of(0);
  if (rows.uniform) return;
  rows.kick.resize(8 * rows.count);
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const auto kick = kick_of(i);
    std::copy(kick.begin(), kick.end(), rows.kick.begin() + 8 * i);
  }
}

}  // namespace

Model make_model(const Bed& bed, Rows& rows, const Periods& periods, const Vec3& gravity, double step_s,
                 Precision precision, bool records_touches) {
  Model m;
  StepConstants& c = m.constants;
  c.step_s = step_s;
  c.periodic = periods.any;
  for (int a = 0; a < 3; ++a) c.period[a] = periods.length[a], c.inverse_period[a] = periods.inverse[a];
  m.move.half_step_s = 0.5 * step_s;
  for (int a = 0; a < 3; ++a) m.move.gravity_kick[a] = gravity[a] * step_s;
  if (rows.count == 0) return m;
  m.largest_radius = *std::max_element(rows.radius.begin(), rows.radius.begin() + rows.count);
  m.largest_force_units = precision == Precision::mixed ? 0x1p51 : 0x1p62 / contacts_around;
  if (records_touches) c.touch_units = power_of_two_below(0x1p29 / m.largest_radius);
  fill_scales(bed, rows, norm(gravity), step_s, precision);
  fill_kicks(rows, step_s, m);
  const ContactBody body{&bed.materials[rows.material[0]], rows.radius[0], rows.mass[0]};
  c.radius = rows.radius[0];
  c.scales = rows.scales[0];
  c.pair = ContactLaw::coefficients(BodiesInContact::particles(body, body));
  c.wall = ContactLaw::coefficients(BodiesInContact::with_wall(body));
  return m;
}

}  // namespace granrad::native
