#include "dem/bed/wall_columns.h"

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"

namespace granrad {

namespace {

void sound(bool condition, const std::string& what) {
  if (!condition) throw InputError(what);
}

bool are_ranges(const std::vector<std::int64_t>& begin, std::size_t walls, std::size_t total) {
  return begin.size() == walls + 1 && begin.front() == 0 && std::is_sorted(begin.begin(), begin.end()) &&
         begin.back() == static_cast<std::int64_t>(total);
}

/// Throws InputError unless `columns` can be walls.
void check(const WallColumns& c) {
  const std::size_t n = c.name.size();
  const auto kept = [n](std::size_t length) { return length == n || length == 0; };
  sound(c.role.size() == n && c.temperature_K.size() == n && c.emissivity.size() == n &&
            kept(c.contact.size()) && kept(c.opens_at_s.size()) && kept(c.velocity_m_s.size()) &&
            are_ranges(c.vertex_begin, n, c.vertices_m.size()) && c.triangles.size() % 3 == 0 &&
            are_ranges(c.triangle_begin, n, c.triangles.size() / 3),
        "the length of a wall column");
  for (std::size_t w = 0; w < n; ++w) {
    sound(c.role[w] >= 0 && c.role[w] <= static_cast<std::int32_t>(WallRole::excluded),
          "the role of wall " + c.name[w]);
    sound(std::isfinite(c.temperature_K[w]) && c.temperature_K[w] >= 0 && std::isfinite(c.emissivity[w]) &&
              c.emissivity[w] >= 0,
          "the temperature or emissivity of wall " + c.name[w]);
    sound(c.opens_at_s.empty() || !std::isnan(c.opens_at_s[w]), "opens_at_s of wall " + c.name[w]);
    sound(c.velocity_m_s.empty() || is_finite(c.velocity_m_s[w]), "the velocity of wall " + c.name[w]);
    const auto vertices = c.vertex_begin[w + 1] - c.vertex_begin[w];
    sound(vertices >= 3 && std::all_of(c.vertices_m.begin() + c.vertex_begin[w],
                                       c.vertices_m.begin() + c.vertex_begin[w + 1], is_finite),
          "the vertices of wall " + c.name[w]);
    for (auto t = 3 * c.triangle_begin[w]; t < 3 * c.triangle_begin[w + 1]; ++t)
      sound(c.triangles[t] >= 0 && c.triangles[t] < vertices, "a triangle of " + c.name[w]);
  }
}

}  // namespace

WallColumns columns_of(const std::vector<Wall>& walls) {
  WallColumns c;
  for (const auto& w : walls) {
    c.name.push_back(w.name);
    c.role.push_back(static_cast<std::int32_t>(w.role));
    c.contact.push_back(w.contact);
    c.temperature_K.push_back(w.temperature_K);
    c.emissivity.push_back(w.emissivity);
    c.opens_at_s.push_back(w.opens_at_s);
    c.velocity_m_s.push_back(w.velocity_m_s);
    c.vertices_m.insert(c.vertices_m.end(), w.vertices.begin(), w.vertices.end());
    for (const auto& t : w.triangles) c.triangles.insert(c.triangles.end(), t.begin(), t.end());
    c.vertex_begin.push_back(static_cast<std::int64_t>(c.vertices_m.size()));
    c.triangle_begin.push_back(static_cast<std::int64_t>(c.triangles.size() / 3));
  }
  return c;
}

std::vector<Wall> walls_from(const WallColumns& c) {
  check(c);
  std::vector<Wall> walls(c.name.size());
  for (std::size_t w = 0; w < walls.size(); ++w) {
    Wall& wall = walls[w];
    wall.name = c.name[w];
    wall.role = static_cast<WallRole>(c.role[w]);
    wall.temperature_K = c.temperature_K[w];
    wall.emissivity = c.emissivity[w];
    if (!c.contact.empty()) wall.contact = c.contact[w];
    if (!c.opens_at_s.empty()) wall.opens_at_s = c.opens_at_s[w];
    if (!c.velocity_m_s.empty()) wall.velocity_m_s = c.velocity_m_s[w];
    wall.vertices.assign(c.vertices_m.begin() + c.vertex_begin[w],
                         c.vertices_m.begin() + c.vertex_begin[w + 1]);
    for (auto t = c.triangle_begin[w]; t < c.triangle_begin[w + 1]; ++t)
      wall.triangles.push_back({c.triangles[3 * t], c.triangles[3 * t + 1], c.triangles[3 * t + 2]});
  }
  return walls;
}

}  // namespace granrad
