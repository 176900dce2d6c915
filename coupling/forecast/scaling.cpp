#include "coupling/forecast/scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/engine_liggghts.h"

namespace granrad {

namespace {

// LIGGGHTS' seconds over the native engine's on one core, settled and flowing beds (docs/performance.md).
constexpr double liggghts_slowness = 7;
// Of one sphere at a heat step of LIGGGHTS: what each rank does for its own, most of it LIGGGHTS' set-up of a run; what all
// ranks do for every sphere.
constexpr double set_up_s = 4.5e-7, hand_over_s = 1.5e-7;
constexpr double searched_share =
    0.65;  // of conduction: pairs and their conductances, which ranks share there
constexpr double network_B_s = 1e9, network_delay_s = 5e-5;
constexpr double liggghts_bytes = 700;  // of a sphere, over all ranks
constexpr double least_gain = 1.25;     // of twice as many ranks

/// Bytes a surface that a rank sends or gets at one update.
double exchanged_bytes_of(const RadiationSettings& settings, int ranks) {
  constexpr double heats = 16, wide_integer = 16, replicates = 4, integer = 8, pairs = 40;
  switch (settings.kind) {
    case RadiationKind::paths:
      return wide_integer * (16.0 / ranks + 1) + heats;
    case RadiationKind::lines:
      return replicates * integer;
    case RadiationKind::embree:
      return pairs * 24;
    default:
      return 0;
  }
}

}  // namespace

RankForecast forecast_on_ranks(const Case& c, const Forecast& one, EngineKind engine, int ranks) {
  RankForecast cost;
  cost.ranks = ranks;
  cost.memory_bytes = one.memory_bytes;
  cost.flow_s = one.flow_s;
  if (engine == EngineKind::liggghts) {
    const double in_all =
        one.flow_s * (c.flow.engine == EngineKind::liggghts ? 1 : liggghts_slowness * one.threads);
    cost.flow_s = in_all / ranks;
    cost.gather_s = one.heat_steps * one.mean_count * (set_up_s / ranks + hand_over_s);
    cost.memory_bytes += liggghts_bytes * one.mean_count / ranks;
  }
  const bool searches = engine == EngineKind::liggghts || engine == EngineKind::replay;
  const double shared_conduction = searches ? searched_share : 0;
  cost.conduction_s = one.conduction_s * (1 - shared_conduction + shared_conduction / ranks);
  cost.output_s = one.output_s;
  const double shared_s = one.radiation_s - one.radiation_repeated_s;
  cost.radiation_s = one.radiation_repeated_s + shared_s / ranks;
  if (ranks > 1)
    cost.radiation_s +=
        one.radiation_updates * (2 * network_delay_s * std::ceil(std::log2(ranks)) +
                                 exchanged_bytes_of(c.heat.radiation, ranks) * one.mean_count / network_B_s);
  return cost;
}

int where_it_stops_scaling(const Case& c, const Forecast& one, EngineKind engine, int most) {
  int ranks = 1;
  while (ranks < most && forecast_on_ranks(c, one, engine, ranks).total_s() >
                             least_gain * forecast_on_ranks(c, one, engine, 2 * ranks).total_s())
    ranks *= 2;
  return ranks;
}

std::string scaling_text(const Case& c, const Forecast& one, int ranks) {
  constexpr int most = 1024;
  const bool moves = c.flow.engine == EngineKind::native || c.flow.engine == EngineKind::liggghts;
  std::vector<EngineKind> engines = {c.flow.engine};
  if (c.flow.engine == EngineKind::native && liggghts_problems(c.flow).empty())
    engines.push_back(EngineKind::liggghts);
  std::string text = fmt::format(
      "\nforecast for ranks, one a node of {} threads (seconds; a model, see the documents)\n"
      "  {:<9} {:>5} {:>9} {:>9} {:>10} {:>9} {:>9} {:>9} {:>9}\n",
      one.threads, "engine", "ranks", "flow", "gather", "conduction", "radiation", "output", "total",
      "MB each");
  for (const EngineKind engine : engines)
    for (int r = 1;; r = std::min(2 * r, ranks)) {
      const RankForecast f = forecast_on_ranks(c, one, engine, r);
      text += fmt::format("  {:<9} {:>5} {:>9.3g} {:>9.3g} {:>10.3g} {:>9.3g} {:>9.3g} {:>9.3g} {:>9.0f}\n",
                          engine_names.of(engine), r, f.flow_s, f.gather_s, f.conduction_s, f.radiation_s,
                          f.output_s, f.total_s(), f.memory_bytes / 1e6);
      if (r >= ranks) break;
    }
  for (const EngineKind engine : engines)
    text += fmt::format("  {}: twice as many ranks save less than a fifth from {} on\n",
                        engine_names.of(engine), where_it_stops_scaling(c, one, engine, most));
  if (!moves || engines.size() < 2) return text;
  int pays = 1;
  const double native_s = forecast_on_ranks(c, one, EngineKind::native, ranks).total_s();
  while (pays <= most && forecast_on_ranks(c, one, EngineKind::liggghts, pays).total_s() >= native_s)
    pays *= 2;
  text += pays <= most
              ? fmt::format("  liggghts is faster than native on {} ranks from {} ranks on\n", ranks, pays)
              : fmt::format("  native on {} ranks is faster than liggghts on any number\n", ranks);
  return text;
}

std::string slurm_script(const Case& c, const Forecast& one, int ranks, int threads,
                         const std::string& command) {
  constexpr double margin = 1.5, least_s = 900, before_end_s = 300;
  const RankForecast f = forecast_on_ranks(c, one, c.flow.engine, ranks);
  const auto clock = [](double seconds) {
    const auto s = static_cast<std::int64_t>(std::ceil(seconds));
    return fmt::format("{:02}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
  };
  const double time_s = std::max(least_s, margin * f.total_s());
  std::string name = c.flow.name;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char l) { return !std::isalnum(l); }, '_');
  const std::string launcher = ranks > 1 ? "mpirun --map-by ppr:1:node --bind-to none " : "";
  return fmt::format(
      "#!/bin/bash\n"
      "#SBATCH --job-name={}\n"
      "#SBATCH --nodes={}\n"
      "#SBATCH --ntasks-per-node=1\n"
      "#SBATCH --cpus-per-task={}\n"
      "#SBATCH --mem={:.0f}M\n"
      "#SBATCH --time={}\n"
      "# Started again it goes on from its last frame; where the time was too short it starts itself again.\n"
      "{}{} --threads {} --resume --walltime {}\n"
      "code=$?\n"
      "[ $code -eq 75 ] && exec sbatch \"$0\"\n"
      "exit $code\n",
      name, ranks, threads, std::ceil(margin * f.memory_bytes / 1e6), clock(time_s), launcher, command,
      threads, clock(time_s - before_end_s));
}

}  // namespace granrad
