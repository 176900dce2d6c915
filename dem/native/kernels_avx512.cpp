#include "dem/native/kernel_bodies.h"
#include "dem/native/simd_mixed_avx512.h"

namespace granrad::native {
const Kernels& avx512_kernels() {
  using Mixed = PairBodies<Avx512Mixed>;
  static constexpr Kernels kernels =
      KernelBodies<Avx512Pack>::table("avx512", Mixed::contacts<false>, Mixed::contacts<true>);
  return kernels;
}
}  // namespace granrad::native
