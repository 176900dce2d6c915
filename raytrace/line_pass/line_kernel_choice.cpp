#include <cstdlib>
#include <cstring>

#include "dem/base/error.h"
#include "raytrace/line_pass/line_kernel.h"

namespace granrad {

namespace line_avx512 {
extern const LineKernels kernels;
}
namespace line_avx2 {
extern const LineKernels kernels;
}
namespace line_baseline {
extern const LineKernels kernels;
}

namespace {
bool has_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
}
bool has_avx2() {
  return __builtin_cpu_supports("avx2");
}
}  // namespace

const LineKernels& line_kernels() {
  const char* wanted = std::getenv("GRANRAD_SIMD");
  const auto asked = [&](const char* name) { return !wanted || !*wanted || !std::strcmp(wanted, name); };
  if (asked("avx512") && has_avx512()) return line_avx512::kernels;
  if (asked("avx2") && has_avx2()) return line_avx2::kernels;
  if (asked("baseline")) return line_baseline::kernels;
  throw InputError(advised(
      "environment: GRANRAD_SIMD = " + std::string(wanted) + " (not an instruction set this machine runs)",
      "try avx512, avx2 or baseline, or unset it"));
}

}  // namespace granrad
