#include "dem/io/saved_state.h"

#include <fmt/core.h>

#include "dem/base/error.h"

namespace granrad {

namespace {

/// The column, with `size` values (0: any number).
template <class Columns>
const auto& column(const Columns& columns, const std::string& name, std::size_t size) {
  const auto found = columns.find(name);
  if (found == columns.end() || (size > 0 && found->second.size() != size))
    throw InputError(
        advised(fmt::format("the frame lacks '{}': it is of no run, or of another version", name),
                "start a new case"));
  return found->second;
}

}  // namespace

const StateBlock& saved_block(const Snapshot& frame, const std::string& name) {
  const auto found = frame.state.find(name);
  if (found == frame.state.end())
    throw InputError(
        advised(fmt::format("{} (a frame without the state of a run: it cannot be resumed)", frame.origin),
                "start a new case"));
  return found->second;
}

double saved_real(const StateBlock& block, const std::string& name) {
  return column(block.reals, name, 1)[0];
}

std::int64_t saved_integer(const StateBlock& block, const std::string& name) {
  return column(block.integers, name, 1)[0];
}

const std::vector<double>& saved_reals(const StateBlock& block, const std::string& name) {
  return column(block.reals, name, 0);
}

}  // namespace granrad
