// A program of several ranks for ranks_test.cpp.
#include <fmt/core.h>

#include <cstring>

#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/ranks/ranks.h"

using namespace granrad;

namespace {

void require(bool right, const char* what) {
  if (!right) throw NumericalError(what);
}

/// Rank r sends r times 10 + s bytes of value r to rank s; rank 0 nothing at all.
void exchange() {
  std::vector<std::vector<char>> to;
  for (int s = 0; s < rank_count(); ++s)
    to.emplace_back(static_cast<std::size_t>(rank() * (10 + s)), static_cast<char>(rank()));
  const auto from = exchanged_bytes(to);
  for (int r = 0; r < rank_count(); ++r)
    require(from[static_cast<std::size_t>(r)] ==
                std::vector<char>(static_cast<std::size_t>(r * (10 + rank())), static_cast<char>(r)),
            "exchanged_bytes");
}

void collect() {
  std::vector<std::int64_t> values = {1, rank(), std::int64_t{1} << 60};
  sum_over_ranks(values);
  const std::int64_t n = rank_count();
  require(values == std::vector<std::int64_t>{n, n * (n - 1) / 2, n << 60}, "sum_over_ranks");
  require(largest_over_ranks(rank() == 1 ? 7 : -rank()) == (n > 1 ? 7 : 0), "largest_over_ranks");
  const auto all = joined_over_ranks(std::vector<int>(static_cast<std::size_t>(rank()), rank()));
  std::vector<int> expected;
  for (int r = 0; r < n; ++r) expected.insert(expected.end(), static_cast<std::size_t>(r), r);
  require(all == expected, "joined_over_ranks");
  std::int64_t covered = 0;
  for (int r = 0; r < n; ++r) {
    require(part_of_rank(17, r).begin == covered, "part_of_rank");
    covered = part_of_rank(17, r).end;
  }
  require(covered == 17, "part_of_rank");
}

int body(const std::string& mode) {
  join_ranks();
  if (mode == "collect") {
    collect(), exchange();
    fmt::print("{} ranks\n", rank_count());
  } else if (mode == "alone") {
    if (rank() == 1) throw IoError("the disk of this node is full");
    largest_over_ranks(0);
  } else if (mode == "first") {
    on_first_rank([] { throw IoError("only the first rank writes"); });
  } else if (mode == "differ") {
    require_same_on_ranks(static_cast<std::uint64_t>(rank()), "their number");
  }
  return exit_ok;
}

}  // namespace

int main(int argc, char** argv) {
  return leave_ranks(run_program("ranks_probe", [&] { return body(argc > 1 ? argv[1] : ""); }));
}
