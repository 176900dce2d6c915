#pragma once
#include <string>

#include "dem/engine.h"

namespace granrad {

/// What granrad_liggghts.so gives: a new engine of make_liggghts_engine, for the caller to delete. The part holds this
/// folder's code, LIGGGHTS and MPI, and its own copy of what it needs of dem/bed: granrad's programs link none of it.
extern "C" Engine* granrad_new_liggghts_engine(const Vec3& gravity_m_s2, double step_s);

/// Why there is none.
inline std::string liggghts_absent() {
  return "is not installed beside this program; install the package granrad-liggghts, or libliggghts-dev and libopenmpi-dev and configure "
         "again, or use \"native\"";
}

}  // namespace granrad
