#pragma once
#include "dem/base/constants.h"

namespace granrad {

enum class Verbosity { quiet, normal, verbose };

/// How a command is carried out; results do not depend on any of it.
struct RunOptions {
  bool resume = false;
  double walltime_s = infinity;  ///< save a checkpoint and stop after this
  int threads = 0;               ///< 0: OpenMP's default
  Verbosity verbosity = Verbosity::normal;

  bool quiet() const { return verbosity == Verbosity::quiet; }
};

}  // namespace granrad
