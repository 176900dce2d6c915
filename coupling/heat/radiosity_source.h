#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "raytrace/exchange.h"
#include "raytrace/exchange_source.h"
#include "raytrace/wall_patches.h"

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
/// Walls that reflect, adiabatic ones of emissivity 0 among them, have one radiosity each, or one for each of their
/// patches where the estimate knows patches; excluded walls are dropped before closure. Heats are those of whole walls.
/// Implicit emission of particles is exact here: an emissivity f eps. While the enclosure does not change (a frozen bed)
/// the exchange areas are estimated once. Their random numbers are chosen by the geometry and not by the update, so that
/// a resumed run finds the same areas. One radiosity per sphere is biased in dense grey beds (+14 % wall heat at phi =
/// 0.43, emissivity 0.4); PathSource is not.
class RadiositySource : public ExchangeSource {
 public:
  /// `key` selects random numbers.
  using Estimate = std::function<ExchangeEstimate(const Enclosure&, std::uint64_t key)>;
  /// Surfaces are those of patches.applied_to(enclosure).
  using PatchEstimate =
      std::function<ExchangeEstimate(const Enclosure&, const WallPatches& patches, std::uint64_t key)>;

  RadiositySource(Estimate of_whole_walls, Closure closure);
  /// Walls that reflect are cut into patches as fine as patch_length_m says; not in periodic boxes.
  RadiositySource(PatchEstimate estimate, Closure closure)
      : estimate_(std::move(estimate)), cuts_walls_(true), closure_(closure) {}
  RadiativeHeat net_heat(const Enclosure& enclosure, const RadiativeState& state,
                         std::uint64_t update) override;

  /// Of the areas in use.
  const ClosureReport& closure_report() const { return report_; }
  /// Of the last solve; 0 when every surface was black.
  int iterations() const { return iterations_; }

 private:
  double wall_heat_error_W(const std::vector<double>& radiosity_W_m2, const std::vector<double>& emissivity,
                           const std::vector<char>& gives) const;
  void prepare(const Enclosure& enclosure, const RadiativeState& state);

  PatchEstimate estimate_;
  bool cuts_walls_ = false;
  Closure closure_;
  ClosureReport report_;
  int iterations_ = 0;
  std::int64_t lost_rays_ = 0;  ///< of the areas not yet used
  bool prepared_ = false;
  Enclosure enclosure_;                    ///< the one `areas_` belong to
  std::vector<char> excluded_, reflects_;  ///< its walls
  std::vector<std::int32_t>
      surface_;                  ///< number in it of each row of `areas_`; patches have that of their wall
  ReplicateSamples replicates_;  ///< by rows of `areas_`
  ExchangeAreas areas_;          ///< closed, without excluded walls
};

}  // namespace granrad
