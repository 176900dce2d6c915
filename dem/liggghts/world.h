#pragma once
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace granrad::liggghts {

/// The processes that move the spheres together: all ranks where the program has joined them, else this one alone. MPI runs
/// from the first use to the end of the process.
class World {
 public:
  static const World& started();
  int count() const { return count_; }
  /// The MPI_Comm of these processes.
  void* comm() const { return comm_; }

  /// The values of all ranks in their order, at every rank.
  template <class T>
  std::vector<T> joined(std::vector<T> own) const {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count_ == 1) return own;
    const auto counts = counts_of_ranks(own.size());
    std::size_t total = 0;
    for (const std::int64_t n : counts) total += static_cast<std::size_t>(n);
    std::vector<T> all(total);
    join(own.data(), all.data(), sizeof(T), counts);
    return all;
  }

 private:
  World();
  ~World();
  std::vector<std::int64_t> counts_of_ranks(std::size_t own) const;
  void join(const void* own, void* all, std::size_t item_bytes,
            const std::vector<std::int64_t>& counts) const;

  bool owner_ = false;
  void* comm_ = nullptr;
  int count_ = 1, rank_ = 0;
};

}  // namespace granrad::liggghts
