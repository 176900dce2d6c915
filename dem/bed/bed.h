#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "dem/base/vec3.h"
#include "dem/bed/material.h"
#include "dem/bed/wall.h"

namespace granrad {

/// What two touching bodies remember: the tangential spring of Hertz-Mindlin with history.
struct ContactMemory {
  std::int64_t first = 0;   ///< id of a particle
  std::int64_t second = 0;  ///< id of a particle, > first; or -1 - (wall feature number) for a wall
  Vec3 displacement_m{};    ///< accumulated tangential displacement seen by `first`
};

/// What exists now: particles, walls, and the memory of contacts. Columns have equal length, and particles
/// stand in ascending id, so indices mean the same before and after a restart. Velocity and position belong
/// to the same instant `time_s`. An engine keeps every column aligned with the id; it reads neither
/// temperature nor carried heat.
struct Bed {
  double time_s = 0;
  std::int64_t step = 0;     ///< DEM steps done since time 0
  std::int64_t next_id = 1;  ///< id the next inserted particle gets

  std::vector<std::int64_t> id;
  std::vector<Vec3> position_m;
  std::vector<Vec3> velocity_m_s;
  std::vector<Vec3> angular_velocity_rad_s;
  std::vector<double> radius_m;
  std::vector<double> temperature_K;
  std::vector<double> radiative_heat_W;  ///< received, held from one radiation update to the next
  std::vector<double> solid_heat_W;  ///< received in the last heat step through contacts, for those who look
  std::vector<double> gas_heat_W;    ///< and through the gas
  std::vector<std::int32_t> material;  ///< index into `materials`

  std::vector<ContactMemory> contacts;  ///< sorted by (first, second)
  std::vector<Material> materials;
  std::vector<Wall> walls;
  std::array<bool, 3> periodic{};  ///< directions in which `box` repeats; positions may lie outside it
  Box box;                         ///< the box of the scene; periods where periodic

  std::size_t size() const { return id.size(); }
  /// Appends a particle at rest in rotation and returns its index; its id is `next_id`, which then grows.
  std::size_t add(const Vec3& position, const Vec3& velocity, double radius, double temperature_K,
                  std::int32_t material_index = 0);
  /// The particles in the order order[0], order[1], ... (a permutation of the indices).
  void permute(const std::vector<std::size_t>& order);
  /// Removes the particles with keep[i] == 0, with their contacts; the others keep their order.
  void remove_unless(const std::vector<char>& keep);
  /// Index of the particle with this id (binary search), or -1.
  std::int64_t index_of(std::int64_t id) const;
};

/// p moved by whole periods into the box along its periodic directions.
Vec3 wrapped_into_box(const Bed& bed, Vec3 p);
/// The shortest of the periodic images of a vector between two places.
Vec3 nearest_image(const Bed& bed, Vec3 apart);

/// Mean of the diameters, m; 0 when there is none.
double mean_diameter_m(const std::vector<double>& radius_m);
/// Mass of particle i: 4/3 pi r^3 rho, kg.
double mass_kg(const Bed& bed, std::size_t i);

}  // namespace granrad
