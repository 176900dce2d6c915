#include "raytrace/slab/steady_network.h"

#include <fmt/core.h>

#include <Eigen/Sparse>
#include <limits>
#include <numeric>

#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr double tolerance = 1e-12;

/// Which nodes hang together with a plate.
std::vector<char> joined_to_plates(std::size_t nodes, const std::vector<Link>& links) {
  std::vector<std::int32_t> parent(nodes + 2);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t n) {
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
  };
  for (const Link& link : links)
    if (link.conductance > 0) parent[root(link.a)] = root(link.b);
  const auto low = static_cast<std::int32_t>(nodes), high = low + 1;
  std::vector<char> joined(nodes);
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto at = root(static_cast<std::int32_t>(n));
    joined[n] = at == root(low) || at == root(high);
  }
  return joined;
}

}  // namespace

std::vector<double> steady_potentials(std::size_t nodes, const std::vector<Link>& links) {
  const auto joined = joined_to_plates(nodes, links);
  const auto n = static_cast<Eigen::Index>(nodes);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n), right = Eigen::VectorXd::Zero(n);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Link& link : links)
    for (const auto& [i, j] : {std::pair{link.a, link.b}, std::pair{link.b, link.a}}) {
      if (i >= n || link.conductance <= 0) continue;
      diagonal[i] += link.conductance;
      if (j < n) entries.emplace_back(i, j, -link.conductance);
      if (j == n) right[i] += link.conductance;
    }
  for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(i, i, joined[i] ? diagonal[i] : 1.0);
  std::erase_if(entries, [&](const auto& e) { return e.row() != e.col() && !joined[e.row()]; });
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double, Eigen::RowMajor>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(tolerance);
  solver.setMaxIterations(20 * n + 1000);
  solver.compute(matrix);
  const Eigen::VectorXd u = solver.solve(right);
  if (n > 0 && solver.info() != Eigen::Success)
    throw NumericalError(fmt::format("the steady state of {} particles is not found (residual {:.1e})", nodes,
                                     solver.error()));
  std::vector<double> potential(u.data(), u.data() + n);
  for (std::size_t i = 0; i < nodes; ++i)
    if (!joined[i]) potential[i] = std::numeric_limits<double>::quiet_NaN();
  return potential;
}

}  // namespace granrad
