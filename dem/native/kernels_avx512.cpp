#include "dem/native/kernel_bodies.h"
#include "dem/native/simd_avx512.h"

namespace granrad::native {
const Kernels& avx512_kernels() {
  static constexpr Kernels kernels = KernelBodies<Avx512Pack>::table("avx512");
  return kernels;
}
}  // namespace granrad::native
