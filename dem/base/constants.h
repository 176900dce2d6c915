#pragma once
#include <limits>
#include <numbers>

namespace granrad {

inline constexpr double pi = std::numbers::pi;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// 4/3 pi r^3.
constexpr double sphere_volume(double radius) {
  return 4.0 / 3.0 * pi * radius * radius * radius;
}

/// Stefan-Boltzmann constant, W/(m^2 K^4). CODATA 2018 (exact since the 2019 SI: 2 pi^5 k^4 / (15 h^3 c^2)).
inline constexpr double stefan_boltzmann = 5.670374419e-8;

/// Emissive power of a black surface, sigma T^4, W/m^2.
constexpr double emissive_power(double temperature_K) {
  const double t2 = temperature_K * temperature_K;
  return stefan_boltzmann * t2 * t2;
}

}  // namespace granrad
