#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "dem/base/error.h"
#include "dem/native/kernels.h"

namespace granrad::native {
namespace {

bool machine_has_avx512() {
#if defined(GRANRAD_X86)
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
#else
  return false;
#endif
}

bool machine_has_avx2() {
#if defined(GRANRAD_X86)
  return __builtin_cpu_supports("avx2");
#else
  return false;
#endif
}

}  // namespace

const Kernels& select_kernels() {
  const char* variable = std::getenv("GRANRAD_SIMD");
  const std::string_view wish = variable ? variable : "";
  const bool known = wish.empty() || wish == "avx512" || wish == "avx2" || wish == "baseline";
  const bool possible = (wish != "avx512" || machine_has_avx512()) && (wish != "avx2" || machine_has_avx2());
  if (!known || !possible)
    throw InputError(advised(fmt::format("GRANRAD_SIMD = {} ({})", wish,
                                         known ? "this machine lacks it" : "unknown instruction set"),
                             "use avx512, avx2 or baseline, or leave it unset"));
#if defined(GRANRAD_X86)
  if (wish == "avx512" || (wish.empty() && machine_has_avx512())) return avx512_kernels();
  if (wish == "avx2" || (wish.empty() && machine_has_avx2())) return avx2_kernels();
#endif
  return baseline_kernels();
}

}  // namespace granrad::native
