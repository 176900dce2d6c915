#include "dem/packing/packing_relax.h"

#include <algorithm>
#include <cmath>

#include "dem/base/program.h"
#include "dem/packing/packing_cells.h"

namespace granrad {

namespace {

constexpr int most_steps = 20000;

struct OverlappingPair {
  int i, j;
};

/// Neighbour list with a skin, rebuilt when a sphere has moved half of it.
class Neighbours {
 public:
  Neighbours(const PackingBox& where, const std::vector<double>& radius, double inflation)
      : where_(where),
        radius_(radius),
        inflation_(inflation),
        largest_(*std::max_element(radius.begin(), radius.end())) {}

  const std::vector<OverlappingPair>& pairs(const std::vector<Vec3>& position) {
    if (built_at_.empty() || moved_far(position)) build(position);
    return pairs_;
  }

 private:
  double skin() const { return 0.3 * largest_; }

  bool moved_far(const std::vector<Vec3>& position) const {
    const double limit = 0.25 * skin() * skin();
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3 d = where_.separation(built_at_[i], position[i]);
      if (dot(d, d) > limit) return true;
    }
    return false;
  }

  void build(const std::vector<Vec3>& position) {
    built_at_ = position;
    pairs_.clear();
    const PackingCells cells(where_, 2 * inflation_ * largest_ + skin(), position);
    for (int i = 0; i < static_cast<int>(position.size()); ++i)
      cells.all_near(position[i], [&](int j) {
        const Vec3 d = where_.separation(position[i], position[j]);
        const double reach = inflation_ * (radius_[i] + radius_[j]) + skin();
        if (j > i && dot(d, d) < reach * reach) pairs_.push_back({i, j});
        return true;
      });
  }

  const PackingBox& where_;
  const std::vector<double>& radius_;
  double inflation_, largest_;
  std::vector<Vec3> built_at_;
  std::vector<OverlappingPair> pairs_;
};

struct Forces {
  std::vector<Vec3> on;
  double worst_overlap = 0;  ///< of the true spheres, over the smaller radius
};

void add_walls(const PackingBox& where, double radius, double inflation, const Vec3& p, Vec3& force,
               double& worst) {
  for (int k = 0; k < 3; ++k) {
    if (where.periodic[k]) continue;
    const double below = where.box.min[k] - (p[k] - radius), above = p[k] + radius - where.box.max[k];
    const double extra = (inflation - 1) * radius;
    worst = std::max(worst, std::max(below, above) / radius);
    // Twice a pair's stiffness: a wall does not give way.
    force[k] += 2 * std::max(0.0, below + extra) - 2 * std::max(0.0, above + extra);
  }
}

void compute(const PackingBox& where, const std::vector<double>& radius, double inflation,
             const std::vector<Vec3>& position, const std::vector<OverlappingPair>& pairs, Forces& forces) {
  std::fill(forces.on.begin(), forces.on.end(), Vec3{});
  double worst = -1;
  for (const auto& [i, j] : pairs) {
    const Vec3 d = where.separation(position[i], position[j]);
    const double touching = radius[i] + radius[j], distance2 = dot(d, d);
    if (distance2 >= inflation * inflation * touching * touching) continue;
    const double distance = std::max(std::sqrt(distance2), 1e-9 * touching);
    worst = std::max(worst, (touching - distance) / std::min(radius[i], radius[j]));
    const Vec3 push = d * ((inflation * touching - distance) / distance);
    forces.on[i] -= push;
    forces.on[j] += push;
  }
  for (std::size_t i = 0; i < position.size(); ++i)
    add_walls(where, radius[i], inflation, position[i], forces.on[i], worst);
  forces.worst_overlap = worst;
}

void wrap(const PackingBox& where, Vec3& p) {
  for (int k = 0; k < 3; ++k) {
    if (!where.periodic[k]) continue;
    const double period = where.box.max[k] - where.box.min[k];
    p[k] -= period * std::floor((p[k] - where.box.min[k]) / period);
    if (p[k] >= where.box.max[k]) p[k] = where.box.min[k];
  }
}

/// State of FIRE: velocity is mixed towards the force while going downhill, reset when going uphill.
class Fire {
 public:
  explicit Fire(std::size_t n) : velocity_(n) {}

  void mix(const std::vector<Vec3>& force) {
    double power = 0, force2 = 0, speed2 = 0;
    for (std::size_t i = 0; i < force.size(); ++i) {
      power += dot(force[i], velocity_[i]);
      force2 += dot(force[i], force[i]);
      speed2 += dot(velocity_[i], velocity_[i]);
    }
    if (power <= 0) {
      std::fill(velocity_.begin(), velocity_.end(), Vec3{});
      step_ *= 0.5, mixing_ = 0.1, downhill_ = 0;
      return;
    }
    const double scale = force2 > 0 ? mixing_ * std::sqrt(speed2 / force2) : 0;
    for (std::size_t i = 0; i < force.size(); ++i)
      velocity_[i] = velocity_[i] * (1 - mixing_) + force[i] * scale;
    if (++downhill_ > 5) step_ = std::min(1.1 * step_, 0.6), mixing_ *= 0.99;
  }

  void move(const std::vector<Vec3>& force, const std::vector<double>& radius, const PackingBox& where,
            std::vector<Vec3>& position) {
    for (std::size_t i = 0; i < position.size(); ++i) {
      velocity_[i] += force[i] * step_;
      Vec3 d = velocity_[i] * step_;
      const double length = norm(d), longest = 0.1 * radius[i];
      if (length > longest) d *= longest / length;
      position[i] += d;
      wrap(where, position[i]);
    }
  }

 private:
  std::vector<Vec3> velocity_;
  double step_ = 0.1, mixing_ = 0.1;
  int downhill_ = 0;
};

}  // namespace

double relax_overlaps(const PackingBox& where, const std::vector<double>& radius_m, double inflation,
                      std::vector<Vec3>& position) {
  if (position.empty()) return 0;
  const double apart_enough = -0.5 * (inflation - 1);
  Neighbours neighbours(where, radius_m, inflation);
  Forces forces{std::vector<Vec3>(position.size())};
  Fire fire(position.size());
  for (int step = 0; step < most_steps; ++step) {
    stop_if_interrupted();
    compute(where, radius_m, inflation, position, neighbours.pairs(position), forces);
    if (forces.worst_overlap < apart_enough) break;
    fire.mix(forces.on);
    fire.move(forces.on, radius_m, where, position);
  }
  return forces.worst_overlap;
}

}  // namespace granrad
