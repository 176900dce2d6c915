#include "raytrace/paths/path_source.h"

#include <algorithm>
#include <cmath>

#include "raytrace/same_geometry.h"

namespace granrad {

RadiativeHeat PathSource::net_heat(const Enclosure& enclosure, const RadiativeState& state,
                                   std::uint64_t update) {
  if (!tracer_ || !same_geometry(enclosure, enclosure_)) {
    tracer_.reset();
    enclosure_ = enclosure;
    tracer_ = std::make_unique<EmbreeTracer>(enclosure_, options_.threads);
  }
  return options_.walks > 0 ? trace_paths(enclosure_, *tracer_, state, options_, update)
                            : trace_enough_paths(state, update);
}

RadiativeHeat PathSource::trace_enough_paths(const RadiativeState& state, std::uint64_t update) const {
  constexpr std::uint64_t first_look = std::uint64_t{1} << 62;  // random numbers no update uses
  constexpr double margin = 1.2;                                // 16 batches know their variance to 36 %
  PathOptions options = options_;
  options.walks = first_look_walks;
  RadiativeHeat heat = trace_paths(enclosure_, *tracer_, state, options, update | first_look);
  const double ratio = heat.isothermal_wall_heat_error_W / state.wanted_error_W;
  if (!(state.wanted_error_W > 0) || ratio <= 1) return heat;
  const double walks = margin * static_cast<double>(first_look_walks) * ratio * ratio;
  options.walks = static_cast<std::int64_t>(std::min(walks, static_cast<double>(most_chosen_walks)));
  const RadiativeHeat look = heat;
  heat = trace_paths(enclosure_, *tracer_, state, options, update);
  heat.rays += look.rays;
  heat.lost_rays += look.lost_rays;
  return heat;
}

}  // namespace granrad
