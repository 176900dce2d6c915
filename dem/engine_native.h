#pragma once
#include <memory>

#include "dem/engine.h"
#include "dem/scene/scene.h"

namespace granrad {

/// The native engine: leapfrog (velocity Verlet) with rotation, Hertz-Mindlin with history, SIMD kernels for
/// AVX-512, AVX2 and the baseline from one source (chosen at run time), OpenMP, order-free fixed-point sums.
/// threads 0: OpenMP's default; results do not depend on it, nor on the instruction set.
std::unique_ptr<Engine> make_native_engine(const Bed& bed, const Vec3& gravity_m_s2, double step_s, int threads = 0);

}  // namespace granrad
