#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "coupling/simulation/simulation.h"
#include "dem/base/constants.h"
#include "tests/temporary_folder.h"

/// Walls written as a box, polygons or meshes, and the heat of a sphere among them.
namespace granrad::written_walls {

inline constexpr double hot_K = 1000, cold_K = 300;
inline double exitance(double t) {
  return stefan_boltzmann * t * t * t * t;
}

using Move = std::function<Vec3(const Vec3&)>;
using Corners = std::vector<Vec3>;

inline std::string list(const Corners& corners) {
  std::string text;
  for (const Vec3& v : corners)
    text += fmt::format("{}[{:.17g}, {:.17g}, {:.17g}]", text.empty() ? "" : ", ", v.x, v.y, v.z);
  return "[" + text + "]";
}

inline std::string polygon(const std::string& name, const Corners& corners, double t) {
  return fmt::format(
      "[[polygon]]\nname = \"{}\"\nvertices_m = {}\nrole = \"isothermal\"\ntemperature_K = {}\nemissivity = 1\n",
      name, list(corners), t);
}

inline std::string mesh(const std::string& name, double t, const std::string& more = "") {
  return fmt::format(
      "[[mesh]]\nname = \"{0}\"\nfile = \"{0}.stl\"\nrole = \"isothermal\"\ntemperature_K = {1}\nemissivity = 1\n{2}",
      name, t, more);
}

inline std::string stl(const std::vector<Corners>& faces) {
  std::string text = "solid s\n";
  for (const auto& face : faces)
    for (std::size_t k = 2; k < face.size(); ++k) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const Vec3& v : {face[0], face[k - 1], face[k]})
        text += fmt::format("vertex {:.9g} {:.9g} {:.9g}\n", v.x, v.y, v.z);
      text += "endloop\nendfacet\n";
    }
  return text + "endsolid s\n";
}

inline Corners moved(const Corners& corners, const Move& move) {
  Corners all;
  for (const Vec3& v : corners) all.push_back(move(v));
  return all;
}

inline Corners reversed(Corners corners) {
  return {corners.rbegin(), corners.rend()};
}

inline const Box room{{0, 0, 0}, {0.01, 0.01, 0.01}};
inline const Corners patch{{0.003, 0.003, 0}, {0.007, 0.003, 0}, {0.007, 0.007, 0}, {0.003, 0.007, 0}};
inline const Vec3 above{0.005, 0.005, 0.002};  ///< 2 mm over the middle of the patch

inline std::string box_text(double t) {
  std::string text = "[box]\nsize_m = [0.01, 0.01, 0.01]\n";
  for (const auto& wall : box_walls(room))
    text +=
        fmt::format("[walls.{}]\nrole = \"isothermal\"\ntemperature_K = {}\nemissivity = 1\n", wall.name, t);
  return text;
}

inline std::string polygons_text(const Move& move, double t, bool backwards = false) {
  std::vector<std::string> all;
  for (const auto& wall : box_walls(room))
    all.push_back(polygon("wall_" + wall.name, moved(wall.vertices, move), t));
  if (backwards) std::reverse(all.begin(), all.end());
  std::string text;
  for (const auto& one : all) text += one;
  return text;
}

struct Written {
  std::string walls;
  Vec3 centre = above;
  double radius = 5e-4;
  std::map<std::string, std::string> files{};
};

/// Heat of the one sphere, W, its stated error, and what the program remarks.
struct Measured {
  double heat_W, error_W;
  std::string notes{};
};

/// Within four stated errors, and those small enough that an uncovered patch (half the heat and more) would stand out by
/// ten and more of them.
inline void expect_within(const Measured& found, double expected_W, double largest_error = 0.05) {
  EXPECT_LE(std::abs(found.heat_W - expected_W), 4 * found.error_W)
      << found.heat_W << " +- " << found.error_W << " for " << expected_W;
  EXPECT_LT(found.error_W, largest_error * expected_W);
}

inline Measured heat(const Written& scene, const std::string& source, double rays) {
  const TemporaryFolder folder;
  for (const auto& [name, text] : scene.files) folder.write(name, text);
  folder.write("bed.csv", fmt::format("x,y,z,radius,temperature\n{:.17g},{:.17g},{:.17g},{},{}\n",
                                      scene.centre.x, scene.centre.y, scene.centre.z, scene.radius, cold_K));
  const auto file = folder.write(
      "scene.toml",
      fmt::format(
          "[scene]\nname = \"s\"\nend_time_s = 0.01\n[material]\ndensity_kg_m3 = 2500\n"
          "specific_heat_J_kgK = 800\nconductivity_W_mK = 1\nyoungs_modulus_Pa = 5e6\npoisson_ratio = 0.3\n"
          "restitution = 0.5\nfriction = 0.3\nemissivity = 1\n[particles]\nfile = \"bed.csv\"\n[dem]\nengine = "
          "\"none\"\n[conduction]\nsolid = false\n[radiation]\nsource = \"{}\"\nrays = {}\nevery_s = 0.01\n{}",
          source, rays, scene.walls));
  const Case c = read_case(file, {});
  Simulation simulation(c, 1);
  simulation.start();
  const auto drawn = simulation.draw_radiation(1);
  std::string notes;
  for (const auto& note : simulation.notes()) notes += note + "\n";
  return {drawn.heat_W.at(0), drawn.standard_error_W.at(0), notes};
}

inline const std::vector<std::pair<std::string, double>> sources = {
    {"paths", 30000}, {"embree", 6000}, {"lines", 12000}};

}  // namespace granrad::written_walls
