#include <fmt/core.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/base/program.h"
#include "fit/vfgen/check_table.h"
#include "fit/vfgen/vfgen_commands.h"

namespace granrad {

namespace {

/// F of every row at some distances, held within the bounds as in use; walls against an unbounded one.
void print_curves(const CorrelationTable& table) {
  for (const auto& row : table.rows) {
    const Correlation held(table, row.solid_fraction);
    std::string pairs, walls;
    for (const double d : {1.0, 1.5, 2.0, 3.0, 5.0})
      pairs += fmt::format("  F_pp({}) = {:.4g}", d, held.pp(d));
    for (const double h : {0.5, 1.0, 2.0, 5.0})
      walls += fmt::format("  F_pw({}) = {:.4g}", h, held.pw(h, 0.5));
    fmt::print("curve   solid fraction {}:{};{} (h/d, wide wall)\n", row.solid_fraction, pairs, walls);
  }
}

}  // namespace

int run_check(const std::filesystem::path& table, Verbosity verbosity) {
  const auto read = read_correlation(table);
  const auto findings = check_table(read);
  if (verbosity == Verbosity::verbose) print_curves(read);
  std::size_t problems = 0;
  for (const auto& finding : findings) {
    if (finding.problem) ++problems;
    if (finding.problem || verbosity != Verbosity::quiet)
      print_message(fmt::format("{} {}", finding.problem ? "problem" : "note   ", finding.text), stdout);
  }
  fmt::print("{}: {}\n", table.string(),
             problems == 0 ? "sound" : fmt::format("{} problem{}", problems, problems == 1 ? "" : "s"));
  return problems == 0 ? exit_ok : exit_bad_input;
}

}  // namespace granrad
