#include "dem/native/model.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
namespace granrad::native {
namespace {

double power_of_two_below(double x) {
  return std::exp2(std::floor(std::log2(x)));
}

}  // namespace

Model make_model(const Bed& bed, Rows& rows, const Periods& periods, const Vec3& gravity, double step_s,
                 Precision precision) {
  Model m;
  StepConstants& c = m.constants;
  c.step_s = step_s;
  c.periodic = periods.any;
  for (int a = 0; a < 3; ++a) c.period[a] = periods.length[a], c.inverse_period[a] = periods.inverse[a];
  m.move.half_step_s = 0.5 * step_s;
  for (int a = 0; a < 3; ++a) m.move.gravity_kick[a] = gravity[a] * step_s;
  c.force_scale = c.torque_scale = 1;
  if (rows.count == 0) return m;

  const auto [least, most] = std::minmax_element(rows.radius.begin(), rows.radius.begin() + rows.count);
  m.smallest_radius = *least, m.largest_radius = *most;
  double wall_speed = 0;
  for (const auto& w : bed.walls) wall_speed = std::max(wall_speed, norm(w.velocity_m_s));
  const double speed = 2 * std::sqrt(3.0) * fastest_step * m.largest_radius / step_s + wall_speed;
  double force = 0, moment_ratio = 1;
  for (const auto& material : bed.materials) {
    if (material.youngs_modulus_Pa <= 0) continue;  // a material no particle uses
    const double mass = 4.0 / 3.0 * pi * std::pow(m.largest_radius, 3) * material.density_kg_m3;
    const ContactBody body{&material, m.largest_radius, mass};
    const auto law = ContactLaw::coefficients(BodiesInContact::with_wall(body));
    force = std::max(force, ContactLaw::force_bound(law, deepest_overlap * m.largest_radius, speed));
    moment_ratio = std::max(moment_ratio, ContactLaw::moment_ratio(material));
  }
  const double size_ratio = m.largest_radius / m.smallest_radius;
  const double neighbours = std::max(16.0, 4 * (1 + size_ratio) * (1 + size_ratio));
  double units = 0x1p62 / (force * neighbours);
  if (precision == Precision::mixed) units = std::min(units, 0x1p50 / force);
  c.force_scale = power_of_two_below(units);
  c.torque_scale = power_of_two_below(c.force_scale / (2 * moment_ratio * m.largest_radius));

  const auto kick_of = [&](std::int64_t i) {
    const double push = step_s / rows.mass[i] / c.force_scale;
    const double turn = step_s / (0.4 * rows.mass[i] * rows.radius[i] * rows.radius[i]) / c.torque_scale;
    return std::array<double, 8>{push, push, push, 0, turn, turn, turn, 0};
  };
  m.kick_row = kick_of(0);
  c.radius = rows.radius[0];
  const ContactBody body{&bed.materials[rows.material[0]], rows.radius[0], rows.mass[0]};
  c.pair = ContactLaw::coefficients(BodiesInContact::particles(body, body));
  c.wall = ContactLaw::coefficients(BodiesInContact::with_wall(body));
  if (rows.uniform) return m;
  rows.kick.resize(8 * rows.count);
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const auto kick = kick_of(i);
    std::copy(kick.begin(), kick.end(), rows.kick.begin() + 8 * i);
  }
  return m;
}

}  // namespace granrad::native
