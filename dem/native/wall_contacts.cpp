#include "dem/native/wall_contacts.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"

namespace granrad::native {
namespace {

using Touch = WallSurface::Touch;

/// Whether facet f is closer than reach to p or, where p is near a periodic border, to its image across it.
bool is_close(const WallSurface& surface, const Periods& periods, std::int32_t f, const Vec3& p,
              double reach) {
  if (std::abs(surface.height(f, p)) < reach && surface.distance(f, p) < reach) return true;
  if (!periods.any) return false;
  Vec3 low, high;
  for (int a = 0; a < 3; ++a) {
    const double above = p[a] - periods.origin[a], length = periods.length[a];
    if (length == 0) continue;
    if (above < reach) high[a] = length;
    if (length - above < reach) low[a] = -length;
  }
  for (const double x : {low.x, 0.0, high.x})
    for (const double y : {low.y, 0.0, high.y})
      for (const double z : {low.z, 0.0, high.z}) {
        const Vec3 image = p + Vec3{x, y, z};
        if (!(image == p) && std::abs(surface.height(f, image)) < reach && surface.distance(f, image) < reach)
          return true;
      }
  return false;
}

}  // namespace

void WallContacts::find_near(const WallSurface& surface, const Grid& grid, const Rows& rows,
                             const Periods& periods, Range range, const std::vector<double>& skin_m,
                             double gap_m, const Vec3& drift, double slack_m) {
  near_.clear();
  double largest = 0;
  for (auto i = range.begin; i < range.end; ++i) largest = std::max(largest, rows.radius[i] + skin_m[i]);
  const double margin = largest + gap_m + slack_m;
  const Vec3 grow{margin, margin, margin};
  for (std::int32_t f = 0; f < surface.facet_count(); ++f) {
    if (!surface.stands(f)) continue;
    const Box box{surface.bounds(f).min - grow - drift, surface.bounds(f).max + grow - drift};
    grid.ranges_in(box, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = std::max(begin, range.begin); i < std::min(end, range.end); ++i) {
        const Vec3 p = periods.wrapped(rows.position_of(i));
        const double reach = rows.radius[i] + skin_m[i] + gap_m;
        if (is_close(surface, periods, f, p, reach)) near_.push_back({static_cast<std::int32_t>(i), f});
      }
    });
  }
  std::sort(near_.begin(), near_.end(),
            [](const Near& a, const Near& b) { return a.row != b.row ? a.row < b.row : a.facet < b.facet; });
}

bool WallContacts::acts_as_planes(const WallSurface& surface, const Periods& periods, const Vec3& p,
                                  double margin_m, const std::vector<std::int32_t>& facets) const {
  for (const auto f : facets) {
    for (int a = 0; a < 3; ++a)  // planes know no images
      if (periods.length[a] > 0 && surface.plane_rows()[8 * f + 4 + a] != 0) return false;
    if (!surface.clear_of_sides(f, p, margin_m)) return false;
    const bool inside = std::any_of(facets.begin(), facets.end(), [&](auto g) {
      return surface.group(g) == surface.group(f) && surface.foot_inside(g, p);
    });
    if (!inside) return false;
  }
  return true;
}

void WallContacts::add_plane(std::int32_t row, std::int32_t facet, std::int64_t feature,
                             std::vector<WallMemory>& kept) {
  rows_.push_back(row), facets_.push_back(facet), features_.push_back(feature);
  Vec3 s;
  const auto at =
      std::lower_bound(kept.begin(), kept.end(), row, [](const WallMemory& m, auto r) { return m.row < r; });
  for (auto m = at; m != kept.end() && m->row == row; ++m)
    if (m->feature == feature) s = m->displacement;
  for (int a = 0; a < 3; ++a) displacement_[a].push_back(s[a]);
}

void WallContacts::finish_planes(const Rows& rows, const std::vector<Material>& materials,
                                 std::int32_t idle_row, std::int32_t idle_plane) {
  plane_count_ = static_cast<std::int64_t>(rows_.size());
  while (rows_.size() % 8) {
    rows_.push_back(idle_row), facets_.push_back(idle_plane), features_.push_back(-1);
    for (auto& column : displacement_) column.push_back(0);
  }
  const auto padded = rows_.size();
  varied_.clear();
  if (rows.uniform) return;
  varied_.resize(static_cast<std::int64_t>(padded));
  for (std::int64_t k = 0; k < plane_count_; ++k) {
    const auto i = rows_[k];
    const ContactBody body{&materials[rows.material[i]], rows.radius[i], rows.mass[i]};
    const ContactColumns::Side side{body.radius_m, rows.scales[i]};
    varied_.put(k, side, side, ContactLaw::coefficients(BodiesInContact::with_wall(body)));
  }
}

void WallContacts::find_closing_speeds(const WallSurface& surface, const Rows& rows, const Periods& periods,
                                       double life_s, std::vector<double>& closing) const {
  constexpr double rebound = 2;
  for (const auto& [row, facet] : near_) {
    const Vec3 v = rows.velocity_of(row) - surface.velocity(facet);
    const double* plane = surface.plane_rows() + 8 * facet;
    const double speed = rebound * std::abs(dot(v, Vec3{plane[4], plane[5], plane[6]}));
    if (speed <= closing[row] || !surface.stands(facet)) continue;
    const double reach = rows.position[4 * row + 3] + norm(v) * life_s;
    if (is_close(surface, periods, facet, periods.wrapped(rows.position_of(row)), reach))
      closing[row] = speed;
  }
}

void WallContacts::refresh(const WallSurface& surface, const Rows& rows, const Periods& periods,
                           const std::vector<Material>& materials, const StepConstants& constants,
                           std::int32_t idle_row) {
  const double life_s = constants.life_s;
  for (std::int64_t k = 0; k < plane_count_ && !touch_sum_.empty(); ++k)
    if (touch_sum_[k] != 0) left_.push_back({rows_[k], surface.wall(facets_[k]), touch_sum_[k]});
  std::vector<WallMemory> kept = restored_ ? std::move(memories_) : collect();
  restored_ = false;
  memories_.clear(), borders_.clear(), border_facets_.clear();
  rows_.clear(), facets_.clear(), features_.clear();
  for (auto& column : displacement_) column.clear();
  std::vector<std::int32_t> close;
  for (std::size_t k = 0; k < near_.size();) {
    const auto row = near_[k].row;
    const Vec3 p = periods.wrapped(rows.position_of(row));
    const double reach = rows.position[4 * row + 3] + norm(rows.velocity_of(row)) * life_s,
                 margin = reach - rows.radius[row];
    close.clear();
    for (; k < near_.size() && near_[k].row == row; ++k)
      if (surface.stands(near_[k].facet) && is_close(surface, periods, near_[k].facet, p, reach))
        close.push_back(near_[k].facet);
    if (close.empty()) continue;
    if (acts_as_planes(surface, periods, p, margin, close)) {
      // Faces back to back, or one over the other, are one plane.
      const auto first = facets_.size();
      for (const auto f : close) {
        const auto same = [&](std::int32_t g) { return surface.in_one_plane(f, g); };
        if (surface.foot_inside(f, p) && std::none_of(facets_.begin() + first, facets_.end(), same))
          add_plane(row, f, surface.group(f), kept);
      }
      continue;
    }
    Border border{row, border_facets_.size(), border_facets_.size() + close.size(), {}};
    border_facets_.insert(border_facets_.end(), close.begin(), close.end());
    for (const auto& m : kept)
      if (m.row == row) border.springs.push_back({m.feature, m.displacement});
    borders_.push_back(std::move(border));
  }
  finish_planes(rows, materials, idle_row, surface.facet_count());
  touch_sum_.assign(constants.touch_units > 0 ? rows_.size() : 0, 0.0);
}

WorstContact WallContacts::add_forces(const Kernels& kernels, const WallSurface& surface, Rows& rows,
                                      const Periods& periods, const StepConstants& constants,
                                      const std::vector<Material>& materials) {
  WorstContact worst;
  if (plane_count_ > 0) {
    const auto padded = static_cast<std::int64_t>(rows_.size());
    ContactView view{rows_.data(), facets_.data(), padded, {}, {}, varied_.view(0), nullptr};
    if (!touch_sum_.empty()) view.touch_sum = touch_sum_.data();
    for (int a = 0; a < 3; ++a) view.displacement[a] = displacement_[a].data();
    worst =
        kernels.plane_contacts(rows.view(), view, {surface.plane_rows(), surface.velocity_rows()}, constants);
  }
  for (auto& border : borders_)
    worst.include(border_forces(surface, rows, periods, constants, materials, border));
  return worst;
}

/// A spring stays with its feature; what rolled from one feature to the next takes its spring along.
std::vector<WallContacts::Spring> WallContacts::carry_springs(const WallSurface& surface,
                                                              const std::vector<Touch>& touches,
                                                              std::vector<Spring> old) {
  const auto take = [&](auto matches) {
    Vec3 s;
    const auto at = std::find_if(old.begin(), old.end(), matches);
    if (at != old.end()) s = at->displacement, old.erase(at);
    return s;
  };
  const auto known = [&](std::int64_t feature) {
    return std::any_of(old.begin(), old.end(), [&](const Spring& s) { return s.feature == feature; });
  };
  std::vector<Spring> springs;
  std::vector<bool> is_new;
  for (const auto& t : touches) {
    is_new.push_back(!known(t.feature));
    springs.push_back({t.feature, take([&](const Spring& s) { return s.feature == t.feature; })});
  }
  for (std::size_t k = 0; k < touches.size(); ++k)
    if (is_new[k])
      springs[k].displacement =
          take([&](const Spring& s) { return surface.adjacent(s.feature, touches[k].feature); });
  return springs;
}

/// Adds the force of one touch, with its spring.
WorstContact WallContacts::add_touch(const WallSurface& surface, Rows& rows, std::int32_t i,
                                     const LawCoefficients& law, const StepConstants& constants,
                                     const Touch& t, Vec3& spring) {
  const double radius = rows.radius[i];
  const Vec3 u = rows.velocity_of(i) - surface.velocity(t.facet), w = rows.spin_of(i);
  ContactState<ScalarPack> c;
  c.overlap = radius - t.distance_m;
  const double arm = radius - 0.5 * c.overlap;
  for (int a = 0; a < 3; ++a) {
    c.normal[a] = t.normal[a], c.velocity[a] = u[a], c.arm_spin[a] = arm * w[a];
    c.displacement[a] = spring[a];
  }
  const auto result = ContactLaw::force<ScalarPack>(law, constants.step_s, c);
  double torque[3], roll[3];
  for (int a = 0; a < 3; ++a) torque[a] = -arm * result.moment[a];
  if (!rows.uniform) {
    const double spin[3] = {w.x, w.y, w.z};
    ContactLaw::rolling_torque<ScalarPack>(law, result.elastic, c.normal, spin, roll);
    for (int a = 0; a < 3; ++a) torque[a] += roll[a];
  }
  const FixedScales scales = rows.scales[i];
  WorstContact worst{c.overlap - deepest_overlap * radius, 0};
  for (int a = 0; a < 3; ++a) {
    worst.include({-1, std::abs(result.force[a]) * scales.force});
    rows.force[8 * i + a] += ScalarPack::to_fixed(result.force[a] * scales.force);
    rows.force[8 * i + 4 + a] += ScalarPack::to_fixed(torque[a] * scales.torque);
    spring[a] = c.displacement[a];
  }
  return worst;
}

/// Few rows are at edges, but each at every step: what belongs together is added up where it was put last.
void WallContacts::record_touch(const StepConstants& constants, std::int32_t row, std::int32_t wall,
                                double radius, double distance) {
  const double area = pi * std::max((radius - distance) * (radius + distance), 0.0);
  const double units = ScalarPack::round(std::sqrt(area) * constants.touch_units);
  const auto same = [&](const TouchSum& t) { return t.first == row && t.second == wall; };
  const auto at = std::find_if(left_.rbegin(), left_.rend(), same);
  if (at != left_.rend())
    at->units += units;
  else
    left_.push_back({row, wall, units});
}

WorstContact WallContacts::border_forces(const WallSurface& surface, Rows& rows, const Periods& periods,
                                         const StepConstants& constants,
                                         const std::vector<Material>& materials, Border& border) {
  const auto i = border.row;
  const Vec3 p = periods.wrapped(rows.position_of(i));
  const auto touches =
      surface.distinct_touches(border_facets_.data() + border.facets_begin,
                               border_facets_.data() + border.facets_end, p, rows.radius[i], rows.radius[i]);
  if (touches.empty()) {
    border.springs.clear();
    return {};
  }
  const ContactBody body{&materials[rows.material[i]], rows.radius[i], rows.mass[i]};
  const auto law = rows.uniform ? constants.wall : ContactLaw::coefficients(BodiesInContact::with_wall(body));
  auto springs = carry_springs(surface, touches, std::move(border.springs));
  border.springs.clear();
  WorstContact worst;
  for (std::size_t k = 0; k < touches.size(); ++k) {
    auto& s = springs[k];
    if (constants.touch_units > 0)
      record_touch(constants, i, surface.wall(touches[k].facet), rows.radius[i], touches[k].distance_m);
    worst.include(add_touch(surface, rows, i, law, constants, touches[k], s.displacement));
    if (!(s.displacement == Vec3{})) border.springs.push_back(s);
  }
  return worst;
}

std::vector<WallMemory> WallContacts::collect() const {
  if (restored_) return memories_;
  std::vector<WallMemory> all;
  for (std::int64_t k = 0; k < plane_count_; ++k) {
    const Vec3 s{displacement_[0][k], displacement_[1][k], displacement_[2][k]};
    if (!(s == Vec3{})) all.push_back({rows_[k], features_[k], s});
  }
  for (const auto& b : borders_)
    for (const auto& s : b.springs) all.push_back({b.row, s.feature, s.displacement});
  std::sort(all.begin(), all.end(), [](const WallMemory& a, const WallMemory& b) {
    return a.row != b.row ? a.row < b.row : a.feature < b.feature;
  });
  return all;
}

}  // namespace granrad::native
