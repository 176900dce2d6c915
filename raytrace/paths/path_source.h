#pragma once
#include <memory>

#include "raytrace/paths/path_tracer.h"

namespace granrad {

inline constexpr std::int64_t first_look_walks = 4096, most_chosen_walks = 100000000;

/// Exchange source by traced paths (absorption by weights: Modest, Radiative Heat Transfer, chapter
/// on Monte Carlo methods): trace_paths on a tracer that is rebuilt only when the enclosure changes. With
/// options.walks = 0 it chooses its walks: a first look of first_look_walks, and where its error of the wall heat is above
/// RadiativeState::wanted_error_W, as many anew as bring it down. The choice depends on nothing before this update.
class PathSource : public ExchangeSource {
 public:
  explicit PathSource(const PathOptions& options) : options_(options) {}
  RadiativeHeat net_heat(const Enclosure& enclosure, const RadiativeState& state,
                         std::uint64_t update) override;

 private:
  RadiativeHeat trace_enough_paths(const RadiativeState& state, std::uint64_t update) const;

  PathOptions options_;
  Enclosure enclosure_;  ///< the one `tracer_` was built for
  std::unique_ptr<EmbreeTracer> tracer_;
};

}  // namespace granrad
