#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dem/bed/wall.h"

namespace granrad {

/// Walls as columns of equal length, as files keep them; vertices and triangles of all walls follow each
/// other, wall w owns those from begin[w] to begin[w + 1].
struct WallColumns {
  std::vector<std::string> name;
  std::vector<std::int32_t> role;
  std::vector<std::uint8_t> contact;
  std::vector<double> temperature_K, emissivity, opens_at_s;
  std::vector<Vec3> velocity_m_s, vertices_m;
  std::vector<std::int64_t> vertex_begin{0}, triangle_begin{0};
  std::vector<std::int32_t> triangles;  ///< three each, indices of the wall's own vertices
};

WallColumns columns_of(const std::vector<Wall>& walls);

/// The walls again. Columns that a file does not keep (contact, opens_at_s, velocity_m_s) may be empty.
/// Throws InputError that names the column which is not sound: a length, an order or a number out of range.
std::vector<Wall> walls_from(const WallColumns& columns);

}  // namespace granrad
