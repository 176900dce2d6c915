#pragma once
#include <string>
#include <vector>

#include "coupling/heat/heat_parts.h"
#include "dem/io/snapshot.h"
#include "raytrace/enclosure.h"

namespace granrad {

/// Heat that every wall gave since time 0, J, by its number in the Bed; the surroundings last.
class WallHeats {
 public:
  /// Nothing so far, for the walls of `bed`.
  void start(const Bed& bed);
  /// Net emission of the walls and the surroundings, to be held until the next update, from the net heat that every
  /// surface of an enclosure of the Bed received, W.
  void hold_radiation(const Enclosure& enclosure, const std::vector<double>& received_W);
  /// One heat step: what contacts and gas brought, J by wall, and the radiation held over dt_s.
  void add(const std::vector<HeatPaths>& conducted_J, double dt_s);

  /// By wall, then the surroundings.
  const std::vector<HeatPaths>& given_J() const { return given_J_; }

  StateBlock save() const;
  void load(const StateBlock& block);

 private:
  std::vector<HeatPaths> given_J_;
  std::vector<double> radiation_W_;
};

/// Columns of a frame, one for each path of heat, and back.
void save_paths(StateBlock& block, const std::string& name, const std::vector<HeatPaths>& values);
std::vector<HeatPaths> saved_paths(const StateBlock& block, const std::string& name);

}  // namespace granrad
