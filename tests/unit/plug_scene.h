#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "dem/base/error.h"
#include "dem/scene/scene.h"

/// A scene of a plug as text, and what reading it gives.
namespace granrad::plug_scene_text {

// Line 1 holds the name of the scene; tests that count lines rely on it.
inline const std::string material =
    "[material]\ndensity_kg_m3 = 3984\nspecific_heat_J_kgK = 755\nconductivity_W_mK = 33\n"
    "youngs_modulus_Pa = \"5 MPa\"\nreal_youngs_modulus_Pa = \"414 GPa\"\npoisson_ratio = 0.23\n"
    "restitution = 0.45\nfriction = 0.4\n";
inline const std::string general = "[scene]\nend_time_s = 5\n";
inline const std::string particles = "[particles]\ndiameter_m = \"0.8 mm\"\ntemperature_K = 300\n";
inline const std::string box = "[box]\nsize_m = [0.010, 0.004, 0.050]\n";
inline const std::string plug = "[feed]\nkind = 'plug'\nsolid_fraction = 0.25\nmass_flow_kg_s = '1.59 g/s'\n";
inline const std::string plug_scene = general + material + particles + box + plug;

inline Scene parse(const std::string& text) {
  auto document = TomlDocument::from_string(text, "f.toml");
  Scene scene = read_scene(document);
  document.finish();
  return scene;
}

inline std::vector<std::string> problems_of(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, text.npos) << what;
  return text.replace(at, what.size(), by);
}

}  // namespace granrad::plug_scene_text
