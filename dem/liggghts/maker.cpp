#include "dem/base/error.h"
#include "dem/base/plugin.h"
#include "dem/engine_liggghts.h"
#include "dem/liggghts/plugin.h"

namespace granrad {

std::unique_ptr<Engine> make_liggghts_engine(const Vec3& gravity_m_s2, double step_s) {
  const auto file = plugin_file("granrad_liggghts");
  if (file.empty()) throw InputError("dem.engine = \"liggghts\" (" + liggghts_absent() + ")");
  const auto make = reinterpret_cast<decltype(&granrad_new_liggghts_engine)>(
      plugin_function(file, "granrad_new_liggghts_engine"));
  return std::unique_ptr<Engine>(make(gravity_m_s2, step_s));
}

}  // namespace granrad
