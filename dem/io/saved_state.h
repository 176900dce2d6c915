#pragma once
#include "dem/io/snapshot.h"

namespace granrad {

/// Reading back what a frame holds beside the Bed. Each throws InputError when it is not there: the frame is
/// none of a run, or of another version of the program.
const StateBlock& saved_block(const Snapshot& frame, const std::string& name);
double saved_real(const StateBlock& block, const std::string& name);
std::int64_t saved_integer(const StateBlock& block, const std::string& name);
const std::vector<double>& saved_reals(const StateBlock& block, const std::string& name);

}  // namespace granrad
