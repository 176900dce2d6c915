#pragma once
#include <cstdint>
#include <vector>

namespace granrad {

/// A conductance between two nodes, W/K (or m^2 of exchange area: any unit of heat over any of potential).
struct Link {
  std::int32_t a, b;
  double conductance;
};

/// Potentials of `nodes` free nodes in the steady state between two plates, the nodes `nodes` (at 1) and
/// `nodes` + 1 (at 0): sum_j g_ij (u_j - u_i) = 0, by conjugate gradients to 1e-12. nan for nodes that no chain of
/// links joins to a plate. Throws NumericalError when the solver stalls.
std::vector<double> steady_potentials(std::size_t nodes, const std::vector<Link>& links);

}  // namespace granrad
