#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "raytrace/enclosure.h"
#include "raytrace/exchange_source.h"

namespace granrad {

/// What a walk finds at each surface.
class PathSurfaces {
 public:
  PathSurfaces(const Enclosure& enclosure, const RadiativeState& state);

  std::int32_t count() const { return static_cast<std::int32_t>(absorptivity_.size()); }
  bool is_wall(std::int32_t s) const { return s >= first_wall_; }  ///< the surroundings too
  bool drops(std::int32_t s) const { return drops_[s]; }           ///< excluded walls
  bool radiates(std::int32_t s) const { return absorptivity_[s] > 0 && !drops_[s]; }
  double absorptivity(std::int32_t s) const { return absorptivity_[s]; }  ///< of what is kept, f eps
  /// Part of what is not kept that leaves again from all of the surface alike: (1 - f) eps / (1 - f eps).
  double spread_share(std::int32_t s) const { return spread_share_.empty() ? 0 : spread_share_[s]; }
  /// RadiativeState::relaxation; 0 when not known.
  double relaxation(std::int32_t s) const { return relaxation_.empty() ? 0 : relaxation_[s]; }
  double power_W_m2(std::int32_t s) const { return power_W_m2_[s]; }  ///< sigma T^4

  double smallest_absorptivity() const;  ///< of the radiating surfaces
  double power_range_W_m2() const;       ///< largest minus smallest power of the radiating surfaces

 private:
  std::vector<double> absorptivity_, power_W_m2_, spread_share_, relaxation_;
  std::vector<char> drops_;
  std::int32_t first_wall_;
};

/// Walks from a particle that would come to its equilibrium with all it sees until the next update. One walk then
/// moves its temperature by at most 1 % of the way to that of the other end.
inline constexpr double walks_per_relaxation = 100;

/// Where walks start: a share on the walls (PathOptions::wall_share), the rest on the particles, on each kind in proportion
/// to emissivity times area. Particles that this gives fewer than walks_per_relaxation k / (1 + k) get that many, and the walks become
/// more: a small particle, whose temperature follows its heat at once, is sampled as often as it needs. Both ends of a
/// pair are weighted by their own density of walks, so that any choice of starts is unbiased.
class PathStarts {
 public:
  /// `closed`: no walk reaches the surroundings.
  PathStarts(const Enclosure& enclosure, const PathSurfaces& surfaces, std::int64_t walks,
             std::optional<double> wall_share, bool closed);

  std::int64_t walks() const { return walks_; }  ///< those asked for, or more
  /// sum eps_i A_i over the surfaces that emit, m^2. 0: no walk can start.
  double emission_area_m2() const { return emission_area_m2_; }
  /// Surface at the fraction u in [0, 1) of all starts.
  std::int32_t surface_at(double u) const { return surface_at(u, 0); }
  /// Found at once where it is that of the start before.
  std::int32_t surface_at(double u, std::int32_t before) const;
  /// Exchange area that a whole walk between i and j stands for, m^2: 1/(1/g_i + 1/g_j), g = eps A / walks.
  double area_per_walk_m2(std::int32_t i, std::int32_t j) const {
    return 1 / (walks_per_m2_[i] + walks_per_m2_[j]);
  }
  double most_walks_per_m2() const;

 private:
  void raise_to_needs(const PathSurfaces& surfaces, const std::vector<double>& area);

  std::int64_t walks_;
  std::vector<double> cumulative_;    ///< per surface but the surroundings
  std::vector<double> walks_per_m2_;  ///< 1/g
  double emission_area_m2_ = 0;
};

/// Starts of one batch: a rank-1 lattice over point and direction (multiples of the powers of 1/x, x^5 = x +
/// 1), ordered along the surfaces, moved by one random shift. Each start alone is uniform, together they are
/// even.
class StartLattice {
 public:
  StartLattice(std::uint64_t seed, std::uint64_t update, int batch, std::int64_t count);
  /// Place of start k along all starts of the batch, in [0, 1).
  double position(std::int64_t k) const;
  /// Uniforms for point and direction of start k, in [0, 1).
  std::array<double, 4> uniforms(std::int64_t k) const;

 private:
  std::int64_t count_;
  std::array<double, 6> shift_;
};

}  // namespace granrad
