#include "dem/native/kernel_bodies.h"
#include "dem/native/simd_mixed_scalar.h"

namespace granrad::native {
const Kernels& baseline_kernels() {
  static constexpr Kernels kernels = KernelBodies<ScalarPack>::table(
      "baseline", PairBodies<ScalarMixed>::contacts<false>, PairBodies<ScalarMixed>::contacts<true>);
  return kernels;
}
}  // namespace granrad::native
