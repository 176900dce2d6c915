#pragma once
#include <cmath>
#include <cstdint>

#include "raytrace/embree/embree_tracer.h"
#include "raytrace/paths/clear_flights.h"
#include "raytrace/paths/path_starts.h"
#include "raytrace/paths/path_tally.h"
#include "raytrace/paths/path_tracer.h"
#include "raytrace/rays/emission.h"

namespace granrad {

/// Surfaces that one walk meets: what it still carries after the last goes to those of its second half, in proportion
/// to what they absorbed.
inline constexpr int most_surfaces_of_a_walk = 400;

/// Follows single walks of one update and books what they exchange.
class PathWalker {
 public:
  PathWalker(const Enclosure& enclosure, const EmbreeTracer& tracer, const RadiativeState& state,
             const PathOptions& options, std::uint64_t update);

  const PathSurfaces& surfaces() const { return surfaces_; }
  /// 0 when nothing emits.
  std::int64_t walks() const { return starts_.emission_area_m2() > 0 ? starts_.walks() : 0; }
  double quantum_W() const { return quantum_W_; }
  StartLattice lattice(int batch, std::int64_t walks_of_batch) const {
    return {seed_, update_, batch, walks_of_batch};
  }
  bool has_clear_flights() const { return !flights_.idle(); }
  /// Takes off what is expected of the clear flights of so many walks.
  void expect(std::int64_t walks, PathTally& tally) const;
  /// Walk k of a batch, `number` among all.
  void walk(const StartLattice& lattice, std::int64_t k, std::uint64_t number, PathTally& tally) const;

 private:
  struct Given;
  Quanta in_quanta(double heat_W) const;
  double power_difference_W_m2(std::int32_t a, std::int32_t b) const {
    return surfaces_.power_W_m2(a) - surfaces_.power_W_m2(b);
  }
  /// From its first hit on.
  void follow(std::int32_t start, Hit hit, std::uint64_t number, PathTally& tally) const;
  void exchange(std::int32_t start, std::int32_t end, double weight, PathTally& tally) const;
  /// A weight to those that got something from the number `from` on, in proportion.
  void share_out(std::int32_t start, double weight, const Given& given, std::size_t from,
                 PathTally& tally) const;
  /// Of the first flight just made; the heat that walls give by it.
  double fly_clear(std::int32_t start, PathTally& tally) const;
  Emission leave(const Hit& hit, const std::uint64_t number, const std::uint64_t event, double u0, double u1,
                 double choice) const;

  const EmbreeTracer& tracer_;
  PathSurfaces surfaces_;
  PathStarts starts_;
  ClearFlights flights_;
  Emitter emitter_;
  std::uint64_t seed_, update_;
  bool weighted_;
  double quantum_W_, quanta_per_W_;
  double moments_per_W_ = 0;  ///< units of WalkMoments
};

}  // namespace granrad
