#pragma once
#include <string>
#include <vector>

#include "coupling/simulation/heat_scene.h"
#include "raytrace/exchange_source.h"

namespace granrad {

/// A source with a number of rays: a point of the front.
struct Contender {
  std::string name;
  RadiationSettings settings;
  bool paper = false;    ///< four walls dropped and rows normalised, as the paper does
  bool in_time = false;  ///< also judged by T(5 s), and by h in a flow where it is cheap enough
};

/// Every source with a ladder of rays, the shipped tables, and the paper's scheme. `few`: fewer rungs.
std::vector<Contender> contenders(bool few);

/// A frozen bed in the channel, grey or black, with the heats that traced paths find for it.
class FrontCase {
 public:
  /// Bed of static_phi*.toml; half the walks for each of two references.
  FrontCase(double solid_fraction, double emissivity, double walks);

  double solid_fraction, emissivity;
  double walks, reference_noise_pct;  ///< rms of the particle heats, of their mean
  double mean_heat_W, wall_heat_W, wall_error_pct;
  double reference_seconds;

  struct Point {
    Contender of;
    double cpu_s = 0, cpu_spread_s = 0;  ///< median of the draws and half their range
    double particle_rms_pct = 0, particle_rms_error_pct = 0;
    double geometry_rms_pct = 0,
           geometry_rms_error_pct = 0;        ///< against exact view factors and the same radiosities;
                                              ///< NaN: a source of another kind
    double wall_pct = 0, wall_error_pct = 0;  ///< of the mean over the draws
    double wall_rms_pct = 0;                  ///< of one update, as it comes
    double seconds_to_1_pct = 0;  ///< over a run: noise averages out over updates, bias does not; NaN: never
    double temperature_pct = 0,
           temperature_rms_pct = 0;     ///< of the rise in 5 s: mean, each particle; NaN: not asked
    double h_pct = 0, h_error_pct = 0;  ///< in a flow; NaN: not asked
  };
  /// Seconds in which independent rays from every particle, by Embree and nothing else, know its heat so well: the rate of
  /// such rays here times the binomial law; of black surfaces.
  double bare_embree_seconds(double error_pct) const;
  Point measure(const Contender& contender) const;
  /// T(5 s) of those that are `in_time`, against paths.
  void heat_for_5_s(std::vector<Point>& points) const;
  /// h of a plug flow, of those that are `in_time`, against paths.
  void run_flows(std::vector<Point>& points) const;

 private:
  Case scene(bool paper, const std::string& name) const;

  Case six_, two_;  ///< all six walls; four of them dropped
  Bed bed_;
  RadiativeHeat half_[2];  ///< by paths
  /// By view factors of many lines, one radiosity for each sphere and each wall [0], or each patch [1].
  RadiativeHeat geometry_[2][2];
};

}  // namespace granrad
