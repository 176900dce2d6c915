#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace granrad {

/// What a column of numbers of particles can mean.
enum class Quantity {
  id,
  x,
  y,
  z,
  radius,
  diameter,
  temperature,
  vx,
  vy,
  vz,
  omegax,
  omegay,
  omegaz,
  material,
  type,
  q_rad,
  q_ss,
  q_sfs,
  count
};

/// Which column holds which quantity, by the names programs and people give them.
class ColumnNames {
 public:
  /// Exact names first; then, for what is still missing, names that differ by case, by f_ c_ v_ before or [1]
  /// behind, by a unit (temperature_K, "T (K)"), by the way to write a component (v:0, velocity_x, Points:2).
  explicit ColumnNames(std::vector<std::string> names);

  const std::vector<std::string>& all() const { return names_; }
  /// Place of a quantity, or -1.
  int at(Quantity quantity) const { return at_[static_cast<std::size_t>(quantity)]; }
  bool has(Quantity quantity) const { return at(quantity) >= 0; }
  /// Names given twice, two columns that could be the same quantity, a column that is nearly a known name or
  /// has an unknown unit (temperature_C), columns that tell of particles that are no spheres.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  void take_exact();
  void take_alike();
  void refuse_near_misses();
  void refuse_other_shapes();
  bool taken(std::size_t column) const;

  std::vector<std::string> names_;
  std::array<int, static_cast<std::size_t>(Quantity::count)> at_{};
  std::vector<std::string> problems_;
};

}  // namespace granrad
