#include "dem/liggghts/deck.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace granrad::liggghts {
namespace {

constexpr double skin_radii = 0.5;  // lists reach this far beyond contact; a quarter of a diameter

/// Materials in the order of types; the walls' own type, if any, is the null pointer at the end.
std::vector<const Material*> number_types(const Bed& bed, Deck& deck) {
  deck.type_of_material.assign(bed.materials.size(), 0);
  for (const auto m : bed.material) deck.type_of_material[m] = 1;
  std::vector<const Material*> types;
  for (std::size_t m = 0; m < bed.materials.size(); ++m) {
    if (deck.type_of_material[m] == 0) continue;
    types.push_back(&bed.materials[m]);
    deck.type_of_material[m] = static_cast<std::int32_t>(types.size());
  }
  if (types.size() > 1 && !deck.meshes.empty()) types.push_back(nullptr);
  deck.mesh_type = static_cast<std::int32_t>(types.size());
  return types;
}

/// The smallest extent of the domain, which LIGGGHTS widens as particles move: around the walls; without
/// walls around the particles, in large blocks so that it seldom changes.
Box extent(const Bed& bed, const WallMeshes& walls, double radius) {
  const bool has_walls = !walls.meshes().empty();
  Box box = has_walls ? bed.box : Box{bed.position_m[0], bed.position_m[0]};
  for (const auto& mesh : walls.meshes())
    for (const auto& triangle : mesh.triangles)
      for (const auto& corner : triangle) box.include(corner);
  for (std::size_t i = 0; i < bed.size() && !has_walls; ++i) box.include(bed.position_m[i]);
  const double block = has_walls ? 4 * radius : 16 * radius, margin = has_walls ? 1 : 0.25;
  for (int a = 0; a < 3; ++a) {
    box.min[a] = bed.periodic[a] ? bed.box.min[a] : std::floor(box.min[a] / block - margin) * block;
    box.max[a] = bed.periodic[a] ? bed.box.max[a] : std::ceil(box.max[a] / block + margin) * block;
  }
  return box;
}

std::vector<Vec3> places_in_box(const Bed& bed) {
  std::vector<Vec3> places = bed.position_m;
  for (Vec3& p : places) p = wrapped_into_box(bed, p);
  return places;
}

void add_domain(const Bed& bed, const WallMeshes& walls, int ranks, std::size_t types, Deck& deck) {
  const double radius = *std::max_element(bed.radius_m.begin(), bed.radius_m.end());
  const Box box = extent(bed, walls, radius);
  const auto style = [&](int a) { return bed.periodic[a] ? "p" : "m"; };
  if (ranks > 1) {
    deck.parts = parts_of(box, places_in_box(bed), ranks);
    const auto& [x, y, z] = deck.parts.count;
    deck.before_meshes.push_back(fmt::format("processors {} {} {}", x, y, z));
  }
  deck.before_meshes.insert(
      deck.before_meshes.end(),
      {"units si", "atom_style granular", "atom_modify map array",
       fmt::format("boundary {} {} {}", style(0), style(1), style(2)), "newton off",
       "communicate single vel yes", "soft_particles yes", "hard_particles yes",
       fmt::format("region domain block {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} units box", box.min.x,
                   box.max.x, box.min.y, box.max.y, box.min.z, box.max.z),
       fmt::format("create_box {} domain", types), fmt::format("neighbor {:.17g} bin", skin_radii * radius),
       "neigh_modify delay 0 every 1 check yes page 1000000 one 20000"});
}

/// A property of pairs: the geometric mean, as dem/native/hertz_mindlin.h mixes it; a wall takes the particle's.
std::string pair_property(const char* name, const std::vector<const Material*>& types,
                          double Material::*value) {
  std::string line =
      fmt::format("fix {} all property/global {} peratomtypepair {}", name, name, types.size());
  for (const auto* a : types)
    for (const auto* b : types) {
      const auto& first = a ? *a : b ? *b : *types[0];
      const auto& second = b ? *b : first;
      const double x = first.*value, y = second.*value;
      line += fmt::format(" {:.17g}", x == y ? x : std::sqrt(x * y));
    }
  return line;
}

std::string type_property(const char* name, const std::vector<const Material*>& types,
                          double Material::*value) {
  std::string line = fmt::format("fix {} all property/global {} peratomtype", name, name);
  for (const auto* m : types) line += fmt::format(" {:.17g}", (m ? m : types[0])->*value);
  return line;
}

/// Adds the properties and returns the contact model of pairs and walls.
std::string add_model(const std::vector<const Material*>& types, std::vector<std::string>& commands) {
  commands.push_back(type_property("youngsModulus", types, &Material::youngs_modulus_Pa));
  commands.push_back(type_property("poissonsRatio", types, &Material::poisson_ratio));
  commands.push_back(pair_property("coefficientRestitution", types, &Material::restitution));
  commands.push_back(pair_property("coefficientFriction", types, &Material::friction));
  const bool rolls =
      std::any_of(types.begin(), types.end(), [](const Material* m) { return m && m->rolling_friction > 0; });
  if (rolls)
    commands.push_back(pair_property("coefficientRollingFriction", types, &Material::rolling_friction));
  const std::string model =
      std::string("model hertz tangential history") + (rolls ? " rolling_friction cdt" : "");
  commands.push_back("pair_style gran " + model);
  commands.push_back("pair_coeff * *");
  return model;
}

}  // namespace

std::string mesh_name(std::size_t number) {
  return fmt::format("mesh{}", number);
}

Deck make_deck(const Bed& bed, const WallMeshes& walls, const Vec3& gravity_m_s2, double step_s, int ranks) {
  Deck deck;
  deck.meshes = walls.meshes();
  const auto types = number_types(bed, deck);
  add_domain(bed, walls, ranks, types.size(), deck);
  const auto model = add_model(types, deck.before_meshes);
  deck.before_meshes.push_back(fmt::format("timestep {:.17g}", step_s));
  if (const double g = norm(gravity_m_s2); g > 0)
    deck.before_meshes.push_back(fmt::format("fix weight all gravity {:.17g} vector {:.17g} {:.17g} {:.17g}",
                                             g, gravity_m_s2.x, gravity_m_s2.y, gravity_m_s2.z));
  if (!deck.meshes.empty()) {
    std::string names;
    for (std::size_t m = 0; m < deck.meshes.size(); ++m) names += fmt::format(" {}", mesh_name(m));
    deck.after_meshes.push_back(fmt::format("fix walls all wall/gran {} mesh n_meshes {} meshes{}", model,
                                            deck.meshes.size(), names));
  }
  deck.after_meshes.push_back("fix motion all nve/sphere");
  return deck;
}

}  // namespace granrad::liggghts
