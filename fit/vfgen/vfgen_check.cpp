#include <fmt/core.h>

#include <algorithm>

#include "dem/base/error.h"
#include "fit/vfgen/check_table.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

int run_check(const std::filesystem::path& table, Verbosity verbosity) {
  const auto findings = check_table(read_correlation(table));
  std::size_t problems = 0;
  for (const auto& finding : findings) {
    if (finding.problem) ++problems;
    if (finding.problem || verbosity != Verbosity::quiet)
      fmt::print("{} {}\n", finding.problem ? "problem" : "note   ", finding.text);
  }
  fmt::print("{}: {}\n", table.string(), problems == 0 ? "sound" : fmt::format("{} problems", problems));
  return problems == 0 ? exit_ok : exit_bad_input;
}

}  // namespace granrad
