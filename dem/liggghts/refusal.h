#pragma once
#include <string>

namespace granrad::liggghts {

/// What LIGGGHTS says when it gives up: thrown in place of its exit() and MPI_Abort().
struct Refusal {
  std::string message;
};

}  // namespace granrad::liggghts
