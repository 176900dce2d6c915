// The plug-in with MPI: the only code of the rays that knows it.
#define OMPI_SKIP_MPICXX
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "dem/ranks/rank_functions.h"

namespace granrad {

namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 30;  // MPI counts in int

MPI_Comm work, farewell;  // a failed rank says good-bye beside what the others still do
RankFunctions functions{};

void sum(std::int64_t* values, std::size_t count) {
  constexpr std::size_t piece = piece_bytes / sizeof(std::int64_t);
  for (std::size_t k = 0; k < count; k += piece)
    MPI_Allreduce(MPI_IN_PLACE, values + k, static_cast<int>(std::min(piece, count - k)), MPI_INT64_T,
                  MPI_SUM, work);
}

void share(const void* own, void* all, const std::size_t* bytes_of_rank) {
  std::vector<int> bytes, begin;
  std::size_t total = 0;
  for (int r = 0; r < functions.count; ++r) {
    begin.push_back(static_cast<int>(total));
    bytes.push_back(static_cast<int>(bytes_of_rank[r]));
    total += bytes_of_rank[r];
  }
  if (total < piece_bytes) {
    MPI_Allgatherv(own, bytes[static_cast<std::size_t>(functions.rank)], MPI_BYTE, all, bytes.data(),
                   begin.data(), MPI_BYTE, work);
    return;
  }
  char* to = static_cast<char*>(all);
  for (int r = 0; r < functions.count; ++r) {
    if (r == functions.rank) std::copy_n(static_cast<const char*>(own), bytes_of_rank[r], to);
    for (std::size_t k = 0; k < bytes_of_rank[r]; k += piece_bytes)
      MPI_Bcast(to + k, static_cast<int>(std::min(piece_bytes, bytes_of_rank[r] - k)), MPI_BYTE, r, work);
    to += bytes_of_rank[r];
  }
}

void exchange(const void* out, const std::size_t* out_bytes, void* in, const std::size_t* in_bytes) {
  std::vector<MPI_Request> requests;
  const auto in_pieces = [&](std::size_t bytes, auto start) {
    for (std::size_t k = 0; k < bytes; k += piece_bytes)
      start(k, static_cast<int>(std::min(piece_bytes, bytes - k)), &requests.emplace_back());
  };
  char* to = static_cast<char*>(in);
  const char* from = static_cast<const char*>(out);
  for (int r = 0; r < functions.count; ++r) {
    in_pieces(in_bytes[r], [&](std::size_t k, int n, MPI_Request* request) {
      MPI_Irecv(to + k, n, MPI_BYTE, r, 0, work, request);
    });
    to += in_bytes[r];
  }
  for (int r = 0; r < functions.count; ++r) {
    in_pieces(out_bytes[r], [&](std::size_t k, int n, MPI_Request* request) {
      MPI_Isend(from + k, n, MPI_BYTE, r, 0, work, request);
    });
    from += out_bytes[r];
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

int part(int code, double patience_s) {
  int largest = code, all_here = 0;
  MPI_Request request;
  MPI_Iallreduce(&code, &largest, 1, MPI_INT, MPI_MAX, farewell, &request);
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    MPI_Test(&request, &all_here, MPI_STATUS_IGNORE);
    if (all_here) return largest;
    if (patience_s >= 0 &&
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > patience_s)
      return -1;
    usleep(1000);
  }
}

void finish() {
  MPI_Finalize();
}

void abort_all(int code) {
  MPI_Abort(MPI_COMM_WORLD, code);
}

}  // namespace

extern "C" const RankFunctions* granrad_join_ranks() {
  int given = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given);
  MPI_Comm_rank(MPI_COMM_WORLD, &functions.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &functions.count);
  MPI_Comm_dup(MPI_COMM_WORLD, &work);
  MPI_Comm_dup(MPI_COMM_WORLD, &farewell);
  functions.sum = sum;
  functions.share = share;
  functions.exchange = exchange;
  functions.part = part;
  functions.finish = finish;
  functions.abort = abort_all;
  if (functions.count > 1) return &functions;
  MPI_Finalize();
  return nullptr;
}

}  // namespace granrad
