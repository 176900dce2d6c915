#include "dem/native/kernel_bodies.h"
#include "dem/native/simd_avx512.h"

namespace granrad::native {
const Kernels& avx512_kernels() {
  static const Kernels kernels = KernelBodies<Avx512Pack>::table("avx512", avx2_kernels().mixed_contacts,
                                                                 avx2_kernels().mixed_contacts_first);
  return kernels;
}
}  // namespace granrad::native
