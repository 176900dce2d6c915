#include <fmt/core.h>

#include <algorithm>
#include <functional>

#include "dem/scene/scene_parts.h"

namespace granrad {

namespace {

/// A temperature that changes; false where the table gives none.
bool read_course(TomlTable& table, Wall& wall) {
  const TemperatureCourse course{
      table.number_list(
          {"times_s", "instants of temperatures_K, from the start of the run", "none: temperature_K holds"},
          {.unit = "s", .min = 0}, 0),
      table.number_list(
          {"temperatures_K",
           "temperatures of an isothermal wall at times_s; linear in between, held before and after",
           "none: temperature_K holds"},
          {.unit = "K", .min = 0, .min_exclusive = true}, 0)};
  const auto& times = course.time_s;
  if (table.has("temperature_K") && !(times.empty() && course.temperature_K.empty()))
    table.problem("temperature_K", "stands beside times_s and temperatures_K; use one or the other");
  if (table.has("temperature_K")) wall.course = {};
  if (!table.has("times_s") && !table.has("temperatures_K")) return false;
  if (wall.role == WallRole::open)
    table.problem("temperatures_K", "the surroundings have one temperature: give temperature_K");
  if (times.size() != course.temperature_K.size() || times.empty())
    table.problem("temperatures_K", fmt::format("has {} temperatures for {} of times_s",
                                                course.temperature_K.size(), times.size()));
  else if (std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) != times.end())
    table.problem("times_s", "must ascend, each instant once; for a jump give two that are close");
  else
    wall.temperature_K = course.at(0), wall.course = course;
  return true;
}

bool has_temperature(WallRole role) {
  return role == WallRole::isothermal || role == WallRole::open;
}

void read_temperature(TomlTable& table, Wall& wall, bool inherits) {
  const Key key{"temperature_K", "temperature of an isothermal or open wall"};
  const NumberRule rule{.unit = "K", .min = 0, .min_exclusive = true};
  if (has_temperature(wall.role)) {
    if (!read_course(table, wall))
      wall.temperature_K = inherits ? table.number(key, rule, wall.temperature_K) : table.number(key, rule);
    return;
  }
  wall.course = {};
  for (const char* given : {"temperature_K", "times_s", "temperatures_K"})
    if (table.has(given))
      table.problem(given, fmt::format("an {} wall has no temperature of its own: remove it, or choose "
                                       "role = \"isothermal\"",
                                       to_string(wall.role)));
}

}  // namespace

void read_wall_properties(TomlTable& table, Wall& wall, const Scene& scene, bool role_required,
                          bool inherits) {
  if (role_required && !inherits && !table.has("role"))
    table.problem("role",
                  "missing: radiation is on, so every wall must choose \"isothermal\", \"adiabatic\", "
                  "\"open\" or \"excluded\"");
  const WallRole before = wall.role;
  wall.role = table.choice(
      {"role",
       "isothermal: held at temperature_K; adiabatic: re-radiates what it receives; open: black surroundings; excluded: left out of the exchange",
       "required when radiation is on, else adiabatic"},
      wall_roles, inherits ? before : WallRole::adiabatic);
  read_temperature(table, wall, inherits && has_temperature(before));
  if (wall.role == WallRole::open) {
    wall.emissivity = 1;
    if (table.has("emissivity"))
      table.problem("emissivity",
                    "an open wall is the black surroundings: remove it, or choose role = \"isothermal\"");
  } else {
    wall.emissivity =
        table.number({"emissivity", "of the wall, grey and diffuse", "emissivity of the material"},
                     {.min = 0, .max = 1, .why = "grey diffuse surface"},
                     inherits && before != WallRole::open ? wall.emissivity : scene.materials[0].emissivity);
  }
  wall.contact =
      table.boolean({"contact", "particles touch it", "true, but for the ends of a plug"}, wall.contact);
  wall.velocity_m_s = table.vec3({"velocity_m_s", "speed of the surface, which drags particles along it"},
                                 {.unit = "m/s"}, wall.velocity_m_s);
  wall.opens_at_s = table.number({"opens_at_s", "time at which the wall is taken away", "never"},
                                 {.unit = "s", .min = 0}, wall.opens_at_s);
}

}  // namespace granrad
