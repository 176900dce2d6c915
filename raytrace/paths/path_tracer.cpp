#include "raytrace/paths/path_tracer.h"

#include <fmt/format.h>
#include <omp.h>

#include <cmath>

#include "dem/base/error.h"
#include "raytrace/paths/path_walker.h"

namespace granrad {

namespace {

/// Work that a thread takes at a time: pieces of batches, so that any number of threads has something to do.
constexpr std::int64_t walks_of_a_piece = 64;

struct Piece {
  int batch;
  std::int64_t first, last;  ///< walks of the batch
};

std::int64_t first_walk(std::int64_t walks, int batch) {
  return walks * batch / path_batches;
}

std::vector<Piece> pieces_of(std::int64_t walks) {
  std::vector<Piece> pieces;
  for (int b = 0; b < path_batches; ++b) {
    const std::int64_t count = first_walk(walks, b + 1) - first_walk(walks, b);
    for (std::int64_t k = 0; k < count; k += walks_of_a_piece)
      pieces.push_back({b, k, std::min(count, k + walks_of_a_piece)});
  }
  return pieces;
}

/// Tallies of the batches. Pieces come in their order, so that a thread leaves each batch once.
std::vector<PathTally> run_batches(const PathWalker& walker, int threads) {
  const auto surfaces = static_cast<std::size_t>(walker.surfaces().count());
  std::vector<PathTally> batches(path_batches, PathTally(surfaces));
  const std::int64_t walks = walker.walks();
  const auto pieces = pieces_of(walks);
#pragma omp parallel num_threads(threads)
  {
    PathTally own(surfaces);
    int batch = 0;
    const auto hand_over = [&](int next) {
      if (next == batch) return;
#pragma omp critical
      batches[static_cast<std::size_t>(batch)].add(own);
      own.clear();
      batch = next;
    };
#pragma omp for schedule(dynamic, 1) nowait
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      const Piece& piece = pieces[p];
      hand_over(piece.batch);
      const std::int64_t first = first_walk(walks, piece.batch);
      const auto lattice = walker.lattice(piece.batch, first_walk(walks, piece.batch + 1) - first);
      for (std::int64_t k = piece.first; k < piece.last; ++k)
        walker.walk(lattice, k, static_cast<std::uint64_t>(first + k), own);
    }
    hand_over(-1);
  }
  return batches;
}

/// Sum over the batches and the standard error of that sum, in quanta.
template <class Value>
std::pair<double, double> total_and_error(Value value_of_batch) {
  Quanta total = 0;
  for (int b = 0; b < path_batches; ++b) total += value_of_batch(b);
  const double mean = static_cast<double>(total) / path_batches;
  double squares = 0;
  for (int b = 0; b < path_batches; ++b) {
    const double d = static_cast<double>(value_of_batch(b)) - mean;
    squares += d * d;
  }
  return {static_cast<double>(total), std::sqrt(squares * path_batches / (path_batches - 1))};
}

RadiativeHeat assemble(const PathWalker& walker, const std::vector<PathTally>& batches) {
  const PathSurfaces& surfaces = walker.surfaces();
  const double quantum = walker.quantum_W();
  RadiativeHeat result;
  std::vector<Quanta> given(path_batches, 0);
  for (std::int32_t s = 0; s < surfaces.count(); ++s) {
    const auto [total, error] = total_and_error([&](int b) { return batches[b].heat[s]; });
    result.heat_W.push_back(total * quantum);
    result.standard_error_W.push_back(error * quantum);
    if (surfaces.is_wall(s))
      for (int b = 0; b < path_batches; ++b) given[b] -= batches[b].heat[s];
  }
  const auto [total, error] = total_and_error([&](int b) { return given[b]; });
  result.isothermal_wall_heat_W = total * quantum;
  result.isothermal_wall_heat_error_W = error * quantum;
  for (const auto& batch : batches) result.rays += batch.segments;
  return result;
}

}  // namespace

RadiativeHeat trace_paths(const Enclosure& enclosure, const EmbreeTracer& tracer, const RadiativeState& state,
                          const PathOptions& options, std::uint64_t update) {
  if (options.walks < 2 * path_batches)
    throw InputError(
        advised(fmt::format("radiation.rays = {} (paths need at least {} walks an update to know their "
                            "error)",
                            options.walks, 2 * path_batches),
                "10000 is usual"));
  const PathWalker walker(enclosure, tracer, state, options, update);
  const auto batches = run_batches(walker, options.threads > 0 ? options.threads : omp_get_max_threads());
  std::int64_t lost = 0;
  for (const auto& batch : batches) lost += batch.lost;
  if (static_cast<double>(lost) > 1e-3 * static_cast<double>(walker.walks()))
    throw NumericalError(
        advised(fmt::format("paths: {} of {} walks leaked or did not end", lost, walker.walks()),
                "close the walls, and let some surface absorb"));
  return assemble(walker, batches);
}

}  // namespace granrad
