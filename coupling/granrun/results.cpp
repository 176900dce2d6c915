#include "coupling/granrun/results.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/simulation/radiation_source.h"

namespace granrad {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t batch_count = 8;

double mean_of(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  double sum = 0;
  for (std::size_t k = begin; k < end; ++k) sum += values[k];
  return end > begin ? sum / static_cast<double>(end - begin) : undefined;
}

Average average(const std::vector<double>& rows) {
  std::vector<double> defined;
  for (double value : rows)
    if (std::isfinite(value)) defined.push_back(value);
  Average result{mean_of(defined, 0, defined.size()), undefined};
  if (defined.size() < 2 * batch_count) return result;
  double squares = 0;
  for (std::size_t b = 0; b < batch_count; ++b) {
    const double batch =
        mean_of(defined, b * defined.size() / batch_count, (b + 1) * defined.size() / batch_count);
    squares += (batch - result.mean) * (batch - result.mean);
  }
  result.standard_error = std::sqrt(squares / (batch_count * (batch_count - 1)));
  return result;
}

void line(const char* what, const Average& average, const char* unit) {
  if (!std::isfinite(average.mean) || average.mean == 0) return;
  if (std::isfinite(average.standard_error))
    fmt::print("  {:<34}{:>12.5g} +- {:<9.2g} {}\n", what, average.mean, average.standard_error, unit);
  else
    fmt::print("  {:<34}{:>12.5g}              {}\n", what, average.mean, unit);
}

void print_seconds(const PartSeconds& s) {
  const double total = s.flow + s.conduction + s.radiation;
  if (total <= 0) return;
  const auto part = [&](double seconds) { return 100 * seconds / total; };
  fmt::print(
      "  computing: flow {:.1f} s ({:.0f} %), conduction {:.1f} s ({:.0f} %), radiation {:.1f} s ({:.0f} "
      "%)\n",
      s.flow, part(s.flow), s.conduction, part(s.conduction), s.radiation, part(s.radiation));
}

}  // namespace

double Results::mean(const std::string& name) const {
  const auto found = column.find(name);
  return found == column.end() ? undefined : found->second.mean;
}

Results summarise(const History& history) {
  Results results;
  const auto& time = history.at("time_s");
  if (time.empty()) {
    for (const auto& [name, values] : history) results.column[name] = average(values);
    return results;
  }
  const double middle = time.back() / 2;
  const auto first = std::lower_bound(time.begin(), time.end(), middle * (1 + 1e-9)) - time.begin();
  const auto begin = std::min<std::size_t>(first, time.size() - 1);
  results.from_s = begin > 0 ? time[begin - 1] : 0;
  results.to_s = time.back();
  for (const auto& [name, values] : history)
    results.column[name] = average({values.begin() + begin, values.end()});
  for (double defect : history.at("energy_defect"))
    results.largest_energy_defect = std::max(results.largest_energy_defect, defect);
  results.final_mean_temperature_K = history.at("mean_temperature_K").back();
  return results;
}

void print_results(const Case& c, const Results& results, const Simulation& simulation,
                   const CaseFolder& folder) {
  const auto& of = results.column;
  fmt::print("{}: means from {:g} s to {:g} s (radiation: {})\n", c.flow.name, results.from_s, results.to_s,
             describe(c.heat.radiation));
  line("wall to particles, h_wp", of.at("h_wp_W_m2K"), "W/m2K");
  line("  solid contacts", of.at("h_ss_W_m2K"), "W/m2K");
  line("  gas lenses", of.at("h_sfs_W_m2K"), "W/m2K");
  line("  radiation", of.at("h_rad_W_m2K"), "W/m2K");
  line("Nusselt number Nu_d", of.at("Nu_d"), "");
  line("mean temperature in the region", of.at("mean_temperature_K"), "K");
  line("temperature of leaving particles", of.at("outlet_temperature_K"), "K");
  line("solid fraction in the region", of.at("solid_fraction"), "");
  if (simulation.fed().inserted + simulation.fed().removed > 0) {
    line("mass flow in", of.at("mass_flow_in_kg_s"), "kg/s");
    line("mass flow out", of.at("mass_flow_out_kg_s"), "kg/s");
    line("mean velocity", of.at("mean_velocity_m_s"), "m/s");
    line("residence time", of.at("residence_time_s"), "s");
    line("Peclet number Pe_L", of.at("Pe_L"), "");
  }
  line("contacts per particle", of.at("coordination_number"), "");
  const double final_K = results.final_mean_temperature_K;
  fmt::print("  at the end: {} particles, {} in the region\n", simulation.bed().size(),
             std::isfinite(final_K) ? fmt::format("{:.2f} K", final_K) : "none");
  fmt::print("  energy: |stored - received| / received = {:.1e} at most\n", results.largest_energy_defect);
  print_seconds(simulation.seconds());
  fmt::print("  history {}   frames {}\n", folder.history().string(),
             (folder.root() / "run.hdf.series").string());
}

}  // namespace granrad
