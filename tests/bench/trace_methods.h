#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/lines/line_sweep.h"
#include "tests/bench/trace_case.h"

namespace granrad::trace_bench {

Result embree_sobol(const Case& c, double rays_per_particle, std::uint64_t seed);
LineOptions line_options(int directions, std::uint64_t seed, int threads = 1);
Result lines_matrix(const Case& c, int directions, std::uint64_t seed);
std::vector<double> hot_walls(const Case& c);
Result lines_heat(const Case& c, int directions, std::uint64_t seed, double lines_per_disc = 12);
Result lines_pairs(const Case& c, int directions);

}  // namespace granrad::trace_bench
