#include "dem/native/kernel_bodies.h"
#include "dem/native/simd_avx2.h"
#include "dem/native/simd_mixed_avx2.h"

namespace granrad::native {
const Kernels& avx2_kernels() {
  static constexpr Kernels kernels = KernelBodies<Avx2Pack>::table(
      "avx2", PairBodies<Avx2Mixed>::contacts<false>, PairBodies<Avx2Mixed>::contacts<true>);
  return kernels;
}
}  // namespace granrad::native
