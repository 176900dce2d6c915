#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "dem/liggghts/deck.h"
#include "dem/liggghts/plugin.h"
#include "dem/liggghts/session.h"
#include "dem/step_clock.h"

namespace granrad {
namespace liggghts {
namespace {

void check_finite(const Spheres& s, const Bed& bed) {
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (!is_finite(s.position_m[i]) || !is_finite(s.velocity_m_s[i]) ||
        !is_finite(s.angular_velocity_rad_s[i]))
      throw NumericalError(advised(fmt::format("particle {} left the range of numbers", bed.id[i]),
                                   "try a smaller step or less overlap at the start"));
}

/// The whole periods by which p stands outside the box: LIGGGHTS takes positions inside it.
Vec3 periods_outside(const Bed& bed, const Vec3& p) {
  Vec3 shift;
  for (int a = 0; a < 3; ++a) {
    const double period = bed.box.size()[a];
    if (bed.periodic[a]) shift[a] = period * std::floor((p[a] - bed.box.min[a]) / period);
  }
  return shift;
}

class LiggghtsEngine final : public Engine {
 public:
  LiggghtsEngine(const Vec3& gravity_m_s2, double step_s) : gravity_(gravity_m_s2), step_s_(step_s) {
    if (!(step_s > 0)) throw InputError(fmt::format("dem.step_s = {} (must be positive)", step_s));
  }
  void advance(Bed& bed, double until_s) override;
  NearPairs near_pairs(const Bed& bed, double max_gap_m) override {
    return granrad::near_pairs(bed, max_gap_m);
  }

 private:
  void run(Bed& bed, std::int64_t steps);
  void fit_session(Deck deck);
  Spheres spheres_of(const Bed& bed, const WallMeshes& walls) const;
  void store(const Spheres& spheres, const WallMeshes& walls, Bed& bed) const;

  Vec3 gravity_;
  double step_s_;
  Deck deck_;
  std::unique_ptr<Session> session_;
};

/// The session of the last run where its deck is the same.
void LiggghtsEngine::fit_session(Deck deck) {
  if (session_ && deck == deck_) return;
  session_.reset();
  auto session = std::make_unique<Session>();
  for (const auto& line : deck.before_meshes) session->command(line);
  for (std::size_t m = 0; m < deck.meshes.size(); ++m)
    session->add_mesh(mesh_name(m), deck.meshes[m], deck.mesh_type);
  for (const auto& line : deck.after_meshes) session->command(line);
  session_ = std::move(session);
  deck_ = std::move(deck);
}

Spheres LiggghtsEngine::spheres_of(const Bed& bed, const WallMeshes& walls) const {
  Spheres s;
  for (const auto& p : bed.position_m) s.position_m.push_back(p - periods_outside(bed, p));
  s.velocity_m_s = bed.velocity_m_s;
  s.angular_velocity_rad_s = bed.angular_velocity_rad_s, s.radius_m = bed.radius_m;
  for (const auto m : bed.material) {
    s.type.push_back(deck_.type_of_material[m]);
    s.density_kg_m3.push_back(bed.materials[m].density_kg_m3);
  }
  s.wall_springs.resize(deck_.meshes.size());
  for (const auto& c : bed.contacts) {
    const auto first = static_cast<std::int32_t>(bed.index_of(c.first));
    if (first < 0) continue;
    if (c.second >= 0) {
      const auto second = static_cast<std::int32_t>(bed.index_of(c.second));
      if (second >= 0) s.pair_springs.push_back({first, second, c.displacement_m});
      continue;
    }
    const auto place = walls.nearest(-1 - c.second, s.position_m[first]);
    if (place.triangle >= 0) s.wall_springs[place.mesh].push_back({first, place.triangle, c.displacement_m});
  }
  return s;
}

void LiggghtsEngine::store(const Spheres& s, const WallMeshes& walls, Bed& bed) const {
  for (std::size_t i = 0; i < bed.size(); ++i)
    bed.position_m[i] = s.position_m[i] + periods_outside(bed, bed.position_m[i]);
  bed.velocity_m_s = s.velocity_m_s;
  bed.angular_velocity_rad_s = s.angular_velocity_rad_s;
  bed.contacts.clear();
  for (const auto& p : s.pair_springs)
    bed.contacts.push_back({bed.id[p.sphere], bed.id[p.partner], p.displacement_m});
  for (std::size_t m = 0; m < s.wall_springs.size(); ++m)
    for (const auto& p : s.wall_springs[m])
      bed.contacts.push_back({bed.id[p.sphere], -1 - walls.face_of(m, p.partner), p.displacement_m});
  // One spring for a sphere and a face: its triangles share an edge, LIGGGHTS lets one of them act.
  const auto key = [](const ContactMemory& c) { return std::pair(c.first, c.second); };
  std::stable_sort(bed.contacts.begin(), bed.contacts.end(),
                   [&](const ContactMemory& a, const ContactMemory& b) { return key(a) < key(b); });
  bed.contacts.erase(
      std::unique(bed.contacts.begin(), bed.contacts.end(),
                  [&](const ContactMemory& a, const ContactMemory& b) { return key(a) == key(b); }),
      bed.contacts.end());
}

void LiggghtsEngine::run(Bed& bed, std::int64_t steps) {
  if (bed.size() == 0) return;
  const WallMeshes walls(bed);
  fit_session(make_deck(bed, walls, gravity_, step_s_));
  Spheres spheres = spheres_of(bed, walls);
  check_finite(spheres, bed);
  session_->run(spheres, steps);
  check_finite(spheres, bed);
  store(spheres, walls, bed);
}

void LiggghtsEngine::advance(Bed& bed, double until_s) {
  const StepClock clock(bed, step_s_);
  const std::int64_t last = clock.first_at_or_after(until_s);
  while (bed.step < last) {
    const double opens = next_opening_s(bed.walls, bed.time_s);
    auto steps = last - bed.step;
    if (opens < clock.time_s(last))
      steps = std::clamp<std::int64_t>(clock.first_at_or_after(opens) - bed.step, 1, steps);
    run(bed, steps);
    bed.step += steps;
    bed.time_s = clock.time_s(bed.step);
  }
}

}  // namespace
}  // namespace liggghts

extern "C" Engine* granrad_new_liggghts_engine(const Vec3& gravity_m_s2, double step_s) {
  return new liggghts::LiggghtsEngine(gravity_m_s2, step_s);
}

}  // namespace granrad
