#pragma once
#include <string>

#include "dem/base/constants.h"
#include "dem/base/program.h"

namespace granrad {

/// How a command is carried out; results do not depend on any of it.
struct RunOptions {
  bool resume = false;
  double walltime_s = infinity;  ///< save a checkpoint and stop after this
  int threads = 0;               ///< 0: OpenMP's default
  Verbosity verbosity = Verbosity::normal;
  std::string command_line{};  ///< as it was given, for the record

  bool quiet() const { return verbosity == Verbosity::quiet; }
  bool verbose() const { return verbosity == Verbosity::verbose; }
};

}  // namespace granrad
