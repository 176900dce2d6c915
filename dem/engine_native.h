#pragma once
#include <memory>

#include "dem/engine.h"
#include "dem/scene/scene.h"

namespace granrad {

/// The native engine: Hertz-Mindlin with history (dem/native/hertz_mindlin.h) and leapfrog with rotation, SIMD
/// kernels for AVX-512, AVX2 and the baseline from one source (chosen at run time; GRANRAD_SIMD=avx512 | avx2
/// | baseline forces one), OpenMP, order-free fixed-point sums.
///
/// The leapfrog is written drift - kick - drift: x moves half a step, forces follow from there and from the
/// velocity at the step's start, v moves a whole step, x the other half. This is the map of velocity Verlet
/// seen half a step later, and a Bed (position, velocity and springs at one instant) is all it needs to go
/// on: cutting a run into pieces changes no bit. Neither do threads, list schedules and instruction sets.
///
/// Precision::mixed works the law of contacts between particles in single precision, eight at once:
/// positions, their differences, velocities between steps, the sums of forces and walls stay double, springs
/// and the velocities the law sees are rounded to single. Everything said above holds of its bits as well.
///
/// Touches take the areas of contacts at the middle of every step, where forces are.
/// threads: the most to use, 0: OpenMP's default. One alone is used where it is faster, which the engine finds
/// out in the run and now and then again: small beds, machines with other work. bed.time_s = bed.step x step_s after each advance.
std::unique_ptr<Engine> make_native_engine(const Bed& bed, const Vec3& gravity_m_s2, double step_s,
                                           int threads = 0, Precision precision = Precision::full);

}  // namespace granrad
