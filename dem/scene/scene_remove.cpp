#include "dem/base/constants.h"
#include "dem/scene/scene_parts.h"

namespace granrad {

namespace {

/// {axis = "z", value = -0.01}: everything below that plane.
Box half_space(TomlTable below) {
  const std::string axis = below.choice({"axis", "axis across the plane"}, {"x", "y", "z"});
  const double value = below.number({"value", "place of the plane: particles below it leave"}, {.unit = "m"});
  Box box{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  box.max[axis == "x" ? 0 : axis == "y" ? 1 : 2] = value;
  return box;
}

}  // namespace

void read_removals(TomlTable root, Scene& scene) {
  for (auto& table :
       root.tables({"remove", "particles in these places leave, counted with their mass and heat"})) {
    TomlTable below = table.table({"below_m", "a plane below which particles leave"});
    if (below.present()) {
      scene.removals.push_back(half_space(below));
      const bool from = table.has("min_m"), to = table.has("max_m");
      if (!from && !to) continue;
      table.problem("below_m", "and a box are two places: write two [[remove]]");
    }
    Box box;
    box.min = table.vec3({"min_m", "lower corner of the box in which particles leave"}, {.unit = "m"});
    box.max = table.vec3({"max_m", "upper corner of that box"}, {.unit = "m"});
    for (int axis = 0; axis < 3; ++axis)
      if (table.has("min_m") && table.has("max_m") && !(box.max[axis] > box.min[axis])) {
        table.problem("max_m", "must be beyond min_m along every axis");
        break;
      }
    scene.removals.push_back(box);
  }
  if (!scene.removals.empty() && scene.engine == EngineKind::none)
    root.problem("remove", "has no meaning in a frozen bed (nothing moves); leave it out");
}

}  // namespace granrad
