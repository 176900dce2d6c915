#include "raytrace/paths/path_source.h"

#include "raytrace/same_geometry.h"

namespace granrad {

RadiativeHeat PathSource::net_heat(const Enclosure& enclosure, const RadiativeState& state,
                                   std::uint64_t update) {
  if (!tracer_ || !same_geometry(enclosure, enclosure_)) {
    tracer_.reset();
    enclosure_ = enclosure;
    tracer_ = std::make_unique<EmbreeTracer>(enclosure_, options_.threads);
  }
  return trace_paths(enclosure_, *tracer_, state, options_, update);
}

}  // namespace granrad
