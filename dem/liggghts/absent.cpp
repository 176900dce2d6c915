#include "dem/base/error.h"
#include "dem/engine_liggghts.h"

// The engine of a build without LIGGGHTS.
namespace granrad {

std::vector<std::string> liggghts_problems(const Scene&) {
  return {
      "is not built into this program; install libliggghts-dev and libopenmpi-dev and configure again, or "
      "use "
      "\"native\""};
}

std::unique_ptr<Engine> make_liggghts_engine(const Vec3&, double) {
  throw InputError("dem.engine = \"liggghts\" (" + liggghts_problems({}).front() + ")");
}

}  // namespace granrad
