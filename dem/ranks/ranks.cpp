#include "dem/ranks/ranks.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/plugin.h"
#include "dem/base/program.h"
#include "dem/ranks/rank_functions.h"

namespace granrad {

namespace {

const RankFunctions* functions = nullptr;  // null: alone
std::FILE* said = nullptr;                 // what a silent rank wrote to stderr
int shown = -1;                            // its real stderr

constexpr double patience_s = 3;  // in which ranks that fail alike come to their ends

/// A number that a launcher gives its copies in one of these variables.
std::optional<int> launcher_says(std::initializer_list<const char*> variables) {
  for (const char* variable : variables)
    if (const char* text = std::getenv(variable)) return std::atoi(text);
  return {};
}

int copies_started() {
  return launcher_says({"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "SLURM_STEP_NUM_TASKS"})
      .value_or(1);
}

double seconds_between = 0;

/// Counts the time until its end as spent between ranks.
class Between {
 public:
  ~Between() {
    seconds_between += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// stdout into nothing, stderr into a file that leave_ranks shows where this rank alone fails.
void fall_silent() {
  std::fflush(nullptr);
  said = std::tmpfile();
  shown = dup(2);
  const int nothing = open("/dev/null", O_WRONLY);
  dup2(nothing, 1);
  dup2(said ? fileno(said) : nothing, 2);
  close(nothing);
}

void show_what_was_said() {
  if (!said) return;
  std::fflush(nullptr);
  std::rewind(said);
  char line[1024];
  while (std::fgets(line, sizeof line, said)) dprintf(shown, "rank %d: %s", rank(), line);
}

std::vector<std::size_t> sizes_of_ranks(std::size_t own) {
  std::vector<std::int64_t> sizes(static_cast<std::size_t>(rank_count()), 0);
  sizes[static_cast<std::size_t>(rank())] = static_cast<std::int64_t>(own);
  functions->sum(sizes.data(), sizes.size());
  return {sizes.begin(), sizes.end()};
}

std::vector<std::vector<char>> split(const std::vector<char>& all, const std::vector<std::size_t>& sizes) {
  std::vector<std::vector<char>> parts;
  auto from = all.begin();
  for (const std::size_t size : sizes) {
    parts.emplace_back(from, from + static_cast<std::ptrdiff_t>(size));
    from += static_cast<std::ptrdiff_t>(size);
  }
  return parts;
}

}  // namespace

int rank() {
  return functions ? functions->rank : 0;
}

int rank_count() {
  return functions ? functions->count : 1;
}

void join_ranks() {
  const int copies = copies_started();
  if (functions || copies <= 1) return;
  const bool first = launcher_says({"OMPI_COMM_WORLD_RANK", "PMI_RANK", "SLURM_PROCID"}).value_or(0) == 0;
  if (!first) fall_silent();
  const auto file = plugin_file("granrad_mpi");
  if (file.empty())
    throw InputError(advised(
        fmt::format("started {} times by mpirun, and without the plug-in granrad_mpi: each copy would "
                    "compute the same case",
                    copies),
        "start it once; or install the package granrad-mpi, or libopenmpi-dev and build again"));
  using Join = const RankFunctions* (*)();
  functions = reinterpret_cast<Join>(plugin_function(file, "granrad_join_ranks"))();
  if (!functions)
    throw InputError(
        advised(fmt::format("started {} times by a launcher that our MPI does not know: each copy would "
                            "compute the same case",
                            copies),
                "start it with the mpirun of the MPI it was built with"));
}

void refuse_several_ranks(const std::string& what) {
  if (rank_count() > 1)
    throw InputError(
        advised(fmt::format("started {} times by mpirun ({} runs in one process)", rank_count(), what),
                "start it once, without mpirun or with -n 1; --threads uses the cores of a node"));
}

int leave_ranks(int code) {
  if (!functions) return code;
  std::fflush(nullptr);
  const int agreed = functions->part(code, code == exit_ok ? -1 : patience_s);
  if (agreed < 0) {
    show_what_was_said();
    functions->abort(code);
  }
  functions->finish();
  return agreed;
}

RankPart part_of_rank(std::int64_t count, int of) {
  return {count * of / rank_count(), count * (of + 1) / rank_count()};
}

double seconds_between_ranks() {
  return seconds_between;
}

void sum_over_ranks(std::span<std::int64_t> values) {
  if (!functions) return;
  const Between between;
  functions->sum(values.data(), values.size());
}

std::int64_t largest_over_ranks(std::int64_t value) {
  const auto all = joined_over_ranks(std::vector<std::int64_t>{value});
  return *std::max_element(all.begin(), all.end());
}

bool interrupted_alone() {
  return rank_count() == 1 && interrupt_signal() != 0;
}

void stop_if_interrupted_alone() {
  if (rank_count() == 1) stop_if_interrupted();
}

void on_first_rank(const std::function<void()>& action) {
  if (!functions) return action();
  largest_over_ranks(0);  // the others are done with what `action` may change
  std::string failure;
  if (rank() == 0) try {
      action();
    } catch (const Error& error) {
      failure = std::string(1, static_cast<char>(error.exit_code())) + error.what();
    } catch (const std::exception& error) {
      failure = std::string(1, static_cast<char>(exit_numerical_failure)) + error.what();
    }
  const auto told = shared_bytes(failure)[0];
  if (!told.empty()) throw Error(static_cast<ExitCode>(told[0]), std::string(told.begin() + 1, told.end()));
}

void require_same_on_ranks(std::uint64_t value, const std::string& what) {
  const auto all = joined_over_ranks(std::vector<std::uint64_t>{value});
  for (std::size_t r = 1; r < all.size(); ++r)
    if (all[r] != all[0])
      throw NumericalError(advised(fmt::format("ranks 0 and {} do not agree on {}", r, what),
                                   "give all nodes the same files and the same libraries"));
}

std::vector<std::vector<char>> shared_bytes(std::span<const char> own) {
  if (!functions) return {std::vector<char>(own.begin(), own.end())};
  const Between between;
  const auto sizes = sizes_of_ranks(own.size());
  std::vector<char> all(std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}));
  functions->share(own.data(), all.data(), sizes.data());
  return split(all, sizes);
}

std::vector<std::vector<char>> exchanged_bytes(const std::vector<std::vector<char>>& to) {
  if (!functions) return to;
  const Between between;
  const auto ranks = static_cast<std::size_t>(rank_count());
  std::vector<std::int64_t> table(ranks * ranks, 0);  // [from][to]
  std::vector<std::size_t> out, in;
  std::vector<char> sent;
  for (std::size_t r = 0; r < ranks; ++r) {
    table[static_cast<std::size_t>(rank()) * ranks + r] = static_cast<std::int64_t>(to[r].size());
    out.push_back(to[r].size());
    sent.insert(sent.end(), to[r].begin(), to[r].end());
  }
  functions->sum(table.data(), table.size());
  for (std::size_t r = 0; r < ranks; ++r)
    in.push_back(static_cast<std::size_t>(table[r * ranks + static_cast<std::size_t>(rank())]));
  std::vector<char> received(std::accumulate(in.begin(), in.end(), std::size_t{0}));
  functions->exchange(sent.data(), out.data(), received.data(), in.data());
  return split(received, in);
}

}  // namespace granrad
