#include "fit/trace/view_factor_samples.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "dem/base/error.h"
#include "fit/correlation/solid_fraction_field.h"
#include "raytrace/rays/view_factor_file.h"
#include "raytrace/same_geometry.h"

namespace granrad {

std::vector<FittableFile> look_at(const std::vector<std::filesystem::path>& files) {
  std::vector<FittableFile> fittable;
  std::vector<std::string> problems;
  std::map<std::uint64_t, std::string> known;
  const auto look = [&](const std::filesystem::path& file) {
    const std::string name = file.string();
    const auto traced = read_view_factors(file);
    if (std::any_of(traced.emissivity.begin(), traced.emissivity.end(), [](double e) { return e != 1; }))
      problems.push_back(
          advised(name + ": holds total exchange areas of grey surfaces (a table is fitted to view factors)",
                  "trace without --emissivity"));
    if (!traced.check.failed.empty())
      problems.push_back(advised(fmt::format("{}: its self-check failed ({})", name, traced.check.failed),
                                 "mend the walls or the snapshot and trace it again"));
    const auto [same, is_new] = known.emplace(geometry_key(traced.enclosure), name);
    if (!is_new)
      problems.push_back(advised(
          fmt::format(
              "{}: the same bed as {} (one snapshot twice is not two, and would make errors look small)",
              name, same->second),
          "give each snapshot once"));
    fittable.push_back({file, solid_fraction(traced.enclosure)});
  };
  for (const auto& file : files) try {
      look(file);
    } catch (const InputError& error) {
      const std::string name = file.string();
      for (const auto& problem : error.problems())
        problems.push_back(problem.starts_with(name) ? problem : fmt::format("{}: {}", name, problem));
    }
  if (!problems.empty()) throw InputError(problems);
  return fittable;
}

std::vector<SampleSet> read_samples(const std::vector<FittableFile>& files,
                                    const std::vector<std::size_t>& which, double pp_cutoff) {
  std::vector<SampleSet> samples;
  for (const std::size_t k : which) {
    const auto traced = read_view_factors(files[k].file);
    samples.push_back(make_samples(traced.enclosure, traced.counts, pp_cutoff, files[k].file.string()));
  }
  return samples;
}

std::string snapshot_warning(double solid_fraction, std::size_t snapshots) {
  if (snapshots > 1) return "";
  return advised(
      fmt::format("solid fraction {:.4f}: one snapshot (nothing is held out, and the errors of the "
                  "coefficients take its pairs as independent, which makes them 2.6 to 10 times too small)",
                  solid_fraction),
      "trace four or more snapshots of the same flow");
}

}  // namespace granrad
