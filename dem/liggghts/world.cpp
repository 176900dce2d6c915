#include "dem/liggghts/world.h"

#define OMPI_SKIP_MPICXX
#include <mpi.h>

#include <limits>

#include "dem/base/error.h"

namespace granrad::liggghts {

namespace {

MPI_Comm& communicator() {
  static MPI_Comm comm = MPI_COMM_NULL;
  return comm;
}

}  // namespace

const World& World::started() {
  static const World world;
  return world;
}

World::World() {
  int running = 0;
  MPI_Initialized(&running);
  if (!running) MPI_Init(nullptr, nullptr);
  owner_ = !running;
  MPI_Comm_dup(running ? MPI_COMM_WORLD : MPI_COMM_SELF, &communicator());
  comm_ = &communicator();
  MPI_Comm_size(communicator(), &count_);
  MPI_Comm_rank(communicator(), &rank_);
}

World::~World() {
  int finished = 0;
  MPI_Finalized(&finished);
  if (owner_ && !finished) MPI_Finalize();
}

std::vector<std::int64_t> World::counts_of_ranks(std::size_t own) const {
  const auto count = static_cast<std::int64_t>(own);
  std::vector<std::int64_t> all(static_cast<std::size_t>(count_));
  MPI_Allgather(&count, 1, MPI_INT64_T, all.data(), 1, MPI_INT64_T, communicator());
  return all;
}

/// Counted in items: MPI counts in int, and bytes of 10^7 spheres are more than that.
void World::join(const void* own, void* all, std::size_t item_bytes,
                 const std::vector<std::int64_t>& counts) const {
  std::vector<int> begin, size;
  std::int64_t total = 0;
  for (const std::int64_t n : counts) {
    begin.push_back(static_cast<int>(total)), size.push_back(static_cast<int>(n));
    total += n;
  }
  if (total > std::numeric_limits<int>::max())
    throw NumericalError(advised("more spheres than MPI gathers at once", "use engine = \"native\""));
  MPI_Datatype item;
  MPI_Type_contiguous(static_cast<int>(item_bytes), MPI_BYTE, &item);
  MPI_Type_commit(&item);
  MPI_Allgatherv(own, size[static_cast<std::size_t>(rank_)], item, all, size.data(), begin.data(), item,
                 communicator());
  MPI_Type_free(&item);
}

}  // namespace granrad::liggghts
