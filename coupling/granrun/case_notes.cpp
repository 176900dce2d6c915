#include "coupling/granrun/case_notes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "coupling/heat/wall_area.h"
#include "coupling/heat/wall_coefficients.h"

namespace granrad {

namespace {

constexpr double resting_exponent = 1.0 / 3;

/// Contacts of a plug last for collisions; elsewhere particles lie on each other.
bool rests(const Scene& scene) {
  return scene.engine == EngineKind::none || scene.feed.kind != FeedSettings::Kind::plug;
}

std::string modulus_note(const Case& c) {
  if (!c.heat.conduction.solid || c.heat.modulus_exponent_chosen || !rests(c.flow)) return "";
  double factor = 1;
  for (const Material& m : c.flow.materials)
    factor = std::max(factor, std::pow(m.real_youngs_modulus_Pa / m.youngs_modulus_Pa,
                                       resting_exponent - c.heat.conduction.modulus_exponent));
  if (factor < 1.01) return "";
  return fmt::format(
      "conduction.modulus_exponent = {:g} by default, right for collisions: contacts that carry a load, as in a bed at "
      "rest or in a slow one, conduct {:.2g} times too well with it; choose modulus_exponent = 0.333 for those, or "
      "write {:g} to keep it",
      c.heat.conduction.modulus_exponent, factor, c.heat.conduction.modulus_exponent);
}

std::string outside_walls_note(const Case& c) {
  std::string names;
  for (const Wall& wall : c.flow.walls)
    if (wall.role == WallRole::isothermal && area_inside(wall, c.flow.region) == 0)
      names += (names.empty() ? "" : ", ") + wall.name;
  if (names.empty()) return "";
  return fmt::format(
      "isothermal walls outside the heat-transfer region: {}. They count in no area and no coefficient, "
      "and radiate only if they (or the body they are a side of) touch the region; [region] min_m, max_m would take them in",
      names);
}

std::string temperatures_note(const Case& c, const Bed& bed) {
  const auto walls = hot_walls(bed, c.flow.region);
  if (walls.empty() || at_one_temperature(bed, walls)) return "";
  std::string list;
  for (const std::size_t w : walls)
    list +=
        fmt::format("{}{} {:g} K", list.empty() ? "" : ", ", bed.walls[w].name, bed.walls[w].temperature_K);
  return fmt::format(
      "isothermal walls at several temperatures ({}): there is no h_wp and no Nu; walls.csv and "
      "results.json tell the heat of each wall",
      list);
}

std::string filling_note(const Case& c, const Bed& bed) {
  const FeedSettings& feed = c.flow.feed;
  const auto asked = static_cast<std::size_t>(feed.particle_count);
  if (feed.kind != FeedSettings::Kind::hopper || feed.rate_1_s > 0 || bed.size() >= asked) return "";
  return fmt::format(
      "feed.particle_count = {}: {} particles are there at time 0, as many as fit into feed.fill_region; the others follow "
      "where there is room",
      asked, bed.size());
}

}  // namespace

std::vector<std::string> case_notes(const Case& c, const Bed& bed) {
  std::vector<std::string> notes;
  for (const auto& note :
       {modulus_note(c), outside_walls_note(c), temperatures_note(c, bed), filling_note(c, bed)})
    if (!note.empty()) notes.push_back(note);
  return notes;
}

}  // namespace granrad
