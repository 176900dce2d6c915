#include "coupling/simulation/wall_heats.h"

#include <algorithm>

#include "dem/base/error.h"
#include "dem/io/saved_state.h"

namespace granrad {

void WallHeats::start(const Bed& bed) {
  given_J_.assign(bed.walls.size() + 1, {});
  radiation_W_.assign(bed.walls.size() + 1, 0.0);
}

void WallHeats::hold_radiation(const Enclosure& enclosure, const std::vector<double>& received_W) {
  std::fill(radiation_W_.begin(), radiation_W_.end(), 0.0);
  for (std::size_t w = 0; w < enclosure.wall.size(); ++w)
    radiation_W_[enclosure.wall[w]] = -received_W[enclosure.sphere_count() + w];
  radiation_W_.back() = -received_W[enclosure.open_surface()];
}

void WallHeats::add(const std::vector<HeatPaths>& conducted_J, double dt_s) {
  for (std::size_t w = 0; w < conducted_J.size(); ++w) {
    given_J_[w].solid += conducted_J[w].solid;
    given_J_[w].gas += conducted_J[w].gas;
  }
  for (std::size_t w = 0; w < given_J_.size(); ++w) given_J_[w].radiation += radiation_W_[w] * dt_s;
}

StateBlock WallHeats::save() const {
  StateBlock block;
  save_paths(block, "given", given_J_);
  block.reals["held_radiation_W"] = radiation_W_;
  return block;
}

void WallHeats::load(const StateBlock& block) {
  given_J_ = saved_paths(block, "given");
  radiation_W_ = saved_reals(block, "held_radiation_W");
  if (given_J_.size() != radiation_W_.size()) throw InputError("the heats of the walls are damaged");
}

void save_paths(StateBlock& block, const std::string& name, const std::vector<HeatPaths>& values) {
  auto &solid = block.reals[name + "_solid_J"], &gas = block.reals[name + "_gas_J"],
       &radiation = block.reals[name + "_radiation_J"];
  for (const HeatPaths& value : values) {
    solid.push_back(value.solid);
    gas.push_back(value.gas);
    radiation.push_back(value.radiation);
  }
}

std::vector<HeatPaths> saved_paths(const StateBlock& block, const std::string& name) {
  const auto &solid = saved_reals(block, name + "_solid_J"), &gas = saved_reals(block, name + "_gas_J"),
             &radiation = saved_reals(block, name + "_radiation_J");
  if (solid.size() != gas.size() || solid.size() != radiation.size())
    throw InputError("the heats of the walls are damaged");
  std::vector<HeatPaths> values;
  for (std::size_t k = 0; k < solid.size(); ++k) values.push_back({solid[k], gas[k], radiation[k]});
  return values;
}

}  // namespace granrad
