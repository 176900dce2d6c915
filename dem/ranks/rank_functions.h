#pragma once
#include <cstddef>
#include <cstdint>

namespace granrad {

/// What the plug-in with MPI gives (granrad_mpi.so): plain functions, so that nothing else knows MPI. All ranks call the
/// same ones in the same order, from the thread that joined.
struct RankFunctions {
  int rank, count;
  /// values[k] becomes its sum over the ranks.
  void (*sum)(std::int64_t* values, std::size_t count);
  /// Every rank's bytes one after the other, at every rank.
  void (*share)(const void* own, void* all, const std::size_t* bytes_of_rank);
  /// From each rank to each: what lies in `out` for the ranks in their order comes to lie in their `in`.
  void (*exchange)(const void* out, const std::size_t* out_bytes, void* in, const std::size_t* in_bytes);
  /// The largest code of all ranks once all have come here; -1 when they have not within `patience_s` (< 0: for ever).
  int (*part)(int code, double patience_s);
  void (*finish)();
  void (*abort)(int code);  ///< ends all ranks
};

/// The plug-in's one function. Null where MPI says that this process is alone.
extern "C" const RankFunctions* granrad_join_ranks();

}  // namespace granrad
