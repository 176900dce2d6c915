#include "coupling/granrun/check.h"

#include <fmt/core.h>

#include <cmath>
#include <string>
#include <vector>

#include "coupling/forecast/forecast.h"
#include "coupling/forecast/scaling.h"
#include "coupling/granrun/case_notes.h"
#include "coupling/heat/wall_coefficients.h"
#include "coupling/simulation/radiation_source.h"
#include "coupling/simulation/simulation.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/bed/solid_fraction.h"

namespace granrad {

namespace {

struct Verdict {
  std::vector<std::string> modelled, left_out;
  void say(bool is_modelled, const std::string& yes, const std::string& no) {
    (is_modelled ? modelled : left_out).push_back(is_modelled ? yes : no);
  }
};

bool has_role(const Scene& scene, WallRole role) {
  for (const Wall& wall : scene.walls)
    if (wall.role == role) return true;
  return false;
}

bool is_black(const Case& c) {
  for (const Material& material : c.flow.materials)
    if (material.emissivity < 1) return false;
  for (const Wall& wall : c.flow.walls)
    if (wall.role == WallRole::adiabatic || (wall.role == WallRole::isothermal && wall.emissivity < 1))
      return false;
  return true;
}

std::string names_of(const Scene& scene, WallRole role) {
  std::string names;
  for (const Wall& wall : scene.walls)
    if (wall.role == role) names += (names.empty() ? "" : ", ") + wall.name;
  return names;
}

void judge_flow(const Case& c, Verdict& verdict) {
  const Scene& scene = c.flow;
  const bool moves = scene.engine != EngineKind::none;
  const char* engine = scene.engine == EngineKind::liggghts ? "LIGGGHTS" : "native DEM engine";
  verdict.say(
      moves,
      scene.engine == EngineKind::replay
          ? fmt::format("flow: the recording of {} files, {}", scene.replay.files.size(),
                        scene.replay.interpolated ? "interpolated" : "the nearest snapshot at each time")
          : fmt::format("flow: {}, Hertz-Mindlin contacts with history{}", engine,
                        scene.precision == Precision::mixed ? ", their law in single precision" : ""),
      "flow: dem.engine = \"none\", the bed is frozen");
  if (!moves || scene.engine == EngineKind::replay) return;
  verdict.say(norm(scene.gravity_m_s2) > 0, fmt::format("gravity {:g} m/s2", norm(scene.gravity_m_s2)),
              "gravity: scene.gravity_m_s2 is 0");
  verdict.say(scene.feed.kind != FeedSettings::Kind::none, "feed: particles enter and leave",
              "feed: no [feed], no particles come");
  verdict.say(!scene.removals.empty(),
              fmt::format("removal of particles in {} places", scene.removals.size()),
              "removal: no [[remove]]");
  bool friction = false, rolling = false;
  for (const Material& material : scene.materials) {
    friction = friction || material.friction > 0;
    rolling = rolling || material.rolling_friction > 0;
  }
  verdict.say(friction, "sliding friction", "sliding friction: material.friction is 0");
  verdict.say(rolling, "rolling friction", "rolling friction: material.rolling_friction is 0");
}

/// A collision may begin and end between two heat steps.
const char* how_contacts_are_seen(EngineKind engine) {
  if (engine == EngineKind::native) return ", integrated over every DEM step";
  return engine == EngineKind::liggghts ? ", as they stand at each heat step (short collisions are sampled)"
                                        : "";
}

void judge_conduction(const Case& c, Verdict& verdict) {
  const auto& conduction = c.heat.conduction;
  verdict.say(conduction.solid,
              fmt::format("conduction through contacts, modulus exponent {:g}{}", conduction.modulus_exponent,
                          how_contacts_are_seen(c.flow.engine)),
              "conduction through contacts: conduction.solid = false");
  verdict.say(conduction.gas.has_value(),
              conduction.gas
                  ? fmt::format("conduction through gas lenses of {:g} radii, {:g} W/mK",
                                conduction.gas->lens_radius_ratio, conduction.gas->conductivity_W_mK)
                  : "",
              "conduction through gas: no [gas]; no lens pairs are searched");
}

void judge_radiation(const Case& c, Verdict& verdict) {
  const auto& radiation = c.heat.radiation;
  const bool on = radiation.kind != RadiationKind::none;
  verdict.say(on, "radiation: " + describe(radiation),
              "radiation: no [radiation] or source = \"none\"; no enclosure is built");
  if (!on) return;
  if (radiation.kind != RadiationKind::paths)
    verdict.say(!is_black(c), "radiosity solve (grey or re-radiating surfaces)",
                "radiosity solve: every surface is black");
  if (c.flow.engine == EngineKind::none && radiation.kind != RadiationKind::paths)
    verdict.left_out.push_back("new view factors per update: the bed is frozen, they are found once");
}

void judge_walls(const Case& c, const Bed& bed, Verdict& verdict) {
  for (WallRole role : {WallRole::isothermal, WallRole::adiabatic, WallRole::open, WallRole::excluded})
    if (has_role(c.flow, role))
      verdict.modelled.push_back(fmt::format("walls {}: {}", to_string(role), names_of(c.flow, role)));
  const auto walls = hot_walls(bed, c.flow.region);
  const char* const coefficients = "wall-to-particle coefficients";
  if (walls.empty())
    verdict.left_out.push_back(fmt::format("{}: no isothermal wall in the region", coefficients));
  else
    verdict.say(at_one_temperature(bed, walls), coefficients,
                fmt::format("{}: the isothermal walls have several temperatures", coefficients));
}

std::string seconds(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g} s", value) : "none";
}

void print_limits(const Simulation& simulation) {
  const auto& limits = simulation.limits();
  const auto& plan = simulation.plan();
  fmt::print("\nstep limits\n");
  const auto row = [](const std::string& what, double value_s, const std::string& remark) {
    fmt::print("  {:<27} {:<12} {}\n", what, seconds(value_s), remark);
  };
  if (std::isfinite(limits.dem_s)) {
    row("Rayleigh time", limits.rayleigh_time_s, "step allowed: 0.3 of it");
    row(fmt::format("Hertz time at {:.3g} m/s", limits.impact_speed_m_s), limits.hertz_time_s,
        "step allowed: 0.1 of it");
    row("DEM step", plan.step_s, fmt::format("largest allowed {}", seconds(limits.dem_s)));
  }
  row("heat step", plan.tick_s,
      fmt::format("conduction allows {} at time 0", seconds(simulation.conduction_limit_s())));
  if (plan.ticks_per_radiation > 0) {
    row("radiation update", plan.tick_s * static_cast<double>(plan.ticks_per_radiation),
        fmt::format("second order up to {}, beyond implicit", seconds(limits.radiation_s)));
    if (std::isfinite(limits.motion_s)) row("", limits.motion_s, "would follow the motion");
  }
  if (std::isfinite(limits.dem_s)) fmt::print("  {} DEM steps per heat step\n", plan.steps_per_tick);
  fmt::print("  {} heat steps in {}{}\n", plan.end_tick, seconds(plan.time_s(plan.end_tick)),
             plan.cuts(plan.end_tick) ? ", the last one cut short" : "");
}

std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return seconds < 2e5 ? fmt::format("{:.1f} h", seconds / 3600)
                       : fmt::format("{:.3g} days", seconds / 86400);
}

void print_forecast(const Case& c, Simulation& simulation, const RunOptions& options,
                    const CheckOptions& asked) {
  const Bed bed = simulation.bed();
  const Forecast cost = forecast(c, simulation, options.threads);
  fmt::print("\nforecast for this machine, {}\n",
             cost.speed_in_contact > 0
                 ? fmt::format("the flow of a bed in contact: {:.2g} million particle-steps a second",
                               cost.speed_in_contact / 1e6)
                 : "from a trial of the bed at time 0");
  fmt::print("  flow {}, conduction {}, radiation {}, output {}: about {}\n", duration(cost.flow_s),
             duration(cost.conduction_s), duration(cost.radiation_s), duration(cost.output_s),
             duration(cost.total_s()));
  fmt::print("  memory about {:.0f} MB, on disk {:.0f} frames of {:.2g} MB\n", cost.memory_bytes / 1e6,
             cost.frames, cost.frame_bytes / 1e6);
  if (asked.ranks > 1) fmt::print("{}", scaling_text(c, cost, asked.ranks));
  if (!asked.slurm.empty()) {
    const auto name = std::filesystem::path(asked.slurm).stem().string();
    write_text_file(asked.slurm,
                    slurm_script(c, cost, asked.ranks, cost.threads,
                                 fmt::format("granrun run {} -o {}_case", asked.scene_line, name)));
  }
  const auto sources = source_costs(c, bed, options.threads);
  if (sources.empty()) return;
  std::string list;
  for (const auto& one : sources)
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", one.source, duration(one.seconds));
  fmt::print("  computing for {:g} % standard error of the wall heat at one update:\n    {}\n",
             100 * sources.front().error, list);
}

}  // namespace

int check_case(const Case& c, const RunOptions& options, const CheckOptions& asked) {
  Simulation simulation(c, options.threads);
  simulation.start();
  if (!options.quiet())
    fmt::print("# the scene in force\n{}\n", asked.defaults ? c.text_with_defaults : c.effective_text);
  Verdict verdict;
  judge_flow(c, verdict);
  judge_conduction(c, verdict);
  judge_radiation(c, verdict);
  judge_walls(c, simulation.bed(), verdict);
  fmt::print("modelled\n");
  for (const auto& text : verdict.modelled) print_message(fmt::format("  {}", text), stdout);
  fmt::print("left out\n");
  for (const auto& text : verdict.left_out) print_message(fmt::format("  {}", text), stdout);
  print_limits(simulation);
  for (const auto& note : simulation.notes()) print_message(fmt::format("  note: {}", note), stdout);
  if (const auto note = end_note(simulation.plan(), c.flow.end_time_s); !note.empty())
    print_message(fmt::format("  note: {}", note), stdout);
  for (const auto& note : case_notes(c, simulation.bed()))
    print_message(fmt::format("  note: {}", note), stdout);
  fmt::print("\n{} particles at time 0, solid fraction {:.4f} in the region\n", simulation.bed().size(),
             solid_fraction(simulation.bed(), c.flow.region));
  print_forecast(c, simulation, options, asked);
  return exit_ok;
}

}  // namespace granrad
