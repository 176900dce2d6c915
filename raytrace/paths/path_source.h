#pragma once
#include <memory>

#include "raytrace/paths/path_tracer.h"

namespace granrad {

/// Exchange source by traced paths: trace_paths on a tracer that is rebuilt only when the enclosure changes.
class PathSource : public ExchangeSource {
 public:
  explicit PathSource(const PathOptions& options) : options_(options) {}
  RadiativeHeat net_heat(const Enclosure& enclosure, const RadiativeState& state,
                         std::uint64_t update) override;

 private:
  PathOptions options_;
  Enclosure enclosure_;  ///< the one `tracer_` was built for
  std::unique_ptr<EmbreeTracer> tracer_;
};

}  // namespace granrad
