#pragma once
#include <memory>

#include "raytrace/exchange_source.h"
#include "raytrace/lines/line_sweep.h"

namespace granrad {

/// Exchange source by lines that builds no matrix where none is needed: between black surfaces (none excluded, none
/// re-radiating) the heats are summed along the lines themselves (sweep_black_heat), with standard errors from the
/// replicates. Any other state goes to `otherwise`. For beds that move: a frozen bed traces its matrix once. Random
/// numbers are chosen by the geometry, so that a resumed run finds the same lines.
class BlackLineSource : public ExchangeSource {
 public:
  BlackLineSource(const LineOptions& options, std::unique_ptr<ExchangeSource> otherwise)
      : options_(options), otherwise_(std::move(otherwise)) {}
  RadiativeHeat net_heat(const Enclosure& enclosure, const RadiativeState& state,
                         std::uint64_t update) override;

 private:
  LineOptions options_;
  std::unique_ptr<ExchangeSource> otherwise_;
};

}  // namespace granrad
