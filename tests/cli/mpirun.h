#pragma once
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

/// How often a text stands in another.
inline int times_said(const std::string& text, const std::string& what) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++count;
  return count;
}

}  // namespace granrad::cli
