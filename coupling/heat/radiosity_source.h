#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "raytrace/exchange.h"
#include "raytrace/exchange_source.h"

namespace granrad {

/// Exchange areas of an enclosure, one-way or symmetric, before closure, what their replicates found, and how many rays
/// were lost in tracing them.
struct ExchangeEstimate {
  ExchangeAreas areas;
  ReplicateSamples replicates;  ///< empty: the error of the wall heat comes from the variances of pairs
  std::int64_t lost_rays = 0;
  ExchangeEstimate(ExchangeAreas found, ReplicateSamples samples = {}, std::int64_t lost = 0)
      : areas(std::move(found)), replicates(std::move(samples)), lost_rays(lost) {}
};

/// Exchange source by view factors and one radiosity per surface: estimate -> close -> solve (the paper's Eqs.
/// (radiosity) and (Qrad); net-radiation method, Modest, Radiative Heat Transfer, ch. 5).
/// A wall of emissivity 0 (adiabatic) re-radiates with one radiosity, excluded walls are dropped before
/// closure. Implicit emission of particles is exact here: an emissivity f eps. While the enclosure does not change (a frozen bed) the exchange areas are estimated once. Their
/// random numbers are chosen by the geometry and not by the update, so that a resumed run finds the same
/// areas. One radiosity per surface is biased in dense grey beds (+14 % wall heat at phi = 0.43, emissivity
/// 0.4); PathSource is not.
class RadiositySource : public ExchangeSource {
 public:
  /// `key` selects random numbers.
  using Estimate = std::function<ExchangeEstimate(const Enclosure&, std::uint64_t key)>;

  RadiositySource(Estimate estimate, Closure closure) : estimate_(std::move(estimate)), closure_(closure) {}
  RadiativeHeat net_heat(const Enclosure& enclosure, const RadiativeState& state,
                         std::uint64_t update) override;

  /// Of the areas in use.
  const ClosureReport& closure_report() const { return report_; }
  /// Of the last solve; 0 when every surface was black.
  int iterations() const { return iterations_; }

 private:
  double wall_heat_error_W(const std::vector<double>& radiosity_W_m2, const std::vector<double>& emissivity,
                           const std::vector<char>& gives) const;
  void prepare(const Enclosure& enclosure, const std::vector<char>& excluded);

  Estimate estimate_;
  Closure closure_;
  ClosureReport report_;
  int iterations_ = 0;
  std::int64_t lost_rays_ = 0;  ///< of the areas not yet used
  bool prepared_ = false;
  Enclosure enclosure_;             ///< the one `areas_` belong to
  std::vector<std::int32_t> kept_;  ///< surface number of each row of `areas_`
  ReplicateSamples replicates_;     ///< by rows of `areas_`
  ExchangeAreas areas_;             ///< closed, without excluded walls
};

}  // namespace granrad
