#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace granrad {

// The processes that compute one case together, as a launcher of MPI started them. A process belongs to one such group,
// as it has one environment, so these are functions and no object is handed round. A process that was started alone is
// rank 0 of 1: everything here is the identity then, and MPI is not loaded.
//
// Every rank holds the same state and makes the same calls in the same order; each does a part of the work, integers are
// summed or parts are put one after the other, so that results do not depend on the number of ranks. Calls come from the
// thread that joined, outside of parallel regions or in their master.

int rank();
int rank_count();

/// Where a launcher started several copies of this program, these become ranks: MPI is loaded, and all ranks but the
/// first fall silent. Throws InputError where the plug-in with MPI is missing or MPI knows of no other copy.
void join_ranks();
/// Throws InputError where there are several ranks: `what` runs in one process.
void refuse_several_ranks(const std::string& what);
/// The last call, with this rank's exit code; returns the largest of all ranks. A rank that failed while others did not
/// says why on stderr and ends them all with its code (after a few seconds, in which they may fail likewise).
int leave_ranks(int code);

/// What is done between two ranks' begin and end, of `count` pieces of work in their order.
struct RankPart {
  std::int64_t begin, end;
};
RankPart part_of_rank(std::int64_t count, int of = rank());

/// Clock time spent in what follows here, waiting for other ranks included.
double seconds_between_ranks();

void sum_over_ranks(std::span<std::int64_t> values);
std::int64_t largest_over_ranks(std::int64_t value);

/// Whether a signal asks to stop and no other rank would wait in vain for this one: long loops may end in their middle
/// then. Several ranks stop together after a step.
bool interrupted_alone();
void stop_if_interrupted_alone();  ///< throws Error

/// Runs on the first rank while the others wait; what it throws is thrown on all, with its exit code.
void on_first_rank(const std::function<void()>& action);

/// Throws NumericalError where the ranks' values differ: `what` says what they should agree on.
void require_same_on_ranks(std::uint64_t value, const std::string& what);

/// Bytes of every rank, by rank, at every rank.
std::vector<std::vector<char>> shared_bytes(std::span<const char> own);
/// to[r] goes to rank r; what came from each rank.
std::vector<std::vector<char>> exchanged_bytes(const std::vector<std::vector<char>>& to);

/// The values of all ranks one after the other, at every rank.
template <class T>
std::vector<T> joined_over_ranks(const std::vector<T>& own) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (rank_count() == 1) return own;
  std::vector<T> all;
  for (const auto& bytes :
       shared_bytes({reinterpret_cast<const char*>(own.data()), own.size() * sizeof(T)})) {
    const auto* begin = reinterpret_cast<const T*>(bytes.data());
    all.insert(all.end(), begin, begin + bytes.size() / sizeof(T));
  }
  return all;
}

}  // namespace granrad
