#include "raytrace/paths/path_tracer.h"

#include <fmt/format.h>
#include <omp.h>

#include "dem/base/error.h"
#include "dem/ranks/ranks.h"
#include "raytrace/paths/path_batches.h"
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

/// Tallies of the batches that this rank worked at: its part of the pieces. Pieces come in their order, so that a
/// thread, and a rank, leaves each batch once.
BatchTallies run_batches(const PathWalker& walker, int threads) {
  const auto surfaces = static_cast<std::size_t>(walker.surfaces().count());
  BatchTallies batches(path_batches);
  const std::int64_t walks = walker.walks();
  const auto pieces = pieces_of(walks);
  const RankPart mine = part_of_rank(static_cast<std::int64_t>(pieces.size()));
#pragma omp parallel num_threads(threads)
  {
    PathTally own(surfaces, walker.has_clear_flights());
    int batch = -1;
    const auto hand_over = [&](int next) {
      if (next == batch) return;
      if (batch >= 0) {
#pragma omp critical
        {
          auto& sum = batches[static_cast<std::size_t>(batch)];
          if (!sum) sum.emplace(surfaces, walker.has_clear_flights());
          sum->add(own);
        }
        own.clear();
      }
      batch = next;
    };
#pragma omp for schedule(dynamic, 1) nowait
    for (std::int64_t p = mine.begin; p < mine.end; ++p) {
      if (interrupted_alone()) continue;
      const Piece& piece = pieces[static_cast<std::size_t>(p)];
      hand_over(piece.batch);
      const std::int64_t first = first_walk(walks, piece.batch);
      const std::int64_t of_batch = first_walk(walks, piece.batch + 1) - first;
      const auto lattice = walker.lattice(piece.batch, of_batch);
      if (piece.first == 0) walker.expect(of_batch, own);
      for (std::int64_t k = piece.first; k < piece.last; ++k)
        walker.walk(lattice, k, static_cast<std::uint64_t>(first + k), own);
    }
    hand_over(-1);
  }
  stop_if_interrupted_alone();
  return batches;
}

RadiativeHeat in_watts(const BatchSums& sums, double quantum_W) {
  RadiativeHeat result;
  for (const auto& [total, error] : sums.surface) {
    result.heat_W.push_back(total * quantum_W);
    result.standard_error_W.push_back(error * quantum_W);
  }
  result.isothermal_wall_heat_W = sums.given.total * quantum_W;
  result.isothermal_wall_heat_error_W = sums.given.error * quantum_W;
  result.rays = sums.segments;
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
  BatchTallies batches = run_batches(walker, options.threads > 0 ? options.threads : omp_get_max_threads());
  if (walker.has_clear_flights()) take_out_clear_flights(batches);
  const BatchSums sums = sum_batches(batches, walker.surfaces());
  if (static_cast<double>(sums.lost) > 1e-3 * static_cast<double>(walker.walks()))
    throw NumericalError(
        advised(fmt::format("paths: {} of {} walks leaked or did not end", sums.lost, walker.walks()),
                "close the walls, and let some surface absorb"));
  RadiativeHeat heat =
      in_watts(sums, walker.quantum_W() / (walker.has_clear_flights() ? clear_flight_parts : 1));
  heat.lost_rays = sums.lost;
  return heat;
}

}  // namespace granrad
