#pragma once
#include <filesystem>
#include <limits>

namespace granrad {

/// Processors' worth of time that control groups grant this process: the least quota / period of its group and of
/// those above it, by `cpu.max` (cgroup 2) or `cpu.cfs_quota_us` (cgroup 1); infinite without any. Containers and
/// batch systems limit processes this way and still show them every processor of the machine.
/// groups: as /proc/self/cgroup; mount: as /sys/fs/cgroup.
double granted_processors(const std::filesystem::path& groups = "/proc/self/cgroup",
                          const std::filesystem::path& mount = "/sys/fs/cgroup");

/// Lets OpenMP start no more threads than processors are granted, unless OMP_NUM_THREADS says how many.
void respect_granted_processors();

}  // namespace granrad
