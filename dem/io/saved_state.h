#pragma once
#include "dem/io/snapshot.h"

namespace granrad {

/// Reading back what a frame holds beside the Bed. Each throws InputError when it is not there: the frame is
/// none of a run, or of another version of the program.
const StateBlock& saved_block(const Snapshot& frame, const std::string& name);
double saved_real(const StateBlock& block, const std::string& name);
std::int64_t saved_integer(const StateBlock& block, const std::string& name);
const std::vector<double>& saved_reals(const StateBlock& block, const std::string& name);

/// Both ways of one list: `visit(values, integer, real)` calls integer(name, member) and real(name, member) for each
/// member of `values` that a restart needs.
template <class Values, class Visit>
void save_values(const Values& values, StateBlock& block, Visit visit) {
  visit(
      values, [&](const char* name, std::int64_t value) { block.integers[name] = {value}; },
      [&](const char* name, double value) { block.reals[name] = {value}; });
}
template <class Values, class Visit>
void restore_values(Values& values, const StateBlock& block, Visit visit) {
  visit(
      values, [&](const char* name, std::int64_t& value) { value = saved_integer(block, name); },
      [&](const char* name, double& value) { value = saved_real(block, name); });
}

}  // namespace granrad
