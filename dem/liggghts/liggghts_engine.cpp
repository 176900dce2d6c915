#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "dem/liggghts/deck.h"
#include "dem/liggghts/plugin.h"
#include "dem/liggghts/session.h"
#include "dem/liggghts/world.h"
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

/// Bed::index_of in one look: ids of a bed lie close together.
class IndexOfId {
 public:
  explicit IndexOfId(const Bed& bed) : bed_(bed), first_(bed.id.front()) {
    const std::int64_t span = bed.id.back() - first_ + 1;
    if (span > most_per_sphere * static_cast<std::int64_t>(bed.size())) return;
    index_.assign(static_cast<std::size_t>(span), -1);
    for (std::size_t i = 0; i < bed.size(); ++i)
      index_[static_cast<std::size_t>(bed.id[i] - first_)] = static_cast<std::int32_t>(i);
  }
  std::int32_t operator()(std::int64_t id) const {
    if (index_.empty()) return static_cast<std::int32_t>(bed_.index_of(id));
    const auto k = static_cast<std::uint64_t>(id - first_);  // below the first: beyond the end
    return k < index_.size() ? index_[k] : -1;
  }

 private:
  static constexpr std::int64_t most_per_sphere = 16;
  const Bed& bed_;
  std::int64_t first_;
  std::vector<std::int32_t> index_;
};

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
  void store_springs(const Spheres& spheres, const WallMeshes& walls, Bed& bed) const;
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
  if (deck.parts != Parts{}) session->cut(deck.parts);
  for (std::size_t m = 0; m < deck.meshes.size(); ++m)
    session->add_mesh(mesh_name(m), deck.meshes[m], deck.mesh_type);
  for (const auto& line : deck.after_meshes) session->command(line);
  session_ = std::move(session);
  deck_ = std::move(deck);
}

Spheres LiggghtsEngine::spheres_of(const Bed& bed, const WallMeshes& walls) const {
  Spheres s;
  s.position_m.reserve(bed.size());
  for (const auto& p : bed.position_m) s.position_m.push_back(p - periods_outside(bed, p));
  s.velocity_m_s = bed.velocity_m_s;
  s.angular_velocity_rad_s = bed.angular_velocity_rad_s, s.radius_m = bed.radius_m;
  for (const auto m : bed.material) {
    s.type.push_back(deck_.type_of_material[m]);
    s.density_kg_m3.push_back(bed.materials[m].density_kg_m3);
  }
  s.springs.reserve(bed.contacts.size());
  const IndexOfId index_of(bed);
  for (const auto& c : bed.contacts) {
    const std::int32_t first = index_of(c.first);
    if (first < 0) continue;
    if (c.second >= 0) {
      const std::int32_t second = index_of(c.second);
      if (second >= 0) s.springs.push_back({first, Spring::pair, second, c.displacement_m});
      continue;
    }
    const auto place = walls.nearest(-1 - c.second, s.position_m[first]);
    if (place.triangle >= 0)
      s.springs.push_back({first, static_cast<std::int32_t>(place.mesh), place.triangle, c.displacement_m});
  }
  return s;
}

/// One spring for a sphere and a face: its triangles share an edge, LIGGGHTS lets one of them act.
void LiggghtsEngine::store_springs(const Spheres& s, const WallMeshes& walls, Bed& bed) const {
  bed.contacts.clear();
  bed.contacts.reserve(s.springs.size());
  for (std::size_t k = 0; k < s.springs.size();) {
    const auto sphere = s.springs[k].sphere;
    const auto first = static_cast<std::ptrdiff_t>(bed.contacts.size());
    for (; k < s.springs.size() && s.springs[k].sphere == sphere && s.springs[k].mesh != Spring::pair; ++k) {
      const auto face = walls.face_of(static_cast<std::size_t>(s.springs[k].mesh), s.springs[k].partner);
      bed.contacts.push_back({bed.id[sphere], -1 - face, s.springs[k].displacement_m});
    }
    const auto begin = bed.contacts.begin() + first;
    std::stable_sort(begin, bed.contacts.end(),
                     [](const ContactMemory& a, const ContactMemory& b) { return a.second < b.second; });
    bed.contacts.erase(
        std::unique(begin, bed.contacts.end(),
                    [](const ContactMemory& a, const ContactMemory& b) { return a.second == b.second; }),
        bed.contacts.end());
    for (; k < s.springs.size() && s.springs[k].sphere == sphere; ++k)
      bed.contacts.push_back({bed.id[sphere], bed.id[s.springs[k].partner], s.springs[k].displacement_m});
  }
}

void LiggghtsEngine::store(const Spheres& s, const WallMeshes& walls, Bed& bed) const {
  for (std::size_t i = 0; i < bed.size(); ++i)
    bed.position_m[i] = s.position_m[i] + periods_outside(bed, bed.position_m[i]);
  bed.velocity_m_s = s.velocity_m_s;
  bed.angular_velocity_rad_s = s.angular_velocity_rad_s;
  store_springs(s, walls, bed);
}

void LiggghtsEngine::run(Bed& bed, std::int64_t steps) {
  if (bed.size() == 0) return;
  const WallMeshes walls(bed);
  fit_session(make_deck(bed, walls, gravity_, step_s_, World::started().count()));
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
