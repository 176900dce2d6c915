#include "dem/bed/wall.h"

#include <algorithm>

namespace granrad {

double TemperatureCourse::at(double t_s) const {
  const auto next =
      static_cast<std::size_t>(std::upper_bound(time_s.begin(), time_s.end(), t_s) - time_s.begin());
  if (next == 0) return temperature_K.front();
  if (next == time_s.size()) return temperature_K.back();
  const double share = (t_s - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
  return temperature_K[next - 1] + share * (temperature_K[next] - temperature_K[next - 1]);
}

double TemperatureCourse::mean(double from_s, double to_s) const {
  if (!(to_s > from_s)) return at(from_s);
  double integral_K_s = 0, before_s = from_s;
  const auto to_next = [&](double t_s) {
    integral_K_s += 0.5 * (at(before_s) + at(t_s)) * (t_s - before_s);
    before_s = t_s;
  };
  for (const double corner_s : time_s)
    if (corner_s > from_s && corner_s < to_s) to_next(corner_s);
  to_next(to_s);
  return integral_K_s / (to_s - from_s);
}

void hold_temperatures(std::vector<Wall>& walls, const std::vector<Wall>& given, double from_s, double to_s) {
  for (std::size_t w = 0; w < walls.size(); ++w)
    if (!given[w].course.empty()) walls[w].temperature_K = given[w].course.mean(from_s, to_s);
}

double hottest_K(const Wall& wall) {
  const auto& course = wall.course.temperature_K;
  return course.empty() ? wall.temperature_K : *std::max_element(course.begin(), course.end());
}

double next_opening_s(const std::vector<Wall>& walls, double time_s) {
  double next = infinity;
  for (const auto& w : walls)
    if (stands(w, time_s)) next = std::min(next, w.opens_at_s);
  return next;
}

std::array<Wall, 6> box_walls(const Box& box) {
  static const char* const names[6] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  std::array<Wall, 6> walls;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool upper = face % 2;
    const auto corner = [&](bool at_u, bool at_v) {
      Vec3 p;
      p[axis] = upper ? box.max[axis] : box.min[axis];
      p[u] = at_u ? box.max[u] : box.min[u];
      p[v] = at_v ? box.max[v] : box.min[v];
      return p;
    };
    Wall& w = walls[face];
    w.name = names[face];
    w.vertices = {corner(false, false), corner(true, false), corner(true, true), corner(false, true)};
    if (upper) std::swap(w.vertices[1], w.vertices[3]);
  }
  return walls;
}

}  // namespace granrad
