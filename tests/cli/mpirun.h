#pragma once
#include <signal.h>

#include <chrono>
#include <thread>

#include "dem/base/plugin.h"
#include "granrun.h"

namespace granrad::cli {

/// Whether this build can be started several times as one.
inline bool ranks_are_built() {
  return !plugin_file("granrad_mpi").empty() && std::system("command -v mpirun >/dev/null") == 0;
}

/// More ranks than cores, as root in a container too.
inline void set_mpi_for_tests() {
  for (const char* one : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM",
                          "OMPI_MCA_rmaps_base_oversubscribe", "OMPI_MCA_mpi_yield_when_idle"})
    setenv(one, "1", 1);
  setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 1);
  setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 1);
}

/// A program of the build on several ranks.
inline Outcome run_on_ranks(const Scratch& scratch, int ranks, const std::string& program,
                            const std::string& arguments) {
  set_mpi_for_tests();
  const auto out = scratch.root / "stdout.txt", err = scratch.root / "stderr.txt";
  const std::string command = "OMP_WAIT_POLICY=passive mpirun -n " + std::to_string(ranks) + " " +
                              std::string(GRANRAD_BIN_DIR) + "/" + program + " " + arguments + " >" +
                              out.string() + " 2>" + err.string() + " </dev/null";
  Outcome result;
  result.code = exit_code(std::system(command.c_str()));
  result.out = content(out);
  result.err = content(err);
  return result;
}

/// Process numbers of the ranks that write to this folder.
inline std::vector<pid_t> ranks_on(const fs::path& folder) {
  std::vector<pid_t> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string line = content(entry.path() / "cmdline");
    if (line.find("/granrun") < line.find('\0') && line.find(folder.string()) != std::string::npos)
      found.push_back(std::stoi(name));
  }
  return found;
}

/// Starts an endless run on ranks, signals one of them after the first frame; the launcher's exit code.
inline int stopped_by(const Scratch& scratch, const fs::path& scene, const fs::path& folder, int signal,
                      int ranks = 3, const std::string& more = "") {
  set_mpi_for_tests();
  const std::string command = "mpirun -n " + std::to_string(ranks) + " " GRANRAD_BIN_DIR "/granrun run " +
                              scene.string() + " -q --threads 1 --set scene.end_time_s=100 -o " +
                              folder.string() + more + " >" + (scratch.root / "stopped.txt").string() +
                              " 2>&1 </dev/null";
  std::thread stopper([&] {
    for (int wait = 0; wait < 1500 && !fs::exists(folder / "frames" / "f_000000800.hdf"); ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const auto found = ranks_on(folder);
    EXPECT_EQ(found.size(), static_cast<std::size_t>(ranks));
    if (!found.empty()) kill(found.back(), signal);
  });
  const int code = exit_code(std::system(command.c_str()));
  stopper.join();
  return code;
}

/// How often a text stands in another.
inline int times_said(const std::string& text, const std::string& what) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++count;
  return count;
}

}  // namespace granrad::cli
