#include "fit/vfgen/check_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "dem/packing/packing.h"
#include "fit/correlation/correlation_source.h"
#include "raytrace/exact.h"
#include "raytrace/unobstructed_pair.h"

namespace granrad {

namespace {

constexpr double overshoot_noted = 0.01, overshoot_allowed = 0.10;  ///< of the contact value
constexpr double growth_allowed = 0.05;                             ///< of the contact value
constexpr double closure_allowed = 0.25;                            ///< mean row sum off 1
constexpr double step = 0.01;                                       ///< in d*

/// A curve over distance with its upper bound, as a table holds it.
struct CheckedCurve {
  std::string name, distance;
  double contact, cutoff;
  std::function<double(double)> raw, bound;
};

class Checker {
 public:
  explicit Checker(const CorrelationTable& table) : table_(table) {}
  std::vector<CheckFinding> run();

 private:
  void problem(const std::string& text) { findings_.push_back({true, table_.name + ": " + text}); }
  void note(const std::string& text) { findings_.push_back({false, table_.name + ": " + text}); }
  void report(bool wrong, const std::string& text) {
    if (wrong)
      problem(advised(text, "refit this row"));
    else
      note(text);
  }
  CheckedCurve pair_curve(const CorrelationRow& row) const;
  CheckedCurve wall_curve(const CorrelationRow& row) const;
  void check_upper(const CorrelationRow& row, const CheckedCurve& curve);
  void check_lower(const CorrelationRow& row, const CheckedCurve& curve);
  void check_monotone(const CorrelationRow& row, const CheckedCurve& curve);
  void check_neighbours();
  void check_closure(const CorrelationRow& row);
  void check_walls(const CorrelationRow& row, const Enclosure& bed);

  const CorrelationTable& table_;
  std::vector<CheckFinding> findings_;
};

CheckedCurve Checker::pair_curve(const CorrelationRow& row) const {
  return {"F_pp",
          "d*",
          1,
          table_.pp_cutoff,
          [&](double d) { return raw_pp(table_, row, d); },
          [](double d) { return unobstructed_pair(d); }};
}

/// Against an unbounded wall: the exact factor is 1/2 at every distance.
CheckedCurve Checker::wall_curve(const CorrelationRow& row) const {
  const double shift = wall_distance(table_.pw_distance, 0);
  return {"F_pw",
          table_.pw_distance == WallDistance::h_plus_r_over_d ? "(h + r)/d" : "h/d",
          0.5 + shift,
          table_.pw_cutoff,
          [&, shift](double d) { return raw_pw(table_, row, d - shift, 0.5); },
          [](double) { return 0.5; }};
}

void Checker::check_upper(const CorrelationRow& row, const CheckedCurve& curve) {
  double worst = 0, at = 0;
  for (double d = curve.contact; d < curve.cutoff; d += step)
    if (const double over = curve.raw(d) - curve.bound(d); over > worst) worst = over, at = d;
  const double part = worst / curve.bound(curve.contact);
  if (part < overshoot_noted) return;
  const auto text = fmt::format(
      "solid fraction {}: {}({} = {:.2f}) = {:.4g} (with nothing in between it would be {:.4g}; held "
      "there in use)",
      row.solid_fraction, curve.name, curve.distance, at, curve.raw(at), curve.bound(at));
  report(part > overshoot_allowed, text);
}

void Checker::check_lower(const CorrelationRow& row, const CheckedCurve& curve) {
  double first = 0, lowest = 0;
  for (double d = curve.contact; d < curve.cutoff; d += step) {
    const double f = curve.raw(d);
    if (f < 0 && lowest == 0) first = d;
    lowest = std::min(lowest, f);
  }
  if (lowest == 0) return;
  const auto text =
      fmt::format("solid fraction {}: {} is negative from {} = {:.2f}, down to {:.2e} (held at {} in use)",
                  row.solid_fraction, curve.name, curve.distance, first, lowest, table_.clip);
  report(first <= curve.contact, text);
}

void Checker::check_monotone(const CorrelationRow& row, const CheckedCurve& curve) {
  const auto held = [&](double d) { return std::min(std::max(curve.raw(d), table_.clip), curve.bound(d)); };
  double lowest = held(curve.contact), growth = 0, at = 0;
  for (double d = curve.contact; d < curve.cutoff; d += step) {
    const double f = held(d);
    lowest = std::min(lowest, f);
    if (f - lowest > growth) growth = f - lowest, at = d;
  }
  const double contact = held(curve.contact);
  if (growth <= 1e-3 * contact) return;
  const auto text = fmt::format(
      "solid fraction {}: {} grows with distance, by {:.2g} ({:.1f} % of its contact value) up "
      "to {} = {:.2f}",
      row.solid_fraction, curve.name, growth, 100 * growth / contact, curve.distance, at);
  report(growth > growth_allowed * contact, text + " (shading only grows with distance)");
}

void Checker::check_neighbours() {
  for (std::size_t k = 1; k < table_.rows.size(); ++k) {
    const auto &a = table_.rows[k - 1], &b = table_.rows[k];
    const double fa = Correlation(table_, a.solid_fraction).pp(2),
                 fb = Correlation(table_, b.solid_fraction).pp(2);
    if (fb > fa * (1 + growth_allowed))
      note(fmt::format(
          "F_pp(2) grows from {:.4g} to {:.4g} between solid fractions {} and {} (a denser bed hides more)",
          fa, fb, a.solid_fraction, b.solid_fraction));
  }
}

/// Hard spheres of diameter 1 in a closed box of 12.5 x 5 x 25 diameters: a stretch of the paper's channel.
Enclosure synthetic_bed(double solid_fraction) {
  PackingRequest request;
  request.where.box = {{0, 0, 0}, {12.5, 5, 25}};
  request.radius_m = equal_radii(request.where.box, solid_fraction, 0.5);
  request.equilibration_sweeps = 100;
  Enclosure bed;
  bed.centre_m = pack_spheres(request);
  bed.radius_m = request.radius_m;
  bed.box = request.where.box;
  const auto walls = box_walls(request.where.box);
  bed.walls.assign(walls.begin(), walls.end());
  return bed;
}

void Checker::check_closure(const CorrelationRow& row) {
  Enclosure bed;
  try {
    bed = synthetic_bed(row.solid_fraction);
  } catch (const InputError&) {
    note(fmt::format("solid fraction {}: closure not checked (too dense for the synthetic bed)",
                     row.solid_fraction));
    return;
  }
  const auto areas =
      correlation_exchange_areas(table_, bed, {.solid_fraction = row.solid_fraction, .uniform = true});
  double sum = 0, sum2 = 0;
  for (std::size_t i = 0; i < bed.sphere_count(); ++i) {
    double total = 0;
    for (auto k = areas.pattern.row_begin[i]; k < areas.pattern.row_begin[i + 1]; ++k)
      total += areas.value[k];
    const double defect = total / areas.area_m2[i] - 1;
    sum += defect;
    sum2 += defect * defect;
  }
  const double n = static_cast<double>(bed.sphere_count()), mean = sum / n;
  const auto text = fmt::format(
      "solid fraction {}: row sums of {} spheres in a box of 12.5 x 5 x 25 d are {:.3f} in the "
      "mean, {:.3f} rms off 1 before closing",
      row.solid_fraction, bed.sphere_count(), 1 + mean, std::sqrt(sum2 / n));
  report(std::abs(mean) > closure_allowed, text + " (1 in truth)");
  check_walls(row, bed);
}

/// How often the wall function asks for more than a wall's own exact factor, over the spheres and walls of the
/// bed; in use it is held there, so that the walls never hold more than 1 of a lone sphere.
void Checker::check_walls(const CorrelationRow& row, const Enclosure& bed) {
  std::size_t pairs = 0, beyond = 0;
  double worst = 0, possible = 0;
  for (const auto& wall : bed.walls) {
    const Vec3 normal = plane_of(wall)->normal;
    for (std::size_t i = 0; i < bed.sphere_count(); ++i, ++pairs) {
      const double exact = exact_sphere_wall(bed.centre_m[i], wall);
      const double h_over_d = dot(bed.centre_m[i] - wall.vertices[0], normal) / (2 * bed.radius_m[i]);
      if (wall_distance(table_.pw_distance, h_over_d) >= table_.pw_cutoff) continue;
      const double raw = raw_pw(table_, row, h_over_d, exact);
      beyond += raw > exact;
      if (raw - exact > worst) worst = raw - exact, possible = exact;
    }
  }
  if (beyond > 0)
    note(fmt::format(
        "solid fraction {}: {:.2g} % of the F_pw in that box exceed the exact factor of their wall, by up "
        "to {:.2g} ({:.3g} where {:.3g} is possible; held there in use)",
        row.solid_fraction, 100.0 * static_cast<double>(beyond) / static_cast<double>(pairs), worst,
        possible + worst, possible));
}

std::vector<CheckFinding> Checker::run() {
  note(fmt::format(
      "{} rows of form {}, solid fraction {:.4g} to {:.4g}, F_pp to d* = {:g}, F_pw to {} = {:g}",
      table_.rows.size(), to_string(table_.form), table_.rows.front().solid_fraction,
      table_.rows.back().solid_fraction, table_.pp_cutoff, to_string(table_.pw_distance), table_.pw_cutoff));
  for (const auto& row : table_.rows) {
    for (const auto& curve : {pair_curve(row), wall_curve(row)}) {
      check_upper(row, curve);
      check_lower(row, curve);
      check_monotone(row, curve);
    }
    check_closure(row);
  }
  check_neighbours();
  return findings_;
}

}  // namespace

std::vector<CheckFinding> check_table(const CorrelationTable& table) {
  return Checker(table).run();
}

}  // namespace granrad
