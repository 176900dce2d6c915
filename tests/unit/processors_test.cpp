// Requirement: the quota of a container or a batch job is found, whichever control groups give it.
//
// Planted: the group's own file alone, not those above it; "max" read as 0.
#include "dem/base/processors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/temporary_folder.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text << "\n";
}

TEST(Processors, quotas_of_cgroup_2_hold_for_groups_below) {
  const TemporaryFolder folder;
  const fs::path root = folder.path();
  put(root / "groups", "0::/batch/job_7");
  put(root / "mount/batch/job_7/cpu.max", "max 100000");
  EXPECT_TRUE(std::isinf(granted_processors(root / "groups", root / "mount")));
  put(root / "mount/batch/cpu.max", "250000 100000");
  EXPECT_EQ(granted_processors(root / "groups", root / "mount"), 2.5);
  put(root / "mount/cpu.max", "50000 100000");
  EXPECT_EQ(granted_processors(root / "groups", root / "mount"), 0.5);
}

TEST(Processors, quotas_of_cgroup_1) {
  const TemporaryFolder folder;
  const fs::path root = folder.path();
  put(root / "groups", "4:memory:/elsewhere\n2:cpu,cpuacct:/docker/abc\n1:cpuset:/");
  put(root / "mount/cpu,cpuacct/docker/abc/cpu.cfs_quota_us", "-1");
  put(root / "mount/cpu,cpuacct/docker/abc/cpu.cfs_period_us", "100000");
  EXPECT_TRUE(std::isinf(granted_processors(root / "groups", root / "mount")));
  put(root / "mount/cpu,cpuacct/docker/abc/cpu.cfs_quota_us", "400000");
  EXPECT_EQ(granted_processors(root / "groups", root / "mount"), 4);
}

TEST(Processors, no_groups_no_limit) {
  EXPECT_TRUE(std::isinf(granted_processors("/nowhere/groups", "/nowhere")));
}

}  // namespace
}  // namespace granrad
