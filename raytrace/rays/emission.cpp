#include "raytrace/rays/emission.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"

namespace granrad {

namespace {

struct CosineSine {
  double cosine, sine;
};

/// 1/k! with the sign it has in the series of sine and cosine.
constexpr double term(int k) {
  double t = 1;
  for (int j = 2; j <= k; ++j) t /= j;
  return k / 2 % 2 ? -t : t;
}

/// The terms first, first + 2, ..., first + 16 of the series, y = x^2, in pairs that do not wait for each other.
template <int first>
double series(double y) {
  constexpr auto t = [](int k) { return term(first + 2 * k); };
  const double y2 = y * y, y4 = y2 * y2, y8 = y4 * y4;
  const double low = (t(0) + t(1) * y) + (t(2) + t(3) * y) * y2;
  const double high = (t(4) + t(5) * y) + (t(6) + t(7) * y) * y2;
  return (low + high * y4) + t(8) * y8;
}

/// cos and sin of 2 pi v, v in [0, 1], within 1e-15: series on the nearest quarter. The same bits on every
/// machine, which those of the C library are not.
CosineSine cosine_sine(double v) {
  const int quarter = static_cast<int>(4 * v + 0.5);
  const double x = (v - 0.25 * quarter) * (2 * pi), y = x * x;
  const double of[2] = {series<0>(y), x * series<1>(y)};  // looked up, for no branch foresees the quarter
  static constexpr double sign_of_cosine[4] = {1, -1, -1, 1}, sign_of_sine[4] = {1, 1, -1, -1};
  const int q = quarter & 3, odd = quarter & 1;
  return {sign_of_cosine[q] * of[odd], sign_of_sine[q] * of[1 - odd]};
}

Vec3 direction_on_sphere(double u, double v) {
  const double z = 1 - 2 * u, s = std::sqrt(std::max(0.0, 1 - z * z));
  const CosineSine t = cosine_sine(v);
  return {s * t.cosine, s * t.sine, z};
}

}  // namespace

Vec3 cosine_direction(const Vec3& n, double u, double v) {
  // Orthonormal frame without branches (Duff et al. 2017): t1, t2, n.
  const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
  const Vec3 t1{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, t2{b, sign + n.y * n.y * a, -n.y};
  const double s = std::sqrt(u), c = std::sqrt(1 - u);
  const CosineSine t = cosine_sine(v);
  return t1 * (s * t.cosine) + t2 * (s * t.sine) + n * c;
}

Emitter::Emitter(const Enclosure& enclosure) : enclosure_(enclosure) {
  for (const Wall& wall : enclosure.walls) {
    Source source;
    if (const auto figure = parallelogram_of(wall)) {
      source.figure = *figure;
      source.normal = polygon_normal(wall.vertices);
    } else {
      source.triangles = triangles_of(wall);
      double sum = 0;
      for (const auto& [a, b, c] : source.triangles)
        source.cumulative_area_m2.push_back(sum += 0.5 * norm(cross(b - a, c - a)));
    }
    sources_.push_back(std::move(source));
  }
}

Emission Emitter::emit(std::int32_t surface, double u0, double u1, double u2, double u3) const {
  const auto spheres = static_cast<std::int32_t>(enclosure_.sphere_count());
  if (surface < spheres) {
    const Vec3 normal = direction_on_sphere(u0, u1);
    return {enclosure_.centre_m[surface] + enclosure_.radius_m[surface] * normal,
            cosine_direction(normal, u2, u3), normal};
  }
  const Source& source = sources_[surface - spheres];
  const auto& cumulative = source.cumulative_area_m2;
  if (cumulative.empty()) {  // a parallelogram: both uniforms stay stratified over its sides
    const Parallelogram& f = source.figure;
    return {f.corner + u0 * f.side[0] + u1 * f.side[1], cosine_direction(source.normal, u2, u3),
            source.normal};
  }
  const double target = u0 * cumulative.back();
  const std::size_t k = std::min<std::size_t>(
      std::upper_bound(cumulative.begin(), cumulative.end(), target) - cumulative.begin(),
      cumulative.size() - 1);
  const double before = k == 0 ? 0 : cumulative[k - 1];
  const double within = std::clamp((target - before) / (cumulative[k] - before), 0.0, 1.0);
  const auto& [a, b, c] = source.triangles[k];
  const double root = std::sqrt(within);
  const Vec3 origin = a * (1 - root) + b * (root * (1 - u1)) + c * (root * u1);
  const Vec3 normal = normalized(cross(b - a, c - a));
  return {origin, cosine_direction(normal, u2, u3), normal};
}

}  // namespace granrad
