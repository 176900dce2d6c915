#pragma once
#include <vector>

#include "dem/feed/feed.h"
#include "dem/feed/plug_friction.h"
#include "dem/packing/packing.h"

namespace granrad {

/// Plug flow: spheres enter above the channel and move down (-z) at one speed, at a given solid fraction phi
/// in the channel box and mass flow rho phi A v (A: the box's x-y section, walls' shadow included).
///
/// The spheres come on an endless tape: a random packing of the channel's section, periodic in z, whose
/// period (about the channel's height) is chosen so that its solid fraction is phi exactly. The tape moves
/// down with v; a sphere enters the Bed when its centre passes `insertion_height` = 2.5 d above z_max, at the
/// place it has on the tape. So nothing depends on finding room by chance (random insertion ends at phi
/// 0.36), and every period brings exactly the same number of spheres. Each half period the part of the tape
/// that has not yet come is shaken again, so that periods differ.
///
/// Friction at the walls slows the plug (1.3 % on average at phi 0.48), and a slower plug is a denser one at
/// the same mass flow. So newcomers enter faster than the tape moves by the mean loss that kinetic theory
/// expects (dem/feed/plug_friction.h), corrected each half period by the measured solid fraction of the channel. A
/// channel filled at the start is filled with the velocities spheres have at that age.
///
/// Transverse velocities are fresh normal deviates keyed by the id. As earlier spheres have drifted by then,
/// a newcomer that touches one is pushed aside until it is free (counted as `nudged`); one that finds no room
/// waits, and enters at a random free place of the insertion zone as soon as there is one.
/// Above the channel, where no walls are, spheres that drift across its section are reflected at its sides.
/// Spheres leave when they are wholly below z_min.
///
/// engine "none": one packing of the box instead, walled on all sides but the periodic ones, at rest.
class PlugFeed {
 public:
  explicit PlugFeed(const Scene& scene);
  void start(Bed& bed);
  double leaves_below_m() const;
  void insert_due(Bed& bed, FeedTotals& totals);
  void save(StateBlock& state) const;
  void load(const StateBlock& state);

 private:
  struct Coming {
    double tape_m;  ///< place along the tape: due when the tape has moved this far
    double x, y;
  };
  double insertion_plane_m() const;
  std::vector<Coming> coming_until(double tape_m) const;
  void reshuffle();
  void measure_solid_fraction(const Bed& bed);
  void correct_speed();
  void add(Bed& bed, const Vec3& position, double age_s) const;
  void place(Bed& bed, Vec3 scheduled, std::vector<std::size_t>& near, FeedTotals& totals);
  void place_waiting(Bed& bed, std::vector<std::size_t>& near, FeedTotals& totals);
  bool push_clear(const Bed& bed, const std::vector<std::size_t>& near, Vec3& position) const;
  void keep_inside(Vec3& position) const;
  void reflect_above_channel(Bed& bed) const;
  std::vector<std::size_t> particles_near_inlet(const Bed& bed, double moved_m) const;

  FeedSettings settings_;
  Box channel_;
  std::array<bool, 3> periodic_;
  double radius_, temperature_, speed_ = 0;
  PlugFriction friction_;
  bool frozen_;

  PackingBox tape_;           ///< one period of the tape, z from 0
  std::vector<Vec3> column_;  ///< the spheres of one period; those already used stand for the next period
  double start_s_ = 0;        ///< time at which the tape started
  double used_m_ = 0;         ///< length of tape used so far
  double faster_ = 0;         ///< newcomers move down with speed_ (1 + faster_)
  double measured_sum_ = 0;   ///< of the channel's solid fraction at each update of this half period
  std::int64_t half_periods_ = 0, tries_ = 0, measured_ = 0;
};

}  // namespace granrad
