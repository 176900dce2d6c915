#pragma once
#include <vector>

#include "raytrace/exchange_source.h"
#include "raytrace/lines/exchange_moments.h"

namespace granrad {

/// Exchange source without the one-radiosity bias and without noise from update to update: radiosities that
/// vary over each sphere (spherical harmonics up to `order`) and over the walls (patches no longer than the
/// smallest radius), on global parallel lines. Between planar walls only; excluded walls are refused. Each
/// replicate of the lines is a system of its own: the heat is their mean, its standard error their scatter.
/// A frozen bed is assembled once. Of random numbers and threads as RadiositySource.
class HarmonicSource : public ExchangeSource {
 public:
  HarmonicSource(int order, const LineOptions& options) : order_(order), options_(options) {}
  RadiativeHeat net_heat(const Enclosure& enclosure, const RadiativeState& state,
                         std::uint64_t update) override;

 private:
  void prepare(const Enclosure& enclosure);

  int order_;
  LineOptions options_;
  bool prepared_ = false;
  Enclosure enclosure_;
  std::vector<ExchangeMoments> replicates_;
};

}  // namespace granrad
