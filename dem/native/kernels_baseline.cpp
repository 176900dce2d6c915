#include "dem/native/kernel_bodies.h"

namespace granrad::native {
const Kernels& baseline_kernels() {
  static constexpr Kernels kernels = KernelBodies<ScalarPack>::table("baseline");
  return kernels;
}
}  // namespace granrad::native
